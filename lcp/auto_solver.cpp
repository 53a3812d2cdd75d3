#include <signorini/lcp/auto_solver.h>
#include <signorini/lcp/mass_ratio.h>
#include <signorini/lcp/ray.h>
#include <signorini/lcp/symmetric_lcp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Index kSmall = 100;                 // rows up to which dense pivoting is the fastest
constexpr Index kSmallCold = 48;              // the same, of a factored M without a start
constexpr Index kSmallCycles = 72;            // the same, where bodies are in cycles and differ
constexpr Index kSingleContactRows = 180;     // up to which a guess and pivots beat Newton's steps
constexpr int kPivotsFromAGuess = 360;        // then it was none
constexpr Index kStructuredLemkeRows = 2000;  // a pivot costs up to n^2 / 2
constexpr Index kLemkeRows = 1000;            // the same, with larger constants
constexpr double kMassRatioForSweeps = 1e3;   // above it sweeps stall
constexpr std::size_t kAttemptsKept = 16;     // no chain is longer
constexpr int kFirstSweeps = 48;
constexpr int kConeInteriorSteps = 30;  // where nothing slides about ten are enough
constexpr int kConeNewtonSteps = 400;   // what takes more is as a rule beyond it
constexpr int kSetsForLastDigits = 2;
constexpr int kBlockPivotingSets = 50;  // real problems need up to 20; more only where it cycles
// An interior point of this many rows costs a few milliseconds: sweeps only win where little
// accuracy is asked.
constexpr Index kRowsForAccurateSweeps = 5000;
constexpr double kRoughTolerance = 1e-5;
constexpr double kCaution = 1.5;  // rates fall as sweeps go on
// From an iterate worse than this a path takes more factorisations than from none.
constexpr double kWarmEnough = 1e-4;
// Rows that are not tangential up to which a proof that there is no answer costs less than one
// factorisation of Newton's.
constexpr Index kNormalsBeforeNewton = 300;
// A z that is |q| over this part of M has a rounding floor above what any certificate excuses.
constexpr double kRoundingOfM = 1e-12;

/// Adds a counter that may be absent (-1).
void add(int& sum, int counter) {
  if (counter >= 0) {
    sum = std::max(sum, 0) + counter;
  }
}

/// Rows that are on the same bodies as the row before.
int repeated_pairs(const FactoredMatrix& A) {
  const auto same_block = [](const FactoredMatrix::Entry& a, const FactoredMatrix::Entry& b) {
    return a.block == b.block;
  };
  int same = 0;
  for (int i = 1; i < A.rows(); ++i) {
    same += std::ranges::equal(A.entries(i - 1), A.entries(i), same_block) ? 1 : 0;
  }
  return same;
}

/// One contact a pair, about: a ball between walls has two with what does not move.
bool has_single_contacts(const FactoredMatrix& A) {
  constexpr int kFew = 8;  // one in so many
  return kFew * repeated_pairs(A) <= A.rows();
}

/// More pairs than bodies, which is a wall or a pyramid and not a tower, and some bodies far
/// heavier than others: which contacts press is then not seen from the first steps.
bool has_cycles_and_heavy_bodies(const FactoredMatrix& A) {
  const int pairs = A.rows() - repeated_pairs(A);
  return pairs > A.mass.block_count() && !are_masses_alike(A.mass);
}

}  // namespace

void AutoSettings::validate() const {
  SolverSettings::validate();
  if (most_sweeps < 0) {
    throw std::invalid_argument("settings: most_sweeps: must be >= 0, got " +
                                std::to_string(most_sweeps));
  }
}

AutoSolver::AutoSolver(const AutoSettings& settings) : settings_(settings) {
  settings_.validate();
  old_attempts_.reserve(kAttemptsKept);
}

std::string AutoSolver::refuses(const Problem&) const {
  return {};
}

void AutoSolver::choose(const Problem& problem) {
  const Index n = problem.size();
  const bool factored = std::holds_alternative<FactoredMatrix>(problem.M);
  chain_.clear();
  sweeps_first_ = false;
  if (!problem.cones.empty()) {
    choose_for_cones(problem);
    return;
  }
  const bool symmetric = SymmetricLcp::asymmetry(problem).size <= SymmetricLcp::kMostAsymmetry;
  const bool single = factored && n > kSmallCold && n <= kSingleContactRows && problem.is_lcp() &&
                      has_single_contacts(std::get<FactoredMatrix>(problem.M));
  if (single) {
    chain_.push_back({"structured-lemke", "one contact a pair of bodies", kPivotsFromAGuess, true});
  }
  if (symmetric && n <= kSmall) {
    const bool newton_first =
        factored && !has_start_ && n > kSmallCold &&
        !(n <= kSmallCycles && has_cycles_and_heavy_bodies(std::get<FactoredMatrix>(problem.M)));
    if (newton_first) {
      chain_.push_back({"interior-point", "factored, from no start"});
    }
    chain_.push_back({"dantzig", "symmetric and small", -1, true});
    if (!single) {
      chain_.push_back({"structured-lemke", "symmetric and small", -1, true});
    }
  } else if (factored) {
    const bool sweeps_may_win =
        settings_.tolerance >= kRoughTolerance || n > kRowsForAccurateSweeps;
    sweeps_first_ = settings_.most_sweeps > 0 && sweeps_may_win &&
                    mass_ratio(std::get<FactoredMatrix>(problem.M).mass) <= kMassRatioForSweeps;
    chain_.push_back({"interior-point", "factored and large"});
  } else {
    if (symmetric) {
      chain_.push_back({"block-pivoting", "symmetric and large", kBlockPivotingSets});
    }
    chain_.push_back({"interior-point", symmetric ? "symmetric and large" : "not symmetric"});
  }
  chain_.push_back({"alart-curnier", symmetric ? "symmetric" : "not symmetric"});
  if (symmetric && !single && n > kSmall && n <= kStructuredLemkeRows) {
    chain_.push_back({"structured-lemke", "a vertex, or a proof that there is none", -1, true});
  }
  if (n <= kLemkeRows) {
    chain_.push_back({"lemke", "a vertex, or a proof that there is none", -1, true});
  }
  chain_.push_back({"pgs", "takes everything"});
}

void AutoSolver::choose_for_cones(const Problem& problem) {
  const bool factored = std::holds_alternative<FactoredMatrix>(problem.M);
  const bool associated = problem.friction_law == FrictionLaw::kAssociated;
  if (factored && has_start_) {
    chain_.push_back({"sticking", "perhaps little slides"});
  } else if (associated && (factored || problem.size() > kSmall)) {
    chain_.push_back({"cone-interior-point", "a convex program"});
  } else if (factored) {
    chain_.push_back({"cone-interior-point", "perhaps little slides", kConeInteriorSteps});
  }
  Index normals = problem.size();
  for (const FrictionCone& cone : problem.cones) {
    normals -= cone.dimension - 1;
  }
  const Step proof{"frictionless", "perhaps a proof that there is none", -1, true};
  const bool proof_is_cheap = factored && !has_start_ && normals <= kNormalsBeforeNewton;
  if (proof_is_cheap) {
    chain_.push_back(proof);
  }
  // From no start the smooth path is the shorter way in body space; small systems of a given M are
  // smaller still without the contacts that are open. Near a start nothing has to be smoothed.
  const bool has_path = problem.limits.empty();
  const bool path_first = has_path && factored && !has_start_ && !associated;
  if (has_path && !path_first) {
    chain_.push_back({"alart-curnier", "friction cones", kConeNewtonSteps});
  }
  if (has_path) {
    chain_.push_back({"cone-smoothing", "friction cones, by a smooth path"});
  }
  if (!has_path || path_first) {
    chain_.push_back({"alart-curnier", "friction cones"});
  } else if (settings_.max_iterations < 0) {
    chain_.push_back({"alart-curnier", "from the best so far"});
  }
  if (!proof_is_cheap && normals <= kStructuredLemkeRows) {
    chain_.push_back(proof);
  }
  chain_.push_back({"nsgs", "friction cones"});
}

Solver& AutoSolver::solver(std::string_view name, int max_iterations) {
  const auto same = [&](const Made& made) {
    return made.name == name && made.max_iterations == max_iterations;
  };
  const auto found = std::ranges::find_if(made_, same);
  if (found != made_.end()) {
    return *found->solver;
  }
  SolverSettings own = settings_;
  own.max_iterations = max_iterations;
  own.recorder = nullptr;  // told of the whole solve, not of its attempts
  own.certify_islands = false;
  made_.push_back({name, max_iterations, make_solver(name, own)});
  return *made_.back().solver;
}

void AutoSolver::recycle(std::vector<Attempt>& attempts) {
  while (!attempts.empty() && old_attempts_.size() < old_attempts_.capacity()) {
    old_attempts_.push_back(std::move(attempts.back()));
    attempts.pop_back();
  }
}

void AutoSolver::note_attempt(const Step& step, Result& result) {
  Attempt attempt;
  if (!old_attempts_.empty()) {
    attempt = std::move(old_attempts_.back());
    old_attempts_.pop_back();
  }
  attempt.solver = step.solver;
  attempt.reason = step.reason;
  attempt.status = one_.status;
  attempt.natural_residual = one_.certificate.natural_residual;
  attempt.unit_free_residual = one_.certificate.unit_free_residual;
  attempt.statistics = one_.statistics;
  attempt.detail = one_.detail;
  result.attempts.push_back(std::move(attempt));
}

bool AutoSolver::attempt(const Problem& problem, const Step& step, int max_iterations,
                         const Deadline& deadline, Result& result) {
  const double left = deadline.left_seconds();
  if (!(left > 0.0)) {
    return true;
  }
  Solver& tried = solver(step.solver, max_iterations);
  if (!tried.refuses(problem).empty()) {
    return false;
  }
  const bool follows_a_path = step.solver == "interior-point" || step.solver == "cone-smoothing";
  const bool start_helps = !follows_a_path || best_solver_.empty() || best_merit_ <= kWarmEnough;
  tried.solve_within(left, problem, one_, has_start_ && start_helps ? &start_ : nullptr);
  note_attempt(step, result);
  add(result.statistics.iterations, one_.statistics.iterations);
  add(result.statistics.pivots, one_.statistics.pivots);
  add(result.statistics.factorizations, one_.statistics.factorizations);
  add(result.statistics.refinements, one_.statistics.refinements);
  result.statistics.factor_bytes =
      std::max(result.statistics.factor_bytes, one_.statistics.factor_bytes);
  if (one_.ray.size() > 0 && one_.ray_bound > result.ray_bound) {
    result.ray = one_.ray;
    result.ray_bound = one_.ray_bound;
    is_out_of_reach_ = one_.status == Status::kNoSolutionBelow &&
                       judge_ray(problem, one_.ray).defect <= kRoundingOfM;
  }
  const double merit = BestIterate::merit(one_.certificate);
  const bool solves_now = is_solved(one_.status) && !is_solved(best_status_);
  const bool better = merit < best_merit_ && is_solved(one_.status) == is_solved(best_status_);
  if (best_solver_.empty() || solves_now || better) {
    best_merit_ = merit;
    best_solver_ = step.solver;
    best_certificate_ = one_.certificate;
    best_status_ = one_.status;
    result.z = one_.z;
    result.w = one_.w;
    start_ = one_.z;
    has_start_ = true;
  }
  return is_solved(one_.status) || one_.status == Status::kInfeasible;
}

/// Some sweeps, twice as many, and the rest of them if the rate at which the residual fell in the
/// second piece promises the tolerance in time.
bool AutoSolver::sweep(const Problem& problem, const Deadline& deadline, Result& result) {
  if (attempt(problem, {"nncg", "a few sweeps first"}, kFirstSweeps, deadline, result)) {
    return true;
  }
  const double before = BestIterate::merit(one_.certificate);
  if (attempt(problem, {"nncg", "to see its rate"}, 2 * kFirstSweeps, deadline, result)) {
    return true;
  }
  const double after = BestIterate::merit(one_.certificate);
  const double fallen = std::log(before / after) / (2 * kFirstSweeps);
  const double needed = std::log(after / settings_.tolerance) / settings_.most_sweeps;
  return fallen > kCaution * needed && attempt(problem, {"nncg", "its residual falls fast"},
                                               settings_.most_sweeps, deadline, result);
}

Status AutoSolver::iterate(const Problem& problem, const Vector* warm_start,
                           const Deadline& deadline, Result& result) {
  has_start_ = warm_start != nullptr;
  choose(problem);
  best_merit_ = kInfinity;
  best_solver_ = {};
  best_status_ = Status::kNotRun;
  is_out_of_reach_ = false;
  if (has_start_) {
    start_ = *warm_start;
  }
  result.z.setZero();
  bool done = sweeps_first_ && settings_.max_iterations < 0 && sweep(problem, deadline, result);
  for (std::size_t k = 0; !done && k < chain_.size(); ++k) {
    if (is_out_of_reach_ && !chain_[k].pivots) {
      result.detail = "iterations passed over: M, changed by its own rounding, has no solution";
      continue;
    }
    const int most = settings_.max_iterations >= 0 ? settings_.max_iterations : chain_[k].most;
    done = attempt(problem, chain_[k], most, deadline, result);
  }
  if (best_status_ == Status::kSolvedToRounding && best_solver_ != "sticking") {
    const int most = settings_.max_iterations >= 0
                         ? std::min(settings_.max_iterations, kSetsForLastDigits)
                         : kSetsForLastDigits;
    attempt(problem, {"sticking", "the last digits", kSetsForLastDigits}, most, deadline, result);
  }
  result.solver = "auto";
  if (!best_solver_.empty()) {
    result.solver += ": ";
    result.solver += best_solver_;
  }
  if (deadline.passed()) {
    return Status::kTimeLimit;
  }
  return result.ray.size() > 0 ? Status::kRayUnproven : one_.status;
}

/// The best attempt certified the same z of the same problem.
void AutoSolver::certify(const Problem& problem, Result& result) {
  if (best_solver_.empty()) {
    Solver::certify(problem, result);
  } else {
    result.certificate = best_certificate_;
  }
}

}  // namespace signorini::lcp
