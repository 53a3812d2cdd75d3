#pragma once

#include "bench/scaling_row.h"

#include <filesystem>
#include <string>
#include <vector>

namespace signorini::bench {

/// A run compared with a stored one of the same program's making.
struct BaselineComparison {
  int compared = 0;                     ///< rows of ours that both have
  std::vector<std::string> worse;       ///< counts that grew, and answers that are gone: failures
  std::vector<std::string> better;      ///< counts that fell
  std::vector<std::string> slower;      ///< steps that take more than kSlower times as long: told
  std::vector<std::string> not_stored;  ///< rows that the baseline does not have

  [[nodiscard]] bool passed() const { return worse.empty(); }
};
/// Times of a busy machine differ by so much with no reason.
inline constexpr double kSlower = 1.25;

/// Rows of ours alone; those that only the baseline has are another size of run, and no failure.
[[nodiscard]] BaselineComparison compare(const std::vector<ScalingRow>& rows,
                                         const std::vector<ScalingRow>& baseline);

[[nodiscard]] std::string to_text(const BaselineComparison& comparison);

/// Reads a baseline for a run that is to have these rows.
/// @throws lcp::InputError as read_scaling_csv(), and where none of them is in it
[[nodiscard]] std::vector<ScalingRow> read_baseline(const std::filesystem::path& file,
                                                    const std::vector<ScalingRow>& planned);

}  // namespace signorini::bench
