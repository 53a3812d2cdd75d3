#include <signorini/lcp/cone_barrier.h>
#include <signorini/lcp/friction_cone.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double slip(const Eigen::Vector3d& v) {
  return std::hypot(v[1], v[2]);
}

}  // namespace

ConeBarrier::Vector3 ConeBarrier::from(const double* values) const {
  Vector3 all = Vector3::Zero();
  std::copy_n(values, group_.dimension, all.data());
  return all;
}

void ConeBarrier::start(const Group& group, const double* b, double margin, bool shift) {
  *this = {};
  group_ = group;
  shift_ = shift;
  if (group.dimension == 1 || group.mu == 0.0) {
    start_row(b[0], margin);
    return;
  }
  kind_ = Kind::kCone;
  Vector3 out = from(b);
  out[0] /= group.mu;
  const Vector3 in = -out;
  project_on_cone(1.0, 3, out.data(), v_.data());
  project_on_cone(1.0, 3, in.data(), x_.data());
  // Where mu > 1 these coordinates are not the caller's: the margin is that of x_N and u_N.
  const double stretch = std::max(group.mu, 1.0);
  v_[0] += margin / stretch;
  x_[0] += margin * stretch;
}

void ConeBarrier::start_row(double b, double margin) {
  const double l = group_.lower;
  const double h = group_.upper;
  if (l == h) {
    x_[0] = l;
    return;
  }
  kind_ = Kind::kRow;
  lower_.exists = l > -kInfinity;
  upper_.exists = h < kInfinity;
  if (lower_.exists && upper_.exists) {
    const double inside = std::min(margin, 0.25 * (h - l));
    x_[0] = std::clamp(-b, l + inside, h - inside);
  } else if (lower_.exists) {
    x_[0] = l + std::max(-b, 0.0) + margin;
  } else if (upper_.exists) {
    x_[0] = h - std::max(b, 0.0) - margin;
  }
  if (lower_.exists) {
    lower_.s = x_[0] - l;
    lower_.y = std::max(b, margin);
  }
  if (upper_.exists) {
    upper_.s = h - x_[0];
    upper_.y = std::max(-b, margin);
  }
}

int ConeBarrier::count() const {
  return kind_ == Kind::kCone ? 1 : (lower_.exists ? 1 : 0) + (upper_.exists ? 1 : 0);
}

void ConeBarrier::get(double* x) const {
  std::copy_n(x_.data(), group_.dimension, x);  // tangents of mu = 0 stay 0
  if (kind_ == Kind::kCone) {
    x[0] /= group_.mu;
  }
}

void ConeBarrier::set_residual(const double* u) {
  residual_.setZero();
  if (kind_ == Kind::kCone) {
    residual_ = from(u) - v_;
    residual_[0] = u[0] - group_.mu * (v_[0] - (shift_ ? slip(v_) : 0.0));
  } else if (kind_ == Kind::kRow) {
    residual_[0] = u[0] - lower_.y + upper_.y;
  }
}

void ConeBarrier::derive(Block& A, Block& B) {
  A.setIdentity();
  B.setZero();
  if (kind_ == Kind::kCone) {
    scaling_.set(x_, v_);
    lambda_ = scaling_.times(v_);
    B = scaling_.square();
    B.row(0) /= group_.mu;
    B.col(0) /= group_.mu;
    const double length = slip(v_);
    if (shift_ && length > 0.0) {
      B.col(1) += group_.mu * (v_[1] / length) * B.col(0);
      B.col(2) += group_.mu * (v_[2] / length) * B.col(0);
    }
  } else if (kind_ == Kind::kRow) {
    const double e = lower_.y / lower_.s + upper_.y / upper_.s;
    A(0, 0) = e / (1.0 + e);
    B(0, 0) = 1.0 / (1.0 + e);
  }
}

void ConeBarrier::predict() {
  c_ = -x_;
  lower_.c = -lower_.s * lower_.y;
  upper_.c = -upper_.s * upper_.y;
}

void ConeBarrier::correct(double target) {
  if (kind_ == Kind::kCone) {
    Vector3 products = -second_order_cone::product(lambda_, lambda_) -
                       second_order_cone::product(scaling_.inverse_times(dx_), scaling_.times(dv_));
    products[0] += target;
    c_ = scaling_.times(second_order_cone::quotient(lambda_, products));
  } else {
    for (Bound* bound : {&lower_, &upper_}) {
      bound->c = target - bound->s * bound->y - bound->ds * bound->dy;
    }
  }
}

void ConeBarrier::right_side(const Block& B, double* F) const {
  Vector3 all = Vector3::Zero();
  if (kind_ == Kind::kCone) {
    all = B * residual_ - c_;
    all[0] += c_[0] - c_[0] / group_.mu;
  } else if (kind_ == Kind::kRow) {
    const double low = lower_.exists ? lower_.c / lower_.s : 0.0;
    const double high = upper_.exists ? upper_.c / upper_.s : 0.0;
    all[0] = B(0, 0) * (residual_[0] - low + high);
  }
  std::copy_n(all.data(), group_.dimension, F);
}

void ConeBarrier::follow(const double* dx, const double* du) {
  if (kind_ == Kind::kCone) {
    dx_ = from(dx);
    dx_[0] *= group_.mu;
    dv_ = from(du) + residual_;
    const double length = slip(v_);
    dv_[0] /= group_.mu;
    if (shift_ && length > 0.0) {
      dv_[0] += (v_[1] * dv_[1] + v_[2] * dv_[2]) / length;
    }
  } else if (kind_ == Kind::kRow) {
    dx_[0] = dx[0];
    lower_.ds = dx[0];
    upper_.ds = -dx[0];
    for (Bound* bound : {&lower_, &upper_}) {
      bound->ds = bound->exists ? bound->ds : 0.0;
      bound->dy = bound->exists ? (bound->c - bound->y * bound->ds) / bound->s : 0.0;
    }
  }
}

double ConeBarrier::gap_after(double step) const {
  if (kind_ == Kind::kCone) {
    return (x_ + step * dx_).dot(v_ + step * dv_);
  }
  double sum = 0.0;
  for (const Bound* bound : {&lower_, &upper_}) {
    sum += bound->exists ? (bound->s + step * bound->ds) * (bound->y + step * bound->dy) : 0.0;
  }
  return sum;
}

double ConeBarrier::longest_step() const {
  if (kind_ == Kind::kCone) {
    return std::min(second_order_cone::longest_step(x_, dx_),
                    second_order_cone::longest_step(v_, dv_));
  }
  double step = kInfinity;
  for (const Bound* bound : {&lower_, &upper_}) {
    step = bound->ds < 0.0 ? std::min(step, -bound->s / bound->ds) : step;
    step = bound->dy < 0.0 ? std::min(step, -bound->y / bound->dy) : step;
  }
  return step;
}

void ConeBarrier::move(double step) {
  x_ += step * dx_;
  v_ += step * dv_;
  for (Bound* bound : {&lower_, &upper_}) {
    bound->s += step * bound->ds;
    bound->y += step * bound->dy;
  }
}

}  // namespace signorini::lcp
