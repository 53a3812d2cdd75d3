#pragma once

#include <signorini/core/response/accuracy.h>
#include <signorini/core/response/contact_islands.h>
#include <signorini/core/response/step_report.h>
#include <signorini/core/response/velocity_problem.h>
#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace signorini {

/// How the problems of islands are solved: the part of TimeStepSettings that says so.
struct IslandSettings {
  std::string solver;
  std::string cone_solver;
  std::string joint_solver;
  lcp::SolverSettings lcp;
  std::optional<Accuracy> accuracy;  ///< set: chooses solvers and tolerance, these are not used
  bool warm_start = true;
};

/// What the impulses of the step before say about this one.
struct StepMemory {
  const ContactMemory& contacts;
  const JointMemory& joints;
};

/// An island's problem and its solution; kept from step to step, for its memory.
struct IslandAnswer {
  VelocityProblem velocity;
  /// With the scene's body numbers, as the memory of the step before has them.
  ContactSet contacts;
  lcp::Vector start;  ///< of the warm start
  lcp::Result result;
  double work = 0.0;  ///< what was spent, in units of StepBudget::work
  /// Of the dial: whether a start that nearly was the answer was made so (by `sticking`), its
  /// impulses changed.
  bool corrected = false;
  double assemble_seconds = 0.0;  ///< wall time of making `velocity`, s
};

/// Solves islands one after the other with solvers of its own, for one thread. The answer depends
/// on the island and the memory alone, not on what was solved before.
///
/// One contact is answered in closed form where it has one, and certified like any other. With the
/// dial (accuracy set) an island is tried in this order, until its residual is met; each starts
/// from the best iterate so far:
///
/// - residual >= 3e-6 (preview, game), friction: sticking (3 sets) where warm, else
///   cone-interior-point (30 steps), then alart-curnier (30 steps), all to 1e-8 m/s: their last
///   steps square the residual, and what a rougher answer leaves comes back in the next step. Where
///   none gets there the best is judged by the residual; nsgs (preview: 50 sweeps, else 200); auto
/// - else, and without friction: auto
///
/// What is at rest starts from its answer, and stays as it is while that is far below what is
/// asked. A start that no longer is gets corrected, and the impulses of that step also stop what
/// little moves: the next step must not start from them unasked, or it sets going as much the other
/// way, and every second step is a correction. So after one sticking is tried first (4 sets)
/// and told a tenth of its aim (down to 1e-10 of |q|), while the residual asked judges as ever.
///
/// With a budget auto, which knows none, gives way to interior-point (no friction), alart-curnier
/// and nsgs. What the rest of the budget does not pay for is left out; where it pays for nothing
/// the start is certified, and that is the answer (solver "none"). Result::attempts lists all,
/// auto's too.
class IslandSolver {
 public:
  explicit IslandSolver(const IslandSettings& settings) : settings_(settings) {}

  /// @param island has velocity and contacts; receives result and work
  /// @param budget of this island
  void solve(std::span<const JointRow> joints, const StepMemory& memory, const StepBudget& budget,
             IslandAnswer& island);

 private:
  struct Try {
    const char* solver;
    const char* reason;
    int most;      ///< iterations, -1: the solver's own
    bool is_fine;  ///< aims at kExactAim at least
  };
  /// One of each name and tolerance is kept, made anew where its iterations change: those that a
  /// budget allows are any number.
  struct Made {
    std::string name;
    double tolerance = 0.0;
    int most = -1;
    std::unique_ptr<lcp::Solver> solver;
  };
  void solve_by_settings(const lcp::Problem& problem, bool has_joints, const lcp::Vector* start,
                         lcp::Result& result);
  void solve_by_dial(const lcp::Problem& problem, const StepBudget& budget, bool is_warm,
                     IslandAnswer& island);
  void choose(const lcp::Problem& problem, bool is_warm, bool is_limited);
  [[nodiscard]] double tolerance(const lcp::Problem& problem) const;
  [[nodiscard]] double aim(const Try& tried, const lcp::Problem& problem) const;
  [[nodiscard]] bool attempt(const lcp::Problem& problem, const Try& tried, int most,
                             double seconds, const lcp::Vector* start, lcp::Result& result);
  void certify_start(const lcp::Problem& problem, const lcp::Vector* start, lcp::Result& result);
  [[nodiscard]] lcp::Solver& solver(std::string_view name, double tolerance, int most);

  IslandSettings settings_;
  std::vector<Made> made_;
  lcp::Certifier certifier_;
  lcp::BestIterate start_;
  std::vector<Try> chain_;
  bool after_correction_ = false;  // the island's start
  lcp::Vector step_start_;         // where warm: of the step, before any attempt
  lcp::Result another_;            // of an attempt that is not an island's first
  std::vector<lcp::Attempt> attempts_;
};

/// What was solved for an island, and how well.
void describe(const ContactIsland& island, const VelocityProblem& velocity,
              const lcp::Result& result, FrictionModel model, IslandReport& report);

/// Whether the result of an island is worse than that of another: not solved before solved, then by
/// the unit-free residual.
[[nodiscard]] bool is_worse(const lcp::Result& result, const lcp::Result& than);

}  // namespace signorini
