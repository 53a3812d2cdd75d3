#include <signorini/lcp/io/problem_folder.h>
#include <signorini/lcp/io/recorded_solve.h>
#include <signorini/lcp/io/text_lines.h>

#ifdef SIGNORINI_HAS_HDF5
#include <signorini/lcp/io/fclib.h>
#endif

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

namespace signorini::lcp {
namespace {

using Path = std::filesystem::path;
using Json = nlohmann::json;

bool is_hdf5(const Path& path) {
  return path.extension() == ".hdf5" || path.extension() == ".h5";
}

bool is_problem_folder(const Path& path) {
  std::error_code error;
  return std::filesystem::exists(path / "problem.txt", error);
}

/// A number of record.json, where null is "none" and infinity a string.
double number(const Json& json, double none) {
  if (json.is_string() && json.get<std::string>() == "inf") {
    return std::numeric_limits<double>::infinity();
  }
  return json.is_null() ? none : json.get<double>();
}

int counter(const Json& json) {
  return json.is_null() ? -1 : json.get<int>();
}

void read_record(const Path& file, RecordedSolve& recorded) {
  std::ifstream stream(file);
  try {
    const Json json = Json::parse(stream);
    const Json& settings = json.at("settings");
    const Json& result = json.at("result");
    recorded.solver = json.at("solver").get<std::string>();
    recorded.settings.tolerance = number(settings.at("tolerance"), 0.0);
    recorded.settings.max_iterations = counter(settings.at("max_iterations"));
    recorded.settings.time_limit = number(settings.at("time_limit"), 0.0);
    recorded.settings.validate();
    recorded.status = result.at("status").get<std::string>();
    recorded.work = std::max(counter(result.at("pivots")), counter(result.at("iterations")));
    recorded.seconds = number(result.at("solve_seconds"), -1.0);
  } catch (const Json::exception& error) {
    throw InputError(file, 0, error.what());
  } catch (const std::invalid_argument& error) {
    throw InputError(file, 0, error.what());
  }
}

}  // namespace

Vector read_numbers(const Path& file, Index size) {
  TextLines lines(file);
  std::vector<double> numbers;
  while (lines.next_nonblank()) {
    numbers.push_back(lines.number("value"));
    lines.expect_end_of_line("the value");
  }
  if (static_cast<Index>(numbers.size()) != size) {
    throw InputError(file, 0,
                     "expected " + std::to_string(size) + " numbers, one a line, found " +
                         std::to_string(numbers.size()));
  }
  return Eigen::Map<const Vector>(numbers.data(), size);
}

RecordedSolve read_recorded_solve(const Path& path) {
  RecordedSolve recorded;
  if (is_hdf5(path)) {
#ifdef SIGNORINI_HAS_HDF5
    FclibProblem fclib = read_fclib(path);
    recorded.problem = std::move(fclib.problem);
    recorded.notes = std::move(fclib.notes);
    if (!fclib.guesses.empty()) {
      recorded.warm_start = std::move(fclib.guesses.front());
    }
    return recorded;
#else
    throw InputError(path, 0, "an HDF5 file; this build has no HDF5 (SIGNORINI_WITH_HDF5=OFF)");
#endif
  }
  recorded.problem = read_problem(path);
  std::error_code error;
  if (std::filesystem::exists(path / "warm_start.txt", error)) {
    recorded.warm_start = read_numbers(path / "warm_start.txt", recorded.problem.size());
  }
  if (std::filesystem::exists(path / "record.json", error)) {
    read_record(path / "record.json", recorded);
  }
  return recorded;
}

std::vector<Path> list_problems(const Path& folder) {
  if (is_hdf5(folder) || is_problem_folder(folder)) {
    return {folder};
  }
  std::vector<Path> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (is_problem_folder(entry.path()) || is_hdf5(entry.path())) {
      found.push_back(entry.path());
    }
  }
  if (error) {
    throw InputError(folder, 0, "expected a folder of problems: " + error.message());
  }
  if (found.empty()) {
    throw InputError(folder, 0, "expected problem folders or .hdf5 files in it, found none");
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace signorini::lcp
