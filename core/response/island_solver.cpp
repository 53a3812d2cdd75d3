#include <signorini/core/response/island_solver.h>
#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/certificate.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace signorini {
namespace {

constexpr double kRough = 3e-3;   // m/s, see the table
constexpr double kCasual = 3e-6;  // m/s
// What solvers whose last steps square the residual aim at at least: a step or two more, while what
// a rougher answer leaves sets a pile in motion, which costs many.
constexpr double kExactAim = 1e-8;  // m/s
// Tolerances are powers of ten, so that islands share solvers. The least is below what rounding
// leaves of any problem: the answer is then solved to rounding, or not solved.
constexpr double kLeastTolerance = 1e-20;
constexpr double kMostTolerance = 0.1;
// What `sticking` is told of its aim after a correction, and the least that comes of it.
constexpr double kAfterCorrection = 0.1;
constexpr double kLeastAfterCorrection = 1e-10;
// The start is near; where rounding hides that aim more sets are waste.
constexpr int kCorrectionSets = 4;
constexpr double kRowsOfAUnit = 1000.0;
// However much a budget allows: a solver that has not ended by then does not.
constexpr double kMostIterations = 1e4;
// Impulses that differ by less, of their size, are the same.
constexpr double kSame = 1e-12;

double largest_q(const lcp::Problem& problem) {
  return problem.size() > 0 ? problem.q.cwiseAbs().maxCoeff() : 0.0;
}

/// The largest power of ten that keeps residual m/s, as a part of |q|.
double tolerance_for(double residual, double q_inf) {
  const double wanted = q_inf > 0.0 ? residual / q_inf : kMostTolerance;
  const double decade = std::pow(10.0, std::floor(std::log10(wanted) + 1e-9));
  return std::clamp(decade, kLeastTolerance, kMostTolerance);
}

bool sweeps(std::string_view name) {
  return name == "nsgs";
}

/// Work units of one iteration.
double unit_cost(std::string_view name, lcp::Index rows) {
  const double once = static_cast<double>(rows) / kRowsOfAUnit;
  return sweeps(name) ? once : StepBudget::kSweepsOfAFactor * once;
}

double spent(std::string_view name, const lcp::Result& result) {
  const auto& statistics = result.statistics;
  const int steps = sweeps(name) ? statistics.iterations
                                 : std::max(statistics.factorizations, statistics.iterations);
  return std::max(steps, 0) * unit_cost(name, result.z.size());
}

/// In any row by more than rounding.
bool differ(const lcp::Vector& z, const lcp::Vector& start) {
  return ((z - start).array().abs() > kSame * z.array().abs()).any();
}

}  // namespace

lcp::Solver& IslandSolver::solver(std::string_view name, double tolerance, int most) {
  auto made = std::ranges::find_if(
      made_, [&](const Made& one) { return one.tolerance == tolerance && one.name == name; });
  if (made == made_.end()) {
    made_.push_back({.name = std::string(name), .tolerance = tolerance, .solver = nullptr});
    made = std::prev(made_.end());
  }
  if (made->solver == nullptr || made->most != most) {
    lcp::SolverSettings own = settings_.lcp;
    own.tolerance = tolerance;
    own.max_iterations = most;
    made->solver = lcp::make_solver(name, own);
    made->most = most;
  }
  return *made->solver;
}

/// Of an island's problem: that of the dial where it is set.
double IslandSolver::tolerance(const lcp::Problem& problem) const {
  return settings_.accuracy ? tolerance_for(settings_.accuracy->residual(), largest_q(problem))
                            : settings_.lcp.tolerance;
}

void IslandSolver::solve(std::span<const JointRow> joints, const StepMemory& memory,
                         const StepBudget& budget, IslandAnswer& island) {
  const lcp::Problem& problem = island.velocity.problem();
  lcp::Result& result = island.result;
  island.work = 0.0;
  island.corrected = false;
  lcp::start_result(problem.size(), result);
  if (island.velocity.closed_form(result.z)) {
    result.solver = "closed form";
    result.certificate = certifier_.certify(problem, result.z, &result.w);
    result.status =
        lcp::judge(result.certificate, tolerance(problem), lcp::Status::kNumericalBreakdown);
    if (lcp::is_solved(result.status)) {
      return;
    }
  }
  ContactMemory::Recalled recalled;
  if (settings_.warm_start) {
    recalled = island.velocity.recall(island.contacts, memory.contacts, island.start);
  }
  const bool warm = settings_.warm_start && (recalled.known > 0 || !joints.empty());
  after_correction_ = recalled.corrected;
  if (warm) {
    recall_joints(joints, memory.joints, island.start);
    step_start_ = island.start;
  }
  if (settings_.accuracy) {
    solve_by_dial(problem, budget, warm, island);
  } else {
    solve_by_settings(problem, !joints.empty(), warm ? &island.start : nullptr, result);
  }
}

void IslandSolver::solve_by_settings(const lcp::Problem& problem, bool has_joints,
                                     const lcp::Vector* start, lcp::Result& result) {
  const std::string& without_cones = has_joints ? settings_.joint_solver : settings_.solver;
  const std::string& name = problem.cones.empty() ? without_cones : settings_.cone_solver;
  solver(name, settings_.lcp.tolerance, settings_.lcp.max_iterations).solve(problem, result, start);
}

void IslandSolver::choose(const lcp::Problem& problem, bool is_warm, bool is_limited) {
  const double residual = settings_.accuracy->residual();
  chain_.clear();
  if (!problem.cones.empty() && residual >= kCasual) {
    const bool rough = residual >= kRough;
    if (is_warm) {
      chain_.push_back({"sticking", "perhaps little slides", 3, true});
    } else {
      chain_.push_back({"cone-interior-point", "perhaps little slides", 30, true});
    }
    if (!is_limited) {
      chain_.push_back({"alart-curnier", "an accurate step is the next one's start", 30, true});
    }
    chain_.push_back({"nsgs", "little accuracy is asked", rough ? 50 : 200, false});
  }
  if (!is_limited) {
    const bool can_aim_lower = tolerance(problem) > kLeastAfterCorrection;
    if (chain_.empty() && is_warm && after_correction_ && can_aim_lower) {
      chain_.push_back({"sticking", "the step before was a correction", kCorrectionSets, true});
    }
    chain_.push_back({"auto", "whatever it takes", -1, false});
    return;
  }
  if (problem.cones.empty()) {
    chain_.push_back({"interior-point", "no friction", -1, false});
  } else if (residual < kCasual) {
    chain_.push_back({is_warm ? "sticking" : "cone-interior-point", "perhaps little slides",
                      is_warm ? 25 : 30, true});
  }
  chain_.push_back({"alart-curnier", "the budget allows it", -1, false});
  chain_.push_back({"nsgs", "what is left of the budget", -1, false});
}

/// What a solver of the dial is told.
double IslandSolver::aim(const Try& tried, const lcp::Problem& problem) const {
  const double asked = tolerance(problem);
  const double aimed =
      tried.is_fine ? std::min(asked, tolerance_for(kExactAim, largest_q(problem))) : asked;
  return after_correction_ && tried.solver == std::string_view("sticking")
             ? std::min(aimed, std::max(kAfterCorrection * aimed, kLeastAfterCorrection))
             : aimed;
}

/// @return whether the aim is met; the status is by what is asked
bool IslandSolver::attempt(const lcp::Problem& problem, const Try& tried, int most, double seconds,
                           const lcp::Vector* start, lcp::Result& result) {
  solver(tried.solver, aim(tried, problem), most).solve_within(seconds, problem, result, start);
  if (lcp::is_solved(result.status)) {
    return true;
  }
  result.status = lcp::judge(result.certificate, tolerance(problem), result.status);
  return false;
}

/// The start, or 0 where that is better: what a budget that pays for no solver gives.
void IslandSolver::certify_start(const lcp::Problem& problem, const lcp::Vector* start,
                                 lcp::Result& result) {
  start_.reset(problem, tolerance(problem));
  if (start != nullptr) {
    (void)start_.offer(*start);
  }
  result.solver = "none";
  result.z = start_.z();
  result.certificate = certifier_.certify(problem, result.z, &result.w);
  result.status = lcp::judge(result.certificate, tolerance(problem), lcp::Status::kIterationLimit);
}

/// Tries what the budget allows of the chain; the result is the best attempt's.
void IslandSolver::solve_by_dial(const lcp::Problem& problem, const StepBudget& budget,
                                 bool is_warm, IslandAnswer& island) {
  lcp::Result& result = island.result;
  const lcp::Vector* start = is_warm ? &island.start : nullptr;
  const lcp::Deadline deadline(budget.seconds);
  const auto merit = [](const lcp::Result& r) { return lcp::BestIterate::merit(r.certificate); };
  attempts_.clear();
  double seconds = 0.0;
  lcp::Status used_up = lcp::Status::kNotRun;  // what a budget that is used up ends in
  const auto take = [&](const Try& tried, int most) {
    const bool first = attempts_.empty();
    lcp::Result& one = first ? result : another_;
    const bool aim_met = attempt(problem, tried, most, deadline.left_seconds(), start, one);
    island.work += spent(tried.solver, one);
    seconds += one.statistics.solve_seconds;
    if (one.attempts.empty()) {
      attempts_.push_back({tried.solver, tried.reason, one.status, one.certificate.natural_residual,
                           one.certificate.unit_free_residual, one.statistics, one.detail});
    }
    attempts_.insert(attempts_.end(), one.attempts.begin(), one.attempts.end());
    const bool first_solved = lcp::is_solved(one.status) && !lcp::is_solved(result.status);
    if (!first && (first_solved || merit(one) < merit(result))) {
      std::swap(result, another_);
    }
    return aim_met;
  };
  lcp::start_result(problem.size(), result);
  choose(problem, is_warm, budget.is_limited());
  for (std::size_t k = 0; k < chain_.size(); ++k) {
    const Try& next = chain_[k];
    const double allowed =
        std::floor((budget.work - island.work) / unit_cost(next.solver, problem.size()) + 1e-9);
    if (!(allowed >= 1.0) || deadline.passed()) {
      used_up = !deadline.passed() ? lcp::Status::kIterationLimit : lcp::Status::kTimeLimit;
      continue;  // a cheaper one may still fit
    }
    const int most = !std::isfinite(allowed) ? next.most
                     : next.most < 0         ? static_cast<int>(std::min(allowed, kMostIterations))
                                     : static_cast<int>(std::min<double>(next.most, allowed));
    if (!solver(next.solver, aim(next, problem), most).refuses(problem).empty()) {
      continue;
    }
    const bool aim_met = take(next, most);
    const bool may_do_better = !aim_met && k + 1 < chain_.size() && chain_[k + 1].is_fine;
    if (lcp::is_solved(result.status) && !may_do_better) {
      break;
    }
    island.start = result.z;
    start = &island.start;
  }
  if (attempts_.empty()) {
    certify_start(problem, start, result);
  }
  if (used_up != lcp::Status::kNotRun && !lcp::is_solved(result.status)) {
    result.status = used_up;
    result.detail += (result.detail.empty() ? "" : "; ") + std::string("budget used up");
  }
  result.statistics.solve_seconds = seconds;
  island.corrected = is_warm && lcp::is_solved(result.status) && !attempts_.empty() &&
                     attempts_.back().solver == "sticking" &&
                     attempts_.back().statistics.factorizations > 0 &&
                     differ(result.z, step_start_);
  std::swap(result.attempts, attempts_);
}

bool is_worse(const lcp::Result& result, const lcp::Result& than) {
  const bool solved = lcp::is_solved(result.status);
  if (solved != lcp::is_solved(than.status)) {
    return !solved;
  }
  return solved && result.certificate.unit_free_residual > than.certificate.unit_free_residual;
}

void describe(const ContactIsland& island, const VelocityProblem& velocity,
              const lcp::Result& result, FrictionModel model, IslandReport& report) {
  const lcp::Problem& problem = velocity.problem();
  const std::size_t frictionless_rows = island.contacts.size() + island.joints.size();
  const bool friction = problem.size() > static_cast<lcp::Index>(frictionless_rows);
  report.joint_rows = static_cast<int>(island.joints.size());
  report.bodies = static_cast<int>(std::ranges::count_if(island.bodies, &Body::is_dynamic));
  report.contacts = static_cast<int>(island.contacts.size());
  report.rows = static_cast<int>(problem.size());
  report.columns = velocity.columns();
  report.model = report.contacts == 1 && report.joint_rows == 0 ? "single contact, " : "";
  report.model += friction ? to_string(model) : "frictionless";
  if (model == FrictionModel::kCone && !problem.limits.empty()) {
    report.model += ", box where turning is resisted";
  }
  report.solver = result.solver;
  report.status = result.status;
  report.unit_free_residual = result.certificate.unit_free_residual;
  report.residual = report.unit_free_residual * largest_q(problem);
  report.work = 0.0;
}

}  // namespace signorini
