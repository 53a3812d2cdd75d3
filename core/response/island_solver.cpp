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
// What steps_are_exact() aims at at least: a step or two more, while what a rougher answer leaves
// sets a pile in motion, which costs many.
constexpr double kExactAim = 1e-8;  // m/s
// Tolerances are powers of ten, so that islands share solvers. The least is below what rounding
// leaves of any problem: the answer is then solved to rounding, or not solved.
constexpr double kLeastTolerance = 1e-20;
constexpr double kMostTolerance = 0.1;
constexpr double kRowsOfAUnit = 1000.0;
constexpr double kMostIterations = 1e9;  // that a budget may allow
constexpr double kLeastSeconds = 1e-9;   // a solver's limit is > 0

bool is_worse(const lcp::Result& a, const lcp::Result& b) {
  const bool solved = lcp::is_solved(a.status);
  if (solved != lcp::is_solved(b.status)) {
    return !solved;
  }
  return solved && a.certificate.unit_free_residual > b.certificate.unit_free_residual;
}

double largest_q(const lcp::Problem& problem) {
  return problem.size() > 0 ? problem.q.cwiseAbs().maxCoeff() : 0.0;
}

/// The largest power of ten that keeps residual m/s, as a part of |q|.
double tolerance_for(double residual, double q_inf) {
  const double wanted = q_inf > 0.0 ? residual / q_inf : kMostTolerance;
  const double decade = std::pow(10.0, std::floor(std::log10(wanted) + 1e-9));
  return std::clamp(decade, kLeastTolerance, kMostTolerance);
}

bool sweeps(const std::string& name) {
  return name == "nsgs";
}

/// Solvers whose last steps square the residual.
bool steps_are_exact(const std::string& name) {
  return name == "sticking" || name == "cone-interior-point";
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
  Made& made = made_[{name, tolerance}];
  if (made.solver == nullptr || made.most != most) {
    lcp::SolverSettings own = settings_.lcp;
    own.tolerance = tolerance;
    own.max_iterations = most;
    made = {most, lcp::make_solver(name, own)};
  }
  return *made.solver;
}

/// Of an island's problem: that of the dial where it is set.
double IslandSolver::tolerance(const lcp::Problem& problem) const {
  return settings_.accuracy ? tolerance_for(settings_.accuracy->residual(), largest_q(problem))
                            : settings_.lcp.tolerance;
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
        lcp::judge(result.certificate, tolerance(problem), lcp::Status::kNumericalBreakdown);
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
      chain.push_back({"sticking", "perhaps little slides", 6});
    } else {
      chain.push_back({"cone-interior-point", "perhaps little slides", 30});
    }
    chain.push_back({"nsgs", "little accuracy is asked", rough ? 50 : 200});
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

lcp::Result IslandSolver::attempt(const lcp::Problem& problem, const std::string& name, int most,
                                  double seconds, const lcp::Vector* start) {
  const double asked = tolerance(problem);
  const double aim =
      steps_are_exact(name) ? std::min(asked, tolerance_for(kExactAim, largest_q(problem))) : asked;
  lcp::Result result;
  if (std::isfinite(seconds)) {  // a solver's time is in its settings
    lcp::SolverSettings own = settings_.lcp;
    own.tolerance = aim;
    own.max_iterations = most;
    own.time_limit = std::min(own.time_limit, std::max(seconds, kLeastSeconds));
    lcp::make_solver(name, own)->solve(problem, result, start);
  } else {
    solver(name, aim, most).solve(problem, result, start);
  }
  if (aim < asked && !lcp::is_solved(result.status)) {
    result.status = lcp::judge(result.certificate, asked, result.status);
  }
  return result;
}

/// Tries what the budget allows of the chain; result is the best attempt's.
void IslandSolver::solve_by_dial(const lcp::Problem& problem, const lcp::Vector* start,
                                 const StepBudget& budget, lcp::Result& result, double& work) {
  const lcp::Deadline deadline(budget.seconds);
  const auto left = [&] { return budget.seconds - deadline.elapsed_seconds(); };
  const auto merit = [](const lcp::Result& r) { return lcp::BestIterate::merit(r.certificate); };
  std::vector<lcp::Attempt> attempts;
  double seconds = 0.0;
  lcp::Status used_up = lcp::Status::kNotRun;  // what a budget that is used up ends in
  const auto take = [&](const Try& tried, lcp::Result&& one) {
    work += spent(tried.solver, one);
    seconds += one.statistics.solve_seconds;
    if (one.attempts.empty()) {
      one.attempts.push_back({tried.solver, tried.reason, one.status,
                              one.certificate.natural_residual, one.certificate.unit_free_residual,
                              one.statistics, one.detail});
    }
    attempts.insert(attempts.end(), one.attempts.begin(), one.attempts.end());
    const bool solved = lcp::is_solved(one.status);
    if (result.status == lcp::Status::kNotRun || solved || merit(one) < merit(result)) {
      result = std::move(one);
    }
    return solved;
  };
  result = {};
  for (const Try& next : choose(problem, start != nullptr, budget.is_limited())) {
    const double allowed =
        std::floor((budget.work - work) / unit_cost(next.solver, problem.size()) + 1e-9);
    if (!(allowed >= 1.0) || !(left() > 0.0)) {
      used_up = left() > 0.0 ? lcp::Status::kIterationLimit : lcp::Status::kTimeLimit;
      continue;  // a cheaper one may still fit
    }
    if (!solver(next.solver, tolerance(problem), next.most).refuses(problem).empty()) {
      continue;
    }
    const int most = !std::isfinite(allowed) ? next.most
                     : next.most < 0         ? static_cast<int>(std::min(allowed, kMostIterations))
                                     : static_cast<int>(std::min<double>(next.most, allowed));
    if (take(next, attempt(problem, next.solver, most, left(), start))) {
      break;
    }
    start_ = result.z;
    start = &start_;
  }
  if (result.status == lcp::Status::kNotRun) {  // nothing could be tried
    const Try none{"nsgs", "certifies the start", 0};
    take(none, attempt(problem, none.solver, none.most, left(), start));
  }
  if (used_up != lcp::Status::kNotRun && !lcp::is_solved(result.status)) {
    result.status = used_up;
    result.detail += (result.detail.empty() ? "" : "; ") + std::string("budget used up");
  }
  result.statistics.solve_seconds = seconds;
  result.attempts = std::move(attempts);
}

void keep_worse(lcp::Result&& result, lcp::Result& kept) {
  const double seconds =
      std::max(result.statistics.solve_seconds, 0.0) + std::max(kept.statistics.solve_seconds, 0.0);
  if (kept.status == lcp::Status::kNotRun || is_worse(result, kept)) {
    kept = std::move(result);
  }
  kept.statistics.solve_seconds = seconds;
}

IslandReport describe(const ContactIsland& island, const lcp::Problem& problem,
                      const lcp::Result& result, FrictionModel model) {
  const std::size_t frictionless_rows = island.contacts.size() + island.joints.size();
  const bool friction = problem.size() > static_cast<lcp::Index>(frictionless_rows);
  IslandReport report;
  report.joint_rows = static_cast<int>(island.joints.size());
  report.bodies = static_cast<int>(std::ranges::count_if(island.bodies, &Body::is_dynamic));
  report.contacts = static_cast<int>(island.contacts.size());
  report.rows = static_cast<int>(problem.size());
  report.model = (report.contacts == 1 && report.joint_rows == 0 ? "single contact, " : "") +
                 std::string(friction ? to_string(model) : "frictionless");
  if (model == FrictionModel::kCone && !problem.limits.empty()) {
    report.model += ", box where turning is resisted";
  }
  report.solver = result.solver;
  report.status = result.status;
  report.unit_free_residual = result.certificate.unit_free_residual;
  report.residual = report.unit_free_residual * largest_q(problem);
  return report;
}

}  // namespace signorini
