#include <signorini/core/response/island_solver.h>
#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/certificate.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace signorini {
namespace {

constexpr double kRough = 3e-3;   // m/s, see the table
constexpr double kCasual = 3e-6;  // m/s
// Tolerances are powers of ten, so that islands share solvers; a residual below this is left to
// rounding.
constexpr double kLeastTolerance = 1e-14;
constexpr double kMostTolerance = 0.1;
constexpr double kRowsOfAUnit = 1000.0;

/// The largest power of ten that keeps residual m/s, as a part of |q|.
double tolerance_for(double residual, double q_inf) {
  const double wanted = q_inf > 0.0 ? residual / q_inf : kMostTolerance;
  const double decade = std::pow(10.0, std::floor(std::log10(wanted) + 1e-9));
  return std::clamp(decade, kLeastTolerance, kMostTolerance);
}

bool sweeps(const std::string& name) {
  return name == "nsgs";
}

/// Work units of one iteration.
double unit_cost(const std::string& name, lcp::Index rows) {
  const double once = static_cast<double>(rows) / kRowsOfAUnit;
  return sweeps(name) ? once : StepBudget::kSweepsOfAFactor * once;
}

double spent(const std::string& name, const lcp::Result& result) {
  const auto& statistics = result.statistics;
  const int steps = sweeps(name) ? statistics.iterations
                                 : std::max(statistics.factorizations, statistics.iterations);
  return std::max(steps, 0) * unit_cost(name, result.z.size());
}

}  // namespace

lcp::Solver& IslandSolver::solver(const std::string& name, double tolerance, int most) {
  std::unique_ptr<lcp::Solver>& found = solvers_[{name, {tolerance, most}}];
  if (found == nullptr) {
    lcp::SolverSettings own = settings_.lcp;
    own.tolerance = tolerance;
    own.max_iterations = most;
    found = lcp::make_solver(name, own);
  }
  return *found;
}

void IslandSolver::solve(const VelocityProblem& velocity, const ContactSet& contacts,
                         std::span<const JointRow> joints, const StepMemory& memory,
                         const StepBudget& budget, lcp::Result& result, double& work) {
  const lcp::Problem& problem = velocity.problem();
  work = 0.0;
  result = {};
  result.z = velocity.closed_form();
  if (result.z.size() > 0) {
    result.solver = "closed form";
    result.certificate = lcp::certify(problem, result.z, &result.w);
    result.status =
        lcp::judge(result.certificate, settings_.lcp.tolerance, lcp::Status::kNumericalBreakdown);
    if (lcp::is_solved(result.status)) {
      return;
    }
  }
  const bool warm = settings_.warm_start &&
                    (velocity.recall(contacts, memory.contacts, start_) > 0 || !joints.empty());
  if (warm) {
    recall_joints(joints, memory.joints, start_);
  }
  const lcp::Vector* start = warm ? &start_ : nullptr;
  if (settings_.accuracy) {
    solve_by_dial(problem, start, budget, result, work);
  } else {
    solve_by_settings(problem, !joints.empty(), start, result);
  }
}

void IslandSolver::solve_by_settings(const lcp::Problem& problem, bool has_joints,
                                     const lcp::Vector* start, lcp::Result& result) {
  const std::string& without_cones = has_joints ? settings_.joint_solver : settings_.solver;
  const std::string& name = problem.cones.empty() ? without_cones : settings_.cone_solver;
  solver(name, settings_.lcp.tolerance, settings_.lcp.max_iterations).solve(problem, result, start);
}

std::vector<IslandSolver::Try> IslandSolver::choose(const lcp::Problem& problem, bool is_warm,
                                                    bool is_limited) const {
  const double residual = settings_.accuracy->residual();
  std::vector<Try> chain;
  if (!problem.cones.empty() && residual >= kCasual) {
    const bool rough = residual >= kRough;
    if (is_warm) {
      chain.push_back({"sticking", "perhaps little slides", rough ? 2 : 6});
    } else {
      chain.push_back({"cone-interior-point", "perhaps little slides", 30});
    }
    chain.push_back({"nsgs", "little accuracy is asked", rough ? 50 : 200});
    if (rough) {
      return chain;
    }
  }
  if (!is_limited) {
    chain.push_back({"auto", "whatever it takes", -1});
    return chain;
  }
  if (problem.cones.empty()) {
    chain.push_back({"interior-point", "no friction", -1});
  } else if (residual < kCasual) {
    chain.push_back(
        {is_warm ? "sticking" : "cone-interior-point", "perhaps little slides", is_warm ? 25 : 30});
  }
  chain.push_back({"alart-curnier", "the budget allows it", -1});
  chain.push_back({"nsgs", "what is left of the budget", -1});
  return chain;
}

/// Tries the chain while the budget lasts; result is the best attempt's.
void IslandSolver::solve_by_dial(const lcp::Problem& problem, const lcp::Vector* start,
                                 const StepBudget& budget, lcp::Result& result, double& work) {
  const double q_inf = problem.size() > 0 ? problem.q.cwiseAbs().maxCoeff() : 0.0;
  const double tolerance = tolerance_for(settings_.accuracy->residual(), q_inf);
  const lcp::Deadline deadline(budget.seconds);
  const auto merit = [](const lcp::Result& r) { return lcp::BestIterate::merit(r.certificate); };
  std::vector<lcp::Attempt> attempts;
  bool has_result = false;
  bool is_short = false;
  for (const Try& next : choose(problem, start != nullptr, budget.is_limited())) {
    if (!solver(next.solver, tolerance, next.most).refuses(problem).empty()) {
      continue;
    }
    const double allowed =
        std::floor((budget.work - work) / unit_cost(next.solver, problem.size()) + 1e-9);
    const double left = budget.seconds - deadline.elapsed_seconds();
    is_short = is_short || !(allowed >= 1.0) || !(left > 0.0);
    // Where nothing is left the start is certified, and that is the answer.
    if (is_short && has_result) {
      break;
    }
    const int most = !std::isfinite(allowed) ? next.most
                     : next.most < 0         ? static_cast<int>(std::clamp(allowed, 0.0, 1e9))
                                             : std::min(next.most, static_cast<int>(allowed));
    lcp::Result one;
    if (std::isfinite(budget.seconds)) {  // a solver's time is in its settings
      lcp::SolverSettings own = settings_.lcp;
      own.tolerance = tolerance;
      own.max_iterations = is_short ? 0 : most;
      own.time_limit = std::max(left, 1e-9);
      lcp::make_solver(is_short ? "nsgs" : next.solver, own)->solve(problem, one, start);
    } else {
      solver(is_short ? "nsgs" : next.solver, tolerance, is_short ? 0 : most)
          .solve(problem, one, start);
    }
    work += spent(next.solver, one);
    attempts.push_back({next.solver, next.reason, one.status, one.certificate.natural_residual,
                        one.certificate.unit_free_residual, one.statistics, one.detail});
    const bool solved = lcp::is_solved(one.status);
    if (!has_result || solved || merit(one) < merit(result)) {
      result = std::move(one);
      has_result = true;
      if (!solved) {
        start_ = result.z;
        start = &start_;
      }
    }
    if (solved) {
      break;
    }
  }
  if (is_short && !lcp::is_solved(result.status)) {
    result.status =
        std::isfinite(budget.work) ? lcp::Status::kIterationLimit : lcp::Status::kTimeLimit;
    result.detail += (result.detail.empty() ? "" : "; ") + std::string("budget used up");
  }
  if (result.attempts.empty()) {
    result.attempts = std::move(attempts);
  }
}

}  // namespace signorini
