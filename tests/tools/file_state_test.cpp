#include "tools/file_state.h"

#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace signorini::tools {
namespace {

TEST(FileState, ChangesWithTheFile) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("signorini-state-" + std::to_string(::getpid()));
  EXPECT_EQ(file_state(file), file.string() + " absent");
  std::ofstream(file) << "one";
  const std::string one = file_state(file);
  EXPECT_EQ(one.rfind(file.string() + " 3 ", 0), 0U) << one;
  EXPECT_EQ(file_state(file), one);
  std::filesystem::last_write_time(
      file, std::filesystem::last_write_time(file) + std::chrono::seconds(1));
  EXPECT_NE(file_state(file), one) << "touched";
  std::ofstream(file) << "three";
  EXPECT_NE(file_state(file), one) << "longer";
  std::filesystem::remove(file);
}

TEST(FileState, TheCLibraryIsALibraryOfThisProcess) {
  const std::string states = library_states();
  EXPECT_NE(states.find("/libc.so"), std::string::npos) << states;
  EXPECT_EQ(states.find("absent"), std::string::npos) << states;
  EXPECT_EQ(library_states(), states);
}

}  // namespace
}  // namespace signorini::tools
