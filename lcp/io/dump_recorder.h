#pragma once

#include <signorini/lcp/solve_recorder.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace signorini::lcp {

/// What DumpRecorder writes, and where.
struct DumpSettings {
  enum class When : std::uint8_t { kAll, kUnsolved };

  std::filesystem::path folder;  ///< made if absent
  When when = When::kAll;        ///< kUnsolved: those whose status is not is_solved()
  bool write_folder = true;      ///< as a problem folder, DIR/000001
  bool write_hdf5 = false;       ///< as FCLIB HDF5, DIR/000001.hdf5
  int max_count = 10000;         ///< problems written, >= 1; solves beyond it are only counted

  /// Reads `DIR[:OPTION[,OPTION]...]`, the text of the environment variable SIGNORINI_DUMP.
  /// Options: all, unsolved; folder, hdf5, both; max=N. A DIR with a colon needs an option list
  /// behind it. @throws std::invalid_argument naming the option and what is known
  [[nodiscard]] static DumpSettings parse(std::string_view text);
};

/// Writes solves to files, so that they can be replayed by signorini-solve and signorini-bench
/// sequence: problem k as the folder DIR/00000k with the problem (problem_folder.h), warm_start.txt
/// (where there was one), z.txt (where the result has one) and record.json (settings and result);
/// as HDF5 with the warm start as a guess and z as the solution (fclib.h).
///
/// Numbers count the problems written, from 1, or on from the largest number in DIR. Every folder
/// and file is written whole or not at all. What cannot be written (a full disk; what FCLIB cannot
/// say) is reported in the detail of the solve's result and breaks nothing. One recorder may serve
/// several threads (the numbers then follow the order in which solves end); two processes must not
/// share a DIR. Cost: the files, some 20 bytes a number.
class DumpRecorder : public SolveRecorder {
 public:
  /// @throws std::runtime_error if the folder cannot be made or looked into; std::invalid_argument
  /// for settings out of range, or write_hdf5 in a build without HDF5
  explicit DumpRecorder(DumpSettings settings);

  std::string record(const SolveRecord& record) override;

  [[nodiscard]] int written() const { return written_; }
  /// Solves beyond max_count, not written.
  [[nodiscard]] int left_out() const { return left_out_; }
  /// Solves of which a folder or a file could not be written.
  [[nodiscard]] int failed() const { return failed_; }
  [[nodiscard]] const DumpSettings& settings() const { return settings_; }

 private:
  [[nodiscard]] std::filesystem::path name(int number, const char* extension) const;

  DumpSettings settings_;
  std::mutex mutex_;
  int next_ = 1;
  int written_ = 0;
  int left_out_ = 0;
  int failed_ = 0;
};

/// The environment variable that the programs look at.
inline constexpr const char* kDumpVariable = "SIGNORINI_DUMP";

/// A recorder as SIGNORINI_DUMP asks for it; null if it is unset or empty.
/// @throws as DumpSettings::parse() and DumpRecorder, the variable named in the message
[[nodiscard]] std::unique_ptr<DumpRecorder> dump_recorder_from_environment();

/// One line for people at a program's end: "dump: 12 solves written to DIR".
[[nodiscard]] std::string summary(const DumpRecorder& recorder);

}  // namespace signorini::lcp
