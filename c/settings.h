#pragma once

#include <signorini/lcp/solver.h>

#include <memory>
#include <string>
#include <string_view>

namespace signorini::c {

/// The settings of a handle that solves, by name: SolverSettings and where to dump.
struct NamedSettings {
  lcp::SolverSettings lcp;
  std::shared_ptr<lcp::SolveRecorder> recorder;  ///< owns what lcp.recorder points to

  /// "tolerance", "max_iterations", "time_limit", "certify_islands",
  /// "quick_certificate".
  /// @throws std::invalid_argument for another name, or a value out of range
  void set_number(std::string_view name, double value);
  /// "dump": see DumpSettings::parse(); "": none. @throws std::invalid_argument as set_number();
  /// where the folder cannot be made or the build has no lcp/io, too
  void set_text(std::string_view name, const std::string& value);
};

/// `value` as a whole number. @throws std::invalid_argument that names the setting unless it is one
[[nodiscard]] int whole_number(std::string_view setting, double value);

/// `value` as a switch. @throws std::invalid_argument that names the setting unless it is 0 or 1
[[nodiscard]] bool flag(std::string_view setting, double value);

}  // namespace signorini::c
