#include <signorini/lcp/exact_sum.h>
#include <signorini/lcp/ray.h>

#include <cmath>
#include <limits>
#include <vector>

namespace signorini::lcp {
namespace {

/// max_i of what is added, from above, and 0 if none of them is positive. NaN stays NaN.
class LargestAbove {
 public:
  void add(const ExactSum& sum) {
    if (sum.sign() > 0) {
      add(sum.enclosure());
    }
  }
  void add(const Interval& value) {
    if (!(value.upper <= largest_)) {
      largest_ = value.upper;
    }
  }
  [[nodiscard]] long double value() const { return largest_; }

 private:
  long double largest_ = 0.0L;
};

/// max_i (M^T y)_i+, rounded up; 0 only if M^T y <= 0 exactly.
long double growth(const Matrix& M, const VectorRef& y) {
  LargestAbove largest;
  for (Index j = 0; j < M.cols(); ++j) {
    ExactSum sum;
    for (Index i = 0; i < M.rows(); ++i) {
      sum.add_product(M(i, j), y[i]);
    }
    largest.add(sum);
  }
  return largest.value();
}

long double growth(const SparseMatrix& M, const VectorRef& y) {
  LargestAbove largest;
  for (Index j = 0; j < M.outerSize(); ++j) {
    ExactSum sum;
    for (SparseMatrix::InnerIterator it(M, j); it; ++it) {
      sum.add_product(it.value(), y[it.row()]);
    }
    largest.add(sum);
  }
  return largest.value();
}

/// p = J^T y, every sum exact, then enclosed.
std::vector<Interval> enclose_transpose_times(const FactoredMatrix& A, const VectorRef& y) {
  std::vector<ExactSum> sums(A.degrees_of_freedom());
  for (int i = 0; i < A.rows(); ++i) {
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      for (int k = 0; k < A.mass.dimension(entry.block); ++k) {
        sums[A.mass.offset(entry.block) + k].add_product(A.values(entry)[k], y[i]);
      }
    }
  }
  std::vector<Interval> p(sums.size());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    p[k] = sums[k].enclosure();
  }
  return p;
}

long double growth(const FactoredMatrix& A, const VectorRef& y) {
  const std::vector<Interval> p = enclose_transpose_times(A, y);
  std::vector<Interval> v(p.size());
  for (int b = 0; b < A.mass.block_count(); ++b) {
    A.mass.apply_inverse(b, p.data() + A.mass.offset(b), v.data() + A.mass.offset(b));
  }
  LargestAbove largest;
  for (int i = 0; i < A.rows(); ++i) {
    Interval sum = A.compliance(i) * Interval(y[i]);
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      for (int k = 0; k < A.mass.dimension(entry.block); ++k) {
        sum += A.values(entry)[k] * v[A.mass.offset(entry.block) + k];
      }
    }
    largest.add(sum);
  }
  return largest.value();
}

ExactSum dot(const Vector& a, const VectorRef& b) {
  ExactSum sum;
  for (Index i = 0; i < a.size(); ++i) {
    sum.add_product(a[i], b[i]);
  }
  return sum;
}

double round_down(long double value) {
  const double nearest = static_cast<double>(value);
  return nearest <= value ? nearest
                          : std::nextafter(nearest, -std::numeric_limits<double>::infinity());
}

bool can_be_judged(const Problem& problem, const VectorRef& y) {
  return problem.is_lcp() && y.allFinite() && (y.array() >= 0.0).all() &&
         find_bad_value(problem).empty();
}

}  // namespace

RayVerdict judge_ray(const Problem& problem, const VectorRef& y) {
  if (!can_be_judged(problem, y)) {
    return {};
  }
  const ExactSum q_dot_y = dot(problem.q, y);
  if (q_dot_y.sign() >= 0) {
    return {};
  }
  const long double most = std::visit([&y](const auto& M) { return growth(M, y); }, problem.M);
  if (most == 0.0L) {
    return {Status::kInfeasible, std::numeric_limits<double>::infinity()};
  }
  const Interval bound = Interval(-q_dot_y.enclosure().upper) / most;
  const double rounded = round_down(bound.lower);
  if (!(rounded > 0.0) || !std::isfinite(most)) {  // underflow, overflow or NaN
    return {};
  }
  return {Status::kNoSolutionBelow, rounded};
}

}  // namespace signorini::lcp
