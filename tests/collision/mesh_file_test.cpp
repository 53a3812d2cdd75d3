#include <signorini/collision/mesh_file.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <stdexcept>

namespace signorini::collision {
namespace {

class MeshFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("signorini-mesh-file-") +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  static std::string refusal(const std::string& path, const std::string& part = "") {
    try {
      (void)read_mesh_file(path, part);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

/// A unit cube of squares, fronts outside.
const std::string kCube =
    "o cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST_F(MeshFile, PolygonsBecomeTrianglesThatEncloseTheVolume) {
  const TriangleSoup soup = read_mesh_file(write("cube.obj", kCube));
  EXPECT_EQ(soup.triangles.size(), 12u);
  EXPECT_TRUE(is_closed(soup));
  EXPECT_NEAR(enclosed_volume(soup), 1.0, 1e-12);
}

TEST_F(MeshFile, AMissingFaceIsSeen) {
  std::string open = kCube;
  open.resize(open.rfind("f "));
  EXPECT_FALSE(is_closed(read_mesh_file(write("open.obj", open))));
}

TEST_F(MeshFile, PartsAreFoundByName) {
  const std::string two = kCube + "o flag\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 9 10 11\n";
  const std::string path = write("two.obj", two);
  EXPECT_EQ(read_mesh_file(path).triangles.size(), 13u);
  EXPECT_EQ(read_mesh_file(path, "flag").triangles.size(), 1u);
  const std::string message = refusal(path, "sail");
  EXPECT_NE(message.find("no part 'sail'"), std::string::npos) << message;
  EXPECT_NE(message.find("'cube'"), std::string::npos) << message;
}

TEST_F(MeshFile, FaultsAreNamedWithTheFile) {
  EXPECT_NE(refusal((folder_ / "absent.stl").string()).find("there is no such file"),
            std::string::npos);
  EXPECT_NE(refusal(folder_.string()).find("there is no such file"), std::string::npos);
  EXPECT_NE(refusal(write("empty.stl", "")).find("empty.stl: cannot be read as a mesh"),
            std::string::npos);
  EXPECT_NE(refusal(write("a.txt", "hello")).find("cannot be read as a mesh"), std::string::npos);
  EXPECT_NE(refusal(write("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")), "");
  for (const std::string bad : {"nan", "inf"}) {
    const std::string message =
        refusal(write(bad + ".obj", "v 0 0 0\nv 1 0 0\nv " + bad + " 1 0\nf 1 2 3\n"));
    EXPECT_NE(message.find("vertex 2: must be finite"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace signorini::collision
