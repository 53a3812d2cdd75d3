#include <signorini/validation/series_thinning.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace signorini::validation {
namespace {

/// The indices in [begin, end) worth keeping, ascending and distinct.
std::vector<std::size_t> extremes(const std::vector<double>& y, std::size_t begin,
                                  std::size_t end) {
  std::optional<std::size_t> lowest, highest, gap;
  for (std::size_t i = begin; i < end; ++i) {
    if (std::isnan(y[i])) {
      if (!gap) gap = i;
      continue;
    }
    if (!lowest || y[i] < y[*lowest]) lowest = i;
    if (!highest || y[i] > y[*highest]) highest = i;
  }
  std::vector<std::size_t> kept;
  for (const auto& index : {lowest, highest, gap}) {
    if (index) kept.push_back(*index);
  }
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

}  // namespace

Series thinned(const Series& series, std::size_t stretches) {
  const std::size_t n = series.y.size();
  if (n <= 2 * stretches + 2) return series;

  Series result{series.name, series.engine, {}, {}};
  const auto keep = [&](std::size_t i) {
    result.x.push_back(series.x[i]);
    result.y.push_back(series.y[i]);
  };
  keep(0);
  for (std::size_t stretch = 0; stretch < stretches; ++stretch) {
    const std::size_t begin = 1 + (n - 2) * stretch / stretches;
    const std::size_t end = 1 + (n - 2) * (stretch + 1) / stretches;
    for (const std::size_t i : extremes(series.y, begin, end)) keep(i);
  }
  keep(n - 1);
  return result;
}

}  // namespace signorini::validation
