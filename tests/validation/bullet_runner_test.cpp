#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/bullet_runner.h>
#include <signorini/validation/input_error.h>
#include <signorini/validation/sdf_reader.h>

#include <cmath>
#include <gtest/gtest.h>

namespace signorini::validation {
namespace {

Scene builtin(const std::string& name) {
  return load_builtin_scene(*find_builtin_scene(name));
}

/// Speed after and before the first bounce of body 0.
std::pair<double, double> first_bounce(const Track& track) {
  for (std::size_t k = 1; k < track.size(); ++k) {
    const double before = track.bodies[k - 1][0].velocity.linear.z();
    const double after = track.bodies[k][0].velocity.linear.z();
    if (before < 0.0 && after > 0.0) return {after, -before};
  }
  return {0.0, 0.0};
}

class NeutralBounce : public testing::TestWithParam<const char*> {};

TEST_P(NeutralBounce, RestitutionIsExact) {
  const Scene scene = builtin(GetParam());
  const double e = scene.colliders[0].material.restitution;
  const auto [after, before] = first_bounce(run_bullet(scene, BulletProfile::neutral()));
  ASSERT_GT(before, 1.0);
  // v+ = -e v- of the step's start: a few roundings.
  EXPECT_NEAR(after / before, e, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Balls, NeutralBounce,
                         testing::Values("ball-drop-e0.5", "ball-drop-e0.9", "ball-drop-e1"),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           for (char& c : name) c = std::isalnum(c) ? c : '_';
                           return name;
                         });

TEST(BulletRunner, DefaultProfileDoesNotKeepRestitution) {
  // Shallow overlap is pushed out through the velocity, and contacts that are still apart take
  // gap/step from it: which of the two acts depends on where the last step ends.
  const Scene scene = builtin("ball-drop-e0.9");
  const auto [after, before] = first_bounce(run_bullet(scene, BulletProfile::bullet_default()));
  EXPECT_GT(std::abs(after / before - 0.9), 0.01);
}

TEST(BulletRunner, PairMaterialFollowsTheScenesRuleNotBulletsProduct) {
  Scene scene = builtin("ball-drop-e0.5");
  scene.colliders[1].material.restitution = 1.0;  // minimum: 0.5; product: 0.5
  scene.colliders[0].material.restitution = 0.8;
  scene.rule = PairingRule::kMinimum;
  auto [after, before] = first_bounce(run_bullet(scene, BulletProfile::neutral()));
  EXPECT_NEAR(after / before, 0.8, 1e-14);
  scene.colliders[1].material.restitution = 0.6;
  scene.rule = PairingRule::kMaximum;
  std::tie(after, before) = first_bounce(run_bullet(scene, BulletProfile::neutral()));
  EXPECT_NEAR(after / before, 0.8, 1e-14);
  scene.rule = PairingRule::kMean;
  std::tie(after, before) = first_bounce(run_bullet(scene, BulletProfile::neutral()));
  EXPECT_NEAR(after / before, 0.7, 1e-14);
}

TEST(BulletRunner, OffDiagonalInertiaMovesLikeTheSameBodyInOtherAxes) {
  // One body twice: axes along the principal axes, and turned by 0.7 rad against them.
  Scene plain = builtin("torque-free-spin");
  plain.duration = 1.0;
  Scene turned = plain;
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, 3.0).normalized()));
  const Mat3 R = turn.toRotationMatrix();
  turned.bodies[0].inertia = R * plain.bodies[0].inertia * R.transpose();
  turned.state[0].q = plain.state[0].q * turn.conjugate();
  const Track a = run_bullet(plain, BulletProfile::neutral());
  const Track b = run_bullet(turned, BulletProfile::neutral());
  // Bullet's implicit gyroscopic step is one Newton step in body axes: it does not depend on the
  // choice of axes beyond rounding, over 240 steps of a motion that amplifies it little.
  const Vec3 wa = a.last(0).velocity.angular;
  const Vec3 wb = b.last(0).velocity.angular;
  EXPECT_NEAR((wa - wb).norm(), 0.0, 1e-9);
  const Quat qa = a.last(0).pose.orientation;
  const Quat qb = b.last(0).pose.orientation * turn;
  EXPECT_NEAR(qa.angularDistance(qb), 0.0, 1e-7);
}

TEST(BulletRunner, HalfSpaceOfAnyNormalCarries) {
  const Track track = run_bullet(builtin("slope-stick"), BulletProfile::neutral());
  EXPECT_LT((track.last(0).pose.position - track.bodies[0][0].pose.position).norm(), 0.1);
}

TEST(BulletRunner, PairsThatNeverCollidePassThroughEachOther) {
  Scene scene = builtin("newtons-cradle");
  scene.duration = 0.1;
  scene.never_collide.push_back({0, 1});
  const Track track = run_bullet(scene, BulletProfile::neutral());
  EXPECT_EQ(track.last(0).velocity.linear.x(), 1.0);
}

TEST(BulletRunner, GravityScaleIsTheBodysOwn) {
  Scene scene = builtin("free-flight");
  scene.bodies[0].gravity_scale = 0.0;
  const Track track = run_bullet(scene, BulletProfile::neutral());
  EXPECT_EQ(track.last(0).velocity.linear.z(), track.bodies[0][0].velocity.linear.z());
}

TEST(BulletRunner, KinematicBodyIsRefusedByName) {
  Scene scene = builtin("free-flight");
  scene.bodies[0].kind = BodyKind::kKinematic;
  EXPECT_THROW((void)run_bullet(scene, BulletProfile::neutral()), InputError);
}

TEST(BulletRunner, StopFlagEndsTheRun) {
  const StopFlag stop{true};
  const Track track = run_bullet(builtin("free-flight"), BulletProfile::neutral(), &stop);
  EXPECT_TRUE(track.interrupted);
  EXPECT_EQ(track.steps, 0);
}

TEST(BulletProfile, NamesAreChecked) {
  EXPECT_EQ(BulletProfile::named("default").iterations, 10);
  EXPECT_THROW((void)BulletProfile::named("fast"), std::invalid_argument);
}

}  // namespace
}  // namespace signorini::validation
