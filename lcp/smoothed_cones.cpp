#include <signorini/lcp/smooth_clamp.h>
#include <signorini/lcp/smoothed_cones.h>

#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

using Group = SmoothedCones::Group;
using Block = SmoothedCones::Block;
using Vector3 = Eigen::Vector3d;

constexpr double kSlipSmoothing = 0.03;  // e of mu
constexpr double kLeastFriction = 1e-12;

/// A cone's part of F and, once asked, its derivatives. Rows that it does not have stay 0.
class ConePart {
 public:
  ConePart(const Group& group, bool shifts, const Vector& x, const Vector& u, double mu)
      : d_(group.dimension), mu_(mu), root_(std::sqrt(group.mu)), shift_(shifts ? group.mu : 0.0) {
    for (int k = 0; k < d_; ++k) {
      x_[k] = x[group.first + k];
      u_[k] = u[group.first + k];
    }
    const double e = kSlipSmoothing * mu;
    slip_ = std::sqrt(u_[1] * u_[1] + u_[2] * u_[2] + e * e);
    Vector3 y;
    y[0] = root_ * x_[0] - (u_[0] + shift_ * (slip_ - e)) / root_;
    y.tail<2>() = x_.tail<2>() / root_ - root_ * u_.tail<2>();
    tangential_ = std::hypot(y[1], y[2]);
    axis_ = Vector3(0.0, 1.0, 0.0);
    if (tangential_ > 0.0) {
      axis_.tail<2>() = y.tail<2>() / tangential_;
    }
    low_ = y[0] - tangential_;
    high_ = y[0] + tangential_;
  }

  [[nodiscard]] Vector3 F() const {
    const double low = SmoothPlus(low_, mu_).value;
    const double high = SmoothPlus(high_, mu_).value;
    Vector3 F(root_ * x_[0], x_[1] / root_, x_[2] / root_);
    F[0] -= 0.5 * (low + high);
    F.tail<2>() -= 0.5 * (high - low) * axis_.tail<2>();
    return F;
  }

  void differentiate(Block& A, Block& B, Vector3& by_mu) const {
    const SmoothPlus low(low_, mu_);
    const SmoothPlus high(high_, mu_);
    const double mean = 0.5 * (high.by_t + low.by_t);
    const double half = 0.5 * (high.by_t - low.by_t);
    // Across the axis: (s(high) - s(low)) / (high - low), without the differences.
    const double roots = high.root + low.root;
    const double across = roots > 0.0 ? (high.value + low.value) / roots : mean;
    Block P = Block::Zero();  // dP / dy
    P(0, 0) = mean;
    P.block<1, 2>(0, 1) = half * axis_.tail<2>().transpose();
    P.block<2, 1>(1, 0) = half * axis_.tail<2>();
    P.block<2, 2>(1, 1) = (mean - across) * axis_.tail<2>() * axis_.tail<2>().transpose();
    P(1, 1) += across;
    P(2, 2) += across;
    Vector3 scale(root_, 1.0 / root_, 1.0 / root_);  // T
    // du~ / du = I + shift e_N (u_T / slip)^T, left of it T^-1.
    Block S = Block::Zero();
    S.diagonal() = scale.cwiseInverse();
    if (slip_ > 0.0) {
      S.block<1, 2>(0, 1) = shift_ / (slip_ * root_) * u_.tail<2>().transpose();
    }
    A = -P;
    A.diagonal().array() += 1.0;
    A = A * scale.asDiagonal();
    B = P * S;
    const double e = kSlipSmoothing * mu_;
    const double shift_by_mu =
        shift_ * kSlipSmoothing * ((slip_ > 0.0 ? e / slip_ : 1.0) - 1.0) / root_;
    by_mu = P.col(0) * shift_by_mu;
    by_mu[0] -= 0.5 * (high.by_mu + low.by_mu);
    by_mu.tail<2>() -= 0.5 * (high.by_mu - low.by_mu) * axis_.tail<2>();
    for (int k = d_; k < 3; ++k) {
      A.row(k).setZero();
      A.col(k).setZero();
      B.row(k).setZero();
      B.col(k).setZero();
    }
  }

 private:
  int d_;
  double mu_, root_, shift_;
  Vector3 x_ = Vector3::Zero();
  Vector3 u_ = Vector3::Zero();
  double slip_ = 0.0;  // |u_T|_e
  Vector3 axis_;       // of y_T
  double tangential_ = 0.0, low_ = 0.0, high_ = 0.0;
};

[[nodiscard]] bool is_cone(const Group& group) {
  return group.dimension > 1 && group.mu >= kLeastFriction;
}

/// p(x - u) of a group's first row: a row with bounds, or the normal row of a cone without
/// friction.
SmoothClamp clamp_of(const Group& group, const Vector& x, const Vector& u, double mu) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double y = x[group.first] - u[group.first];
  return group.dimension > 1 ? SmoothClamp(y, 0.0, kInfinity, mu)
                             : SmoothClamp(y, group.lower, group.upper, mu);
}

}  // namespace

void SmoothedCones::evaluate(const Vector& x, const Vector& u, double mu, Vector& F) const {
  F.resize(x.size());
  for (const Group& group : groups_) {
    if (is_cone(group)) {
      const Vector3 part = ConePart(group, law_ == FrictionLaw::kCoulomb, x, u, mu).F();
      F.segment(group.first, group.dimension) = part.head(group.dimension);
      continue;
    }
    F[group.first] = x[group.first] - clamp_of(group, x, u, mu).value;
    for (int k = 1; k < group.dimension; ++k) {
      F[group.first + k] = x[group.first + k];
    }
  }
}

void SmoothedCones::linearise(const Vector& x, const Vector& u, double mu, Vector& F,
                              std::vector<Block>& A, std::vector<Block>& B, Vector& by_mu) const {
  evaluate(x, u, mu, F);
  by_mu.setZero(x.size());
  A.resize(groups_.size());
  B.resize(groups_.size());
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    if (is_cone(group)) {
      Vector3 part;
      ConePart(group, law_ == FrictionLaw::kCoulomb, x, u, mu).differentiate(A[g], B[g], part);
      by_mu.segment(group.first, group.dimension) = part.head(group.dimension);
      continue;
    }
    const SmoothClamp p = clamp_of(group, x, u, mu);
    A[g].setZero();
    B[g].setZero();
    A[g](0, 0) = p.rest;
    B[g](0, 0) = p.by_y;
    by_mu[group.first] = -p.by_mu;
    for (int k = 1; k < group.dimension; ++k) {
      A[g](k, k) = 1.0;
    }
  }
}

}  // namespace signorini::lcp
