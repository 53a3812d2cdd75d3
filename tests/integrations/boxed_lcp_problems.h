#pragma once

#include <signorini/lcp/boxed_lcp.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace signorini {

/// Contacts of a few bodies with friction in one or two directions, some repeated, and joint rows,
/// free or limited; normals first, then all tangents. A = J W J^T, b = -J v.
inline lcp::BoxedLcp random_boxed_lcp(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto pick = [&](int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
  };
  const int bodies = pick(1, 4);
  const int joint_rows = pick(0, 2) == 0 ? pick(1, 3) : 0;
  const int contacts = pick(joint_rows > 0 ? 0 : 1, 8);
  const int tangents = pick(1, 2);
  const int n = joint_rows + contacts * (1 + tangents);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, 6 * bodies);
  Eigen::VectorXd W(6 * bodies);
  for (Eigen::Index i = 0; i < W.size(); ++i) W[i] = std::pow(10.0, 0.5 * uniform(random));
  const auto fill = [&](int row, int a, int b, const Eigen::Vector3d& axis,
                        const Eigen::Vector3d& r) {
    J.block<1, 3>(row, 6 * a) = axis.transpose();
    J.block<1, 3>(row, 6 * a + 3) = r.cross(axis).transpose();
    if (b >= 0) {
      J.block<1, 3>(row, 6 * b) = -axis.transpose();
      J.block<1, 3>(row, 6 * b + 3) = r.cross(axis).transpose();
    }
  };
  const auto vector = [&] {
    return Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  };
  const auto other_than = [&](int a) { return a == 0 ? -1 : pick(0, a) - 1; };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  lcp::BoxedLcp made;
  made.resize(n);
  made.lower.setZero();
  made.upper.setZero();
  made.x.setZero();
  std::fill(made.normal_row.begin(), made.normal_row.end(), -1);
  for (int row = 0; row < joint_rows; ++row) {
    const int a = pick(0, bodies - 1);
    fill(row, a, other_than(a), vector(), vector());
    const bool limited = pick(0, 1) == 1;
    made.lower[row] = limited ? -0.5 : -kInfinity;
    made.upper[row] = limited ? 0.5 : kInfinity;
  }
  for (int c = 0; c < contacts; ++c) {
    const int normal = joint_rows + c;
    const int first = joint_rows + contacts + c * tangents;
    if (c > 0 && pick(0, 3) == 0) {  // the same contact again
      J.row(normal) = J.row(normal - 1);
      for (int t = 0; t < tangents; ++t) J.row(first + t) = J.row(first + t - tangents);
    } else {
      const int a = pick(0, bodies - 1);
      const int b = other_than(a);
      const Eigen::Vector3d axis = vector().normalized();
      const Eigen::Vector3d r = vector();
      fill(normal, a, b, axis, r);
      const Eigen::Vector3d t1 = axis.unitOrthogonal();
      fill(first, a, b, t1, r);
      if (tangents == 2) fill(first + 1, a, b, axis.cross(t1), r);
    }
    made.upper[normal] = kInfinity;
    const double mu = pick(0, 4) == 0 ? 0.0 : 0.6 + 0.5 * uniform(random);
    for (int t = 0; t < tangents; ++t) {
      made.normal_row[first + t] = normal;
      made.lower[first + t] = -mu;
      made.upper[first + t] = mu;
    }
  }
  const Eigen::VectorXd v =
      Eigen::VectorXd::NullaryExpr(6 * bodies, [&] { return uniform(random); });
  const Eigen::MatrixXd A = J * W.asDiagonal() * J.transpose();
  made.A = A.selfadjointView<Eigen::Lower>();
  made.b = -J * v;
  return made;
}

/// max_i |x_i - clamp(x_i - w_i, lower, upper)| / (1 + |b|), recomputed in long double from the
/// host's numbers alone.
inline double residual(const lcp::BoxedLcp& p) {
  long double most = 0.0L;
  long double b_inf = 0.0L;
  for (Eigen::Index i = 0; i < p.b.size(); ++i) {
    long double w = -static_cast<long double>(p.b[i]);
    for (Eigen::Index j = 0; j < p.b.size(); ++j) {
      w += static_cast<long double>(p.A(i, j)) * static_cast<long double>(p.x[j]);
    }
    const long double scale =
        p.normal_row[i] < 0 ? 1.0L : std::max(static_cast<long double>(p.x[p.normal_row[i]]), 0.0L);
    const auto low = static_cast<long double>(p.lower[i]) * scale;
    const auto high = static_cast<long double>(p.upper[i]) * scale;
    const auto x = static_cast<long double>(p.x[i]);
    most = std::max(most, std::abs(x - std::clamp(x - w, low, high)));
    b_inf = std::max(b_inf, std::abs(static_cast<long double>(p.b[i])));
  }
  return static_cast<double>(most / (1.0L + b_inf));
}

/// What a status allows: the tolerance of 1e-8, and four times what rounding x to numbers of this
/// epsilon costs.
inline double allowance(const lcp::BoxedLcp& p, double epsilon) {
  double most = 0.0;
  for (Eigen::Index i = 0; i < p.b.size(); ++i) {
    most = std::max(
        most, std::abs(p.b[i]) + std::abs(p.x[i]) + p.A.row(i).cwiseAbs().dot(p.x.cwiseAbs()));
  }
  const double b_inf = p.b.size() > 0 ? p.b.cwiseAbs().maxCoeff() : 0.0;
  return 1e-8 + 4.0 * epsilon * most / (1.0 + b_inf);
}

}  // namespace signorini
