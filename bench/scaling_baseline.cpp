#include "bench/scaling_baseline.h"

#include <signorini/lcp/io/input_error.h>

#include "bench/scaling_case.h"
#include "bench/scaling_csv.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace signorini::bench {
namespace {

using ByKey = std::map<std::string, const ScalingRow*>;

ByKey ours_by_key(const std::vector<ScalingRow>& rows) {
  ByKey all;
  for (const ScalingRow& row : rows) {
    if (row.engine == kOurEngine) {
      all[scaling_key(row)] = &row;
    }
  }
  return all;
}

void compare_counts(const std::string& key, const ScalingRow& row, const ScalingRow& stored,
                    BaselineComparison& comparison) {
  for (const auto& [name, count] : kScalingCounts) {
    const long now = row.counts.*count;
    const long then = stored.counts.*count;
    if (now < 0 || then < 0 || now == then) {
      continue;
    }
    (now > then ? comparison.worse : comparison.better)
        .push_back(fmt::format("{}: {} {}, was {}", key, name, now, then));
  }
}

void compare_times(const std::string& key, const ScalingRow& row, const ScalingRow& stored,
                   BaselineComparison& comparison) {
  for (const auto& [name, cost] : kScalingCosts) {
    if (name != "first_step_s" && name != "step_s") {
      continue;
    }
    if (row.costs.*cost > kSlower * stored.costs.*cost) {
      comparison.slower.push_back(
          fmt::format("{}: {} {:.3g}, was {:.3g}", key, name, row.costs.*cost, stored.costs.*cost));
    }
  }
}

void append(std::string_view what, const std::vector<std::string>& lines, std::string& text) {
  for (const std::string& line : lines) {
    text += fmt::format("{}: {}\n", what, line);
  }
}

}  // namespace

BaselineComparison compare(const std::vector<ScalingRow>& rows,
                           const std::vector<ScalingRow>& baseline) {
  const ByKey stored = ours_by_key(baseline);
  BaselineComparison comparison;
  for (const auto& [key, row] : ours_by_key(rows)) {
    const auto found = stored.find(key);
    if (found == stored.end()) {
      comparison.not_stored.push_back(key);
      continue;
    }
    ++comparison.compared;
    if (!row->failure.empty() && found->second->failure.empty()) {
      comparison.worse.push_back(fmt::format("{}: {}, was an answer", key, row->failure));
    }
    if (row->failure.empty() && found->second->failure.empty()) {
      compare_counts(key, *row, *found->second, comparison);
      compare_times(key, *row, *found->second, comparison);
    }
  }
  return comparison;
}

std::string to_text(const BaselineComparison& comparison) {
  std::string text =
      fmt::format("baseline: {} runs compared, {} counts worse, {} better\n", comparison.compared,
                  comparison.worse.size(), comparison.better.size());
  append("WORSE", comparison.worse, text);
  append("better", comparison.better, text);
  append("slower (no failure)", comparison.slower, text);
  append("not in the baseline", comparison.not_stored, text);
  return text;
}

std::vector<ScalingRow> read_baseline(const std::filesystem::path& file,
                                      const std::vector<ScalingRow>& planned) {
  std::vector<ScalingRow> rows = read_scaling_csv(file);
  const ByKey stored = ours_by_key(rows);
  if (std::ranges::none_of(
          planned, [&](const ScalingRow& row) { return stored.contains(scaling_key(row)); })) {
    throw lcp::InputError(file, 0,
                          "has none of the runs that were asked for, such as " +
                              (planned.empty() ? "" : scaling_key(planned.front())));
  }
  return rows;
}

}  // namespace signorini::bench
