#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>

#include "tests/validation/sdf_text.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace signorini::validation {
namespace {

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

TEST(SdfReader, DynamicPlaneIsRefused) {
  EXPECT_NAMES(refusal(world("<model name=\"m\"><link name=\"l\"><collision name=\"c\"><geometry>"
                             "<plane/></geometry></collision></link></model>")),
               "static models only");
}

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
  EXPECT_FALSE(mentions(scene, "without <mass>"));
  EXPECT_FALSE(mentions(scene, "Attribute[auto]"));  // libsdformat 12's, which does not act on it
  EXPECT_NAMES(refusal(world("<model name=\"m\"><link name=\"l\"><inertial auto=\"true\"/>"
                             "</link></model>")),
               "no <collision>");
}

class SdfReaderShapes : public testing::TestWithParam<const char*> {};

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

/// A folder of mesh files beside a scene.
class SdfReaderMeshes : public testing::Test {
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
  EXPECT_EQ(scene.files, std::vector<std::string>{(folder_ / "tetrahedron.obj").string()});
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

}  // namespace
}  // namespace signorini::validation
