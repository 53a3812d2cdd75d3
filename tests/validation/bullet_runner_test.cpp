#include <signorini/collision/compound.h>
#include <signorini/collision/mesh.h>
#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/bullet_runner.h>
#include <signorini/validation/bullet_shapes.h>
#include <signorini/validation/input_error.h>
#include <signorini/validation/sdf_reader.h>
#include <signorini/validation/signorini_runner.h>

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

TEST(BulletRunner, JointsHaveTheSameCoordinateLimitsAndMotors) {
  // A wheel on a hinge and a box on a rail, each driven either way against either limit: Bullet
  // ends where we do.
  for (const JointKind kind : {JointKind::kHinge, JointKind::kSlider}) {
    for (const double speed : {1.0, -1.0}) {
      Scene scene;
      scene.source = "joints";
      scene.step = 1.0 / 240.0;
      scene.duration = 2.0;
      scene.gravity = Vec3::Zero();
      scene.bodies.resize(2);
      scene.bodies[0].kind = BodyKind::kFixed;
      scene.bodies[1].inertia = Vec3(1.0, 1.5, 2.0).asDiagonal();
      scene.state.resize(2);
      scene.state[1].x = Vec3(0.3, 0.0, 0.0);
      scene.state[1].q = Quat(Eigen::AngleAxisd(0.4, Vec3(1.0, 2.0, 3.0).normalized()));
      Joint joint = joint_at(kind, 1, 0, scene.state, scene.state[1].x, {1.0, 0.0, 1.0});
      joint.limits = {-0.5, 0.25};
      joint.motor = {speed, 20.0};
      scene.joints = {joint};
      const double expected = speed > 0.0 ? 0.25 : -0.5;
      for (const Track& track : {run_signorini(scene, step_settings(scene)),
                                 run_bullet(scene, BulletProfile::neutral())}) {
        State end = scene.state;
        end[1].x = track.last(1).pose.position;
        end[1].q = track.last(1).pose.orientation;
        EXPECT_NEAR(joint_coordinate(joint, end), expected, 0.02)
            << track.engine << " " << to_string(kind) << " " << speed;
      }
    }
  }
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

/// A ball of radius 0.5 m over a floor, restitution 0.5.
Scene ball_over(const collision::Shape& floor) {
  Scene scene = builtin("ball-drop-e0.5");
  scene.colliders[1].shape = floor;
  return scene;
}

TEST(BulletRunner, MaterialsAreFoundThroughMeshesAndCompounds) {
  const double half = 10.0;
  const collision::TriangleMesh mesh = collision::make_mesh(
      {Vec3(-half, -half, 0), Vec3(half, -half, 0), Vec3(half, half, 0), Vec3(-half, half, 0)},
      {{0, 1, 2}, {0, 2, 3}});
  const collision::Compound compound = collision::make_compound(
      {{collision::Box{Vec3(half, half, 0.5)}, Pose{Vec3(0, 0, -0.5), Quat::Identity()}},
       {collision::Sphere{1.0}, Pose{Vec3(5, 5, 0), Quat::Identity()}}});
  const collision::TriangleMesh field =
      collision::make_height_field(std::vector<double>(25, 0.0), 5, 5, 4.0, 4.0);
  for (const collision::Shape& floor :
       {collision::Shape(mesh), collision::Shape(compound), collision::Shape(field)}) {
    const auto [after, before] =
        first_bounce(run_bullet(ball_over(floor), BulletProfile::neutral()));
    ASSERT_GT(before, 1.0);
    EXPECT_NEAR(after / before, 0.5, 1e-6) << floor.index();
  }
}

TEST(BulletRunner, EveryShapeIsCarriedWhereItStands) {
  Scene scene = builtin("resting-shapes");
  scene.duration = 0.5;
  const Track track = run_bullet(scene, BulletProfile::neutral());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    // Bullet's margins are below 1 mm here; what it sinks and rocks comes on top.
    EXPECT_NEAR(track.last(static_cast<int>(i)).pose.position.z(), scene.state[i].x.z(), 0.02)
        << scene.bodies[i].name;
  }
  const std::string all = [&] {
    std::string lines;
    for (const std::string& line : track.remarks) lines += line + "\n";
    return lines;
  }();
  EXPECT_NE(all.find("ellipsoids, which Bullet lacks"), std::string::npos) << all;
  EXPECT_NE(all.find("cones are larger"), std::string::npos) << all;
}

TEST(BulletShapes, EllipsoidIsExactAndTheOthersHaveTheirSizes) {
  const auto extent = [](const collision::Shape& shape, int axis) {
    const std::vector<BulletShape> made = make_bullet_shapes(shape, 1.0);
    btVector3 low, high;
    made.at(0).shape->getAabb(btTransform::getIdentity(), low, high);
    return 0.5 * (high[axis] - low[axis]);
  };
  const auto* ellipsoid = dynamic_cast<const btConvexShape*>(
      make_bullet_shapes(collision::Ellipsoid{Vec3(1.0, 2.0, 0.5)}, 1.0).at(0).shape.release());
  for (const btVector3& n : {btVector3(1, 0, 0), btVector3(0.6, 0.8, 0), btVector3(0, -0.6, 0.8)}) {
    const btScalar expected = (btVector3(1.0, 2.0, 0.5) * n).length();
    EXPECT_NEAR(ellipsoid->localGetSupportingVertex(n).dot(n), expected, 1e-12);
  }
  delete ellipsoid;
  EXPECT_NEAR(extent(collision::Ellipsoid{Vec3(1.0, 2.0, 0.5)}, 1), 2.0, 1e-12);
  EXPECT_NEAR(extent(collision::Capsule{0.2, 0.5}, 2), 0.7, 1e-12);
  EXPECT_NEAR(extent(collision::Cylinder{0.2, 0.5}, 2), 0.5, 1e-12);
  // Larger by the margin of 1/1000 of the smallest size, which bounds count twice.
  EXPECT_NEAR(extent(collision::Cone{0.2, 0.5}, 2), 0.5, 4.1e-4);
  EXPECT_GT(extent(collision::Cone{0.2, 0.5}, 2), 0.5);
}

TEST(BulletRunner, FiltersOfCollidersAreTheScenes) {
  for (const bool compound : {false, true}) {
    Scene scene = builtin("ball-drop-e0");
    scene.duration = 1.0;
    scene.colliders[0].filter = {2, 2};
    scene.colliders[1].filter = {4, 4};
    if (compound) {
      // A second shape that meets the plane, out of its reach: the pair of bodies stays.
      collision::Collider other = scene.colliders[0];
      other.filter = {4, 4};
      other.local.position = Vec3(0.0, 0.0, 100.0);
      other.shape = collision::Sphere{0.1};
      scene.colliders.push_back(other);
    }
    EXPECT_LT(run_bullet(scene, BulletProfile::neutral()).last(0).pose.position.z(), -1.0);
    scene.colliders[0].filter = {6, 6};
    EXPECT_GT(run_bullet(scene, BulletProfile::neutral()).last(0).pose.position.z(), 0.0);
  }
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
