// Files that include files: what never ends is refused before libsdformat follows it.
#include <signorini/validation/xml_includes.h>

#include "tests/lcp/temporary_folder.h"
#include "tests/validation/sdf_text.h"

#include <filesystem>
#include <sys/stat.h>

namespace signorini::validation {
namespace {

class SdfIncludes : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  /// <include> of a file of the folder.
  std::string include(const std::string& name, const std::string& as) const {
    return "<include><name>" + as + "</name><uri>" + path(name) + "</uri></include>\n";
  }
  void write(const std::string& name, const std::string& root) const {
    folder_.write(name, "<sdf version=\"1.9\">\n" + root + "</sdf>");
  }
  void write_model(const std::string& name, const std::string& content) const {
    write(name, "<model name=\"m\">\n" + content + "<link name=\"l\"/></model>");
  }
  /// The message of the refusal; empty if there is none.
  std::string refusal_of(const std::string& name) const {
    try {
      (void)read_scene_file(path(name));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  lcp::TemporaryFolder folder_;
};

TEST_F(SdfIncludes, AModelIncludedTwiceIsTwoModels) {
  write_model("m.sdf", "");
  write("world.sdf",
        "<world name=\"w\">" + include("m.sdf", "a") + include("m.sdf", "b") + "</world>");
  EXPECT_EQ(read_scene_file(path("world.sdf")).bodies.size(), 2u);
}

/// A list of jobs takes over what was finished only while all of these are the same.
TEST_F(SdfIncludes, TheSceneNamesEveryFileThatItWasMadeOf) {
  write_model("inner.sdf", "");
  write_model("outer.sdf", include("inner.sdf", "i"));
  write("world.sdf",
        "<world name=\"w\">" + include("outer.sdf", "a") + include("inner.sdf", "b") + "</world>");
  const auto file = [&](const char* name) {
    return std::filesystem::weakly_canonical(path(name)).string();
  };
  EXPECT_EQ(read_scene_file(path("world.sdf")).files,
            (std::vector<std::string>{file("inner.sdf"), file("outer.sdf")}));
  EXPECT_TRUE(read_scene_file(path("inner.sdf")).files.empty());
}

TEST_F(SdfIncludes, AFileThatIncludesItselfIsNamed) {
  write_model("m.sdf", include("m.sdf", "a"));
  EXPECT_NAMES(refusal_of("m.sdf"), "m.sdf:3: model 'm': <include>: " + path("m.sdf"));
  EXPECT_NAMES(refusal_of("m.sdf"), "includes itself");
}

TEST_F(SdfIncludes, AFileWithoutAnElementIsRefused) {
  folder_.write("nothing.sdf", "<!-- nothing -->");
  write("world.sdf", "<world name=\"w\">" + include("nothing.sdf", "a") + "</world>");
  EXPECT_NAMES(refusal_of("world.sdf"), "nothing.sdf");
}

TEST_F(SdfIncludes, ALoopThroughOtherFilesIsNamed) {
  write_model("a.sdf", include("b.sdf", "b"));
  write_model("b.sdf", include("a.sdf", "a"));
  write("world.sdf", "<world name=\"w\">" + include("a.sdf", "a") + "</world>");
  EXPECT_NAMES(refusal_of("world.sdf"), "b.sdf:3: model 'm': <include>: " + path("a.sdf"));
}

TEST_F(SdfIncludes, ALoopThroughAModelFolderIsNamed) {
  std::filesystem::create_directory(folder_.path() / "folder");
  folder_.write("folder/model.config",
                "<model><name>m</name><sdf version=\"1.9\">model.sdf</sdf></model>");
  write_model("folder/model.sdf", include("folder", "a"));
  EXPECT_NAMES(refusal_of("folder/model.sdf"), "includes itself");
}

/// Thirty short files, each of which includes the next one twice: 2^30 models.
TEST_F(SdfIncludes, FilesThatDoubleAreRefusedWithTheirNumber) {
  write_model("0.sdf", "");
  for (int k = 1; k <= 30; ++k) {
    const std::string next = std::to_string(k - 1) + ".sdf";
    write_model(std::to_string(k) + ".sdf", include(next, "a") + include(next, "b"));
  }
  EXPECT_NAMES(refusal_of("30.sdf"), "at most 1000 in all");
}

TEST_F(SdfIncludes, AChainOfFilesHasADeepestOne) {
  write_model("0.sdf", "");
  for (int k = 1; k <= kDeepestInclude + 1; ++k) {
    write_model(std::to_string(k) + ".sdf", include(std::to_string(k - 1) + ".sdf", "a"));
  }
  EXPECT_NAMES(refusal_of(std::to_string(kDeepestInclude + 1) + ".sdf"), "at most 50 deep");
}

TEST_F(SdfIncludes, WhatIsNoFileIsNotRead) {
  ASSERT_EQ(mkfifo(path("pipe.sdf").c_str(), 0600), 0);
  EXPECT_NAMES(refusal_of("pipe.sdf"), "cannot be read");
  EXPECT_NAMES(refusal_of("../../dev/zero"), "cannot be read");
  write_model("m.sdf", include("pipe.sdf", "a"));
  EXPECT_NAMES(refusal_of("m.sdf"), "pipe.sdf is not a file");
}

/// A million levels: the parser has its own bound, and no stack ends.
TEST(SdfReader, DeepXmlIsRefused) {
  std::string text;
  for (int k = 0; k < 1'000'000; ++k) text += "<model name='m'>";
  EXPECT_NAMES(refusal("<sdf version='1.9'>" + text), "XML_ELEMENT_DEPTH_EXCEEDED");
}

}  // namespace
}  // namespace signorini::validation
