#include <signorini/lcp/certificate.h>
#include <signorini/lcp/pgs.h>

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

/// A row of the problem, as a sweep needs it.
struct Row {
  double q;
  double lower;
  double upper;
  double scale;         // D_i of the certificate
  double inverse;       // 1 / M_ii, or 0 where there is no usable diagonal
  double coefficient;   // mu of a coupled row
  int normal_row = -1;  // of a coupled row, else -1
};

struct Bounds {
  double lower;
  double upper;
};

Bounds bounds_of(const Row& row, const Vector& z) {
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

/// The z_i of a row without a usable diagonal: the bound that w points to, if it is finite.
double pushed_to_bound(double z, double w, const Bounds& bounds) {
  const double target = w > 0.0 ? bounds.lower : w < 0.0 ? bounds.upper : z;
  return std::clamp(std::isfinite(target) ? target : z, bounds.lower, bounds.upper);
}

/// M z, kept up to date while z changes one number at a time: a dense or sparse M by its columns.
class DenseColumns {
 public:
  DenseColumns(const Matrix& M, Vector& kept) : M_(M), kept_(kept) {}
  void refresh(const Vector& z) { kept_.noalias() = M_ * z; }
  [[nodiscard]] double product(Index i, double) const { return kept_[i]; }
  void move(Index i, double change) { kept_.noalias() += change * M_.col(i); }

 private:
  const Matrix& M_;
  Vector& kept_;
};

class SparseColumns {
 public:
  SparseColumns(const SparseMatrix& M, Vector& kept) : M_(M), kept_(kept) {}
  void refresh(const Vector& z) {
    kept_.setZero(z.size());
    for (Index i = 0; i < z.size(); ++i) {
      move(i, z[i]);
    }
  }
  [[nodiscard]] double product(Index i, double) const { return kept_[i]; }
  void move(Index i, double change) {
    for (SparseMatrix::InnerIterator it(M_, i); it; ++it) {
      kept_[it.row()] += it.value() * change;
    }
  }

 private:
  const SparseMatrix& M_;
  Vector& kept_;
};

/// The same for A = J W J^T + diag(c), through v = W J^T z. J_i and W J_i^T lie side by side.
class PackedRows {
 public:
  void pack(const FactoredMatrix& A) {
    row_start_.assign(1, 0);
    entries_.clear();
    numbers_.clear();
    compliance_.clear();
    for (int i = 0; i < A.rows(); ++i) {
      compliance_.push_back(A.compliance(i));
      for (const FactoredMatrix::Entry& entry : A.entries(i)) {
        const int d = A.mass.dimension(entry.block);
        const std::size_t first = numbers_.size();
        entries_.push_back({first, A.mass.offset(entry.block), d});
        numbers_.resize(first + 2 * d);
        std::copy_n(A.values(entry), d, &numbers_[first]);
        A.mass.apply_inverse(entry.block, A.values(entry), &numbers_[first + d]);
      }
      row_start_.push_back(entries_.size());
    }
    velocity_.resize(A.degrees_of_freedom());
  }

  void refresh(const Vector& z) {
    velocity_.setZero();
    for (Index i = 0; i < z.size(); ++i) {
      move(i, z[i]);
    }
  }
  [[nodiscard]] double product(Index i, double z_i) const {
    double sum = compliance_[i] * z_i;
    for (std::size_t e = row_start_[i]; e < row_start_[i + 1]; ++e) {
      const Entry& entry = entries_[e];
      const double* row = &numbers_[entry.first];
      const double* v = velocity_.data() + entry.offset;
      sum += entry.dimension == 6 ? dot<6>(row, v) : dot(row, v, entry.dimension);
    }
    return sum;
  }
  void move(Index i, double change) {
    for (std::size_t e = row_start_[i]; e < row_start_[i + 1]; ++e) {
      const Entry& entry = entries_[e];
      const double* column = &numbers_[entry.first] + entry.dimension;
      double* v = velocity_.data() + entry.offset;
      entry.dimension == 6 ? add<6>(change, column, v) : add(change, column, v, entry.dimension);
    }
  }

 private:
  struct Entry {
    std::size_t first;  // J_i at this block, then W J_i^T
    int offset;         // of the block in v
    int dimension;
  };

  // A free body has six degrees of freedom: the length is then known to the compiler.
  template <int kDimension>
  static double dot(const double* a, const double* b) {
    return dot(a, b, kDimension);
  }
  static double dot(const double* a, const double* b, int dimension) {
    double sum = 0.0;
    for (int k = 0; k < dimension; ++k) {
      sum += a[k] * b[k];
    }
    return sum;
  }
  template <int kDimension>
  static void add(double factor, const double* a, double* b) {
    add(factor, a, b, kDimension);
  }
  static void add(double factor, const double* a, double* b, int dimension) {
    for (int k = 0; k < dimension; ++k) {
      b[k] += factor * a[k];
    }
  }

  std::vector<std::size_t> row_start_;
  std::vector<Entry> entries_;
  std::vector<double> numbers_;
  std::vector<double> compliance_;
  Vector velocity_;
};

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

template <typename Product>
Residual residual(const std::vector<Row>& rows, const Product& product, const Vector& z,
                  double q_inf) {
  Residual largest;
  double finite = 0.0;  // becomes NaN as soon as one number is not finite
  for (Index i = 0; i < z.size(); ++i) {
    const Row& row = rows[i];
    const double w = row.q + product.product(i, z[i]);
    const Bounds bounds = bounds_of(row, z);
    const double plain = scaled_step(1.0, z[i], w, bounds);
    const double scaled = scaled_step(row.scale, z[i], w, bounds);
    largest.natural = std::max(largest.natural, std::abs(plain));
    largest.unit_free = std::max(largest.unit_free, std::abs(scaled));
    finite += 0.0 * plain + 0.0 * scaled + 0.0 * w;
  }
  largest.natural = largest.natural / (1.0 + q_inf) + finite;
  largest.unit_free = largest.unit_free / (q_inf > 0.0 ? q_inf : 1.0) + finite;
  return largest;
}

template <typename Product>
void sweep(const std::vector<Row>& rows, double relaxation, Product& product, Vector& z) {
  for (Index i = 0; i < z.size(); ++i) {
    const Row& row = rows[i];
    const double w = row.q + product.product(i, z[i]);
    const Bounds bounds = bounds_of(row, z);
    const double moved = row.inverse > 0.0 ? std::clamp(z[i] - relaxation * w * row.inverse,
                                                        bounds.lower, bounds.upper)
                                           : pushed_to_bound(z[i], w, bounds);
    const double change = moved - z[i];
    if (change != 0.0) {
      z[i] = moved;
      product.move(i, change);
    }
  }
}

/// Brent's cycle detection: an iterate equal to an earlier one repeats for ever, since the next
/// look depends on the iterate alone.
class CycleDetector {
 public:
  /// @return after how many looks the iterate came back, 0 if it did not.
  int look(const Vector& z) {
    ++since_anchor_;
    if (anchor_.size() == z.size() && anchor_ == z) {
      return since_anchor_;
    }
    if (since_anchor_ >= window_) {
      anchor_ = z;
      window_ *= 2;
      since_anchor_ = 0;
    }
    return 0;
  }
  void restart() {
    anchor_.resize(0);
    window_ = 1;
    since_anchor_ = 0;
  }

 private:
  Vector anchor_;
  int window_ = 1;
  int since_anchor_ = 0;
};

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Names the rows in which no step exists, empty if there is none.
template <typename Product>
std::string stuck_rows(const std::vector<Row>& rows, const Product& product, const Vector& z) {
  int count = 0;
  std::string first;
  for (Index i = 0; i < z.size(); ++i) {
    const double w = rows[i].q + product.product(i, z[i]);
    const auto [lower, upper] = bounds_of(rows[i], z);
    const bool stuck = rows[i].inverse == 0.0 &&
                       ((w > 0.0 && lower == -kInfinity) || (w < 0.0 && upper == kInfinity));
    if (stuck && ++count == 1) {
      first = "row " + std::to_string(i) + ": no positive diagonal, w = " + short_text(w) +
              " and no bound that way: no step exists, z kept";
    }
  }
  return count > 1 ? first + " (" + std::to_string(count) + " such rows)" : first;
}

}  // namespace

/// What one solve works with; kept for the next one.
class Pgs::Workspace {
 public:
  Status solve(const Problem& problem, const PgsSettings& settings, const Vector* warm_start,
               const Deadline& deadline, Result& result) {
    prepare(problem, warm_start);
    if (const auto* factored = std::get_if<FactoredMatrix>(&problem.M)) {
      packed_.pack(*factored);
      return run(packed_, problem, settings, deadline, result);
    }
    if (const auto* dense = std::get_if<Matrix>(&problem.M)) {
      DenseColumns columns(*dense, kept_);
      return run(columns, problem, settings, deadline, result);
    }
    SparseColumns columns(std::get<SparseMatrix>(problem.M), kept_);
    return run(columns, problem, settings, deadline, result);
  }

 private:
  void prepare(const Problem& problem, const Vector* warm_start);
  void start(const Problem& problem, const PgsSettings& settings);
  template <typename Product>
  Status run(Product& product, const Problem& problem, const PgsSettings& settings,
             const Deadline& deadline, Result& result);
  template <typename Product>
  std::optional<Status> look(Product& product, const Problem& problem, const PgsSettings& settings,
                             std::int64_t done, Result& result);
  template <typename Product>
  Status end(Product& product, Status status, std::string why, Result& result);

  std::vector<Row> rows_;
  Vector diagonal_;
  Vector z_;
  Vector best_z_;
  Vector kept_;
  PackedRows packed_;
  CycleDetector cycle_;
  double q_inf_ = 0.0;
  double first_residual_ = 0.0;
  double best_residual_ = 0.0;
  // The sweep of the next look; the sweep before which no certificate is asked for, and the one at
  // which it is whatever the residual, since the rounding floor may lie above the tolerance.
  std::int64_t next_look_ = 0;
  std::int64_t next_certificate_ = 0;
  std::int64_t forced_certificate_ = 0;
};

void Pgs::Workspace::prepare(const Problem& problem, const Vector* warm_start) {
  const Index n = problem.size();
  diagonal(problem.M, diagonal_);
  rows_.resize(n);
  for (Index i = 0; i < n; ++i) {
    Row row{};
    row.q = problem.q[i];
    row.lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    row.upper = problem.upper.size() > 0 ? problem.upper[i] : kInfinity;
    row.scale = diagonal_[i] > 0.0 ? diagonal_[i] : 1.0;
    row.inverse =
        diagonal_[i] > 0.0 && std::isfinite(1.0 / diagonal_[i]) ? 1.0 / diagonal_[i] : 0.0;
    row.normal_row = -1;
    rows_[i] = row;
  }
  for (const CoupledLimit& limit : problem.limits) {
    rows_[limit.row].normal_row = limit.normal_row;
    rows_[limit.row].coefficient = limit.coefficient;
  }
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
}

void Pgs::Workspace::start(const Problem& problem, const PgsSettings& settings) {
  cycle_.restart();
  best_z_ = z_;
  q_inf_ = problem.q.cwiseAbs().maxCoeff();
  best_residual_ = kInfinity;
  next_look_ = 0;
  next_certificate_ = 0;
  forced_certificate_ = settings.check_period;
}

template <typename Product>
Status Pgs::Workspace::run(Product& product, const Problem& problem, const PgsSettings& settings,
                           const Deadline& deadline, Result& result) {
  const int most_sweeps =
      settings.max_iterations >= 0 ? settings.max_iterations : PgsSettings::kDefaultSweeps;
  start(problem, settings);
  for (std::int64_t done = 0;; ++done) {
    result.statistics.iterations = static_cast<int>(done);
    const bool out_of_time = deadline.passed();
    if (done == next_look_ || done == most_sweeps || out_of_time) {
      if (const auto ending = look(product, problem, settings, done, result)) {
        return *ending;
      }
    }
    if (done == most_sweeps) {
      return end(product, Status::kIterationLimit, "", result);
    }
    if (out_of_time) {
      return end(product, Status::kTimeLimit, "", result);
    }
    sweep(rows_, settings.relaxation, product, z_);
  }
}

/// Looks at the residual after `done` sweeps. @return what ends the solve, if anything does.
template <typename Product>
std::optional<Status> Pgs::Workspace::look(Product& product, const Problem& problem,
                                           const PgsSettings& settings, std::int64_t done,
                                           Result& result) {
  product.refresh(z_);
  const Residual now = residual(rows_, product, z_, q_inf_);
  if (done == 0) {
    first_residual_ = now.worst();
  }
  const double most = std::max(first_residual_, settings.tolerance) / kEpsilon;
  if (!now.is_finite() || now.worst() > most) {
    return end(product, Status::kNumericalBreakdown,
               "diverged: residual " + short_text(first_residual_) + " at the start, " +
                   short_text(now.worst()) + " after " + std::to_string(done) + " sweeps",
               result);
  }
  if (now.worst() <= best_residual_) {  // of equals the last: the other rows went on
    best_residual_ = now.worst();
    best_z_ = z_;
  }
  const bool small = now.worst() <= settings.tolerance && done >= next_certificate_;
  if (small || done >= forced_certificate_) {
    if (is_solved(judge(certify(problem, z_), settings.tolerance, Status::kNotRun))) {
      result.z = z_;
      return Status::kSolved;
    }
    next_certificate_ = done + std::max<std::int64_t>(settings.check_period, done / 8);
    forced_certificate_ = std::max(2 * done, next_certificate_);
  }
  // From the first full period on the looks are evenly spaced, and the next iterate looked at
  // depends on this one alone.
  const int returned = done >= settings.check_period && done == next_look_ ? cycle_.look(z_) : 0;
  if (returned > 0) {
    return end(product, Status::kStalled,
               "the iterate repeats itself every " +
                   std::to_string(std::int64_t{returned} * settings.check_period) + " sweeps",
               result);
  }
  next_look_ = done + std::clamp<std::int64_t>(done, 1, settings.check_period);
  return std::nullopt;
}

/// Ends with the best iterate and names what kept it from being better.
template <typename Product>
Status Pgs::Workspace::end(Product& product, Status status, std::string why, Result& result) {
  result.z = best_z_;
  result.detail = std::move(why);
  product.refresh(best_z_);
  if (const std::string stuck = stuck_rows(rows_, product, best_z_); !stuck.empty()) {
    result.detail += (result.detail.empty() ? "" : "; ") + stuck;
  }
  return status;
}

void PgsSettings::validate() const {
  SolverSettings::validate();
  if (!(relaxation > 0.0 && relaxation < 2.0)) {
    throw std::invalid_argument("settings: relaxation: must be in (0, 2), got " +
                                short_text(relaxation));
  }
  if (check_period < 1) {
    throw std::invalid_argument("settings: check_period: must be >= 1, got " +
                                std::to_string(check_period));
  }
}

Pgs::Pgs(const PgsSettings& settings)
    : settings_(settings), workspace_(std::make_unique<Workspace>()) {
  settings_.validate();
}

Pgs::~Pgs() = default;

std::string Pgs::refuses(const Problem& problem) const {
  return problem.cones.empty() ? "" : "takes no friction cones";
}

Status Pgs::iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                    Result& result) {
  return workspace_->solve(problem, settings_, warm_start, deadline, result);
}

}  // namespace signorini::lcp
