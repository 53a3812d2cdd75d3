#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>
#include <signorini/validation/input_error.h>
#include <signorini/validation/sdf_reader.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace signorini::validation {
namespace {

using ::testing::Test;

/// A world around some models.
std::string world(const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<sdf version=\"1.9\" xmlns:signorini=\"urn:signorini\">\n"
         "<world name=\"w\">\n" +
         content + "\n</world></sdf>";
}

/// A model of one link with a box, and something more in the link or the collision.
std::string box_model(const std::string& in_link, const std::string& in_collision = "",
                      const std::string& in_model = "") {
  return "<model name=\"brick\">" + in_model + "<link name=\"body\">" + in_link +
         "<collision name=\"c\"><geometry><box><size>1 2 3</size></box></geometry>" + in_collision +
         "</collision></link></model>";
}

/// A model of one link with one shape.
std::string model_of(const std::string& geometry, const std::string& in_model = "",
                     const std::string& in_link = "", const std::string& in_collision = "") {
  return "<model name=\"m\">" + in_model + "<link name=\"l\">" + in_link +
         "<collision name=\"c\"><geometry>" + geometry + "</geometry>" + in_collision +
         "</collision></link></model>";
}

Scene read(const std::string& content, const ReadOptions& options = {}) {
  return read_scene_text(world(content), "test.sdf", options);
}

/// The message of the refusal; empty if there is none.
std::string refusal(const std::string& text, const ReadOptions& options = {}) {
  try {
    (void)read_scene_text(text, "test.sdf", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool mentions(const Scene& scene, const std::string& words) {
  for (const std::string& notice : scene.notices) {
    if (notice.find(words) != std::string::npos) return true;
  }
  return false;
}

#define EXPECT_NAMES(text, words) EXPECT_NE((text).find(words), std::string::npos) << (text)

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

TEST(SdfReader, PlaneIsAHalfSpaceWithItsNormal) {
  const Scene scene = read(
      "<model name=\"wall\"><static>true</static><link name=\"l\"><collision name=\"c\">"
      "<geometry><plane><normal>3 0 4</normal><size>1 1</size></plane></geometry></collision>"
      "</link></model>");
  ASSERT_TRUE(std::holds_alternative<collision::HalfSpace>(scene.colliders[0].shape));
  const Vec3 normal = scene.colliders[0].local.orientation * Vec3::UnitZ();
  EXPECT_NEAR((normal - Vec3(0.6, 0.0, 0.8)).norm(), 0.0, 1e-15);
  EXPECT_EQ(scene.bodies[0].kind, BodyKind::kFixed);
  EXPECT_TRUE(mentions(scene, "<plane><size> ignored"));
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
        BadInput{"unknown_pairing",
                 "<signorini:pairing>sum</signorini:pairing>" + box_model(""),
                 {"<signorini:pairing>", "sum"}},
        BadInput{"unknown_frame",
                 box_model("<pose relative_to=\"nowhere\">0 0 0 0 0 0</pose>"),
                 {"nowhere"}}),
    [](const auto& scene) { return scene.param.name; });

class SdfReaderShapes : public testing::TestWithParam<const char*> {};

TEST(SdfReader, ReadsEveryConvexShape) {
  const auto shape = [](const std::string& geometry) {
    return read(model_of(geometry)).colliders.at(0).shape;
  };
  const std::string round = "<radius>0.25</radius><length>3</length>";
  const auto cylinder = std::get<collision::Cylinder>(shape("<cylinder>" + round + "</cylinder>"));
  EXPECT_EQ(cylinder.radius, 0.25);
  EXPECT_EQ(cylinder.half_length, 1.5);
  // SDFormat's length of a capsule is that between the half balls.
  const auto capsule = std::get<collision::Capsule>(shape("<capsule>" + round + "</capsule>"));
  EXPECT_EQ(capsule.radius, 0.25);
  EXPECT_EQ(capsule.half_length, 1.5);
  const auto cone = std::get<collision::Cone>(shape("<cone>" + round + "</cone>"));
  EXPECT_EQ(cone.radius, 0.25);
  EXPECT_EQ(cone.half_height, 1.5);
  const auto ellipsoid =
      std::get<collision::Ellipsoid>(shape("<ellipsoid><radii>1 2 3</radii></ellipsoid>"));
  EXPECT_EQ(ellipsoid.radii, Vec3(1.0, 2.0, 3.0));
}

TEST(SdfReader, ConvexPolylineIsAPrism) {
  const auto polyline = [](const std::string& points) {
    std::string text = "<polyline><height>2</height>";
    std::istringstream stream(points);
    for (std::string point; std::getline(stream, point, ',');) {
      text += "<point>" + point + "</point>";
    }
    return model_of(text + "</polyline>");
  };
  // Either way round, closed or not, with points along a side.
  for (const std::string points :
       {"0 0,1 0,1 1,0 1", "0 1,1 1,1 0,0 0", "0 0,0.5 0,1 0,1 1,0 1,0 0"}) {
    const Scene scene = read(polyline(points));
    const auto& hull = std::get<collision::ConvexHull>(scene.colliders.at(0).shape);
    EXPECT_EQ(hull.data->vertices.size(), 8u) << points;
    EXPECT_NEAR(hull.data->volume, 2.0, 1e-14) << points;
    EXPECT_NEAR((hull.data->centre - Vec3(0.5, 0.5, 1.0)).norm(), 0.0, 1e-14) << points;
  }
  EXPECT_NAMES(refusal(world(polyline("0 0,2 0,2 1,1 1,1 2,0 2"))), "concave");
  EXPECT_NAMES(refusal(world(polyline("0 0,1 0"))), "at least 3 <point>s");
  EXPECT_NAMES(refusal(world(polyline("0 0,1 0,2 0"))), "<polyline>");
  EXPECT_NAMES(refusal(world(polyline("0 0,1 nan,2 0"))), "<point>");
  EXPECT_NAMES(refusal(world(polyline("0 0,1 0,1 1 1"))), "2 numbers");
}

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

TEST(SdfReader, AutoInertiaIsThatOfTheShapes) {
  // A box of 1 x 2 x 3 m beside a ball, densities of their own and of the link.
  const Scene scene = read(
      "<model name=\"m\"><link name=\"l\"><inertial auto=\"true\"><density>2</density></inertial>"
      "<collision name=\"a\"><geometry><box><size>1 2 3</size></box></geometry></collision>"
      "<collision name=\"b\"><pose>4 0 0 0 0 0</pose><density>5</density><geometry><sphere>"
      "<radius>0.5</radius></sphere></geometry></collision></link></model>");
  const double box = 2.0 * 6.0;
  const double ball = 5.0 * 4.0 / 3.0 * M_PI * 0.125;
  const Body& body = scene.bodies.at(0);
  EXPECT_NEAR(body.mass, box + ball, 1e-12);
  const double com = 4.0 * ball / (box + ball);
  EXPECT_NEAR((scene.state[0].x - Vec3(com, 0.0, 0.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR(scene.colliders[1].local.position.x(), 4.0 - com, 1e-14);
  // About x nothing is moved; about y and z, m_1 m_2 / (m_1 + m_2) 4^2 comes on top.
  const double between = box * ball / (box + ball) * 16.0;
  const double round = 0.4 * ball * 0.25;
  EXPECT_NEAR(body.inertia(0, 0), box / 12.0 * 13.0 + round, 1e-12);
  EXPECT_NEAR(body.inertia(1, 1), box / 12.0 * 10.0 + round + between, 1e-12);
  EXPECT_NEAR(body.inertia(2, 2), box / 12.0 * 5.0 + round + between, 1e-12);
  EXPECT_TRUE(mentions(scene, "computed from the shapes: body 'm'"));
  EXPECT_NAMES(refusal(world("<model name=\"m\"><link name=\"l\"><inertial auto=\"true\"/>"
                             "</link></model>")),
               "no <collision>");
}

/// A folder of mesh files beside a scene.
class SdfReaderMeshes : public Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("signorini-meshes-") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "models" / "thing" / "meshes");
    if (refused_here()) GTEST_SKIP() << "this build reads no mesh files";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  bool refused_here() {
    const std::string message = refusal(world(model_of("<mesh><uri>none.obj</uri></mesh>")));
    return message.find("none.obj") == std::string::npos;
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  /// The scene in this folder.
  Scene read_here(const std::string& content) const {
    write("scene.sdf", world(content));
    return read_scene_file((folder_ / "scene.sdf").string());
  }
  std::string refusal_here(const std::string& content) const {
    try {
      (void)read_here(content);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

const char* const kTetrahedron =
    "o body\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
/// An L of two boxes, 2 x 2 with a quarter missing, 1 thick: volume 3, its hull 3.5.
const char* const kAngle =
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
    "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
    "f 4 3 2 1\nf 6 5 4 1\nf 7 8 9 10\nf 7 10 11 12\n"
    "f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";

std::string mesh(const std::string& uri, const std::string& more = "",
                 const std::string& attributes = "") {
  return "<mesh" + attributes + "><uri>" + uri + "</uri>" + more + "</mesh>";
}

TEST_F(SdfReaderMeshes, DynamicIsAHullAndStaticTrianglesAndBothAreSaid) {
  write("angle.obj", kAngle);
  const Scene moving = read_here(model_of(mesh("angle.obj")));
  const auto& hull = std::get<collision::ConvexHull>(moving.colliders.at(0).shape);
  EXPECT_EQ(hull.data->vertices.size(), 10u);
  EXPECT_NEAR(hull.data->volume, 3.5, 1e-12);
  EXPECT_TRUE(mentions(moving, "body 'm' has the convex hull"));
  EXPECT_TRUE(mentions(moving, "concave: the hull has 1.167 times its volume"));

  const Scene fixed = read_here(model_of(mesh("angle.obj"), "<static>true</static>"));
  const auto& triangles = std::get<collision::TriangleMesh>(fixed.colliders.at(0).shape);
  EXPECT_EQ(triangles.data->triangles.size(), 20u);
  EXPECT_TRUE(mentions(fixed, "20 triangles as they are"));

  const Scene asked = read_here(
      model_of(mesh("angle.obj", "", " optimization=\"convex_hull\""), "<static>true</static>"));
  EXPECT_TRUE(std::holds_alternative<collision::ConvexHull>(asked.colliders.at(0).shape));
  EXPECT_TRUE(mentions(asked, "as the file asks"));
  const Scene parts = read_here(model_of(
      mesh("angle.obj", "", " optimization=\"convex_decomposition\""), "<static>true</static>"));
  EXPECT_TRUE(mentions(parts, "one hull instead of the decomposition"));
}

TEST_F(SdfReaderMeshes, ConvexMeshSaysThatNothingIsAdded) {
  write("tetrahedron.obj", kTetrahedron);
  const Scene scene = read_here(
      model_of(mesh("tetrahedron.obj", "<scale>2 3 4</scale>")) +
      "<model name=\"n\"><link name=\"l\"><collision name=\"c\"><geometry>" +
      mesh("tetrahedron.obj", "<scale>2 3 4</scale>") + "</geometry></collision></link></model>");
  const auto& hull = std::get<collision::ConvexHull>(scene.colliders.at(0).shape);
  EXPECT_NEAR(hull.data->volume, 4.0, 1e-12);
  EXPECT_TRUE(mentions(scene, "the mesh is convex: nothing is added"));
  EXPECT_TRUE(mentions(scene, "'m' and 1 more"));
  EXPECT_EQ(hull.data, std::get<collision::ConvexHull>(scene.colliders.at(1).shape).data)
      << "one file, one hull";
}

TEST_F(SdfReaderMeshes, StlColladaAndModelUrisAreRead) {
  write("triangle.stl",
        "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid t\n");
  write("models/thing/meshes/part.obj", kTetrahedron);
  write("triangle.dae",
        "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
        "version=\"1.4.1\"><asset><unit meter=\"0.01\"/><up_axis>Z_UP</up_axis></asset>"
        "<library_geometries><geometry id=\"g\" name=\"g\"><mesh><source id=\"p\"><float_array "
        "id=\"pa\" count=\"9\">0 0 0 100 0 0 0 100 0</float_array><technique_common><accessor "
        "source=\"#pa\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param "
        "name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
        "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
        "source=\"#p\"/></vertices><triangles count=\"1\"><input semantic=\"VERTEX\" "
        "source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry>"
        "</library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\">"
        "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene>"
        "<instance_visual_scene url=\"#s\"/></scene></COLLADA>");
  for (const std::string uri : {"triangle.stl", "triangle.dae", "file://triangle.stl"}) {
    const Scene scene = read_here(model_of(mesh(uri), "<static>true</static>"));
    const auto& found = std::get<collision::TriangleMesh>(scene.colliders.at(0).shape);
    ASSERT_EQ(found.data->triangles.size(), 1u) << uri;
    EXPECT_NEAR((found.data->triangles[0].normal - Vec3::UnitZ()).norm(), 0.0, 1e-6) << uri;
    EXPECT_NEAR(found.data->radius, 1.0, 1e-6) << uri;
  }
  const Scene scene = read_here(model_of(mesh("model://models/thing/meshes/part.obj")));
  EXPECT_TRUE(std::holds_alternative<collision::ConvexHull>(scene.colliders.at(0).shape));
}

TEST_F(SdfReaderMeshes, SubmeshIsOnePartOfTheFileAndCanBeCentred) {
  write("two.obj", std::string(kTetrahedron) +
                       "o far\nv 10 0 0\nv 12 0 0\nv 10 2 0\nv 10 0 2\n"
                       "f 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n");
  const std::string far = "<submesh><name>far</name><center>true</center></submesh>";
  const Scene scene = read_here(model_of(mesh("two.obj", far)));
  const auto& hull = std::get<collision::ConvexHull>(scene.colliders.at(0).shape);
  EXPECT_NEAR(hull.data->volume, 8.0 / 6.0, 1e-12);
  EXPECT_NEAR((hull.data->vertices[0] - Vec3(-1.0, -1.0, -1.0)).norm(), 0.0, 1e-12);
  EXPECT_NAMES(refusal_here(model_of(mesh("two.obj", "<submesh><name>none</name></submesh>"))),
               "no part 'none'");
}

TEST_F(SdfReaderMeshes, BadFilesAreNamedWithTheirFault) {
  write("nan.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n");
  write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4 3\n");
  write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  write("text.obj", "this is no mesh\n");
  write("unknown.xyz", "0 0 0\n");
  const auto names = [&](const std::string& uri, const std::string& in_model,
                         const std::vector<std::string>& words) {
    const std::string message = refusal_here(model_of(mesh(uri), in_model));
    EXPECT_NAMES(message, "scene.sdf:");
    EXPECT_NAMES(message, "model 'm', link 'l', collision 'c'");
    for (const std::string& word : words) EXPECT_NAMES(message, word);
  };
  const std::string fixed = "<static>true</static>";
  names("absent.obj", "", {"there is no file", "absent.obj"});
  names("model://nowhere/a.obj", "", {"model://nowhere/a.obj", "SDF_PATH"});
  names("nan.obj", fixed, {"nan.obj", "vertex 2", "finite"});
  names("flat.obj", "", {"<mesh>", "plane"});  // no hull; as triangles it is good
  EXPECT_EQ(refusal_here(model_of(mesh("flat.obj"), fixed)), "");
  names("line.obj", fixed, {"<mesh>", "area"});
  names("text.obj", fixed, {"text.obj"});
  names("unknown.xyz", fixed, {"unknown.xyz", "cannot be read as a mesh"});
  names("flat.obj", "<static>false</static>", {"<mesh>"});
  EXPECT_NAMES(refusal_here(model_of("<mesh><uri>flat.obj</uri><scale>1 0 1</scale></mesh>")),
               "<scale>");
}

TEST_F(SdfReaderMeshes, UrdfMeshesAreReadToo) {
  write("tetrahedron.obj", kTetrahedron);
  write("robot.urdf",
        "<robot name=\"r\"><link name=\"base\"><inertial><mass value=\"2\"/><inertia ixx=\"1\" "
        "ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial><collision><geometry>"
        "<mesh filename=\"tetrahedron.obj\" scale=\"2 2 2\"/></geometry></collision></link>"
        "</robot>");
  const Scene scene = read_scene_file((folder_ / "robot.urdf").string());
  const auto& hull = std::get<collision::ConvexHull>(scene.colliders.at(0).shape);
  EXPECT_NEAR(hull.data->volume, 8.0 / 6.0, 1e-12);
}

std::string shape_model(const std::string& shape) {
  return box_model("") + "<model name=\"odd\"><link name=\"l\"><collision name=\"c\"><geometry><" +
         shape + "/></geometry></collision></link></model>";
}

TEST_P(SdfReaderShapes, AreNamedOrSkippedWithANotice) {
  const std::string shape = GetParam();
  const std::string message = refusal(world(shape_model(shape)));
  EXPECT_NAMES(message, "test.sdf:");
  EXPECT_NAMES(message, "model 'odd', link 'l', collision 'c'");
  EXPECT_NAMES(message, "<" + shape + "> is not supported");

  const Scene scene = read(shape_model(shape), {.skip_unsupported = true});
  EXPECT_EQ(scene.bodies.size(), 1u) << "a body without its last shape is left out";
  EXPECT_TRUE(mentions(scene, "skipped: test.sdf:"));
  EXPECT_TRUE(mentions(scene, "'odd' has no supported shape left"));
}

INSTANTIATE_TEST_SUITE_P(Unsupported, SdfReaderShapes, testing::Values("heightmap", "image"));

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

TEST(SdfReader, DynamicPlaneIsRefused) {
  EXPECT_NAMES(refusal(world("<model name=\"m\"><link name=\"l\"><collision name=\"c\"><geometry>"
                             "<plane/></geometry></collision></link></model>")),
               "static models only");
}

TEST(SdfReader, MalformedXmlNamesTheLine) {
  EXPECT_NAMES(refusal("<sdf version='1.9'>\n<world name='w'>\n</sdf>"), "test.sdf:");
  EXPECT_NAMES(refusal("<sdf version='1.9'>\n<world name='w'>\n</sdf>"), "not well-formed XML");
  EXPECT_NAMES(refusal("<html/>"), "got <html>");
  EXPECT_NAMES(refusal(""), "not well-formed XML");
}

TEST(SdfReader, MissingFileIsNamed) {
  try {
    (void)read_scene_file("/no/such/scene.sdf");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_NAMES(std::string(error.what()), "/no/such/scene.sdf: cannot be read");
  }
}

std::string robot(const std::string& in_link) {
  return "<robot name=\"r\"><link name=\"base\"><inertial><mass value=\"2\"/>"
         "<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>" +
         in_link + "</link></robot>";
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

TEST(UrdfReader, CapsulesAndCylindersAreToldApart) {
  const Scene scene = read_scene_text(
      robot("<collision><geometry><capsule radius=\"0.1\" length=\"1\"/></geometry></collision>"
            "<collision><geometry><cylinder radius=\"0.2\" length=\"1\"/></geometry></collision>"
            "<collision><geometry><capsule radius=\"0.3\" length=\"1\"/></geometry></collision>"),
      "test.urdf");
  ASSERT_EQ(scene.colliders.size(), 3u);
  EXPECT_EQ(std::get<collision::Capsule>(scene.colliders[0].shape).radius, 0.1);
  EXPECT_EQ(std::get<collision::Cylinder>(scene.colliders[1].shape).radius, 0.2);
  EXPECT_EQ(std::get<collision::Capsule>(scene.colliders[2].shape).radius, 0.3);
}

/// What each file of the shared scenes is. gz-sim_3k_shapes.sdf is in LargeWorld below.
struct SharedFile {
  const char* name;
  int bodies;
};

class SharedScenes : public testing::TestWithParam<SharedFile> {};

TEST_P(SharedScenes, Load) {
  const std::string folder = std::string(SIGNORINI_SHARED_DIR) + "/data/scenes/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "../shared is absent";
  const Scene scene = read_scene_file(folder + GetParam().name);
  EXPECT_EQ(static_cast<int>(scene.bodies.size()), GetParam().bodies);
}

INSTANTIATE_TEST_SUITE_P(
    All, SharedScenes,
    testing::Values(SharedFile{"bullet_block.urdf", 1}, SharedFile{"bullet_capsule.urdf", 1},
                    SharedFile{"bullet_cube_small.urdf", 1},
                    SharedFile{"bullet_sphere_with_restitution.urdf", 1},
                    SharedFile{"bullet_two_cubes.sdf", 3}, SharedFile{"gz-physics_contact.sdf", 5},
                    SharedFile{"gz-physics_falling.world", 3},
                    SharedFile{"gz-physics_multiple_collisions.sdf", 2},
                    SharedFile{"gz-physics_shapes.world", 6},
                    SharedFile{"gz-physics_slip_compliance.sdf", 2},
                    SharedFile{"gz-sim_falling.sdf", 2}, SharedFile{"gz-sim_friction.sdf", 4},
                    SharedFile{"gz-sim_rolling_shapes.sdf", 6}, SharedFile{"gz-sim_shapes.sdf", 7}),
    [](const auto& scene) {
      std::string name = scene.param.name;
      for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
      return name;
    });

/// So many models that they are read one at a time; the same models in one piece are those of a
/// world that cannot be split (it has a frame).
TEST(LargeWorld, ReadOneModelAtATimeIsTheSameWorld) {
  std::string models = "<gravity>0 0 -5</gravity><light name=\"sun\" type=\"directional\"/>";
  for (int i = 0; i < 101; ++i) {
    const std::string name = "m" + std::to_string(i);
    models += "\n<model name=\"" + name + "\"><pose>" + std::to_string(3 * i) +
              " 0 1 0 0 0.5</pose><link name=\"l\"><inertial><mass>" + std::to_string(i + 1) +
              "</mass></inertial><visual name=\"v\"><geometry><box><size>1 1 1</size></box>"
              "</geometry></visual><collision name=\"c\"><geometry><cylinder><radius>1</radius>"
              "<length>2</length></cylinder></geometry></collision></link></model>";
  }
  const Scene split = read(models);
  const Scene whole = read("<frame name=\"here\"/>" + models);
  ASSERT_EQ(split.bodies.size(), 101u);
  ASSERT_EQ(whole.bodies.size(), 101u);
  EXPECT_EQ(split.gravity, whole.gravity);
  EXPECT_EQ(split.notices, whole.notices);
  EXPECT_TRUE(mentions(split, "visual (101)"));
  for (int i = 0; i < 101; ++i) {
    EXPECT_EQ(split.bodies[i].name, whole.bodies[i].name);
    EXPECT_EQ(split.bodies[i].mass, whole.bodies[i].mass);
    EXPECT_EQ(split.state[i].x, whole.state[i].x);
    EXPECT_EQ(split.state[i].q.coeffs(), whole.state[i].q.coeffs());
    EXPECT_EQ(split.colliders[i].name, whole.colliders[i].name);
    EXPECT_EQ(split.colliders[i].shape.index(), whole.colliders[i].shape.index());
  }
  // Lines are those of the file, and a name cannot be had twice.
  const std::string bad = models + "\n<model name=\"m7\"/>";
  EXPECT_NAMES(refusal(world(bad)), "test.sdf:106: model 'm7': another model");
}

TEST(SharedScenesList, IsWhole) {
  const std::filesystem::path folder = std::string(SIGNORINI_SHARED_DIR) + "/data/scenes";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "../shared is absent";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files += entry.path().extension() != ".md" ? 1 : 0;
  }
  EXPECT_EQ(files, 15) << "a scene that no test above names";
}

}  // namespace
}  // namespace signorini::validation
