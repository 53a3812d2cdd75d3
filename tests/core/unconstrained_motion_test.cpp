#include <signorini/core/model/orientation_drift.h>
#include <signorini/core/model/unconstrained_motion.h>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>
#include <string>

namespace signorini {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Integrator kIntegrators[] = {Integrator::kSemiImplicit, Integrator::kRungeKutta4,
                                       Integrator::kEnergyMomentum};

// Principal moments 1 : 2 : 3 in axes that are not the body's.
Body asymmetric_top() {
  Body body;
  body.mass = 2.0;
  const Mat3 axes = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())).toRotationMatrix();
  const Mat3 inertia = axes * Vec3(1, 2, 3).asDiagonal() * axes.transpose();
  body.inertia = 0.5 * (inertia + inertia.transpose());
  return body;
}

BodyState spinning(const Body& body, const Vec3& w) {
  BodyState state;
  state.q = Quat(Eigen::AngleAxisd(0.4, Vec3(2, -1, 1).normalized()));
  set_velocity(body, {Vec3::Zero(), w}, state);
  return state;
}

BodyState run(const Body& body, BodyState state, double duration, int steps, Integrator integrator,
              const Vec3& force = Vec3::Zero(), const Vec3& torque = Vec3::Zero()) {
  for (int i = 0; i < steps; ++i) {
    integrate_free(body, force, torque, duration / steps, integrator, state);
  }
  return state;
}

MatrixState run(const Body& body, MatrixState state, double duration, int steps,
                Integrator integrator) {
  for (int i = 0; i < steps; ++i) {
    integrate_free(body, Vec3::Zero(), Vec3::Zero(), duration / steps, integrator, state);
  }
  return state;
}

// Slope of log(error) over log(h), for a halved step.
double order(double coarse_error, double fine_error) {
  return std::log2(coarse_error / fine_error);
}

TEST(UnconstrainedMotion, TheOrderOfConvergenceIsOneAndFour) {
  const Body body = asymmetric_top();
  const BodyState start = spinning(body, Vec3(1.0, 2.0, -0.5));
  // The reference's own error, some (h w)^4 = (5e-5)^4, is below rounding.
  const Quat truth = run(body, start, 1.0, 40000, Integrator::kRungeKutta4).q;
  const auto error = [&](Integrator integrator, int steps) {
    return run(body, start, 1.0, steps, integrator).q.angularDistance(truth);
  };
  const auto matrix_error = [&](Integrator integrator, int steps) {
    const Mat3 R = run(body, matrix_state(start), 1.0, steps, integrator).R;
    return (R - truth.toRotationMatrix()).norm();
  };
  // The next power of h changes the slope by O(h w): 0.1 is generous at these steps.
  EXPECT_NEAR(order(error(Integrator::kSemiImplicit, 1000), error(Integrator::kSemiImplicit, 2000)),
              1.0, 0.1);
  EXPECT_NEAR(order(error(Integrator::kRungeKutta4, 50), error(Integrator::kRungeKutta4, 100)), 4.0,
              0.1);
  EXPECT_NEAR(order(matrix_error(Integrator::kSemiImplicit, 1000),
                    matrix_error(Integrator::kSemiImplicit, 2000)),
              1.0, 0.1);
  EXPECT_NEAR(order(matrix_error(Integrator::kRungeKutta4, 50),
                    matrix_error(Integrator::kRungeKutta4, 100)),
              4.0, 0.1);
  EXPECT_NEAR(order(error(Integrator::kEnergyMomentum, 25), error(Integrator::kEnergyMomentum, 50)),
              4.0, 0.1);
  EXPECT_NEAR(order(matrix_error(Integrator::kEnergyMomentum, 25),
                    matrix_error(Integrator::kEnergyMomentum, 50)),
              4.0, 0.1);
  EXPECT_LT(error(Integrator::kRungeKutta4, 1000), 1e-11);
}

TEST(UnconstrainedMotion, TorqueConvergesToo) {
  const Body body = asymmetric_top();
  const BodyState start = spinning(body, Vec3(1.0, 2.0, -0.5));
  const Vec3 torque(3.0, -1.0, 2.0);
  const auto end = [&](Integrator integrator, int steps) {
    return run(body, start, 1.0, steps, integrator, Vec3::Zero(), torque);
  };
  const Quat truth = end(Integrator::kRungeKutta4, 40000).q;
  const auto error = [&](Integrator integrator, int steps) {
    return end(integrator, steps).q.angularDistance(truth);
  };
  EXPECT_NEAR(order(error(Integrator::kSemiImplicit, 1000), error(Integrator::kSemiImplicit, 2000)),
              1.0, 0.1);
  EXPECT_NEAR(order(error(Integrator::kRungeKutta4, 50), error(Integrator::kRungeKutta4, 100)), 4.0,
              0.1);
  EXPECT_NEAR(
      order(error(Integrator::kEnergyMomentum, 200), error(Integrator::kEnergyMomentum, 400)), 2.0,
      0.1);
  EXPECT_LT((end(Integrator::kSemiImplicit, 64).L - start.L - torque).norm(), 1e-13);
}

TEST(UnconstrainedMotion, WithoutTorqueAngularMomentumKeepsEveryBit) {
  const Body body = asymmetric_top();
  const BodyState start = spinning(body, Vec3(10.0, 2.0, -0.5));
  for (const Integrator integrator : kIntegrators) {
    const BodyState end = run(body, start, 10.0, 2400, integrator);
    EXPECT_EQ(end.L, start.L);
    EXPECT_NEAR(end.q.norm(), 1.0, 4e-16);
    EXPECT_EQ(run(body, matrix_state(start), 10.0, 2400, integrator).L, start.L);
  }
}

TEST(UnconstrainedMotion, EnergyMomentumKeepsTheEnergyOfATopAtAnyStep) {
  const Body body = asymmetric_top();
  const BodyState start = spinning(body, Vec3(1.0, 2.0, -0.5));
  const double energy = kinetic_energy(body, start);
  // 100 s at 1/240; steps of a radian; steps of some ten turns, which are divided.
  for (const auto& [duration, steps] : {std::pair{100.0, 24000}, {100.0, 200}, {1000.0, 30}}) {
    const BodyState end = run(body, start, duration, steps, Integrator::kEnergyMomentum);
    EXPECT_EQ(end.L, start.L);
    EXPECT_NEAR(kinetic_energy(body, end), energy, 1e-12 * energy) << duration / steps;
    EXPECT_NEAR(kinetic_energy(body, run(body, matrix_state(start), duration, steps,
                                         Integrator::kEnergyMomentum)),
                energy, 1e-10 * energy);
  }
}

TEST(UnconstrainedMotion, EnergyMomentumTurnsADrivenBodyExactly) {
  Body body = asymmetric_top();
  body.kind = BodyKind::kKinematic;
  BodyState state;
  state.L = Vec3(0.3, -2.0, 1.0);
  const BodyState end = run(body, state, 2.0, 3, Integrator::kEnergyMomentum);
  const Quat expected(Eigen::AngleAxisd(2.0 * state.L.norm(), state.L.normalized()));
  EXPECT_LE(end.q.angularDistance(expected), 1e-14);
  state.L.setZero();
  EXPECT_EQ(run(body, state, 2.0, 3, Integrator::kEnergyMomentum).q.coeffs(), state.q.coeffs());
}

TEST(UnconstrainedMotion, RungeKuttaKeepsTheEnergyOfATopToItsOrder) {
  const Body body = asymmetric_top();
  const BodyState start = spinning(body, Vec3(1.0, 2.0, -0.5));
  const double energy = kinetic_energy(body, start);
  const auto drift = [&](int steps) {
    return std::abs(kinetic_energy(body, run(body, start, 10.0, steps, Integrator::kRungeKutta4)) -
                    energy);
  };
  EXPECT_LT(drift(2400), 1e-9 * energy);
  EXPECT_GE(order(drift(400), drift(800)), 3.9);
}

TEST(UnconstrainedMotion, FreeFlightIsTheClosedForm) {
  Body body;
  body.mass = 2.0;
  BodyState start;
  start.x = Vec3(1, 2, 3);
  start.p = Vec3(4, -6, 20);
  const Vec3 acceleration(0.5, 0.0, -9.81);
  const int n = 100;
  const double h = 0.01;
  const double t = n * h;
  const Vec3 v0 = start.p / 2.0;
  for (const Integrator integrator : kIntegrators) {
    const BodyState end = run(body, start, t, n, integrator, 2.0 * acceleration);
    const double factor =
        integrator == Integrator::kRungeKutta4 ? 0.5 * t * t : 0.5 * h * h * n * (n + 1);
    EXPECT_LT((end.x - (start.x + t * v0 + factor * acceleration)).norm(), 1e-12);
    EXPECT_LT((end.p - (start.p + 2.0 * t * acceleration)).norm(), 1e-12);
  }
}

TEST(UnconstrainedMotion, DrivenBodiesKeepTheirVelocityAndFixedOnesStay) {
  Body belt;
  belt.kind = BodyKind::kKinematic;
  BodyState start;
  start.p = Vec3(1, 0, 0);
  start.L = Vec3(0, 0, 2);
  for (const Integrator integrator : kIntegrators) {
    const BodyState end = run(belt, start, 1.0, 1000, integrator, Vec3(5, 5, 5), Vec3(5, 5, 5));
    EXPECT_EQ(end.p, start.p);
    EXPECT_EQ(end.L, start.L);
    EXPECT_LT((end.x - Vec3(1, 0, 0)).norm(), 1e-13);
    // Euler turns by 2 atan(h w/2) a step: short by (h w)^2/12 of 2 rad.
    const Quat turned(Eigen::AngleAxisd(2.0, Vec3::UnitZ()));
    EXPECT_LT(end.q.angularDistance(turned), integrator == Integrator::kRungeKutta4 ? 1e-13 : 1e-6);
  }
  Body fixed;
  fixed.kind = BodyKind::kFixed;
  BodyState still;
  still.x = Vec3(1, 2, 3);
  const BodyState after =
      run(fixed, still, 1.0, 10, Integrator::kSemiImplicit, Vec3(5, 5, 5), Vec3(5, 5, 5));
  EXPECT_EQ(after.x, still.x);
  EXPECT_EQ(after.q.coeffs(), still.q.coeffs());
  EXPECT_EQ(after.p, Vec3::Zero());
}

TEST(UnconstrainedMotion, TheMatrixSchemeWithGramSchmidtGivesTheQuaternionsRotation) {
  const Body body = asymmetric_top();
  const BodyState start = spinning(body, Vec3(1.0, 2.0, -0.5));
  BodyState by_matrix = start;
  BodyState by_quaternion = start;
  for (int i = 0; i < 200; ++i) {
    const Vec3 none = Vec3::Zero();
    integrate_free(body, none, none, 0.005, Integrator::kRungeKutta4,
                   OrientationScheme::kRotationMatrix, by_matrix);
    integrate_free(body, none, none, 0.005, Integrator::kRungeKutta4,
                   OrientationScheme::kQuaternion, by_quaternion);
  }
  EXPECT_LT(by_matrix.q.angularDistance(by_quaternion.q), 1e-8);  // both (h w)^4 t
  EXPECT_NEAR(by_matrix.q.norm(), 1.0, 4e-16);
}

TEST(UnconstrainedMotion, RefusesBadStepsAndLoadsAndLeavesTheState) {
  const Body body;
  BodyState state;
  state.p = Vec3(1, 2, 3);
  const Vec3 none = Vec3::Zero();
  const auto step = [&](const Vec3& force, const Vec3& torque, double h) {
    integrate_free(body, force, torque, h, Integrator::kSemiImplicit, state);
  };
  EXPECT_THROW(step(none, none, -1.0), std::invalid_argument);
  EXPECT_THROW(step(none, none, kNaN), std::invalid_argument);
  EXPECT_THROW(step(none, none, std::numeric_limits<double>::infinity()), std::invalid_argument);
  EXPECT_THROW(step(Vec3(kNaN, 0, 0), none, 1.0), std::invalid_argument);
  EXPECT_THROW(step(none, Vec3(0, kNaN, 0), 1.0), std::invalid_argument);
  EXPECT_EQ(state.x, Vec3::Zero());
  EXPECT_EQ(state.p, Vec3(1, 2, 3));
  step(none, none, 0.0);
  EXPECT_EQ(state.x, Vec3::Zero());
}

TEST(GramSchmidt, MakesARotationAndKeepsTheFirstDirection) {
  Mat3 R = Quat(Eigen::AngleAxisd(0.4, Vec3(2, -1, 1).normalized())).toRotationMatrix();
  R += 0.05 * (Mat3() << 1, -2, 3, 0, 1, 1, -1, 2, 0).finished();
  const Vec3 first = R.col(0).normalized();
  gram_schmidt(R);
  EXPECT_LT(orthogonality_error(R), 4e-16);
  EXPECT_NEAR(R.determinant(), 1.0, 1e-15);
  EXPECT_LT((R.col(0) - first).norm(), 1e-16);
}

TEST(GramSchmidt, RefusesColumnsThatSpanNoPlane) {
  const auto refused = [](const Vec3& first, const Vec3& second) {
    Mat3 R = Mat3::Identity();
    R.col(0) = first;
    R.col(1) = second;
    const Mat3 before = R;
    EXPECT_THROW(gram_schmidt(R), std::invalid_argument);
    EXPECT_TRUE(((R.array() == before.array()) || before.array().isNaN()).all());
  };
  refused(Vec3::Zero(), Vec3::UnitY());
  refused(Vec3::UnitX(), Vec3::Zero());
  refused(Vec3(1, 2, 3), Vec3(-2, -4, -6));
  refused(Vec3(kNaN, 0, 0), Vec3::UnitY());
}

TEST(OrientationDrift, ComparesTheSchemes) {
  const Body body = asymmetric_top();
  const BodyState start = spinning(body, Vec3(3.0, 6.0, -1.0));
  const auto last = [&](const DriftSettings& settings) {
    const std::vector<DriftSample> samples = orientation_drift(body, start, settings);
    EXPECT_EQ(samples.size(), static_cast<std::size_t>(settings.steps) + 1);
    EXPECT_EQ(samples.front().energy_error, 0.0);
    EXPECT_EQ(samples.back().momentum_error, 0.0);
    EXPECT_NEAR(samples.back().time, settings.steps * settings.step, 1e-12);
    return samples.back();
  };
  for (const Integrator integrator : kIntegrators) {
    const DriftSample quaternion =
        last({.scheme = OrientationScheme::kQuaternion, .integrator = integrator});
    const DriftSample matrix =
        last({.scheme = OrientationScheme::kRotationMatrix, .integrator = integrator});
    const DriftSample mended = last({.scheme = OrientationScheme::kRotationMatrix,
                                     .integrator = integrator,
                                     .gram_schmidt_period = 1});
    EXPECT_LT(quaternion.orthogonality_error, 1e-15);
    EXPECT_LT(mended.orthogonality_error, 1e-15);
    // A product of rotations loses orthogonality by rounding alone.
    const bool product = integrator == Integrator::kEnergyMomentum;
    EXPECT_EQ(product, matrix.orthogonality_error < 1e4 * quaternion.orthogonality_error);
  }
  // Euler stretches R by 1 + (h w)^2/2 a step across w: |w| = 6.8 rad/s, h = 1/240 s, 240 steps.
  const DriftSample euler = last({.scheme = OrientationScheme::kRotationMatrix});
  EXPECT_NEAR(euler.orthogonality_error, 240 * std::pow(6.8 / 240, 2), 0.1);
}

TEST(OrientationDrift, RefusesBadSettings) {
  const Body body = asymmetric_top();
  const BodyState start;
  EXPECT_THROW((void)orientation_drift(body, start, {.step = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)orientation_drift(body, start, {.step = kNaN}), std::invalid_argument);
  EXPECT_THROW((void)orientation_drift(body, start, {.steps = -1}), std::invalid_argument);
  EXPECT_THROW((void)orientation_drift(body, start, {.gram_schmidt_period = -1}),
               std::invalid_argument);
  Body massless = body;
  massless.mass = 0.0;
  EXPECT_THROW((void)orientation_drift(massless, start, {}), std::invalid_argument);
  EXPECT_EQ(orientation_drift(body, start, {.steps = 0}).size(), 1u);
}

}  // namespace
}  // namespace signorini
