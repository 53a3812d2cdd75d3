#pragma once

#include <signorini/core/response/accuracy.h>
#include <signorini/core/response/contact_islands.h>
#include <signorini/core/response/step_report.h>
#include <signorini/core/response/velocity_problem.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

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

/// Solves islands one after the other with solvers of its own, for one thread. The answer depends
/// on the island and the memory alone, not on what was solved before.
///
/// One contact is answered in closed form where it has one, and certified like any other. With the
/// dial (accuracy set) an island is tried in this order, until its residual is met; each starts
/// from the best iterate so far:
///
/// - residual >= 3e-6 (preview, game), friction: sticking (6 sets) where warm, else
///   cone-interior-point (30 steps), both to 1e-8 m/s, judged by the residual; nsgs (preview: 50
///   sweeps, else 200); auto
/// - else, and without friction: auto
///
/// With a budget auto, which knows none, gives way to interior-point (no friction), alart-curnier
/// and nsgs. What the rest of the budget does not pay for is left out; where it pays for nothing
/// the start is certified, and that is the answer. Result::attempts lists all, auto's too.
class IslandSolver {
 public:
  explicit IslandSolver(const IslandSettings& settings) : settings_(settings) {}

  /// @param contacts with the scene's body numbers, as the memory has them
  /// @param budget of this island
  /// @param work receives what was spent, in units of StepBudget::work
  void solve(const VelocityProblem& velocity, const ContactSet& contacts,
             std::span<const JointRow> joints, const StepMemory& memory, const StepBudget& budget,
             lcp::Result& result, double& work);

 private:
  struct Try {
    const char* solver;
    const char* reason;
    int most;  ///< iterations, -1: the solver's own
  };
  /// One of each name and tolerance is kept, made anew where its iterations change: those that a
  /// budget allows are any number.
  struct Made {
    int most = -1;
    std::unique_ptr<lcp::Solver> solver;
  };
  void solve_by_settings(const lcp::Problem& problem, bool has_joints, const lcp::Vector* start,
                         lcp::Result& result);
  void solve_by_dial(const lcp::Problem& problem, const lcp::Vector* start,
                     const StepBudget& budget, lcp::Result& result, double& work);
  [[nodiscard]] std::vector<Try> choose(const lcp::Problem& problem, bool is_warm,
                                        bool is_limited) const;
  [[nodiscard]] double tolerance(const lcp::Problem& problem) const;
  [[nodiscard]] lcp::Result attempt(const lcp::Problem& problem, const std::string& name, int most,
                                    double seconds, const lcp::Vector* start);
  [[nodiscard]] lcp::Solver& solver(const std::string& name, double tolerance, int most);

  IslandSettings settings_;
  std::map<std::pair<std::string, double>, Made> made_;
  lcp::Vector start_;
};

/// What was solved for an island, and how well.
[[nodiscard]] IslandReport describe(const ContactIsland& island, const lcp::Problem& problem,
                                    const lcp::Result& result, FrictionModel model);

/// Keeps the result of the island that ended worse (not solved before solved, then by the unit-free
/// residual), with the sum of both times.
void keep_worse(lcp::Result&& result, lcp::Result& kept);

}  // namespace signorini
