#pragma once

#include <signorini/integrations/bullet/settings.h>
#include <signorini/lcp/certificate.h>
#include <signorini/lcp/solver.h>

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace signorini::bullet {

/// Which problem gave the answer that was certified.
enum class Route : std::uint8_t {
  kNone,       ///< there was nothing to solve
  kUnchanged,  ///< the warm start was the answer already
  kBounds,     ///< the problem has no friction
  kSticking,   ///< as if no contact slipped; no friction bound was then violated
  kCoupled,    ///< friction bounds and normal impulses together
};

/// "none", "unchanged", "bounds", "sticking" or "coupled".
[[nodiscard]] std::string_view to_string(Route route);

/// Solves contact problems, the cheap way first. Knows no Bullet.
///
/// 1. Where nothing moves, the impulses of the last step are still an answer, which one certificate
///    tells.
/// 2. A contact that sticks is w_T = 0 with z_T free. With all tangents free the problem is a mixed
///    LCP, symmetric and positive semidefinite, which the interior point solves in a few
///    factorisations. If its z keeps all friction bounds it solves the coupled problem too, which
///    the certificate of the coupled problem then says. Redundant contacts leave a choice of z;
///    with the tangents soft first it falls on one with little friction. Not tried where the warm
///    start has a contact at its friction bound, nor with many cones whose start is far off.
/// 3. Else the coupled problem is solved, from the best z known. Box friction: small problems by
///    Dantzig, others by Alart-Curnier. Cones: a few steps of Alart-Curnier, before or (many rows
///    whose start is far off) after the interior point over the cones. What these do not solve is
///    left to `auto`.
///
/// Sticking is solved a hundred times more accurately than the tolerance asks, which is cheap, so
/// that the answer still holds in the steps that follow.
class ContactSolver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit ContactSolver(const Settings& settings);

  /// @param problem M factored; cones and limits as friction bounds; the bounds that they override
  /// must be
  /// -+infinity. Changed during the call, the same afterwards.
  /// @param warm_start null, or n numbers
  /// @param result status, z, w and certificate are those of the problem as given, whichever route
  /// was taken; attempts lists every solver tried
  Route solve(lcp::Problem& problem, const lcp::Vector* warm_start, lcp::Result& result);

 private:
  /// A solver, and what it was told.
  struct Method {
    Method(std::string_view name, const lcp::SolverSettings& settings);
    lcp::SolverSettings settings;
    std::unique_ptr<lcp::Solver> solver;
  };

  bool is_still_solved(const lcp::Problem& problem, const lcp::Vector& z, lcp::Result& result);
  void soften(const lcp::Problem& problem);
  void try_sticking(lcp::Problem& problem, const lcp::Vector* warm_start, lcp::Result& result);
  void try_solver(Method& method, std::string_view reason, const lcp::Problem& problem,
                  lcp::Result& result);
  void try_cones(const lcp::Problem& problem, lcp::Result& result);
  bool has_time(Method& method, lcp::Result& result);
  void keep_better(std::string_view solver, std::string_view reason, lcp::Result& result);
  void record(const lcp::Problem& problem, const lcp::Vector* warm_start, lcp::Result& result);

  lcp::SolverSettings settings_;
  lcp::SolveRecorder* recorder_;
  Method sticking_;  // bounds and free rows
  Method boxes_;     // friction
  Method steps_;     // cones: few from a start
  Method inside_;    // cones
  Method anything_;
  lcp::Certifier certifier_;
  lcp::Result one_;
  lcp::Vector start_;
  lcp::Problem soft_;
  lcp::Vector diagonal_, softness_;
  std::vector<lcp::FrictionCone> cones_;  // held back while the problem is solved without them
  std::vector<lcp::CoupledLimit> limits_;
  std::vector<lcp::Attempt> attempts_;
  lcp::Statistics total_;
  lcp::Deadline clock_;  // of the solve that is running
};

}  // namespace signorini::bullet
