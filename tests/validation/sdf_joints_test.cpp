#include "tests/validation/sdf_text.h"

#include <cmath>
#include <utility>

namespace signorini::validation {
namespace {

std::string arm(const std::string& joint) {
  return "<model name=\"arm\"><pose>0 0 1 0 0 1.5707963267948966</pose><link name=\"a\"/>"
         "<link name=\"b\"><pose>1 0 0 0 0 0</pose></link>" +
         joint + "</model>";
}

TEST(SdfReader, JointsBecomeOurs) {
  const Scene scene = read(arm(
      "<joint name=\"elbow\" type=\"revolute\"><pose relative_to=\"__model__\">0.5 0 0 0 0 0</pose>"
      "<parent>a</parent><child>b</child><axis><xyz expressed_in=\"__model__\">1 0 0</xyz>"
      "<limit><lower>-1</lower><upper>0.5</upper></limit>"
      "<dynamics><friction>3</friction></dynamics></axis></joint>"
      "<joint name=\"rail\" type=\"prismatic\"><parent>world</parent><child>a</child>"
      "<axis><xyz>0 0 1</xyz><limit><lower>0</lower></limit></axis></joint>"
      "<joint name=\"ball\" type=\"ball\"><parent>a</parent><child>b</child></joint>"
      "<joint name=\"weld\" type=\"fixed\"><parent>a</parent><child>b</child></joint>"));
  ASSERT_EQ(scene.joints.size(), 4u);
  const Joint& elbow = scene.joints[0];
  EXPECT_EQ(elbow.kind, JointKind::kHinge);
  EXPECT_EQ(elbow.name, "arm::elbow");
  EXPECT_EQ(elbow.body_a, scene.body("arm::b"));
  EXPECT_EQ(elbow.body_b, scene.body("arm::a"));
  EXPECT_EQ(elbow.limits.lower, -1.0);
  EXPECT_EQ(elbow.limits.upper, 0.5);
  EXPECT_EQ(elbow.motor.speed, 0.0);
  EXPECT_EQ(elbow.motor.max_force, 3.0);
  // The model is turned by 90 degrees about z: its x is the world's y.
  EXPECT_NEAR((anchor_a(elbow, scene.state) - Vec3(0.0, 0.5, 1.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((anchor_b(elbow, scene.state) - Vec3(0.0, 0.5, 1.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((scene.state[elbow.body_b].q * elbow.axis - Vec3::UnitY()).norm(), 0.0, 1e-12);
  EXPECT_EQ(joint_coordinate(elbow, scene.state), 0.0);
  const Joint& rail = scene.joints[1];
  EXPECT_EQ(rail.kind, JointKind::kSlider);
  EXPECT_EQ(scene.bodies[rail.body_b].kind, BodyKind::kFixed);
  EXPECT_EQ(rail.limits.lower, 0.0);
  EXPECT_TRUE(std::isinf(rail.limits.upper));
  EXPECT_EQ(scene.joints[2].kind, JointKind::kBall);
  EXPECT_EQ(scene.joints[3].kind, JointKind::kFixed);
}

TEST(SdfReader, JoinedBodiesDoNotCollideAndItIsSaid) {
  const Scene scene = read(
      arm("<self_collide>true</self_collide><joint name=\"weld\" type=\"fixed\"><parent>a</parent>"
          "<child>b</child></joint>"));
  ASSERT_EQ(scene.never_collide.size(), 1u);
  EXPECT_EQ(scene.never_collide[0], std::pair(scene.body("arm::a"), scene.body("arm::b")));
  EXPECT_TRUE(mentions(scene, "1 pairs of bodies do not collide"));
  EXPECT_TRUE(mentions(scene, "or joined"));
}

TEST(UrdfReader, JointsBecomeOurs) {
  const Scene scene = read_scene_text(
      "<robot name=\"arm\">"
      "<link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
      "iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>"
      "<link name=\"b\"><inertial><mass value=\"2\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
      "iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>"
      "<joint name=\"elbow\" type=\"revolute\"><origin xyz=\"0.5 0 0\" rpy=\"0 0 0\"/>"
      "<parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 1 0\"/>"
      "<limit lower=\"-1\" upper=\"2\" effort=\"5\" velocity=\"1\"/></joint></robot>",
      "arm.urdf");
  ASSERT_EQ(scene.joints.size(), 1u);
  const Joint& elbow = scene.joints[0];
  EXPECT_EQ(elbow.kind, JointKind::kHinge);
  EXPECT_EQ(elbow.body_a, scene.body("arm::b"));
  EXPECT_EQ(elbow.limits.lower, -1.0);
  EXPECT_EQ(elbow.limits.upper, 2.0);
  EXPECT_NEAR((anchor_b(elbow, scene.state) - Vec3(0.5, 0.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((elbow.axis - Vec3::UnitY()).norm(), 0.0, 1e-12);
}

TEST(SdfReader, WhatOfAJointIsLeftOutIsNamed) {
  const std::string ends = "<parent>a</parent><child>b</child>";
  const Scene scene = read(arm(
      "<joint name=\"one\" type=\"revolute\">" + ends +
      "<axis><xyz>0 0 1</xyz><limit><lower>-6.5</lower><upper>6.5</upper><effort>9</effort></limit>"
      "<dynamics><damping>0.5</damping><spring_stiffness>2</spring_stiffness></dynamics></axis>"
      "</joint>"));
  ASSERT_EQ(scene.joints.size(), 1u);
  EXPECT_TRUE(std::isinf(scene.joints[0].limits.lower));
  EXPECT_TRUE(mentions(scene, "joint 'one': <limit> -6.5 .. 6.5 rad left out"));
  EXPECT_TRUE(mentions(scene, "<damping> 0.5 left out"));
  EXPECT_TRUE(mentions(scene, "<spring_stiffness> 2 left out"));
  EXPECT_TRUE(mentions(scene, "effort"));
}

TEST(SdfReader, BadJointsAreNamed) {
  const std::string ends = "<parent>a</parent><child>b</child>";
  const std::string screw =
      arm("<joint name=\"elbow\" type=\"screw\">" + ends + "<axis><xyz>0 0 1</xyz></axis></joint>");
  EXPECT_NAMES(refusal(world(screw)), "model 'arm', joint 'elbow'");
  EXPECT_NAMES(refusal(world(screw)), "<joint type=\"screw\"> is not supported");
  EXPECT_TRUE(mentions(read(screw, {.skip_unsupported = true}), "joint 'elbow'"));
  const auto with_axis = [&](const std::string& axis) {
    return refusal(world(arm("<joint name=\"elbow\" type=\"prismatic\">" + ends + "<axis>" + axis +
                             "</axis></joint>")));
  };
  EXPECT_NAMES(with_axis("<xyz>0 0 0</xyz>"), "joint 'elbow': <xyz>: must be 3 numbers");
  EXPECT_NAMES(with_axis("<xyz>0 0 nan</xyz>"), "joint 'elbow': <xyz>: must be 3 numbers");
  EXPECT_NAMES(with_axis("<xyz>0 0 1</xyz><limit><lower>2</lower><upper>1</upper></limit>"),
               "lower <= upper must hold");
  EXPECT_NAMES(refusal(world(arm("<joint name=\"elbow\" type=\"ball\"><parent>a</parent>"
                                 "<child>nobody</child></joint>"))),
               "nobody");
}

}  // namespace
}  // namespace signorini::validation
