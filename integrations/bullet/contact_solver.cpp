#include <signorini/integrations/bullet/contact_solver.h>
#include <signorini/lcp/cone_interior_point.h>
#include <signorini/lcp/friction_cone.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace signorini::bullet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMoreAccurate = 0.01;   // of the tolerance: what solvers aim at
constexpr double kMostAccurate = 1e-12;  // but no lower
constexpr double kSoftness = 1e-3;       // of soft rows, beside A_ii
constexpr double kWorthStarting = 1.0;   // z = 0 is no worse
constexpr lcp::Index kFewRows = 100;     // up to which dense pivoting is the fastest
constexpr double kFarOff = 0.3;          // a start that many rows are not worth trying from
constexpr int kFewSteps = 40;            // factorisations of Alart-Curnier

lcp::SolverSettings solver_settings(const Settings& settings) {
  settings.validate();
  return {.tolerance = settings.tolerance,
          .time_limit = settings.time_limit,
          .quick_certificate = true};
}

lcp::SolverSettings few_steps(lcp::SolverSettings settings) {
  settings.max_iterations = kFewSteps;
  return settings;
}

std::unique_ptr<lcp::Solver> make(std::string_view name, const lcp::SolverSettings& settings) {
  if (name != "cone-interior-point") {
    return lcp::make_solver(name, settings);
  }
  lcp::ConeInteriorPointSettings own;
  static_cast<lcp::SolverSettings&>(own) = settings;
  own.polish_steps = 0;  // steps are tried apart
  return std::make_unique<lcp::ConeInteriorPoint>(own);
}

lcp::SolverSettings more_accurate(lcp::SolverSettings settings) {
  settings.tolerance =
      std::min(settings.tolerance, std::max(kMoreAccurate * settings.tolerance, kMostAccurate));
  return settings;
}

/// A counter that may be absent (-1).
void add(int& sum, int counter) {
  if (counter >= 0) {
    sum = std::max(sum, 0) + counter;
  }
}

/// Sum of both: what a solve of several parts cost.
void add(lcp::Statistics& sum, const lcp::Statistics& one) {
  add(sum.iterations, one.iterations);
  add(sum.pivots, one.pivots);
  add(sum.factorizations, one.factorizations);
  add(sum.refinements, one.refinements);
}

/// What iterates are compared by; NaN: +infinity.
double merit(const lcp::Certificate& certificate) {
  const double worst = std::max(certificate.natural_residual, certificate.unit_free_residual);
  return std::isnan(worst) ? kInfinity : worst;
}

/// Whether a contact of z that carries something pushes as much as its friction bound lets it.
bool has_slip(const lcp::Problem& problem, const lcp::Vector& z) {
  constexpr double kCarries = 1e-6;  // of the largest impulse
  constexpr double kAtBound = 1.0 - 1e-6;
  const double least = kCarries * z.lpNorm<Eigen::Infinity>();
  const auto slips = [&](double tangential, double coefficient, int normal_row) {
    return z[normal_row] > least && tangential >= kAtBound * coefficient * z[normal_row];
  };
  return std::ranges::any_of(problem.cones,
                             [&](const lcp::FrictionCone& cone) {
                               return slips(
                                   lcp::tangential_norm(cone.dimension, z.data() + cone.normal_row),
                                   cone.coefficient, cone.normal_row);
                             }) ||
         std::ranges::any_of(problem.limits, [&](const lcp::CoupledLimit& limit) {
           return slips(std::abs(z[limit.row]), limit.coefficient, limit.normal_row);
         });
}

bool is_done(const lcp::Result& result) {
  return lcp::is_solved(result.status) || result.status == lcp::Status::kInvalidInput;
}

/// Whether there are so many cones, and so little is known of their forces, that steps from it are
/// slower than the way from the inside.
bool is_far_off(const lcp::Problem& problem, const lcp::Result& best) {
  return !problem.cones.empty() && problem.size() > kFewRows &&
         !(merit(best.certificate) < kFarOff);
}

}  // namespace

void Settings::validate() const {
  lcp::SolverSettings{.tolerance = tolerance, .time_limit = time_limit}.validate();
}

std::string_view to_string(Route route) {
  switch (route) {
    case Route::kNone: return "none";
    case Route::kUnchanged: return "unchanged";
    case Route::kBounds: return "bounds";
    case Route::kSticking: return "sticking";
    case Route::kCoupled: return "coupled";
  }
  return "";
}

ContactSolver::Method::Method(std::string_view name, const lcp::SolverSettings& told)
    : settings(told), solver(make(name, told)) {}

ContactSolver::ContactSolver(const Settings& settings)
    : settings_(solver_settings(settings)),
      recorder_(settings.recorder),
      sticking_("interior-point", more_accurate(settings_)),
      boxes_("alart-curnier", settings_),
      steps_("alart-curnier", few_steps(settings_)),
      inside_("cone-interior-point", more_accurate(settings_)),
      anything_("auto", settings_),
      clock_(settings.time_limit) {}

bool ContactSolver::is_still_solved(const lcp::Problem& problem, const lcp::Vector& z,
                                    lcp::Result& result) {
  lcp::start_result(problem.size(), result);
  if (!z.allFinite() || !problem.q.allFinite()) {
    return false;
  }
  result.certificate = certifier_.certify_quickly(problem, z, settings_.tolerance, &result.w);
  result.status = lcp::judge(result.certificate, settings_.tolerance, lcp::Status::kStalled);
  result.z = z;
  result.solver = "warm start";
  result.statistics.iterations = 0;
  return lcp::is_solved(result.status);
}

/// Takes one_, an iterate of the whole problem with its certificate, where it is better.
void ContactSolver::keep_better(std::string_view solver, std::string_view reason,
                                lcp::Result& result) {
  attempts_.push_back({solver, reason, one_.status, one_.certificate.natural_residual,
                       one_.certificate.unit_free_residual, one_.statistics, one_.detail});
  add(total_, one_.statistics);
  if (one_.status == lcp::Status::kInvalidInput || result.status == lcp::Status::kNotRun ||
      !(merit(one_.certificate) >= merit(result.certificate))) {
    std::swap(result, one_);
  } else {
    result.status = one_.status;  // the last attempt's ending, of the better iterate
    result.detail = one_.detail;
  }
}

/// Gives a solver what is left of the time. @return false if nothing is
bool ContactSolver::has_time(Method& method, lcp::Result& result) {
  if (!std::isfinite(settings_.time_limit)) {
    return true;
  }
  lcp::SolverSettings left = method.settings;
  left.time_limit -= clock_.elapsed_seconds();
  if (!(left.time_limit > 0.0)) {
    result.status = lcp::Status::kTimeLimit;
    return false;
  }
  method.solver = make(method.solver->name(), left);
  return true;
}

/// The problem with its friction rows free and soft: z_T = -w_T / (kSoftness A_TT). Of all the ways
/// in which redundant contacts can hold what they hold it takes one with little friction.
void ContactSolver::soften(const lcp::Problem& problem) {
  const auto& A = std::get<lcp::FactoredMatrix>(problem.M);
  if (!std::holds_alternative<lcp::FactoredMatrix>(soft_.M)) {
    soft_.M = lcp::FactoredMatrix();
  }
  auto& soft = std::get<lcp::FactoredMatrix>(soft_.M);
  soft.clear();
  soft.mass = A.mass;
  A.diagonal(diagonal_);
  softness_.setZero(problem.size());
  for (const lcp::FrictionCone& cone : problem.cones) {
    const lcp::Index first = cone.normal_row + 1;
    softness_.segment(first, cone.dimension - 1) =
        kSoftness * diagonal_.segment(first, cone.dimension - 1);
  }
  for (const lcp::CoupledLimit& limit : problem.limits) {
    softness_[limit.row] = kSoftness * diagonal_[limit.row];
  }
  for (int row = 0; row < A.rows(); ++row) {
    soft.add_row(A.compliance(row) + softness_[row]);
    for (const lcp::FactoredMatrix::Entry& entry : A.entries(row)) {
      soft.add_entry(entry.block, lcp::Vector::Map(A.values(entry), A.mass.dimension(entry.block)));
    }
  }
  soft_.q = problem.q;
  soft_.lower = problem.lower;
  soft_.upper = problem.upper;
}

/// Solves the problem with all friction rows free.
void ContactSolver::try_sticking(lcp::Problem& problem, const lcp::Vector* warm_start,
                                 lcp::Result& result) {
  const bool has_friction = !problem.cones.empty() || !problem.limits.empty();
  if (has_friction) {
    if (!has_time(sticking_, result)) {
      return;
    }
    soften(problem);
    sticking_.solver->solve(soft_, one_, warm_start);
    add(total_, one_.statistics);
    start_ = one_.z;
    warm_start = &start_;
  }
  if (!has_time(sticking_, result)) {
    return;
  }
  cones_.clear();
  limits_.clear();
  std::swap(cones_, problem.cones);
  std::swap(limits_, problem.limits);
  sticking_.solver->solve(problem, one_, warm_start);
  std::swap(cones_, problem.cones);
  std::swap(limits_, problem.limits);
  if (one_.status != lcp::Status::kInvalidInput) {
    if (has_friction) {
      one_.certificate = certifier_.certify_quickly(problem, one_.z, settings_.tolerance, &one_.w);
    }
    one_.status = lcp::judge(one_.certificate, settings_.tolerance, lcp::Status::kStalled);
  }
  keep_better(sticking_.solver->name(), has_friction ? "as if nothing slipped" : "no friction",
              result);
}

/// Solves the problem as it is, from the best z known.
void ContactSolver::try_solver(Method& method, std::string_view reason, const lcp::Problem& problem,
                               lcp::Result& result) {
  if (!has_time(method, result)) {
    return;
  }
  const bool has_start = merit(result.certificate) < kWorthStarting;
  if (has_start) {
    start_ = result.z;
  }
  method.solver->solve(problem, one_, has_start ? &start_ : nullptr);
  if (!lcp::is_solved(one_.status) && one_.status != lcp::Status::kInvalidInput) {
    one_.status = lcp::judge(one_.certificate, settings_.tolerance, one_.status);
  }
  keep_better(method.solver->name(), reason, result);
}

/// Friction cones, by steps from the start and from the inside.
void ContactSolver::try_cones(const lcp::Problem& problem, lcp::Result& result) {
  std::array<Method*, 2> order = {&steps_, &inside_};
  if (is_far_off(problem, result)) {
    std::swap(order[0], order[1]);
  }
  for (Method* method : order) {
    if (!is_done(result) && method->solver->refuses(problem).empty()) {
      try_solver(*method, "friction", problem, result);
    }
  }
}

Route ContactSolver::solve(lcp::Problem& problem, const lcp::Vector* warm_start,
                           lcp::Result& result) {
  clock_ = lcp::Deadline(settings_.time_limit);
  attempts_.clear();
  total_ = {};
  const bool has_friction = !problem.cones.empty() || !problem.limits.empty();
  Route route = Route::kUnchanged;
  if (warm_start == nullptr || !is_still_solved(problem, *warm_start, result)) {
    if (warm_start == nullptr) {
      lcp::start_result(problem.size(), result);
    }
    route = has_friction ? Route::kSticking : Route::kBounds;
    const bool may_stick = warm_start == nullptr || !has_slip(problem, *warm_start);
    const bool has_start = warm_start != nullptr && !warm_start->isZero(0.0);
    const bool is_far = has_start && is_far_off(problem, result);
    if (!has_friction || (may_stick && !is_far)) {
      try_sticking(problem, warm_start, result);
    }
    if (!is_done(result) && has_friction) {
      route = Route::kCoupled;
      if (!problem.cones.empty()) {
        try_cones(problem, result);
      } else if (problem.size() > kFewRows) {
        try_solver(boxes_, "friction", problem, result);
      }
    }
    if (!is_done(result)) {
      try_solver(anything_, has_friction ? "friction" : "not solved yet", problem, result);
    }
    result.statistics = total_;
  }
  result.statistics.solve_seconds = clock_.elapsed_seconds();
  result.attempts = attempts_;
  if (recorder_ != nullptr) {
    record(problem, warm_start, result);
  }
  return route;
}

void ContactSolver::record(const lcp::Problem& problem, const lcp::Vector* warm_start,
                           lcp::Result& result) {
  std::string note;
  try {
    note = recorder_->record({"auto", settings_, problem, warm_start, result});
  } catch (const std::exception& error) {
    note = std::string("recording failed: ") + error.what();
  }
  if (!note.empty()) {
    result.detail += (result.detail.empty() ? "" : "; ") + note;
  }
}

}  // namespace signorini::bullet
