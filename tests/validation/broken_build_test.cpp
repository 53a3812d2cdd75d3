// A report must fail where the solver is broken. Each executable that is made of this file links a
// source of ours with one line changed (tests/validation/CMakeLists.txt), and names the scenes that
// must fail and those that the change cannot reach.

#include <signorini/validation/builtin_scenes.h>

#include <gtest/gtest.h>
#include <sstream>
#include <string>

namespace signorini::validation {
namespace {

SceneReport run(const std::string& name) {
  RunOptions options;
  options.bullet = false;
  options.studies = false;
  options.duration = 0.5;
  return validate_builtin(*find_builtin_scene(name), options);
}

void expect(const std::string& scenes, Verdict verdict) {
  std::istringstream names(scenes);
  std::string name;
  while (names >> name) {
    EXPECT_EQ(run(name).verdict(), verdict) << name;
  }
}

TEST(BrokenBuild, FailsWhereItIsBroken) {
  expect(SIGNORINI_BROKEN_SCENES, Verdict::kFail);
}

TEST(BrokenBuild, PassesWhereTheDefectIsNotMet) {
  expect(SIGNORINI_SOUND_SCENES, Verdict::kPass);
}

}  // namespace
}  // namespace signorini::validation
