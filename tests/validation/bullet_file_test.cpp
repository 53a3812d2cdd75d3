#include <signorini/core/model/joint.h>
#include <signorini/validation/bullet_file.h>
#include <signorini/validation/bullet_file_chunks.h>
#include <signorini/validation/input_error.h>
#include <signorini/validation/signorini_runner.h>

#include "saved_world.h"

#include <BulletDynamics/ConstraintSolver/btGeneric6DofConstraint.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <sstream>

namespace signorini::validation {
namespace {

const std::string& saved() {
  static const std::string bytes = SavedWorld().bytes();
  return bytes;
}

Scene read(const std::string& bytes, const ReadOptions& options = {}) {
  return read_bullet_bytes(bytes, "world.bullet", options);
}

std::string refusal(const std::string& bytes, const ReadOptions& options = {}) {
  try {
    (void)read(bytes, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

std::filesystem::path folder() {
  const auto path = std::filesystem::temp_directory_path() / "signorini_bullet_file_test";
  std::filesystem::create_directories(path);
  return path;
}

TEST(BulletFile, WhatAWorldSavesComesBack) {
  SavedWorld world;
  const Scene scene = read(world.bytes());
  EXPECT_EQ(scene.gravity, Vec3(0, 0, -9.75));
  EXPECT_EQ(scene.rule, PairingRule::kMultiply);
  ASSERT_EQ(scene.bodies.size(), world.bodies.size() + 1) << "the world, for its joints";
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    const btRigidBody& body = *world.bodies[i];
    const Body& read = scene.bodies[i];
    EXPECT_EQ(scene.state[i].x, ours(body.getWorldTransform().getOrigin())) << read.name;
    ASSERT_EQ(read.is_dynamic(), body.getInvMass() > 0.0) << read.name;
    if (!read.is_dynamic()) continue;
    EXPECT_DOUBLE_EQ(read.mass, 1.0 / body.getInvMass()) << read.name;
    EXPECT_LT((Vec3(read.inertia.diagonal()) - ours(body.getLocalInertia())).norm(), 1e-12);
    const Velocity v = velocity(read, scene.state[i]);
    EXPECT_LT((v.linear - ours(body.getLinearVelocity())).norm(), 1e-14) << read.name;
    EXPECT_LT((v.angular - ours(body.getAngularVelocity())).norm(), 1e-13) << read.name;
    EXPECT_EQ(read.gravity_scale, 1.0);
  }
  EXPECT_EQ(scene.bodies[scene.body("capsule")].mass, 1.5);
  ASSERT_EQ(scene.joints.size(), 4U);
  const std::vector<JointKind> kinds = {JointKind::kHinge, JointKind::kBall, JointKind::kSlider,
                                        JointKind::kFixed};
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const Joint& joint = scene.joints[k];
    EXPECT_EQ(joint.kind, kinds[k]) << joint.name;
    const JointError error = joint_error(joint, scene.state);
    EXPECT_LT(error.position.norm() + error.angle.norm(), 1e-9) << joint.name;
    EXPECT_FALSE(joint.bodies_collide) << joint.name;
  }
}

TEST(BulletFile, BulletsRunIsThatOfTheLiveWorld) {
  SavedWorld world;
  Scene scene = read(world.bytes());
  scene.duration = 0.25;
  const Track track = run_bullet_file(scene, nullptr);
  world.step(scene.step, static_cast<int>(scene.step_count()));
  ASSERT_EQ(track.steps, scene.step_count());
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    const Vec3 live = ours(world.bodies[i]->getWorldTransform().getOrigin());
    // Bullet loads bodies and pairs in another order, and its iterations end elsewhere: where the
    // cubes stand moves by parts of a millimetre.
    EXPECT_LT((track.bodies.back()[i].pose.position - live).norm(), 1e-3) << scene.bodies[i].name;
  }
}

TEST(BulletFile, OursDoesWhatBulletDoes) {
  Scene scene = read(saved());
  scene.duration = 0.25;
  const Track track = run_signorini(scene, step_settings(scene));
  const Track theirs = run_bullet_file(scene, nullptr);
  EXPECT_EQ(track.unsolved_steps, 0) << track.first_unsolved;
  for (const char* name : {"cube 3", "bar", "ball", "capsule", "hull", "sled", "left", "right"}) {
    const int body = scene.body(name);
    // Both schemes are of first order: 10 m/s^2 times 0.25 s times a step, and Bullet's margins.
    EXPECT_LT((track.last(body).pose.position - theirs.last(body).pose.position).norm(), 2e-2)
        << name;
  }
  EXPECT_LT((track.last(scene.body("cube 3")).pose.position - Vec3(0, 0, 2.5)).norm(), 1e-7);
}

// The signs of limits: where they stop a hinge and a slider, in both engines.
class Limits : public testing::TestWithParam<bool> {};

TEST_P(Limits, StopBothEnginesAtTheSamePlace) {
  SavedWorld world;
  btTransform axle = btTransform::getIdentity();
  axle.setOrigin(btVector3(-0.5, 0, 0));
  axle.setRotation(btQuaternion(btVector3(1, 0, 0), -SIMD_HALF_PI));
  btRigidBody& bar = world.add("falls", new btBoxShape(btVector3(0.5, 0.0625, 0.0625)), 1.0,
                               btVector3(4.5, 20, 4));
  auto* hinge = new btHingeConstraint(bar, axle, GetParam());
  hinge->setLimit(btScalar(-0.25), btScalar(1.0));
  world.add(hinge);
  btRigidBody& sled = world.add("slides", new btSphereShape(0.25), 1.0, btVector3(0, 24, 3));
  sled.setLinearVelocity(btVector3(2, 0, 0));
  auto* slider = new btSliderConstraint(*world.bodies[0], sled,
                                        btTransform(btQuaternion::getIdentity(), {0, 24, 4}),
                                        btTransform::getIdentity(), GetParam());
  slider->setLowerLinLimit(btScalar(-0.25));
  slider->setUpperLinLimit(btScalar(1.0));
  world.add(slider);
  Scene scene = read(world.bytes());
  scene.duration = 1.5;
  const Track ours = run_signorini(scene, step_settings(scene));
  const Track theirs = run_bullet_file(scene, nullptr);
  const int falls = scene.body("falls");
  EXPECT_LT((ours.last(falls).pose.position - theirs.last(falls).pose.position).norm(), 0.05)
      << "ours " << ours.last(falls).pose.position.transpose() << ", Bullet "
      << theirs.last(falls).pose.position.transpose();
  // Bullet's slider springs back from its limit: how far it came counts.
  const auto farthest = [slides = scene.body("slides")](const Track& track) {
    double x = 0.0;
    for (const auto& sample : track.bodies) x = std::max(x, sample[slides].pose.position.x());
    return x;
  };
  EXPECT_NEAR(farthest(ours), GetParam() ? 1.0 : 0.25, 1e-6);
  EXPECT_NEAR(farthest(theirs), GetParam() ? 1.0 : 0.25, 0.05);
}

INSTANTIATE_TEST_SUITE_P(ReferenceFrameA, Limits, testing::Bool());

TEST(BulletFile, WhatOursCannotDoIsRefusedByNameOrNoted) {
  SavedWorld damped;
  damped.bodies[2]->setDamping(btScalar(0.125), 0);
  const std::string text = refusal(damped.bytes());
  EXPECT_NE(text.find("world.bullet: not supported: body 'cube 2': m_linearDamping"),
            std::string::npos)
      << text;
  const Scene scene = read(damped.bytes(), {.skip_unsupported = true});
  EXPECT_TRUE(std::ranges::any_of(scene.notices, [](const std::string& notice) {
    return notice.find("skipped in ours: body 'cube 2': m_linearDamping") != std::string::npos;
  }));

  SavedWorld free;
  free.add(new btGeneric6DofConstraint(*free.bodies[1], *free.bodies[2], btTransform::getIdentity(),
                                       btTransform::getIdentity(), true));
  EXPECT_NE(refusal(free.bytes()).find("constraint 5: m_objectType"), std::string::npos);

  SavedWorld kinematic;
  kinematic.bodies[0]->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  EXPECT_NE(refusal(kinematic.bytes()).find("'ground': m_collisionFlags"), std::string::npos);
}

TEST(BulletFile, WhatIsNoWholeFileIsRefusedWhereItEnds) {
  EXPECT_NE(refusal("").find("world.bullet: byte 0: expected the header"), std::string::npos);
  EXPECT_NE(refusal("<sdf/>").find("byte 0"), std::string::npos);
  std::string big_endian = saved();
  big_endian[8] = 'V';
  EXPECT_NE(refusal(big_endian).find("byte 8: big-endian"), std::string::npos);
  for (std::size_t part = 0; part < 40; ++part) {
    const std::string cut = saved().substr(0, saved().size() * part / 40);
    EXPECT_THROW((void)check_bullet_chunks(cut, "cut"), InputError) << part;
  }
  EXPECT_THROW((void)check_bullet_chunks(saved().substr(0, saved().size() - 1), "cut"), InputError);
  EXPECT_THROW((void)check_bullet_chunks(saved() + "x", "longer"), InputError);
  const BulletFileHeader header = check_bullet_chunks(saved(), "whole");
  EXPECT_TRUE(header.is_double);
  EXPECT_EQ(header.version, btGetVersion());
}

TEST(BulletFile, BytesThatCrashBulletsLoaderAreAnError) {
  // Whatever becomes of a wrong byte in Bullet's loader, this process goes on.
  std::mt19937 random(7);
  int refused = 0;
  for (int k = 0; k < 30; ++k) {
    std::string bytes = saved();
    for (int flips = 0; flips < 20; ++flips) {
      bytes[12 + random() % (bytes.size() - 12)] = static_cast<char>(random());
    }
    refused += refusal(bytes).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 0);
}

TEST(BulletFile, TheProgramRunsOneAndItsReportRepeats) {
  const auto file = folder() / "saved.bullet";
  std::ofstream(file, std::ios::binary) << saved();
  const auto out = folder() / "report";
  const std::string run = std::string(SIGNORINI_VALIDATE) + " " + file.string() +
                          " --duration 0.1 --out " + out.string() + " > " +
                          (folder() / "log").string();
  EXPECT_EQ(std::system(run.c_str()), 0);
  EXPECT_TRUE(std::filesystem::exists(out / "scenes" / "01-saved.bullet"));
  const std::string verify = std::string(SIGNORINI_VALIDATE) + " --verify " + out.string() + " > " +
                             (folder() / "log").string();
  EXPECT_EQ(std::system(verify.c_str()), 0);
}

#ifdef SIGNORINI_SAVE_WORLD
TEST(BulletFile, SinglePrecisionIsReadToo) {
  const auto file = folder() / "float.bullet";
  ASSERT_EQ(std::system((std::string(SIGNORINI_SAVE_WORLD) + " " + file.string()).c_str()), 0);
  Scene single = read_any_scene_file(file.string());
  const Scene whole = read(saved());
  ASSERT_EQ(single.bodies.size(), whole.bodies.size());
  ASSERT_EQ(single.joints.size(), whole.joints.size());
  for (std::size_t i = 0; i < whole.bodies.size(); ++i) {
    EXPECT_LT((single.state[i].x - whole.state[i].x).norm(), 1e-6) << whole.bodies[i].name;
    EXPECT_EQ(single.bodies[i].name, whole.bodies[i].name);
  }
  single.duration = 0.1;
  EXPECT_EQ(run_signorini(single, step_settings(single)).unsolved_steps, 0);
  EXPECT_EQ(run_bullet_file(single, nullptr).steps, single.step_count());
}
#endif

}  // namespace
}  // namespace signorini::validation
