#include <signorini/lcp/contact_groups.h>
#include <signorini/lcp/group_scale.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_free_row(const Problem& problem, Index i) {
  return problem.lower.size() > 0 && problem.lower[i] == -kInfinity &&
         (problem.upper.size() == 0 || problem.upper[i] == kInfinity);
}

bool is_lcp_row(const Problem& problem, Index i) {
  return (problem.lower.size() == 0 || problem.lower[i] == 0.0) &&
         (problem.upper.size() == 0 || problem.upper[i] == kInfinity);
}

/// |z - P_K(z - w / s)| s. Of one dimension: K = {z >= 0}.
double cone_step(double mu, int dimension, const double* z, const double* w, double s) {
  std::array<double, 3> moved{};
  for (int k = 0; k < dimension; ++k) {
    moved[k] = z[k] - w[k] / s;
  }
  if (dimension > 1) {
    project_on_cone(mu, dimension, moved.data(), moved.data());
  } else {
    moved[0] = std::max(moved[0], 0.0);
  }
  double sum = 0.0;
  for (int k = 0; k < dimension; ++k) {
    sum += (z[k] - moved[k]) * (z[k] - moved[k]);
  }
  return s * std::sqrt(sum);
}

}  // namespace

std::string ContactGroups::refuses(const Problem& problem) {
  std::size_t cone = 0;
  for (Index i = 0; i < problem.size(); ++i) {
    if (cone < problem.cones.size() && problem.cones[cone].normal_row == i) {
      i += problem.cones[cone++].dimension - 1;
    } else if (!is_free_row(problem, i) && !is_lcp_row(problem, i)) {
      return "takes cones, LCP rows and free rows; row " + std::to_string(i) + " has other bounds";
    }
  }
  return {};
}

void ContactGroups::set(const Problem& problem) {
  groups_.clear();
  starts_.clear();
  q_inf_ = problem.size() > 0 ? problem.q.cwiseAbs().maxCoeff() : 0.0;
  std::size_t cone = 0;
  for (int i = 0; i < problem.size();) {
    starts_.push_back(i);
    if (cone < problem.cones.size() && problem.cones[cone].normal_row == i) {
      const FrictionCone& c = problem.cones[cone++];
      groups_.push_back({i, c.dimension, c.coefficient, false});
      i += c.dimension;
    } else {
      groups_.push_back({i, 1, 0.0, is_free_row(problem, i)});
      ++i;
    }
  }
  starts_.push_back(static_cast<int>(problem.size()));
}

void ContactGroups::clamp(Vector& z) const {
  for (const Group& group : groups_) {
    double* x = z.data() + group.first;
    if (group.dimension > 1) {
      project_on_cone(group.mu, group.dimension, x, x);
    } else if (!group.is_free) {
      x[0] = std::max(x[0], 0.0);
    }
  }
}

void ContactGroups::reflect(std::size_t c, Vector& x) const {
  const Group& group = groups_[c];
  double* values = x.data() + group.first;
  if (group.dimension == 1) {
    values[0] = std::abs(values[0]);
    return;
  }
  std::array<double, 3> nearest{};
  project_on_cone(group.mu, group.dimension, values, nearest.data());
  for (int k = 0; k < group.dimension; ++k) {
    values[k] = 2.0 * nearest[k] - values[k];
  }
  project_on_cone(group.mu, group.dimension, values, values);
}

double ContactGroups::residual_of(const Problem& problem, const Group& group, const Vector& z,
                                  const Vector& w, double fine) const {
  const auto& [first, dimension, mu, is_free] = group;
  std::array<double, 3> v{};  // w~
  std::copy(w.data() + first, w.data() + first + dimension, v.data());
  if (dimension > 1 && problem.friction_law == FrictionLaw::kCoulomb) {
    v[0] += mu * tangential_norm(dimension, v.data());
  }
  const double* x = z.data() + first;
  const bool has_normal_part = dimension > 1 && problem.friction_law == FrictionLaw::kCoulomb;
  const double w_normal = has_normal_part ? w[first] : 0.0;  // of e_c, see Certificate
  const double unit_free_scale = q_inf_ > 0.0 ? q_inf_ : 1.0;
  if (!is_free && std::all_of(x, x + dimension, [](double value) { return value == 0.0; })) {
    return std::max(cone_step(mu, dimension, x, v.data(), 1.0), -w_normal) / unit_free_scale;
  }
  const bool is_inside =
      is_free || (dimension == 1 ? x[0] >= 0.0 : cone_violation(mu, dimension, x) == 0.0);
  const double bound = std::max(std::hypot(v[0], v[1], v[2]), std::abs(w_normal)) / unit_free_scale;
  if (is_free || (is_inside && !(bound > fine))) {
    return bound;
  }
  const Eigen::Matrix3d block = diagonal_block(problem.M, first, dimension);
  const double D = dimension == 1 ? (block(0, 0) > 0.0 ? block(0, 0) : 1.0)
                                  : largest_eigenvalue(block, dimension);
  const double length = has_normal_part ? std::hypot(x[0], tangential_norm(dimension, x)) : 0.0;
  const auto step = [&](double s) {
    return std::max(cone_step(group.mu, group.dimension, x, v.data(), s),
                    std::abs(std::min(s * length, w_normal)));
  };
  return std::max(step(1.0) / (1.0 + q_inf_), step(D) / unit_free_scale);
}

double ContactGroups::residual(const Problem& problem, const Vector& z, const Vector& w,
                               double fine) const {
  if (!std::isfinite(z.sum()) || !std::isfinite(w.sum())) {
    return kInfinity;
  }
  double most = 0.0;
  for (const Group& group : groups_) {
    most = std::max(most, residual_of(problem, group, z, w, std::max(fine, most)));
  }
  return most;
}

}  // namespace signorini::lcp
