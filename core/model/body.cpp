#include <signorini/core/model/body.h>
#include <signorini/core/model/number_text.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>
#include <string>

namespace signorini {
namespace {

constexpr double kSymmetry = 1e-9;
constexpr double kTriangle = 1e-9;
constexpr double kUnitQuaternion = 1e-6;

[[noreturn]] void refuse(const std::string& body, const std::string& what) {
  throw std::invalid_argument(body + ": " + what);
}

std::string label(const Body& body) {
  return body.name.empty() ? "body" : "body '" + body.name + "'";
}

std::string label(const Bodies& bodies, std::size_t i) {
  return "body " + std::to_string(i) +
         (bodies[i].name.empty() ? "" : " ('" + bodies[i].name + "')");
}

void validate_inertia(const Body& body) {
  const Mat3& J = body.inertia;
  if (!J.allFinite()) {
    for (int i = 0; i < 9; ++i) {
      if (!std::isfinite(J(i / 3, i % 3))) {
        refuse(label(body), "inertia(" + std::to_string(i / 3) + ", " + std::to_string(i % 3) +
                                "): must be finite, got " + number_text(J(i / 3, i % 3)));
      }
    }
  }
  const double asymmetry = (J - J.transpose()).cwiseAbs().maxCoeff();
  if (asymmetry > kSymmetry * J.cwiseAbs().maxCoeff()) {
    refuse(label(body), "inertia: must be symmetric to 1e-9 of its largest entry, differs by " +
                            number_text(asymmetry) + " kg m^2");
  }
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(J, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(moments[0] > 0.0)) {
    refuse(label(body), "inertia: must be positive definite, its principal moments are " +
                            number_text(moments) + " kg m^2");
  }
  if (moments[2] > (moments[0] + moments[1]) * (1.0 + kTriangle)) {
    refuse(label(body),
           "inertia: violates the triangle inequality (each principal moment at most the sum of "
           "the other two), its principal moments are " +
               number_text(moments) + " kg m^2");
  }
}

void validate_finite(const std::string& body, const char* field, const Vec3& value,
                     const char* unit) {
  if (!value.allFinite()) {
    refuse(body, std::string(field) + ": must be finite, got " + number_text(value) + " " + unit);
  }
}

}  // namespace

void validate(const Body& body) {
  if (!std::isfinite(body.gravity_scale)) {
    refuse(label(body), "gravity_scale: must be finite, got " + number_text(body.gravity_scale));
  }
  if (!body.is_dynamic()) {
    return;
  }
  if (!(body.mass > 0.0) || !std::isfinite(body.mass)) {
    refuse(label(body), "mass: must be finite and > 0, got " + number_text(body.mass) + " kg");
  }
  validate_inertia(body);
}

void validate(const Bodies& bodies, const State& state) {
  if (bodies.size() != state.size()) {
    throw std::invalid_argument("state: must have one entry a body (" +
                                std::to_string(bodies.size()) + "), got " +
                                std::to_string(state.size()));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string body = label(bodies, i);
    validate_finite(body, "x", state[i].x, "m");
    validate_finite(body, "p", state[i].p, "kg m/s");
    validate_finite(body, "L", state[i].L, "kg m^2/s");
    const double norm = state[i].q.norm();
    if (!(std::abs(norm - 1.0) <= kUnitQuaternion)) {
      refuse(body, "q: must be a unit quaternion to 1e-6, its norm is " + number_text(norm));
    }
    const bool moves = !state[i].p.isZero(0.0) || !state[i].L.isZero(0.0);
    if (bodies[i].kind == BodyKind::kFixed && moves) {
      refuse(body, "p, L: must be zero for a fixed body, got p = " + number_text(state[i].p) +
                       ", L = " + number_text(state[i].L));
    }
  }
}

Mat3 inverse_inertia_world(const Body& body, const BodyState& state) {
  if (!body.is_dynamic()) {
    return Mat3::Zero();
  }
  const Mat3 R = state.q.toRotationMatrix();
  const Mat3 inverse = R * body.inertia.inverse() * R.transpose();
  return 0.5 * (inverse + inverse.transpose());  // symmetric to the last bit
}

double inverse_mass(const Body& body) {
  return body.is_dynamic() ? 1.0 / body.mass : 0.0;
}

Velocity velocity(const Body& body, const BodyState& state) {
  switch (body.kind) {
    case BodyKind::kDynamic:
      return {state.p / body.mass, inverse_inertia_world(body, state) * state.L};
    case BodyKind::kKinematic: return {state.p, state.L};
    case BodyKind::kFixed: return {};
  }
  throw std::invalid_argument(label(body) + ": kind: not one of dynamic, kinematic, fixed");
}

void set_velocity(const Body& body, const Velocity& velocity, BodyState& state) {
  if (body.kind == BodyKind::kKinematic) {
    state.p = velocity.linear;
    state.L = velocity.angular;
  } else if (body.is_dynamic()) {
    const Mat3 R = state.q.toRotationMatrix();
    state.p = body.mass * velocity.linear;
    state.L = R * (body.inertia * (R.transpose() * velocity.angular));
  }
}

double kinetic_energy(const Body& body, const BodyState& state) {
  if (!body.is_dynamic()) {
    return 0.0;
  }
  const Velocity u = velocity(body, state);
  return 0.5 * (state.p.dot(u.linear) + state.L.dot(u.angular));
}

double kinetic_energy(const Bodies& bodies, const State& state) {
  double sum = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    sum += kinetic_energy(bodies[i], state[i]);
  }
  return sum;
}

double potential_energy(const Bodies& bodies, const State& state, const Vec3& gravity) {
  double sum = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].is_dynamic()) {
      sum -= bodies[i].mass * bodies[i].gravity_scale * gravity.dot(state[i].x);
    }
  }
  return sum;
}

}  // namespace signorini
