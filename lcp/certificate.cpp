#include <signorini/lcp/certificate.h>
#include <signorini/lcp/enclosed_product.h>
#include <signorini/lcp/exact_sum.h>
#include <signorini/lcp/friction_cone.h>
#include <signorini/lcp/group_scale.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// A sum of |M||z| above this has lost nothing to underflow that would count: up to 2^50 products
// lose 2^-1075 each. (Where all products of a row vanish its sum is 0 and the floor too: stricter.)
constexpr double kLeastSum = 0x1p-960;
constexpr double kFloorsAllowed = 4.0;
// No rounding floor excuses a residual above this: where z is so large that |M||z| has no digits
// left beside q, the floor is large too, and an infeasible problem would pass for a rounded one.
constexpr double kRoundingCeiling = 1e-5;
// What the residual itself may have lost to long double's rounding, in floors (which are double's):
// 2^-11, and some for the length of the sums.
constexpr double kOwnRounding = 0x1p-10;
// A numerator above this part of |M||z| is not 0, whatever rounding did.
constexpr double kHidden = 0x1p-40;
// A force this part of its limit inside the cone is none that rounding z could move to the
// boundary.
constexpr long double kFarInside = 1e-3L;
// Of w~ beside what the projection leaves of it: long double's rounding, which a mu of 1e12 makes
// more than the residual.
constexpr long double kLost = 4.0L * std::numeric_limits<long double>::epsilon();
constexpr long double kWiden = 1.0L + 0x1p-58L;  // more than rounding a cone's norms may cost

/// What long double may have lost of w_T, times mu, where the floor is that of the boundary and
/// smaller. Of z_c = 0, whose -w~ is in the polar cone as soon as w_N >= 0, nothing.
/// @param in_w_tilde mu (|M||z| + |q|)_T @param boundary max(|z_T|, mu |z_N|)
long double lost_of_slip(long double in_w_tilde, long double boundary) {
  const long double lost = kLost * in_w_tilde;
  return boundary > 0.0L && lost > kEpsilon * boundary ? lost : 0.0L;
}

Certificate refuse() {
  Certificate certificate;
  certificate.natural_residual = kInfinity;
  certificate.unit_free_residual = kInfinity;
  certificate.rounding_floor = 0.0;
  certificate.natural_floor = 0.0;
  certificate.backward_error = kInfinity;
  return certificate;
}

/// Fills z's row norms |M||z| (added to size), the diagonal and the blocks of the cones.
template <typename Number>
struct EntryVisitor {
  const std::vector<Number>& absolute_z;
  const std::vector<int>& cone_of_row;
  const std::vector<FrictionCone>& cones;
  std::vector<Number>& size;
  Vector& diagonal;
  std::vector<Eigen::Matrix3d>& blocks;

  void operator()(Index i, Index j, double a) const {
    size[i] += std::abs(a) * absolute_z[j];
    if (i == j) {
      diagonal[i] = a;
    }
    if (!cones.empty() && cone_of_row[i] >= 0 && cone_of_row[i] == cone_of_row[j]) {
      const int cone = cone_of_row[i];
      blocks[cone](i - cones[cone].normal_row, j - cones[cone].normal_row) = a;
    }
  }
};

}  // namespace

/// z's row norms |M||z|, scale_ and cone_blocks_: every entry of M is looked at.
template <typename Number>
void Certifier::visit_entries(const Problem& problem, std::vector<Number>& absolute_z,
                              std::vector<Number>& size) {
  const Index n = problem.size();
  size.assign(n, Number{0});
  absolute_z.resize(n);
  for (Index i = 0; i < n; ++i) {
    absolute_z[i] = static_cast<Number>(std::abs(z_[i]));
  }
  const EntryVisitor<Number> visit{absolute_z, cone_of_row_, problem.cones,
                                   size,       scale_,       cone_blocks_};
  if (const auto* factored = std::get_if<FactoredMatrix>(&problem.M)) {
    factored->visit_lower(visit_, [&visit](Index i, Index j, double a) {
      visit(i, j, a);
      if (i != j) {
        visit(j, i, a);
      }
    });
  } else if (const auto* dense = std::get_if<Matrix>(&problem.M)) {
    for (Index j = 0; j < n; ++j) {
      for (Index i = 0; i < n; ++i) {
        visit(i, j, (*dense)(i, j));
      }
    }
  } else {
    const auto& sparse = std::get<SparseMatrix>(problem.M);
    for (Index j = 0; j < n; ++j) {
      for (SparseMatrix::InnerIterator it(sparse, j); it; ++it) {
        visit(it.row(), j, it.value());
      }
    }
  }
}

/// size_ without q: in doubles, whose rounding is nothing in a floor, and in long doubles where one
/// of the sums leaves their range.
void Certifier::find_sizes(const Problem& problem) {
  const auto* factored = std::get_if<FactoredMatrix>(&problem.M);
  absolute_z_.resize(problem.size());
  absolute_w_.resize(problem.size());
  std::ranges::transform(z_, absolute_z_.begin(),
                         [](long double z) { return static_cast<double>(std::abs(z)); });
  if (factored != nullptr &&
      absolute_product_.compute(*factored, absolute_z_, absolute_w_, scale_)) {
    for (std::size_t c = 0; c < problem.cones.size(); ++c) {
      const FrictionCone& cone = problem.cones[c];
      cone_blocks_[c] = diagonal_block(problem.M, cone.normal_row, cone.dimension, block_room_);
    }
  } else {
    visit_entries(problem, absolute_z_, absolute_w_);
  }
  const bool in_range = std::all_of(absolute_w_.begin(), absolute_w_.end(), [](double sum) {
    return sum == 0.0 || (sum > kLeastSum && std::isfinite(sum));
  });
  if (in_range) {
    size_.assign(absolute_w_.begin(), absolute_w_.end());
  } else {
    visit_entries(problem, long_z_, size_);
  }
}

/// w_, size_, scale_ from M and q.
void Certifier::multiply_by_matrix(const Problem& problem) {
  const Index n = problem.size();
  cone_of_row_.assign(problem.cones.empty() ? 0 : n, -1);
  cone_blocks_.assign(problem.cones.size(), Eigen::Matrix3d::Zero());
  for (std::size_t c = 0; c < problem.cones.size(); ++c) {
    for (int k = 0; k < problem.cones[c].dimension; ++k) {
      cone_of_row_[problem.cones[c].normal_row + k] = static_cast<int>(c);
    }
  }
  scale_.setZero(n);
  w_.assign(n, 0.0L);
  if (const auto* factored = std::get_if<FactoredMatrix>(&problem.M)) {
    body_p_.resize(factored->degrees_of_freedom());
    body_v_.resize(factored->degrees_of_freedom());
    factored->transpose_times(z_.data(), body_p_.data());
    factored->apply_inverse_mass(body_p_.data(), body_v_.data());
    factored->times(body_v_.data(), z_.data(), w_.data());
  } else {
    multiply(problem.M, z_.data(), w_.data());
  }
  find_sizes(problem);
  for (Index i = 0; i < n; ++i) {
    w_[i] += problem.q[i];
    size_[i] += std::abs(problem.q[i]);
    scale_[i] = scale_[i] > 0.0 ? scale_[i] : 1.0;
  }
  for (std::size_t c = 0; c < problem.cones.size(); ++c) {
    scale_[problem.cones[c].normal_row] =
        largest_eigenvalue(cone_blocks_[c], problem.cones[c].dimension);
  }
}

void Certifier::find_bounds(const Problem& problem) {
  bounds_.assign(problem.size(), {0.0L, kInfinity, 0.0L});
  for (Index i = 0; i < problem.size(); ++i) {
    if (problem.lower.size() > 0) {
      bounds_[i].lower = problem.lower[i];
    }
    if (problem.upper.size() > 0) {
      bounds_[i].upper = problem.upper[i];
    }
  }
  for (const CoupledLimit& limit : problem.limits) {
    const long double coefficient = limit.coefficient;
    const long double normal = std::max(z_[limit.normal_row], 0.0L);
    const long double most = coefficient * normal;
    bounds_[limit.row] = {-most, most, std::abs(std::fma(coefficient, normal, -most))};
  }
}

inline void Certifier::Total::add_row(long double row_size, double q, long double z) {
  is_zero = is_zero && z == 0.0L;
  size = std::max(size, row_size);
  natural_size = std::max(natural_size, row_size);
  q_inf = std::max(q_inf, std::abs(q));
}

inline void Certifier::Total::add_group(int row, const Measure& measure) {
  const auto least = [](double a, double b) { return b < a || std::isnan(a) ? b : a; };
  const auto largest = [](double a, double b) { return b > a || std::isnan(a) ? b : a; };
  most.natural = std::max(most.natural, measure.natural);
  if (measure.unit_free > most.unit_free || worst_row < 0) {
    most.unit_free = measure.unit_free;
    worst_row = row;
  }
  most.backward = std::max(most.backward, measure.backward);
  most.z_dot_w += measure.z_dot_w;
  most.min_z = least(most.min_z, measure.min_z);
  most.min_w = least(most.min_w, measure.min_w);
  most.cone_violation = largest(most.cone_violation, measure.cone_violation);
  size = std::max(size, measure.scaled_boundary);
  natural_size = std::max(natural_size, measure.boundary);
}

inline Certifier::Measure Certifier::measure_row(Index i) const {
  const long double z = z_[i];
  const long double w = w_[i];
  const Bounds& bounds = bounds_[i];
  const long double lower = bounds.lower, upper = bounds.upper, lost = bounds.lost;
  // s r(s): 0 exactly where the row is solved. Arithmetic with infinities is slow in long double.
  const auto scaled_step = [&](long double s) {
    const long double from_upper = upper < kInfinity ? std::max(w, s * (z - upper)) : w;
    const long double step =
        std::abs(lower > -kInfinity ? std::min(from_upper, s * (z - lower)) : from_upper);
    const bool may_be_bound =
        lost > 0.0L && (s * (z - lower - lost) <= w || s * (z - upper + lost) >= w);
    return may_be_bound ? step + s * lost : step;
  };
  const long double d = scale_[i];
  Measure row;
  row.natural = scaled_step(1.0L);
  row.unit_free = scaled_step(d);
  row.backward = row.unit_free > 0.0L ? row.unit_free / (d * std::abs(z) + size_[i]) : 0.0L;
  if (lower == 0.0L && upper == kInfinity) {
    row.z_dot_w = z * w;
    row.min_z = static_cast<double>(z);
    row.min_w = static_cast<double>(w);
  }
  return row;
}

Certifier::Measure Certifier::measure_cone(const Problem& problem, std::size_t cone) const {
  const int first = problem.cones[cone].normal_row;
  const int d = problem.cones[cone].dimension;
  const long double mu = problem.cones[cone].coefficient;
  const long double* z = z_.data() + first;
  std::array<long double, 3> w{};
  std::copy(w_.data() + first, w_.data() + first + d, w.data());
  Measure sum;
  const long double w_normal = w[0];
  sum.min_w = static_cast<double>(w_normal);
  const bool is_coulomb = problem.friction_law == FrictionLaw::kCoulomb;
  if (is_coulomb) {
    w[0] += mu * tangential_norm(d, w.data());
  }
  // z - P_K(x), x = z - w / scale, by Moreau as w / scale + (x - P_K(x)): nothing of w is lost
  // beside a z that is far larger.
  const long double tangential = tangential_norm(d, z);
  struct Step {
    long double length;
    bool is_far_inside;  // K, from x on: rounding z moves no projection
  };
  const auto step = [&](long double scale) -> Step {
    std::array<long double, 3> moved{};
    std::array<long double, 3> rest{};
    long double across = 0.0L;  // |x_T| - |z_T|, times their sum
    for (int k = 0; k < d; ++k) {
      rest[k] = w[k] / scale;
      moved[k] = z[k] - rest[k];
      across += k > 0 ? rest[k] * (rest[k] - 2.0L * z[k]) : 0.0L;
    }
    long double lost = 0.0L;
    const long double moved_tangential = tangential_norm(d, moved.data());
    const long double sum_of_norms = moved_tangential + tangential;
    const long double outside = (tangential - mu * z[0]) + mu * rest[0] +
                                (sum_of_norms > 0.0L ? across / sum_of_norms : 0.0L);
    if (outside > 0.0L || moved[0] < 0.0L) {  // of mu = 0 and x_T = 0 outside is 0 below K too
      if (!(moved[0] + mu * moved_tangential > 0.0L)) {  // P_K(x) = 0
        std::copy(z, z + d, rest.begin());
      } else {
        const long double distance = outside / (1.0L + mu * mu);
        lost = kLost * std::abs(rest[0]);
        rest[0] -= mu * distance;
        for (int k = 1; k < d; ++k) {
          rest[k] += distance * (moved[k] / moved_tangential);
        }
      }
    }
    return {std::hypot(rest[0], tangential_norm(d, rest.data())) + lost,
            outside < -0.5L * kFarInside * mu * z[0]};
  };
  const long double length = std::hypot(z[0], tangential);
  const auto residual = [&](const Step& taken, long double scale) {
    const long double normal = is_coulomb ? std::abs(std::min(length, w_normal / scale)) : 0.0L;
    return std::max(taken.length, normal);
  };
  const long double scale = scale_[first];
  const Step natural = step(1.0L);
  const Step scaled = step(scale);
  sum.natural = residual(natural, 1.0L);
  sum.unit_free = scale * residual(scaled, scale);
  long double size = 0.0L;
  long double slip_size = 0.0L;
  long double z_size = 0.0L;
  for (int k = 0; k < d; ++k) {
    size = std::max(size, size_[first + k]);
    slip_size = k > 0 ? std::max(slip_size, size_[first + k]) : 0.0L;
    z_size = std::max(z_size, std::abs(z[k]));
    sum.z_dot_w += z[k] * w[k];
  }
  const long double in_w_tilde = is_coulomb ? mu * slip_size : 0.0L;
  const long double boundary = std::max(tangential, mu * std::abs(z[0]));
  const long double lost = lost_of_slip(in_w_tilde, boundary);
  sum.natural += lost;
  sum.unit_free += lost;
  sum.backward = sum.unit_free > 0.0L ? sum.unit_free / (scale * z_size + size) : 0.0L;
  sum.boundary = natural.is_far_inside ? std::min(in_w_tilde, boundary) : boundary;
  sum.scaled_boundary =
      scaled.is_far_inside ? std::min(in_w_tilde, scale * boundary) : scale * boundary;
  sum.min_z = static_cast<double>(z[0]);
  sum.cone_violation = static_cast<double>(cone_violation(mu, d, z));
  return sum;
}

bool Certifier::measure(const Problem& problem, const VectorRef& z,
                        const std::vector<int>* island) {
  const Index n = problem.size();
  if (z.size() != n || !z.allFinite()) {
    return false;
  }
  z_.assign(z.data(), z.data() + n);
  multiply_by_matrix(problem);
  find_bounds(problem);
  for (Index i = 0; i < n; ++i) {
    Total& total = totals_[island != nullptr ? (*island)[i] : 0];
    total.add_row(size_[i], problem.q[i], z_[i]);
    const int cone = problem.cones.empty() ? -1 : cone_of_row_[i];
    if (cone >= 0 && problem.cones[cone].normal_row != i) {
      continue;
    }
    const Measure measure = cone < 0 ? measure_row(i) : measure_cone(problem, cone);
    if (!measure.is_finite() || !std::isfinite(size_[i])) {
      return false;
    }
    total.add_group(static_cast<int>(i), measure);
  }
  return true;
}

bool Certifier::Total::needs_exactness() const {
  return q_inf == 0.0 && !is_zero && most.unit_free <= kHidden * size;
}

Certificate Certifier::Total::certificate() const {
  Certificate result;
  result.natural_residual = static_cast<double>(most.natural / (1.0L + q_inf));
  result.natural_floor = static_cast<double>(kEpsilon * natural_size / (1.0L + q_inf));
  if (q_inf > 0.0) {
    result.unit_free_residual = static_cast<double>(most.unit_free / q_inf);
    result.rounding_floor = static_cast<double>(kEpsilon * size / q_inf);
  } else {
    const bool is_solved = is_zero ? most.unit_free == 0.0L : solved_exactly;
    result.unit_free_residual = is_solved ? 0.0 : kInfinity;
    result.rounding_floor = 0.0;
  }
  result.backward_error = static_cast<double>(most.backward);
  result.min_z = most.min_z;
  result.min_w = most.min_w;
  result.complementarity = static_cast<double>(std::abs(most.z_dot_w));
  result.cone_violation = most.cone_violation;
  result.worst_row = worst_row;
  return result;
}

/// solved_exactly of the totals that need it. @param island of every row; null: all are one
void Certifier::settle_exactly(const Problem& problem, const VectorRef& z,
                               const std::vector<int>* island) {
  if (std::ranges::none_of(totals_, &Total::needs_exactness)) {
    return;
  }
  enclose_product(problem.M, z, product_);
  limit_of_row_.assign(problem.size(), -1);
  for (std::size_t k = 0; k < problem.limits.size(); ++k) {
    limit_of_row_[problem.limits[k].row] = static_cast<int>(k);
  }
  for (Total& total : totals_) {
    total.solved_exactly = total.needs_exactness();
  }
  for (Index i = 0; i < problem.size(); ++i) {
    Total& total = totals_[island != nullptr ? (*island)[i] : 0];
    if (total.solved_exactly) {
      const int cone = problem.cones.empty() ? -1 : cone_of_row_[i];
      total.solved_exactly = cone < 0 ? solves_row(problem, z, i) : solves_cone(problem, z, cone);
    }
  }
}

/// Whether r_i is 0 for w = M z, without rounding.
bool Certifier::solves_row(const Problem& problem, const VectorRef& z, Index i) const {
  int above_lower = 0;  // the signs of z - lower and upper - z
  int below_upper = 0;
  if (const int k = limit_of_row_[i]; k >= 0) {
    const CoupledLimit& limit = problem.limits[k];
    const double normal = std::max(z[limit.normal_row], 0.0);
    ExactSum from_lower;
    ExactSum to_upper;
    from_lower.add_product(limit.coefficient, normal);
    to_upper.add_product(limit.coefficient, normal);
    from_lower.add_product(1.0, z[i]);
    to_upper.add_product(-1.0, z[i]);
    above_lower = from_lower.sign();
    below_upper = to_upper.sign();
  } else {
    const auto sign = [](double lower, double upper) { return (lower < upper) - (lower > upper); };
    above_lower = sign(problem.lower.size() > 0 ? problem.lower[i] : 0.0, z[i]);
    below_upper = sign(z[i], problem.upper.size() > 0 ? problem.upper[i] : kInfinity);
  }
  const Interval& w = product_[i];
  return above_lower >= 0 && below_upper >= 0 && (above_lower == 0 || w.upper <= 0.0L) &&
         (below_upper == 0 || w.lower >= 0.0L);
}

/// The same of a cone, where z_c = 0 or w_c = 0; else false.
bool Certifier::solves_cone(const Problem& problem, const VectorRef& z, std::size_t cone) const {
  const auto [first, d, mu] = problem.cones[cone];
  if (z.segment(first, d).isZero(0.0)) {
    long double tangential = 0.0L;
    for (int k = 1; k < d && problem.friction_law == FrictionLaw::kAssociated; ++k) {
      const Interval& w = product_[first + k];
      tangential = std::hypot(tangential, std::max(std::abs(w.lower), std::abs(w.upper)));
    }
    return product_[first].lower >= mu * tangential * kWiden;
  }
  for (int k = 0; k < d; ++k) {
    if (!(product_[first + k].lower == 0.0L && product_[first + k].upper == 0.0L)) {
      return false;
    }
  }
  const long double normal = z[first];
  return tangential_norm(d, z_.data() + first) * kWiden <= mu * normal && normal >= 0.0L;
}

/// size_: |J||W||J^T||z| + C|z| + |q|, at least (|M||z| + |q|).
void Certifier::bound_sizes(const Problem& problem, const FactoredMatrix& A, const VectorRef& z) {
  absolute_p_.assign(A.degrees_of_freedom(), 0.0);
  absolute_v_.assign(A.degrees_of_freedom(), 0.0);
  for (int i = 0; i < A.rows(); ++i) {
    const double size = std::abs(z[i]);
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      const double* row = A.values(entry);
      double* p = absolute_p_.data() + A.mass.offset(entry.block);
      for (int k = 0; k < A.mass.dimension(entry.block); ++k) {
        p[k] += std::abs(row[k]) * size;
      }
    }
  }
  for (int b = 0; b < A.mass.block_count(); ++b) {
    const auto W = A.mass.stored(b);
    const int d = A.mass.dimension(b);
    const double* p = absolute_p_.data() + A.mass.offset(b);
    double* v = absolute_v_.data() + A.mass.offset(b);
    for (int j = 0; j < d; ++j) {
      for (int i = 0; i < d; ++i) {
        v[i] += std::abs(W(i, j)) * p[j];
      }
    }
  }
  size_.resize(problem.size());
  for (int i = 0; i < A.rows(); ++i) {
    double sum = A.compliance(i) * std::abs(z[i]) + std::abs(problem.q[i]);
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      const double* row = A.values(entry);
      const double* v = absolute_v_.data() + A.mass.offset(entry.block);
      for (int k = 0; k < A.mass.dimension(entry.block); ++k) {
        sum += std::abs(row[k]) * v[k];
      }
    }
    size_[i] = sum;
  }
}

/// D of a cone, or of a row outside cones.
double Certifier::scale_of(const Problem& problem, int first, int cone) {
  const int d = cone < 0 ? 1 : problem.cones[cone].dimension;
  const Eigen::Matrix3d block = diagonal_block(problem.M, first, d, block_room_);
  return cone >= 0 ? largest_eigenvalue(block, d) : block(0, 0) > 0.0 ? block(0, 0) : 1.0;
}

/// The measure of a cone, or of a row outside cones, or a bound of it up to `fine`.
Certifier::Measure Certifier::bound_group(const Problem& problem, int first, int cone, double fine,
                                          bool scales_known) {
  const int d = cone < 0 ? 1 : problem.cones[cone].dimension;
  const long double* z = z_.data() + first;
  const long double* w = w_.data() + first;
  long double tangential = 0.0L;
  long double slip = 0.0L;
  long double sum = 0.0L;
  for (int k = 1; k < d; ++k) {
    tangential += z[k] * z[k];
    slip += w[k] * w[k];
  }
  long double w_tilde = w[0];
  bool is_inside = false;
  if (cone < 0) {
    const auto& [lower, upper, lost_of_bounds] = bounds_[first];
    is_inside = z[0] >= lower && z[0] <= upper &&
                (lost_of_bounds == 0.0L ||
                 (z[0] - lower >= lost_of_bounds && upper - z[0] >= lost_of_bounds));
  } else {
    const long double mu = problem.cones[cone].coefficient;
    const long double limit = (1.0L - kFarInside) * mu * z[0];  // nearer: measured
    is_inside = z[0] > 0.0L && tangential <= limit * limit;
    if (problem.friction_law == FrictionLaw::kCoulomb) {
      w_tilde += mu * std::sqrt(slip);
    }
  }
  // A Coulomb cone's normal part by itself: mu |w_T| may hide a w_N < 0.
  sum = std::max(std::sqrt(w_tilde * w_tilde + slip), std::abs(w[0]));
  if (!is_inside || !(sum <= fine)) {
    // Of z_c = 0 D |P_K(-w~ / D)| is the same for all D.
    const bool any_scale =
        cone >= 0 && std::all_of(z, z + d, [](long double value) { return value == 0.0L; });
    if (!scales_known) {
      scale_[first] = any_scale ? 1.0 : scale_of(problem, first, cone);
    }
    return cone < 0 ? measure_row(first) : measure_cone(problem, cone);
  }
  Measure measure;
  measure.natural = sum;
  measure.unit_free = sum;
  const bool is_lcp_row =
      cone < 0 && bounds_[first].lower == 0.0L && bounds_[first].upper == kInfinity;
  if (cone >= 0 || is_lcp_row) {
    measure.min_z = static_cast<double>(z[0]);
    measure.min_w = static_cast<double>(w[0]);
    measure.z_dot_w = z[0] * w_tilde;
    for (int k = 1; k < d; ++k) {
      measure.z_dot_w += z[k] * w[k];
    }
  }
  if (cone >= 0) {
    measure.cone_violation = 0.0;
    if (problem.friction_law == FrictionLaw::kCoulomb) {
      const long double slip_size = *std::max_element(&size_[first + 1], &size_[first] + d);
      const long double mu = problem.cones[cone].coefficient;
      measure.boundary = mu * slip_size;
      measure.scaled_boundary = measure.boundary;
      const long double lost =
          lost_of_slip(measure.boundary, std::max(std::sqrt(tangential), mu * std::abs(z[0])));
      measure.natural += lost;
      measure.unit_free += lost;
    }
  }
  return measure;
}

/// Adds bounds to the total. @return false where there are none
bool Certifier::bound(const Problem& problem, const VectorRef& z, double tolerance,
                      bool scales_known) {
  const auto* A = std::get_if<FactoredMatrix>(&problem.M);
  const Index n = problem.size();
  const double q_inf = n > 0 ? problem.q.cwiseAbs().maxCoeff() : 0.0;
  if (A == nullptr || !(q_inf > 0.0) || z.size() != n || !z.allFinite()) {
    return false;
  }
  for (int b = 0; b < A->mass.block_count(); ++b) {
    if (A->mass.is_factor(b)) {
      return false;
    }
  }
  z_.assign(z.data(), z.data() + n);
  w_.resize(n);
  body_p_.resize(A->degrees_of_freedom());
  body_v_.resize(A->degrees_of_freedom());
  A->transpose_times(z_.data(), body_p_.data());
  A->apply_inverse_mass(body_p_.data(), body_v_.data());
  A->times(body_v_.data(), z_.data(), w_.data());
  bound_sizes(problem, *A, z);
  find_bounds(problem);
  scale_.resize(n);
  Total& total = totals_.front();
  for (Index i = 0; i < n; ++i) {
    w_[i] += problem.q[i];
    total.add_row(size_[i], problem.q[i], z_[i]);
  }
  const double fine = 0.5 * tolerance * q_inf;
  std::size_t cone = 0;
  for (int i = 0; i < n;) {
    const bool starts_cone = cone < problem.cones.size() && problem.cones[cone].normal_row == i;
    const Measure measure =
        bound_group(problem, i, starts_cone ? static_cast<int>(cone) : -1, fine, scales_known);
    if (!measure.is_finite()) {
      return false;
    }
    total.add_group(i, measure);
    i += starts_cone ? problem.cones[cone++].dimension : 1;
  }
  return true;
}

Certificate Certifier::certify_quickly(const Problem& problem, const VectorRef& z, double tolerance,
                                       Vector* w) {
  totals_.assign(1, Total{});
  if (bound(problem, z, tolerance, false)) {
    Certificate certificate = totals_[0].certificate();
    certificate.backward_error = Certificate::kNaN;
    if (judge(certificate, tolerance, Status::kStalled) == Status::kSolved) {
      if (w != nullptr) {
        w->resize(problem.size());
        std::copy(w_.begin(), w_.end(), w->data());
      }
      return certificate;
    }
  }
  return certify(problem, z, w);
}

void Certifier::start_iterates(const Problem& problem) {
  scale_.setOnes(problem.size());
  std::size_t cone = 0;
  for (int i = 0; i < problem.size();) {
    const bool starts_cone = cone < problem.cones.size() && problem.cones[cone].normal_row == i;
    scale_[i] = scale_of(problem, i, starts_cone ? static_cast<int>(cone) : -1);
    i += starts_cone ? problem.cones[cone++].dimension : 1;
  }
}

Certificate Certifier::certify_iterate(const Problem& problem, const VectorRef& z,
                                       double tolerance) {
  totals_.assign(1, Total{});
  if (bound(problem, z, tolerance, true)) {
    Certificate certificate = totals_[0].certificate();
    certificate.backward_error = Certificate::kNaN;
    if (judge(certificate, tolerance, Status::kStalled) != Status::kSolvedToRounding) {
      return certificate;
    }
  }
  return certify(problem, z);
}

Certificate Certifier::certify(const Problem& problem, const VectorRef& z, Vector* w) {
  const Index n = problem.size();
  totals_.assign(1, Total{});
  if (!measure(problem, z, nullptr)) {
    if (w != nullptr) {
      w->setConstant(n, Certificate::kNaN);
    }
    return refuse();
  }
  settle_exactly(problem, z, nullptr);
  if (w != nullptr) {
    w->resize(n);
    std::copy(w_.begin(), w_.end(), w->data());
  }
  return totals_[0].certificate();
}

void Certifier::certify_islands(const Problem& problem, const VectorRef& z, const Islands& islands,
                                std::vector<Certificate>& certificates) {
  totals_.assign(islands.count, Total{});
  if (!measure(problem, z, &islands.island)) {
    certificates.assign(islands.count, refuse());
    return;
  }
  settle_exactly(problem, z, &islands.island);
  certificates.resize(islands.count);
  std::ranges::transform(totals_, certificates.begin(), &Total::certificate);
}

Certificate certify(const Problem& problem, const VectorRef& z, Vector* w) {
  return Certifier().certify(problem, z, w);
}

Status judge(const Certificate& certificate, double tolerance, Status otherwise) {
  const auto at_most = [](double residual, double floor) {  // NaN makes it NaN
    return residual + kOwnRounding * floor;
  };
  const double natural = at_most(certificate.natural_residual, certificate.natural_floor);
  const double unit_free = at_most(certificate.unit_free_residual, certificate.rounding_floor);
  if (natural <= tolerance && unit_free <= tolerance) {  // false for NaN
    return Status::kSolved;
  }
  const auto within = [tolerance](double residual, double floor) {
    return residual <= std::max(tolerance, std::min(kFloorsAllowed * floor, kRoundingCeiling));
  };
  return within(natural, certificate.natural_floor) && within(unit_free, certificate.rounding_floor)
             ? Status::kSolvedToRounding
             : otherwise;
}

}  // namespace signorini::lcp
