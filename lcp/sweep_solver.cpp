#include <signorini/lcp/certificate.h>
#include <signorini/lcp/column_sweeps.h>
#include <signorini/lcp/number_text.h>
#include <signorini/lcp/packed_rows.h>
#include <signorini/lcp/sweep_solver.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// judge() excuses no residual above 1e-5 by rounding; what is kept of M z may be float's.
constexpr double kMayBeRounding = 1e-4;

struct Bounds {
  double lower;
  double upper;
};

Bounds bounds_of(const SweepRow& row, const Vector& z) {
  if (row.normal_row < 0) {
    return {row.lower, row.upper};
  }
  const double most = row.coefficient * std::max(z[row.normal_row], 0.0);
  return {-most, most};
}

/// D (z - clamp(z - w / D, lower, upper)) without dividing, and w itself where nothing is clamped.
double scaled_step(double scale, double z, double w, const Bounds& bounds) {
  const double moved = scale * z - w;
  const double clamped = std::clamp(moved, scale * bounds.lower, scale * bounds.upper);
  return clamped == moved ? w : scale * z - clamped;
}

/// Both residuals of the certificate, in double and from the kept product: good enough to know when
/// to ask for the certificate, and to tell a better iterate from a worse one.
struct Residual {
  double natural = 0.0;
  double unit_free = 0.0;
  [[nodiscard]] double worst() const { return std::max(natural, unit_free); }
  [[nodiscard]] bool is_finite() const {
    return std::isfinite(natural) && std::isfinite(unit_free);
  }
};

Residual residual(const std::vector<SweepRow>& rows, const Vector& z, const Vector& w,
                  double q_inf) {
  Residual largest;
  double finite = 0.0;  // becomes NaN as soon as one number is not finite
  for (Index i = 0; i < z.size(); ++i) {
    const Bounds bounds = bounds_of(rows[i], z);
    const double plain = scaled_step(1.0, z[i], w[i], bounds);
    const double scaled = scaled_step(rows[i].scale, z[i], w[i], bounds);
    largest.natural = std::max(largest.natural, std::abs(plain));
    largest.unit_free = std::max(largest.unit_free, std::abs(scaled));
    finite += 0.0 * plain + 0.0 * scaled + 0.0 * w[i];
  }
  largest.natural = largest.natural / (1.0 + q_inf) + finite;
  largest.unit_free = largest.unit_free / (q_inf > 0.0 ? q_inf : 1.0) + finite;
  return largest;
}

/// Brent's cycle detection: an iterate equal to an earlier one repeats for ever, since the next
/// look depends on the iterate alone.
class CycleDetector {
 public:
  /// @return after how many looks the iterate came back, 0 if it did not.
  int look(const Vector& z) {
    ++since_anchor_;
    if (is_set_ && anchor_ == z) {
      return since_anchor_;
    }
    if (since_anchor_ >= window_) {
      anchor_ = z;
      is_set_ = true;
      window_ *= 2;
      since_anchor_ = 0;
    }
    return 0;
  }
  void restart() {
    is_set_ = false;
    window_ = 1;
    since_anchor_ = 0;
  }

 private:
  Vector anchor_;
  bool is_set_ = false;
  int window_ = 1;
  int since_anchor_ = 0;
};

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Names the rows in which no step exists, empty if there is none.
std::string stuck_rows(const std::vector<SweepRow>& rows, const Vector& z, const Vector& w) {
  int count = 0;
  std::string first;
  for (Index i = 0; i < z.size(); ++i) {
    const auto [lower, upper] = bounds_of(rows[i], z);
    const bool stuck = rows[i].inverse == 0.0 &&
                       ((w[i] > 0.0 && lower == -kInfinity) || (w[i] < 0.0 && upper == kInfinity));
    if (stuck && ++count == 1) {
      first = "row " + std::to_string(i) + ": no positive diagonal, w = " + short_text(w[i]) +
              " and no bound that way: no step exists, z kept";
    }
  }
  return count > 1 ? first + " (" + std::to_string(count) + " such rows)" : first;
}

/// The sweeps of each form, in one precision.
template <typename T>
class Forms {
 public:
  Sweeps<T>& set(const Problem& problem, std::vector<SweepRow>& rows, double relaxation,
                 const SweepSettings& settings, ThreadTeam* team) {
    if (const auto* factored = std::get_if<FactoredMatrix>(&problem.M)) {
      packed_.set(*factored, rows, relaxation, settings.row_order,
                  best_instruction_set(settings.fused));
      packed_.use(team);
      return packed_;
    }
    columns_.set(problem.M, rows, relaxation);
    return columns_;
  }

 private:
  PackedRows<T> packed_;
  ColumnSweeps<T> columns_;
};

}  // namespace

/// What one solve works with; kept for the next one.
class SweepSolver::Workspace {
 public:
  Status solve(SweepSolver& solver, const Problem& problem, const Vector* warm_start,
               const Deadline& deadline, Result& result) {
    take_rows(problem);
    const SweepSettings& settings = solver.sweep_settings();
    const double relaxation = solver.relaxation();
    if (settings.threads > 1 && settings.row_order == RowOrder::kColoured && team_ == nullptr) {
      team_ = std::make_unique<ThreadTeam>(settings.threads);
    }
    if (settings.precision == Precision::kFloat) {
      return run(solver, single_.set(problem, rows_, relaxation, settings, team_.get()), problem,
                 warm_start, deadline, result);
    }
    return run(solver, double_.set(problem, rows_, relaxation, settings, team_.get()), problem,
               warm_start, deadline, result);
  }

 private:
  void take_rows(const Problem& problem);
  void start(const Problem& problem, const Vector* warm_start, int check_period);
  template <typename T>
  Status run(SweepSolver& solver, Sweeps<T>& sweeps, const Problem& problem,
             const Vector* warm_start, const Deadline& deadline, Result& result);
  template <typename T>
  std::optional<Status> look(SweepSolver& solver, Sweeps<T>& sweeps, const Problem& problem,
                             std::int64_t done, Result& result);
  bool is_certified(const Problem& problem, const SweepSettings& settings, double residual,
                    std::int64_t done);
  template <typename T>
  Status end(Sweeps<T>& sweeps, Status status, std::string why, Result& result);

  std::unique_ptr<ThreadTeam> team_;
  Forms<double> double_;
  Forms<float> single_;
  std::vector<SweepRow> rows_;
  Vector z_;
  Vector w_;
  Vector best_z_;
  CycleDetector cycle_;
  Certifier certifier_;
  double q_inf_ = 0.0;
  double first_residual_ = 0.0;
  double best_residual_ = 0.0;
  // The iteration of the next look; the one before which no certificate is asked for, and the one
  // from which it is although the tolerance is not met, since the rounding floor may lie above it.
  std::int64_t next_look_ = 0;
  std::int64_t next_certificate_ = 0;
  std::int64_t forced_certificate_ = 0;
};

void SweepSolver::Workspace::take_rows(const Problem& problem) {
  rows_.resize(problem.size());
  for (Index i = 0; i < problem.size(); ++i) {
    SweepRow row{};
    row.q = problem.q[i];
    row.lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    row.upper = problem.upper.size() > 0 ? problem.upper[i] : kInfinity;
    row.normal_row = -1;
    rows_[i] = row;
  }
  for (const CoupledLimit& limit : problem.limits) {
    rows_[limit.row].normal_row = limit.normal_row;
    rows_[limit.row].coefficient = limit.coefficient;
  }
}

void SweepSolver::Workspace::start(const Problem& problem, const Vector* warm_start,
                                   int check_period) {
  const Index n = problem.size();
  if (warm_start != nullptr) {
    z_ = *warm_start;
  } else {
    z_.setZero(n);
  }
  for (Index i = 0; i < n; ++i) {
    if (rows_[i].normal_row < 0) {
      z_[i] = std::clamp(z_[i], rows_[i].lower, rows_[i].upper);
    }
  }
  for (Index i = 0; i < n; ++i) {  // after the normal rows they depend on
    const auto [lower, upper] = bounds_of(rows_[i], z_);
    z_[i] = std::clamp(z_[i], lower, upper);
  }
  w_.resize(n);
  best_z_ = z_;
  cycle_.restart();
  q_inf_ = problem.q.cwiseAbs().maxCoeff();
  best_residual_ = kInfinity;
  next_look_ = 0;
  next_certificate_ = 0;
  forced_certificate_ = check_period;
}

template <typename T>
Status SweepSolver::Workspace::run(SweepSolver& solver, Sweeps<T>& sweeps, const Problem& problem,
                                   const Vector* warm_start, const Deadline& deadline,
                                   Result& result) {
  const SweepSettings& settings = solver.sweep_settings();
  const int most =
      settings.max_iterations >= 0 ? settings.max_iterations : SweepSettings::kDefaultIterations;
  start(problem, warm_start, settings.check_period);
  sweeps.start(z_);
  solver.begin();
  for (std::int64_t done = 0;; ++done) {
    result.statistics.iterations = static_cast<int>(done);
    const bool out_of_time = deadline.passed();
    if (done == next_look_ || done == most || out_of_time) {
      if (const auto ending = look(solver, sweeps, problem, done, result)) {
        return *ending;
      }
    }
    if (done == most) {
      return end(sweeps, Status::kIterationLimit, "", result);
    }
    if (out_of_time) {
      return end(sweeps, Status::kTimeLimit, "", result);
    }
    solver.advance(sweeps);
  }
}

/// Looks at the residual after `done` iterations. @return what ends the solve, if anything does.
template <typename T>
std::optional<Status> SweepSolver::Workspace::look(SweepSolver& solver, Sweeps<T>& sweeps,
                                                   const Problem& problem, std::int64_t done,
                                                   Result& result) {
  const SweepSettings& settings = solver.sweep_settings();
  if (done > 0) {  // the start is not rounded to T
    sweeps.read(z_);
    for (Index i = 0; i < z_.size(); ++i) {  // T rounds the bounds, too
      z_[i] = rows_[i].normal_row < 0 ? std::clamp(z_[i], rows_[i].lower, rows_[i].upper) : z_[i];
    }
  }
  sweeps.refresh(w_);
  const Residual now = residual(rows_, z_, w_, q_inf_);
  if (done == 0) {
    first_residual_ = now.worst();
  }
  const double most = std::max(first_residual_, settings.tolerance) / kEpsilon;
  if (!now.is_finite() || now.worst() > most) {
    return end(sweeps, Status::kNumericalBreakdown,
               "diverged: residual " + short_text(first_residual_) + " at the start, " +
                   short_text(now.worst()) + " after " + std::to_string(done) + " iterations",
               result);
  }
  if (now.worst() <= best_residual_) {  // of equals the last: the other rows went on
    best_residual_ = now.worst();
    best_z_ = z_;
  }
  if (is_certified(problem, settings, now.worst(), done)) {
    result.z = z_;
    return Status::kSolved;
  }
  // From the first full period on the looks are evenly spaced, and the next iterate looked at
  // depends on this one alone, unless the solver remembers more.
  const int returned = done >= settings.check_period && done == next_look_ ? cycle_.look(z_) : 0;
  if (returned > 0 && !solver.forget()) {
    return end(sweeps, Status::kStalled,
               "the iterate repeats itself every " +
                   std::to_string(std::int64_t{returned} * settings.check_period) + " iterations",
               result);
  }
  if (returned > 0) {
    cycle_.restart();
  }
  next_look_ = done + std::clamp<std::int64_t>(done, 1, settings.check_period);
  return std::nullopt;
}

/// Asks for the certificate if the residual, or how long none was asked for, says so.
bool SweepSolver::Workspace::is_certified(const Problem& problem, const SweepSettings& settings,
                                          double residual, std::int64_t done) {
  const bool is_small = residual <= settings.tolerance && done >= next_certificate_;
  const bool is_due = residual <= kMayBeRounding && done >= forced_certificate_;
  if (!is_small && !is_due) {
    return false;
  }
  if (is_solved(judge(certifier_.certify(problem, z_), settings.tolerance, Status::kNotRun))) {
    return true;
  }
  next_certificate_ = done + std::max<std::int64_t>(settings.check_period, done / 8);
  forced_certificate_ = std::max(2 * done, next_certificate_);
  return false;
}

/// Ends with the best iterate and names what kept it from being better.
template <typename T>
Status SweepSolver::Workspace::end(Sweeps<T>& sweeps, Status status, std::string why,
                                   Result& result) {
  result.z = best_z_;
  result.detail = std::move(why);
  sweeps.start(best_z_);
  sweeps.refresh(w_);
  if (const std::string stuck = stuck_rows(rows_, best_z_, w_); !stuck.empty()) {
    result.detail += (result.detail.empty() ? "" : "; ") + stuck;
  }
  return status;
}

void SweepSettings::validate() const {
  SolverSettings::validate();
  if (check_period < 1) {
    throw std::invalid_argument("settings: check_period: must be >= 1, got " +
                                std::to_string(check_period));
  }
  if (threads < 1) {
    throw std::invalid_argument("settings: threads: must be >= 1, got " + std::to_string(threads));
  }
}

void check_relaxation(double omega) {
  if (!(omega > 0.0 && omega < 2.0)) {
    throw std::invalid_argument("settings: relaxation: must be in (0, 2), got " +
                                short_text(omega));
  }
}

SweepSolver::SweepSolver() : workspace_(std::make_unique<Workspace>()) {}
SweepSolver::~SweepSolver() = default;

std::string SweepSolver::refuses(const Problem& problem) const {
  return problem.cones.empty() ? "" : "takes no friction cones";
}

Status SweepSolver::iterate(const Problem& problem, const Vector* warm_start,
                            const Deadline& deadline, Result& result) {
  return workspace_->solve(*this, problem, warm_start, deadline, result);
}

}  // namespace signorini::lcp
