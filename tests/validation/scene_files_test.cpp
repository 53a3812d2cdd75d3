#include "tests/validation/sdf_text.h"

#include <cctype>
#include <filesystem>

namespace signorini::validation {
namespace {

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
