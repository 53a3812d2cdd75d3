#include <signorini/core/model/body.h>

#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The message of the error, or "accepted".
std::string message(const std::function<void()>& check) {
  try {
    check();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

void expect_names(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' in: " << text;
  }
}

Body crate() {
  Body body;
  body.mass = 2.0;
  body.inertia = Vec3(1, 2, 2.5).asDiagonal();
  body.name = "crate";
  return body;
}

BodyState turned() {
  BodyState state;
  state.x = Vec3(1, 2, 3);
  state.q = Quat(Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()));
  return state;
}

TEST(Body, AcceptsWhatIsPossible) {
  EXPECT_EQ(message([] { validate(crate()); }), "accepted");
  Body rod = crate();  // the limit of the triangle inequality: 0 + 1 >= 1
  rod.inertia = Vec3(1e-9, 1, 1).asDiagonal();
  EXPECT_EQ(message([&] { validate(rod); }), "accepted");
  Body plate = crate();  // 1 + 1 >= 2
  plate.inertia = Vec3(1, 1, 2).asDiagonal();
  EXPECT_EQ(message([&] { validate(plate); }), "accepted");
}

TEST(Body, RefusesWrongMassesByName) {
  for (const double mass : {0.0, -1.0, kNaN, kInfinity}) {
    Body body = crate();
    body.mass = mass;
    expect_names(message([&] { validate(body); }), {"crate", "mass", "> 0"});
  }
  Body body = crate();
  body.mass = -3.5;
  expect_names(message([&] { validate(body); }), {"-3.5"});
}

TEST(Body, RefusesWrongInertiasByName) {
  const auto with = [](const Mat3& inertia) {
    Body body = crate();
    body.inertia = inertia;
    return message([&] { validate(body); });
  };
  Mat3 J = Vec3(1, 1, 3).asDiagonal();
  expect_names(with(J), {"crate", "inertia", "triangle inequality", "(1, 1, 3)"});
  J = Vec3(1, 1, -1).asDiagonal();
  expect_names(with(J), {"crate", "inertia", "positive definite"});
  expect_names(with(Mat3::Zero()), {"crate", "inertia", "positive definite"});
  J = Mat3::Identity();
  J(0, 1) = 1e-6;
  expect_names(with(J), {"crate", "inertia", "symmetric", "1e-06"});
  J = Mat3::Identity();
  J(1, 2) = kNaN;
  expect_names(with(J), {"crate", "inertia(1, 2)", "finite", "nan"});
  J(1, 2) = kInfinity;
  expect_names(with(J), {"crate", "inertia(1, 2)", "finite", "inf"});
}

TEST(Body, TheTriangleInequalityDoesNotDependOnTheAxes) {
  const Mat3 R = turned().q.toRotationMatrix();
  Body body = crate();
  body.inertia = R * Vec3(1, 1, 2.0001).asDiagonal() * R.transpose();
  expect_names(message([&] { validate(body); }), {"triangle inequality"});
}

TEST(Body, RefusesAGravityScaleThatIsNotFinite) {
  Body body = crate();
  body.gravity_scale = kNaN;
  expect_names(message([&] { validate(body); }), {"crate", "gravity_scale"});
}

TEST(Body, MassAndInertiaOfImmovableBodiesAreNotLookedAt) {
  for (const BodyKind kind : {BodyKind::kFixed, BodyKind::kKinematic}) {
    Body body = crate();
    body.kind = kind;
    body.mass = 0.0;
    body.inertia.setZero();
    EXPECT_EQ(message([&] { validate(body); }), "accepted");
  }
}

TEST(Body, RefusesBadStatesByBodyAndField) {
  const Bodies bodies{Body{}, crate()};
  const auto with = [&](const std::function<void(BodyState&)>& spoil) {
    State state(2);
    spoil(state[1]);
    return message([&] { validate(bodies, state); });
  };
  EXPECT_EQ(with([](BodyState&) {}), "accepted");
  expect_names(with([](BodyState& s) { s.x.y() = kNaN; }), {"body 1", "crate", "x:", "nan"});
  expect_names(with([](BodyState& s) { s.p.z() = kInfinity; }), {"body 1", "p:", "inf"});
  expect_names(with([](BodyState& s) { s.L.x() = kNaN; }), {"body 1", "L:", "nan"});
  expect_names(with([](BodyState& s) { s.q.coeffs() *= 1.1; }), {"body 1", "q:", "unit", "1.1"});
  expect_names(with([](BodyState& s) { s.q.coeffs().setZero(); }), {"body 1", "q:", "unit"});
  expect_names(with([](BodyState& s) { s.q.w() = kNaN; }), {"body 1", "q:", "unit", "nan"});
  EXPECT_EQ(with([](BodyState& s) { s.q.coeffs() *= 1.0 + 9e-7; }), "accepted");
  expect_names(message([&] { validate(bodies, State(3)); }), {"state", "2", "3"});
}

TEST(Body, AFixedBodyMustBeAtRest) {
  Body floor;
  floor.kind = BodyKind::kFixed;
  floor.name = "floor";
  State state(1);
  state[0].L = Vec3(0, 0, 1);
  expect_names(message([&] { validate({floor}, state); }), {"floor", "fixed"});
}

TEST(Body, VelocityAndMomentumAreInverse) {
  const Body body = crate();
  BodyState state = turned();
  const Velocity given{Vec3(1, -2, 3), Vec3(0.5, 4, -1)};
  set_velocity(body, given, state);
  EXPECT_EQ(state.p, 2.0 * given.linear);
  const Velocity back = velocity(body, state);
  EXPECT_LT((back.linear - given.linear).norm(), 1e-15);
  EXPECT_LT((back.angular - given.angular).norm(), 1e-14);
  const Mat3 R = state.q.toRotationMatrix();
  const Vec3 w_body = R.transpose() * given.angular;
  EXPECT_NEAR(kinetic_energy(body, state),
              0.5 * 2.0 * given.linear.squaredNorm() + 0.5 * w_body.dot(body.inertia * w_body),
              1e-13);
}

TEST(Body, TheInverseInertiaIsSymmetricToTheLastBit) {
  Body body = crate();
  body.inertia << 2, 0.3, -0.1, 0.3, 2.5, 0.2, -0.1, 0.2, 1.7;
  const BodyState state = turned();
  const Mat3 inverse = inverse_inertia_world(body, state);
  EXPECT_EQ(inverse, Mat3(inverse.transpose()));
  const Mat3 R = state.q.toRotationMatrix();
  EXPECT_LT((inverse * R * body.inertia * R.transpose() - Mat3::Identity()).norm(), 1e-14);
}

TEST(Body, OnlyDynamicBodiesHaveMassAndEnergy) {
  for (const BodyKind kind : {BodyKind::kFixed, BodyKind::kKinematic}) {
    Body body = crate();
    body.kind = kind;
    BodyState state = turned();
    set_velocity(body, {Vec3(1, 0, 0), Vec3(0, 2, 0)}, state);
    EXPECT_EQ(inverse_mass(body), 0.0);
    EXPECT_EQ(inverse_inertia_world(body, state), Mat3(Mat3::Zero()));
    EXPECT_EQ(kinetic_energy(body, state), 0.0);
    const bool driven = kind == BodyKind::kKinematic;
    EXPECT_EQ(velocity(body, state).linear, driven ? Vec3(1, 0, 0) : Vec3(0, 0, 0));
    EXPECT_EQ(velocity(body, state).angular, driven ? Vec3(0, 2, 0) : Vec3(0, 0, 0));
    EXPECT_EQ(potential_energy({body}, {state}, Vec3(0, 0, -9.81)), 0.0);
  }
}

TEST(Body, EnergiesAreSumsOverTheDynamicBodies) {
  Body light = crate();
  light.gravity_scale = 0.5;
  Body floor;
  floor.kind = BodyKind::kFixed;
  const Bodies bodies{crate(), floor, light};
  State state{turned(), turned(), turned()};
  set_velocity(bodies[0], {Vec3(1, 0, 0), Vec3::Zero()}, state[0]);
  set_velocity(bodies[2], {Vec3(0, 3, 0), Vec3::Zero()}, state[2]);
  EXPECT_NEAR(kinetic_energy(bodies, state), 0.5 * 2.0 * (1 + 9), 1e-14);
  EXPECT_NEAR(potential_energy(bodies, state, Vec3(0, 0, -10)), 2.0 * 10 * 3 * 1.5, 1e-13);
}

TEST(Velocity, OfAPoint) {
  const Velocity velocity{Vec3(1, 0, 0), Vec3(0, 0, 2)};
  EXPECT_EQ(velocity.at(Vec3(0, 1, 0)), Vec3(-1, 0, 0));
}

}  // namespace
}  // namespace signorini
