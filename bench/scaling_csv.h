#pragma once

#include "bench/scaling_row.h"

#include <filesystem>
#include <string>
#include <vector>

namespace signorini::bench {

/// scaling.csv: a head and a line a row. Costs that are not known are "nan", counts -1.
[[nodiscard]] std::string write_scaling_csv(const std::vector<ScalingRow>& rows);

/// Reads what write_scaling_csv() wrote.
/// @throws lcp::InputError naming file, line, field, value and what it must be: another head,
/// another number of fields, numbers that are none or out of range, two rows of one run, no rows
[[nodiscard]] std::vector<ScalingRow> read_scaling_csv(const std::filesystem::path& file);

}  // namespace signorini::bench
