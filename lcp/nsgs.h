#pragma once

#include <signorini/lcp/solver.h>

#include <memory>

namespace signorini::lcp {

/// Settings of Nsgs.
struct NsgsSettings : SolverSettings {
  /// Sweeps when max_iterations is -1.
  static constexpr int kDefaultSweeps = 10000;

  /// Sweeps between two looks at the residual, >= 1; the first looks come at sweeps 0, 1, 2, 4 ...
  int check_period = 16;
  /// Iterations of a contact's own problem, >= 1. They end earlier where they move little (below).
  int local_iterations = 50;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Nonsmooth Gauss-Seidel over contacts: sweeps over the groups c (a cone's rows, or one row with
/// bounds), each time solving the group's own problem with the newest z of all others,
///
///     z_c <- P_K(z_c - w~_c / D_c) until it moves by less than 3 % of its change,
///     w_c = M_cc z_c + (w_c - M_cc z_c)_old,
///
/// w~ and D_c as in Certificate (Jean, The non-smooth contact dynamics method, 1999; Acary,
/// Bremond, Huber 2018, section 4.2; the local iteration is De Saxce and Feng's). Cheap to moderate
/// accuracy, slow to high; no convergence is promised with Coulomb's law.
///
/// Takes all rows of problem.h but coupled limits. Over a factored M the body-space velocity is
/// kept, over a given M the product M z; both are recomputed from z at every look.
///
/// Endings beside solved: kIterationLimit, kTimeLimit, kStalled if a sweep changes no bit,
/// kNumericalBreakdown if a number overflowed. z is the best iterate by certificate.
/// Cost: a sweep is O(entries of J or M) and the local iterations.
class Nsgs : public Solver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit Nsgs(const NsgsSettings& settings = {});
  ~Nsgs() override;

  [[nodiscard]] std::string_view name() const override { return "nsgs"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  class Workspace;
  NsgsSettings settings_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace signorini::lcp
