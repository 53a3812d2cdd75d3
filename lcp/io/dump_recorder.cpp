#include <signorini/lcp/io/dump_recorder.h>
#include <signorini/lcp/io/problem_folder.h>
#include <signorini/lcp/io/result_writer.h>
#include <signorini/lcp/solver.h>

#ifdef SIGNORINI_HAS_HDF5
#include <signorini/lcp/io/fclib.h>
#endif

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fmt/format.h>
#include <map>
#include <stdexcept>
#include <utility>

namespace signorini::lcp {
namespace {

using Path = std::filesystem::path;

constexpr int kMaxNumber = 999999;

/// An integer, or nothing if the text is something else.
std::optional<int> to_int(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = error == std::errc() && end == text.data() + text.size() && !text.empty();
  return good ? std::optional(value) : std::nullopt;
}

/// @return whether the option is known
bool read_option(std::string_view option, DumpSettings& settings) {
  if (option == "all" || option == "unsolved") {
    settings.when = option == "all" ? DumpSettings::When::kAll : DumpSettings::When::kUnsolved;
    return true;
  }
  if (option == "folder" || option == "hdf5" || option == "both") {
    settings.write_folder = option != "hdf5";
    settings.write_hdf5 = option != "folder";
    return true;
  }
  if (option.starts_with("max=")) {
    const std::optional<int> count = to_int(option.substr(4));
    settings.max_count = count.value_or(0);
    return count && *count >= 1;
  }
  return false;
}

/// The largest number that names an entry of the folder, 0 if there is none.
int largest_number(const Path& folder) {
  int largest = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    largest = std::max(largest, to_int(entry.path().stem().string()).value_or(0));
  }
  return largest;
}

std::map<std::string, std::string> files_beside(const SolveRecord& record) {
  std::map<std::string, std::string> files;
  files["record.json"] = record_json(record);
  if (record.warm_start != nullptr && record.warm_start->allFinite()) {  // else it was not used
    files["warm_start.txt"] = vector_text(*record.warm_start);
  }
  if (record.result.z.allFinite()) {
    files["z.txt"] = vector_text(record.result.z);
  }
  return files;
}

#ifdef SIGNORINI_HAS_HDF5
void write_hdf5(const SolveRecord& record, const Path& file) {
  FclibProblem fclib;
  fclib.problem = record.problem;
  fclib.title = "signorini solve";
  fclib.description =
      fmt::format("solver {}, status {}", record.solver, to_string(record.result.status));
  if (record.warm_start != nullptr && record.warm_start->allFinite()) {
    fclib.guesses.push_back(*record.warm_start);
  }
  if (record.result.z.allFinite()) {
    fclib.solution = record.result.z;
  }
  write_fclib(fclib, file);
}
#endif

}  // namespace

DumpSettings DumpSettings::parse(std::string_view text) {
  DumpSettings settings;
  const std::size_t colon = text.rfind(':');
  settings.folder = Path(text.substr(0, colon));
  std::string_view options =
      colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
  if (settings.folder.empty()) {
    throw std::invalid_argument("expected DIR[:OPTION,...], found no folder");
  }
  while (!options.empty()) {
    const std::string_view option = options.substr(0, options.find(','));
    options.remove_prefix(std::min(options.size(), option.size() + 1));
    if (!read_option(option, settings)) {
      throw std::invalid_argument(fmt::format(
          "expected one of all, unsolved, folder, hdf5, both, max=N (N >= 1), found '{}'", option));
    }
  }
  return settings;
}

DumpRecorder::DumpRecorder(DumpSettings settings) : settings_(std::move(settings)) {
  if (settings_.max_count < 1) {
    throw std::invalid_argument(
        fmt::format("dump: max_count: must be >= 1, got {}", settings_.max_count));
  }
#ifndef SIGNORINI_HAS_HDF5
  if (settings_.write_hdf5) {
    throw std::invalid_argument("dump: this build has no HDF5 (SIGNORINI_WITH_HDF5=OFF)");
  }
#endif
  std::filesystem::create_directories(settings_.folder);
  next_ = largest_number(settings_.folder) + 1;
}

Path DumpRecorder::name(int number, const char* extension) const {
  return settings_.folder / fmt::format("{:06}{}", number, extension);
}

std::string DumpRecorder::record(const SolveRecord& record) {
  if (settings_.when == DumpSettings::When::kUnsolved && is_solved(record.result.status)) {
    return {};
  }
  const std::lock_guard lock(mutex_);
  if (written_ >= settings_.max_count || next_ > kMaxNumber) {
    ++left_out_;
    return {};
  }
  std::string failures;
  const auto attempt = [&failures](const auto& write) {
    try {
      write();
      return true;
    } catch (const std::exception& error) {
      failures += (failures.empty() ? "dump: " : "; ") + std::string(error.what());
      return false;
    }
  };
  bool any = false;
  if (settings_.write_folder) {
    any |= attempt(
        [&] { write_problem_folder(record.problem, name(next_, ""), files_beside(record)); });
  }
#ifdef SIGNORINI_HAS_HDF5
  if (settings_.write_hdf5) {
    any |= attempt([&] { write_hdf5(record, name(next_, ".hdf5")); });
  }
#endif
  next_ += any ? 1 : 0;
  written_ += any ? 1 : 0;
  failed_ += failures.empty() ? 0 : 1;
  return failures;
}

std::unique_ptr<DumpRecorder> dump_recorder_from_environment() {
  const char* text = std::getenv(kDumpVariable);
  if (text == nullptr || *text == '\0') {
    return nullptr;
  }
  try {
    return std::make_unique<DumpRecorder>(DumpSettings::parse(text));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", kDumpVariable, error.what()));
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", kDumpVariable, error.what()));
  }
}

std::string summary(const DumpRecorder& recorder) {
  std::string text = fmt::format("dump: {} solves written to {}", recorder.written(),
                                 recorder.settings().folder.string());
  if (recorder.left_out() > 0) {
    text +=
        fmt::format(", {} left out beyond {}", recorder.left_out(), recorder.settings().max_count);
  }
  if (recorder.failed() > 0) {
    text += fmt::format(", {} not written by an error (see their detail)", recorder.failed());
  }
  return text;
}

}  // namespace signorini::lcp
