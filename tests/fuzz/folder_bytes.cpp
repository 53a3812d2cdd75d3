#include <signorini/lcp/io/problem_folder.h>

#include "byte_reader.h"
#include "lcp_bytes.h"
#include "tests/lcp/temporary_folder.h"

#include <array>
#include <string>

namespace signorini::testing {
namespace {

constexpr std::array kFiles = {"problem.txt", "W.mtx",    "q.mtx",      "lower.mtx",
                               "upper.mtx",   "mu.mtx",   "limits.txt", "cones.txt",
                               "H.mtx",       "M.mtx",    "f.mtx",      "w.mtx",
                               "L.mtx",       "Minv.mtx", "blocks.txt", "compliance.mtx"};

/// The text of a folder's files in a fixed order: two problems are the same if these are.
std::string content(const std::filesystem::path& folder) {
  std::string all;
  for (const char* file : kFiles) {
    if (std::filesystem::exists(folder / file)) {
      all += std::string(file) + "\n" + lcp::read_text(folder / file);
    }
  }
  return all;
}

}  // namespace

void judge_folder_bytes(const std::uint8_t* data, std::size_t size) {
  ByteReader bytes(data, size);
  const lcp::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "in");
  for (std::size_t k = 0; k < kFiles.size() && !bytes.at_end(); ++k) {
    const std::string text = bytes.text();
    if (!text.empty()) {
      folder.write(std::string("in/") + kFiles[k], text);
    }
  }
  lcp::Problem problem;
  try {
    problem = lcp::read_problem(folder.path() / "in");
  } catch (const lcp::InputError& error) {
    require(error.what()[0] != '\0', "an InputError has a text");
    return;
  }
  lcp::check_shapes(problem);
  lcp::write_problem_folder(problem, folder.path() / "once");
  lcp::write_problem_folder(lcp::read_problem(folder.path() / "once"), folder.path() / "twice");
  require(content(folder.path() / "once") == content(folder.path() / "twice"),
          "a problem is read back as it was written");
}

}  // namespace signorini::testing
