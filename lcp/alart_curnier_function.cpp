#include <signorini/lcp/alart_curnier_function.h>
#include <signorini/lcp/friction_cone.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Group = AlartCurnierFunction::Group;
using Block = AlartCurnierFunction::Block;
using Vector3 = Eigen::Vector3d;

Vector3 moved(const Group& group, const Vector& x, const Vector& u, double rho) {
  Vector3 y = Vector3::Zero();
  for (int k = 0; k < group.dimension; ++k) {
    y[k] = x[group.first + k] - rho * u[group.first + k];
  }
  return y;
}

/// The derivative of y -> P_K(y): 0, I, or that on the boundary of K.
Block cone_projection_derivative(double mu, int d, const Vector3& y) {
  const double tangential = tangential_norm(d, y.data());
  Block derivative = Block::Zero();
  if (y[0] >= 0.0 && tangential <= mu * y[0]) {
    derivative.diagonal().head(d).setOnes();
    return derivative;
  }
  const double along = (y[0] + mu * tangential) / (1.0 + mu * mu);
  if (!(along > 0.0)) {
    return derivative;
  }
  Vector3 direction = Vector3::Zero();  // of the nearest generator: p = along (1, mu t)
  direction.segment(1, d - 1) = y.segment(1, d - 1) / tangential;
  Vector3 generator = mu * direction;
  generator[0] = 1.0;
  derivative = generator * generator.transpose() / (1.0 + mu * mu);
  for (int j = 1; j < d; ++j) {
    for (int i = 1; i < d; ++i) {
      derivative(i, j) +=
          mu * along / tangential * ((i == j ? 1.0 : 0.0) - direction[i] * direction[j]);
    }
  }
  return derivative;
}

void coulomb_value(const Group& group, const Vector& x, const Vector& u, double rho,
                   const Vector3& y, Vector& F) {
  const bool pushes = y[0] > 0.0;
  const double radius = pushes ? group.mu * y[0] : 0.0;
  const double tangential = tangential_norm(group.dimension, y.data());
  F[group.first] = pushes ? rho * u[group.first] : x[group.first];
  for (int k = 1; k < group.dimension; ++k) {
    const int i = group.first + k;
    F[i] = tangential <= radius ? rho * u[i] : x[i] - radius * (y[k] / tangential);
  }
}

/// dF = A dx + B du of Coulomb's law, B still without its factor rho.
void coulomb_derivative(const Group& group, const Vector3& y, Block& A, Block& B) {
  const int d = group.dimension;
  if (!(y[0] > 0.0)) {
    A.diagonal().head(d).setOnes();
    return;
  }
  B(0, 0) = 1.0;
  const double radius = group.mu * y[0];
  const double tangential = tangential_norm(d, y.data());
  if (tangential <= radius) {
    B.diagonal().segment(1, d - 1).setOnes();
    return;
  }
  for (int i = 1; i < d; ++i) {
    const double along_i = y[i] / tangential;
    A(i, 0) = -group.mu * along_i;
    B(i, 0) = group.mu * along_i;
    for (int j = 1; j < d; ++j) {
      const double projected =
          radius / tangential * ((i == j ? 1.0 : 0.0) - along_i * y[j] / tangential);
      A(i, j) = (i == j ? 1.0 : 0.0) - projected;
      B(i, j) = projected;
    }
  }
}

}  // namespace

void AlartCurnierFunction::set(const Problem& problem, const Vector& scale, double unit) {
  const int n = static_cast<int>(problem.size());
  law_ = problem.friction_law;
  limits_ = problem.limits;
  group_of_row_.assign(n, -1);
  for (std::size_t c = 0; c < problem.cones.size(); ++c) {
    group_of_row_[problem.cones[c].normal_row] = static_cast<int>(c);
  }
  groups_.clear();
  for (int i = 0; i < n;) {
    const int cone = group_of_row_[i];
    Group group{
        .first = i, .dimension = 1, .mu = 0.0, .lower = 0.0, .upper = kInfinity, .limit = -1};
    if (cone >= 0) {
      group.dimension = problem.cones[cone].dimension;
      group.mu = problem.cones[cone].coefficient;
    } else {
      const double size = scale[i] * unit;
      group.lower = problem.lower.size() > 0 ? problem.lower[i] / size : 0.0;
      group.upper = problem.upper.size() > 0 ? problem.upper[i] / size : kInfinity;
    }
    for (int k = 0; k < group.dimension; ++k) {
      group_of_row_[i + k] = static_cast<int>(groups_.size());
    }
    i += group.dimension;
    groups_.push_back(group);
  }
  for (std::size_t k = 0; k < limits_.size(); ++k) {
    CoupledLimit& limit = limits_[k];
    limit.coefficient *= scale[limit.normal_row] / scale[limit.row];
    groups_[group_of_row_[limit.row]].limit = static_cast<int>(k);
  }
}

double AlartCurnierFunction::bound_of(const Group& group, const Vector& x) const {
  const CoupledLimit& limit = limits_[group.limit];
  return limit.coefficient * std::max(x[limit.normal_row], 0.0);
}

void AlartCurnierFunction::evaluate(const Vector& x, const Vector& u, double rho, Vector& F) const {
  F.resize(x.size());
  for (const Group& group : groups_) {
    const Vector3 y = moved(group, x, u, rho);
    const int i = group.first;
    if (group.dimension == 1) {
      const double most = group.limit < 0 ? group.upper : bound_of(group, x);
      const double least = group.limit < 0 ? group.lower : -most;
      F[i] = y[0] < least ? x[i] - least : (y[0] > most ? x[i] - most : rho * u[i]);
    } else if (law_ == FrictionLaw::kCoulomb) {
      coulomb_value(group, x, u, rho, y, F);
    } else {
      Vector3 nearest;
      project_on_cone(group.mu, group.dimension, y.data(), nearest.data());
      for (int k = 0; k < group.dimension; ++k) {
        F[i + k] = x[i + k] - nearest[k];
      }
    }
  }
}

void AlartCurnierFunction::differentiate(const Vector& x, const Vector& u, double rho,
                                         std::vector<Block>& A, std::vector<Block>& B,
                                         std::vector<Coupling>& couplings) const {
  A.assign(groups_.size(), Block::Zero());
  B.assign(groups_.size(), Block::Zero());
  couplings.clear();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    const Vector3 y = moved(group, x, u, rho);
    if (group.dimension == 1) {
      const double most = group.limit < 0 ? group.upper : bound_of(group, x);
      const double least = group.limit < 0 ? group.lower : -most;
      const bool inside = y[0] >= least && y[0] <= most;
      (inside ? B : A)[g](0, 0) = 1.0;
      if (!inside && group.limit >= 0 && most > 0.0) {
        const double sign = y[0] < least ? 1.0 : -1.0;
        couplings.push_back({group.first, limits_[group.limit].normal_row,
                             sign * limits_[group.limit].coefficient});
      }
    } else if (law_ == FrictionLaw::kCoulomb) {
      coulomb_derivative(group, y, A[g], B[g]);
    } else {
      B[g] = cone_projection_derivative(group.mu, group.dimension, y);
      A[g].diagonal().head(group.dimension).setOnes();
      A[g] -= B[g];
    }
    B[g] *= rho;
  }
}

}  // namespace signorini::lcp
