#include "tests/validation/sdf_text.h"

#include <string>
#include <vector>

namespace signorini::validation {
namespace {

TEST(SdfReader, BodyFrameIsTheCentreOfMass) {
  const Scene scene =
      read(box_model("<pose>1 0 0 0 0 1.5707963267948966</pose>"
                     "<inertial><pose>0.5 0 0 0 0 0</pose><mass>2</mass></inertial>"));
  ASSERT_EQ(scene.bodies.size(), 1u);
  // The link is turned by 90 degrees about z: half a metre along its x is half a metre along y.
  EXPECT_NEAR((scene.state[0].x - Vec3(1.0, 0.5, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((scene.colliders[0].local.position - Vec3(-0.5, 0.0, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_EQ(scene.bodies[0].mass, 2.0);
}

TEST(SdfReader, InertiaIsTurnedIntoTheLinksAxes) {
  const Scene scene =
      read(box_model("<inertial><pose>0 0 0 0 0 1.5707963267948966</pose><mass>1</mass>"
                     "<inertia><ixx>2</ixx><iyy>3</iyy><izz>4</izz></inertia></inertial>"));
  const Mat3 expected = Vec3(3.0, 2.0, 4.0).asDiagonal();
  EXPECT_NEAR((scene.bodies[0].inertia - expected).norm(), 0.0, 1e-15);
}

TEST(SdfReader, InertialWithoutMassIsNamed) {
  const std::string pose = "<inertial><pose>0.5 0 0 0 0 0</pose>";
  const Scene scene = read(box_model(pose + "</inertial>"));
  EXPECT_EQ(scene.bodies[0].mass, 1.0);
  EXPECT_TRUE(mentions(scene, "'brick' has an <inertial> without <mass>: 1 kg"));
  EXPECT_FALSE(mentions(read(box_model(pose + "<mass>1</mass></inertial>")), "without <mass>"));
}

TEST(SdfReader, MassWithoutInertiaIsNamed) {
  const Scene scene = read(box_model("<inertial><mass>2</mass></inertial>"));
  EXPECT_EQ(scene.bodies[0].mass, 2.0);
  EXPECT_EQ(scene.bodies[0].inertia, Mat3::Identity());
  EXPECT_TRUE(mentions(scene, "'brick' has a <mass> without <inertia>: 1 kg m^2"));
  EXPECT_FALSE(mentions(
      read(box_model("<inertial><mass>2</mass><inertia><ixx>2</ixx><iyy>2</iyy><izz>2</izz>"
                     "</inertia></inertial>")),
      "without <inertia>"));
}

TEST(SdfReader, PosesGoThroughTheFrameGraph) {
  const Scene scene = read("<frame name=\"shelf\"><pose>0 0 2 0 0 0</pose></frame>" +
                           box_model("<pose relative_to=\"peg\">0 0 1 0 0 0</pose>", "",
                                     "<pose relative_to=\"shelf\">1 0 0 0 0 0</pose>"
                                     "<frame name=\"peg\"><pose>0 3 0 0 0 0</pose></frame>"));
  EXPECT_NEAR((scene.state[0].x - Vec3(1.0, 3.0, 3.0)).norm(), 0.0, 1e-15);
}

TEST(SdfReader, ReadsTheNamespacedElements) {
  const Scene scene = read(
      "<signorini:duration>7.5</signorini:duration><signorini:title>A  title</signorini:title>"
      "<signorini:pairing>multiply</signorini:pairing><signorini:error> the  apex "
      "</signorini:error>"
      "<signorini:error_scale>2.5</signorini:error_scale>" +
      box_model("<signorini:linear_velocity>1 2 3</signorini:linear_velocity>"
                "<signorini:angular_velocity>0 0 4</signorini:angular_velocity>"));
  EXPECT_EQ(scene.duration, 7.5);
  EXPECT_EQ(scene.title, "A title");
  EXPECT_EQ(scene.rule, PairingRule::kMultiply);
  EXPECT_EQ(scene.error, "the apex");
  EXPECT_EQ(scene.error_scale, 2.5);
  EXPECT_NE(scene.text.find("<signorini:error> the  apex"), std::string::npos);
  const Velocity v = velocity(scene.bodies[0], scene.state[0]);
  EXPECT_NEAR((v.linear - Vec3(1.0, 2.0, 3.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((v.angular - Vec3(0.0, 0.0, 4.0)).norm(), 0.0, 1e-15);
}

TEST(SdfReader, WithoutPhysicsTheDefaultsAreSdformats) {
  const Scene scene = read(box_model(""));
  EXPECT_EQ(scene.step, 0.001);
  EXPECT_EQ(scene.gravity, Vec3(0.0, 0.0, -9.8));
  EXPECT_EQ(scene.duration, 5.0);
  EXPECT_TRUE(mentions(scene, "has no <inertial>"));
}

TEST(SdfReader, ReadsGravityStepAndSurfaces) {
  const Scene scene = read(
      "<gravity>0 1 -2</gravity><physics "
      "type=\"ode\"><max_step_size>0.01</max_step_size></physics>" +
      box_model(
          "<gravity>false</gravity>",
          "<surface><friction><ode><mu>0.25</mu><mu2>0.25</mu2></ode></friction>"
          "<bounce><restitution_coefficient>0.75</restitution_coefficient></bounce></surface>"));
  EXPECT_EQ(scene.gravity, Vec3(0.0, 1.0, -2.0));
  EXPECT_EQ(scene.step, 0.01);
  EXPECT_EQ(scene.bodies[0].gravity_scale, 0.0);
  EXPECT_EQ(scene.colliders[0].material.friction, 0.25);
  EXPECT_EQ(scene.colliders[0].material.restitution, 0.75);
  EXPECT_FALSE(mentions(scene, "ignored physics"));
}

TEST(SdfReader, ReadsAnisotropicRollingAndSpinningFriction) {
  const Scene scene = read(
      box_model("",
                "<surface><friction><ode><mu>0.2</mu><mu2>0.5</mu2><fdir1>0 1 0</fdir1></ode>"
                "<bullet><rolling_friction>0.02</rolling_friction></bullet>"
                "<torsional><coefficient>0.8</coefficient><use_patch_radius>true</use_patch_radius>"
                "<patch_radius>0.1</patch_radius></torsional></friction></surface>"));
  const collision::Collider& box = scene.colliders[0];
  EXPECT_EQ(box.material.friction, 0.2);
  EXPECT_DOUBLE_EQ(box.material.friction_ratio, 2.5);
  EXPECT_EQ(box.friction_direction, Vec3(0.0, 1.0, 0.0));
  EXPECT_EQ(box.material.rolling_friction, 0.02);
  EXPECT_DOUBLE_EQ(box.material.spinning_friction, 3.0 * std::numbers::pi / 16.0 * 0.8 * 0.1);
  EXPECT_FALSE(mentions(scene, "ignored physics"));
}

TEST(SdfReader, SaysWhichFrictionItDoesNotTake) {
  const Scene scene = read(box_model(
      "",
      "<surface><friction><ode><mu>0.2</mu><mu2>0</mu2><fdir1>0 1 0</fdir1></ode>"
      "<torsional><coefficient>0.8</coefficient><use_patch_radius>false</use_patch_radius>"
      "<surface_radius>0.1</surface_radius></torsional></friction></surface>"));
  EXPECT_EQ(scene.colliders[0].material.friction_ratio, 1.0);
  EXPECT_EQ(scene.colliders[0].material.spinning_friction, 0.0);
  EXPECT_TRUE(mentions(scene, "mu2 = 0 beside mu = 0.2"));
  EXPECT_TRUE(mentions(scene, "use_patch_radius"));
}

TEST(SdfReader, LinksOfOneModelCollideOnlyIfTheySaySo) {
  const auto two_links = [](const std::string& flag) {
    return read("<model name=\"m\">" + flag + "<link name=\"a\"/><link name=\"b\"/></model>");
  };
  EXPECT_EQ(two_links("").never_collide.size(), 1u);
  EXPECT_EQ(two_links("<self_collide>true</self_collide>").never_collide.size(), 0u);
}

TEST(SdfReader, NothingIsIgnoredSilently) {
  const Scene scene = read(
      "<light name=\"sun\" type=\"directional\"/>" +
      box_model(
          "<visual name=\"v\"><geometry><cylinder><radius>1</radius><length>1</length>"
          "</cylinder></geometry></visual><velocity_decay><linear>0.1</linear></velocity_decay>",
          "<surface><friction><ode><mu>0.5</mu><mu2>0.3</mu2><slip1>0.01</slip1></ode>"
          "</friction><contact><ode><kp>1e5</kp></ode></contact></surface>"));
  EXPECT_TRUE(mentions(scene, "light (1)"));
  EXPECT_TRUE(mentions(scene, "visual (1)"));
  EXPECT_TRUE(mentions(scene, "velocity_decay/linear"));
  EXPECT_TRUE(mentions(scene, "mu2 = 0.3 beside mu = 0.5"));
  EXPECT_TRUE(mentions(scene, "surface/friction/ode/slip1"));
  EXPECT_TRUE(mentions(scene, "surface/contact/ode/kp"));
}

struct BadInput {
  const char* name;
  std::string content;
  std::vector<std::string> names;  ///< what the message must hold
};

class SdfReaderRefuses : public testing::TestWithParam<BadInput> {};

TEST_P(SdfReaderRefuses, AndNamesFileAndField) {
  const std::string message = refusal(world(GetParam().content));
  ASSERT_FALSE(message.empty()) << "was accepted";
  EXPECT_NAMES(message, "test.sdf:");
  for (const std::string& words : GetParam().names) EXPECT_NAMES(message, words);
}

std::string inertial(const std::string& content) {
  return box_model("<inertial>" + content + "</inertial>");
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, SdfReaderRefuses,
    testing::Values(
        BadInput{"negative_mass", inertial("<mass>-1</mass>"), {"link 'body'", "<mass>", "-1"}},
        BadInput{"nan_mass", inertial("<mass>nan</mass>"), {"link 'body'", "<mass>", "nan"}},
        BadInput{"text_for_mass", inertial("<mass>heavy</mass>"), {"<mass>", "heavy"}},
        BadInput{"triangle_inequality",
                 inertial("<mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>3</izz></inertia>"),
                 {"link 'body'", "<inertial>", "triangle inequality"}},
        BadInput{"infinite_inertia",
                 inertial("<inertia><ixx>inf</ixx><iyy>1</iyy><izz>1</izz></inertia>"),
                 {"link 'body'", "<ixx>", "inf"}},
        BadInput{"short_pose", box_model("<pose>1 2</pose>"), {"<pose>", "6 numbers"}},
        BadInput{"nan_pose", box_model("<pose>1 2 nan 0 0 0</pose>"), {"<pose>", "nan"}},
        BadInput{
            "negative_size",
            "<model name=\"m\"><link name=\"l\"><collision name=\"c\"><geometry><box><size>1 1 -1"
            "</size></box></geometry></collision></link></model>",
            {"model 'm'", "collision 'c'", "<size>", "-1"}},
        BadInput{
            "zero_radius",
            "<model name=\"m\"><link name=\"l\"><collision name=\"c\"><geometry><sphere><radius>0"
            "</radius></sphere></geometry></collision></link></model>",
            {"<radius>", "> 0"}},
        BadInput{"negative_length",
                 model_of("<cylinder><radius>1</radius><length>-2</length></cylinder>"),
                 {"collision 'c'", "<length>", "-2", "> 0"}},
        BadInput{"two_radii",
                 model_of("<ellipsoid><radii>1 2</radii></ellipsoid>"),
                 {"collision 'c'", "<radii>", "3 numbers"}},
        BadInput{"nan_cone",
                 model_of("<cone><radius>nan</radius><length>1</length></cone>"),
                 {"<radius>", "nan"}},
        BadInput{"cone_without_length",
                 model_of("<cone><radius>1</radius></cone>"),
                 {"collision 'c'", "<cone>", "<length> is missing"}},
        BadInput{"zero_density",
                 model_of("<sphere><radius>1</radius></sphere>", "",
                          "<inertial auto=\"true\"><density>0</density></inertial>"),
                 {"<density>", "> 0"}},
        BadInput{
            "zero_normal",
            "<model name=\"m\"><static>true</static><link name=\"l\"><collision name=\"c\">"
            "<geometry><plane><normal>0 0 0</normal></plane></geometry></collision></link></model>",
            {"<normal>", "zero"}},
        BadInput{"negative_friction",
                 box_model("", "<surface><friction><ode><mu>-0.1</mu></ode></friction></surface>"),
                 {"<mu>", "-0.1", ">= 0"}},
        BadInput{"restitution_above_one",
                 box_model("",
                           "<surface><bounce><restitution_coefficient>1.5"
                           "</restitution_coefficient></bounce></surface>"),
                 {"<restitution_coefficient>", "[0, 1]", "1.5"}},
        BadInput{"zero_step",
                 "<physics type=\"ode\"><max_step_size>0</max_step_size></physics>" + box_model(""),
                 {"<max_step_size>", "> 0"}},
        BadInput{"unknown_extension",
                 box_model("<signorini:speed>1</signorini:speed>"),
                 {"link 'body'", "<signorini:speed>"}},
        BadInput{"extension_in_the_wrong_place",
                 "<signorini:linear_velocity>1 0 0</signorini:linear_velocity>" + box_model(""),
                 {"<signorini:linear_velocity>", "<world>"}},
        BadInput{"velocity_of_a_static_link",
                 box_model("<signorini:linear_velocity>1 0 0</signorini:linear_velocity>", "",
                           "<static>true</static>"),
                 {"link 'body'", "static"}},
        BadInput{"unknown_stepper",
                 "<signorini:stepper>verlet</signorini:stepper>" + box_model(""),
                 {"<signorini:stepper>", "verlet"}},
        BadInput{"events_with_joints",
                 "<signorini:stepper>event-driven</signorini:stepper>" +
                     box_model("", "",
                               "<joint name=\"j\" type=\"ball\"><parent>world</parent>"
                               "<child>body</child></joint>"),
                 {"<signorini:stepper>", "joints"}},
        BadInput{"unknown_pairing",
                 "<signorini:pairing>sum</signorini:pairing>" + box_model(""),
                 {"<signorini:pairing>", "sum"}},
        BadInput{"unknown_frame",
                 box_model("<pose relative_to=\"nowhere\">0 0 0 0 0 0</pose>"),
                 {"nowhere"}}),
    [](const auto& scene) { return scene.param.name; });

TEST(SdfReader, CollideBitmaskIsAFilter) {
  const auto masked = [](const std::string& mask) {
    return model_of(
        "<sphere><radius>1</radius></sphere>", "", "",
        "<surface><contact><collide_bitmask>" + mask + "</collide_bitmask></contact></surface>");
  };
  const auto filter = [&](const std::string& mask) {
    return read(masked(mask)).colliders.at(0).filter;
  };
  EXPECT_TRUE(collision::may_collide(filter("2"), filter("6")));
  EXPECT_FALSE(collision::may_collide(filter("2"), filter("4")));
  EXPECT_FALSE(mentions(read(masked("2")), "collide_bitmask"));
  const Scene plain = read(model_of("<sphere><radius>1</radius></sphere>"));
  EXPECT_TRUE(collision::may_collide(plain.colliders[0].filter, filter("0x0100")));
  EXPECT_FALSE(collision::may_collide(plain.colliders[0].filter, filter("0x10000")));
  EXPECT_NAMES(refusal(world(masked("-1"))), "<collide_bitmask>");
}

TEST(SdfReader, MalformedXmlNamesTheLine) {
  EXPECT_NAMES(refusal("<sdf version='1.9'>\n<world name='w'>\n</sdf>"), "test.sdf:");
  EXPECT_NAMES(refusal("<sdf version='1.9'>\n<world name='w'>\n</sdf>"), "not well-formed XML");
  EXPECT_NAMES(refusal("<html/>"), "got <html>");
  EXPECT_NAMES(refusal(""), "not well-formed XML");
}

TEST(SdfReader, AVersionThatIsNoNumberIsRefused) {
  EXPECT_NAMES(refusal("<sdf version='1.x9'><world name='w'/></sdf>"), "test.sdf: libsdformat");
}

TEST(SdfReader, MissingFileIsNamed) {
  try {
    (void)read_scene_file("/no/such/scene.sdf");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_NAMES(std::string(error.what()), "/no/such/scene.sdf: cannot be read");
  }
}

TEST(UrdfReader, ReadsBulletsContactValuesAndNamesTheRest) {
  const Scene scene =
      read_scene_text(robot("<contact><restitution value=\"0.5\"/><lateral_friction value=\"0.9\"/>"
                            "<rolling_friction value=\"0.1\"/></contact>"
                            "<collision><geometry><sphere radius=\"0.5\"/></geometry></collision>"),
                      "test.urdf");
  ASSERT_EQ(scene.colliders.size(), 1u);
  EXPECT_EQ(scene.colliders[0].material.restitution, 0.5);
  EXPECT_EQ(scene.colliders[0].material.friction, 0.9);
  EXPECT_EQ(scene.bodies[0].mass, 2.0);
  EXPECT_TRUE(mentions(scene, "<rolling_friction>"));
  EXPECT_TRUE(mentions(scene, "a model without a world"));
}

TEST(UrdfReader, GroundIsAddedOnRequestAndSaid) {
  const std::string text =
      robot("<collision><geometry><box size=\"1 1 1\"/></geometry></collision>");
  EXPECT_EQ(read_scene_text(text, "test.urdf").bodies.size(), 1u);
  const Scene scene = read_scene_text(text, "test.urdf", {.ground = -1.0});
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[1].kind, BodyKind::kFixed);
  EXPECT_EQ(scene.colliders[1].local.position.z(), -1.0);
  EXPECT_TRUE(mentions(scene, "added: a fixed half-space"));
}

TEST(UrdfReader, UnsupportedShapesAndBadNumbersAreNamed) {
  const auto urdf_refusal = [](const std::string& text) { return refusal(text); };
  const std::string cone = urdf_refusal(
      robot("<collision><geometry><cone radius=\"1\" length=\"1\"/></geometry></collision>"));
  EXPECT_NAMES(cone, "link 'base'");
  EXPECT_NAMES(cone, "<cone> is not supported");
  EXPECT_NAMES(urdf_refusal(robot("<collision><geometry><capsule radius=\"-1\" length=\"1\"/>"
                                  "</geometry></collision>")),
               "<capsule radius>");
  EXPECT_NAMES(urdf_refusal("<robot name=\"r\"><link name=\"base\"><inertial><mass value=\"-2\"/>"
                            "</inertial></link></robot>"),
               "<mass value>");
}

}  // namespace
}  // namespace signorini::validation
