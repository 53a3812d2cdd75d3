#include <signorini/core/model/free_rotation.h>
#include <signorini/core/model/number_text.h>
#include <signorini/core/model/unconstrained_motion.h>

#include <cmath>
#include <stdexcept>

namespace signorini {
namespace {

constexpr double kIndependent = 1e-12;  // sine of the angle between U0 and U1

// The two ways to hold an orientation, as an Eigen value that can be added and scaled.
struct QuaternionForm {
  using Value = Eigen::Vector4d;  // x, y, z, w: the coefficients of Eigen's quaternion
  static Mat3 rotation(const Value& q) { return Quat(q).normalized().toRotationMatrix(); }
  static Value rate(const Vec3& w, const Value& q) {
    return 0.5 * (Quat(0.0, w.x(), w.y(), w.z()) * Quat(q)).coeffs();
  }
};

struct MatrixForm {
  using Value = Mat3;
  static const Mat3& rotation(const Value& R) { return R; }
  static Value rate(const Vec3& w, const Value& R) { return skew(w) * R; }
};

Vec3 angular_velocity(const Body& body, const Mat3& R, const Vec3& L) {
  switch (body.kind) {
    case BodyKind::kDynamic: return R * (body.inertia.inverse() * (R.transpose() * L));
    case BodyKind::kKinematic: return L;
    case BodyKind::kFixed: return Vec3::Zero();
  }
  throw std::invalid_argument("body: kind: not one of dynamic, kinematic, fixed");
}

template <typename Form>
typename Form::Value advance_orientation(const Body& body, const Vec3& L, const Vec3& torque,
                                         double h, Integrator integrator,
                                         const typename Form::Value& start) {
  using Value = typename Form::Value;
  const auto rate = [&](double t, const Value& value) -> Value {
    return Form::rate(angular_velocity(body, Form::rotation(value), L + t * torque), value);
  };
  if (integrator == Integrator::kSemiImplicit) {
    return start + h * rate(h, start);
  }
  const Value k1 = rate(0.0, start);
  const Value k2 = rate(0.5 * h, start + 0.5 * h * k1);
  const Value k3 = rate(0.5 * h, start + 0.5 * h * k2);
  const Value k4 = rate(h, start + h * k3);
  return start + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

// The turn of the body's axes over a step of kEnergyMomentum, R its orientation at the start.
Quat energy_momentum_turn(const Body& body, const Mat3& R, const Vec3& L, const Vec3& torque,
                          double h) {
  const Vec3 in_body = R.transpose() * (L + 0.5 * h * torque);
  if (body.is_dynamic()) {
    return free_rotation(body.inertia, in_body, h);
  }
  const double angle = h * in_body.norm();
  return angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, in_body.normalized())) : Quat::Identity();
}

// x and p; RK4 is exact for a constant force, so its four stages collapse.
template <typename AnyState>
void advance_position(const Body& body, const Vec3& force, double h, Integrator integrator,
                      AnyState& state) {
  if (body.kind == BodyKind::kKinematic) {
    state.x += h * state.p;
  } else if (body.is_dynamic()) {
    const Vec3 momentum_midway = state.p + 0.5 * h * force;
    state.p += h * force;
    const bool midway = integrator == Integrator::kRungeKutta4;
    state.x += h / body.mass * (midway ? momentum_midway : state.p);
  }
}

void validate_step(const Vec3& force, const Vec3& torque, double step) {
  if (!(step >= 0.0) || !std::isfinite(step)) {
    throw std::invalid_argument("integrate_free: step: must be finite and >= 0, got " +
                                number_text(step) + " s");
  }
  if (!force.allFinite()) {
    throw std::invalid_argument("integrate_free: force: must be finite, got " + number_text(force) +
                                " N");
  }
  if (!torque.allFinite()) {
    throw std::invalid_argument("integrate_free: torque: must be finite, got " +
                                number_text(torque) + " N m");
  }
}

}  // namespace

MatrixState matrix_state(const BodyState& state) {
  return {state.x, state.q.toRotationMatrix(), state.p, state.L};
}

void integrate_free(const Body& body, const Vec3& force, const Vec3& torque, double step,
                    Integrator integrator, BodyState& state) {
  validate_step(force, torque, step);
  if (body.kind == BodyKind::kFixed) {
    return;
  }
  const Vec3 load = body.is_dynamic() ? torque : Vec3::Zero();
  if (integrator == Integrator::kEnergyMomentum) {
    const Mat3 R = state.q.toRotationMatrix();
    state.q = (state.q * energy_momentum_turn(body, R, state.L, load, step)).normalized();
  } else {
    state.q = Quat(advance_orientation<QuaternionForm>(body, state.L, load, step, integrator,
                                                       state.q.coeffs()))
                  .normalized();
  }
  state.L += step * load;
  advance_position(body, force, step, integrator, state);
}

void integrate_free(const Body& body, const Vec3& force, const Vec3& torque, double step,
                    Integrator integrator, MatrixState& state) {
  validate_step(force, torque, step);
  if (body.kind == BodyKind::kFixed) {
    return;
  }
  const Vec3 load = body.is_dynamic() ? torque : Vec3::Zero();
  state.R = integrator == Integrator::kEnergyMomentum
                ? Mat3(state.R * energy_momentum_turn(body, state.R, state.L, load, step))
                : advance_orientation<MatrixForm>(body, state.L, load, step, integrator, state.R);
  state.L += step * load;
  advance_position(body, force, step, integrator, state);
}

void integrate_free(const Body& body, const Vec3& force, const Vec3& torque, double step,
                    Integrator integrator, OrientationScheme scheme, BodyState& state) {
  if (scheme == OrientationScheme::kQuaternion) {
    integrate_free(body, force, torque, step, integrator, state);
    return;
  }
  MatrixState matrix = matrix_state(state);
  integrate_free(body, force, torque, step, integrator, matrix);
  gram_schmidt(matrix.R);
  state = {matrix.x, Quat(matrix.R).normalized(), matrix.p, matrix.L};
}

void gram_schmidt(Mat3& R) {
  const double length0 = R.col(0).norm();
  const Vec3 u0 = R.col(0) / length0;
  const Vec3 across = R.col(1) - R.col(1).dot(u0) * u0;
  const double length1 = across.norm();
  const double least = kIndependent * R.col(1).norm();
  if (!(length0 > 0.0 && length1 > least) || !std::isfinite(length0 + length1)) {
    throw std::invalid_argument(
        "gram_schmidt: R: its first two columns must be finite and independent, got " +
        number_text(R.col(0)) + " and " + number_text(R.col(1)));
  }
  const Vec3 u1 = across / length1;
  R << u0, u1, u0.cross(u1);
}

double orthogonality_error(const Mat3& R) {
  return (R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff();
}

double kinetic_energy(const Body& body, const MatrixState& state) {
  if (!body.is_dynamic()) {
    return 0.0;
  }
  return 0.5 * (state.p.squaredNorm() / body.mass +
                state.L.dot(angular_velocity(body, state.R, state.L)));
}

}  // namespace signorini
