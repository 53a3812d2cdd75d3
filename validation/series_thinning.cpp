#include <signorini/validation/series_thinning.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace signorini::validation {
namespace {

using Indices = std::vector<std::size_t>;

/// The lowest, the highest and a NaN of y in [begin, end).
void keep_extremes(const std::vector<double>& y, std::size_t begin, std::size_t end,
                   Indices& kept) {
  std::optional<std::size_t> lowest, highest, gap;
  for (std::size_t i = begin; i < end; ++i) {
    if (std::isnan(y[i])) {
      if (!gap) gap = i;
      continue;
    }
    if (!lowest || y[i] < y[*lowest]) lowest = i;
    if (!highest || y[i] > y[*highest]) highest = i;
  }
  for (const auto& index : {lowest, highest, gap}) {
    if (index) kept.push_back(*index);
  }
}

void sort_and_unite(Indices& indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

/// The points to keep of lines with equal x; n > 2 points.
Indices kept_points(const std::vector<const Series*>& lines, std::size_t n, std::size_t stretches) {
  Indices kept = {0, n - 1};
  for (std::size_t stretch = 0; stretch < stretches; ++stretch) {
    const std::size_t begin = 1 + (n - 2) * stretch / stretches;
    const std::size_t end = 1 + (n - 2) * (stretch + 1) / stretches;
    for (const Series* line : lines) keep_extremes(line->y, begin, end, kept);
  }
  sort_and_unite(kept);
  return kept;
}

/// With as many stretches as keep no more than max_points.
Indices kept_points(const std::vector<const Series*>& lines, std::size_t max_points) {
  const std::size_t n = lines.front()->x.size();
  std::size_t stretches = (max_points - 2) / 2;
  Indices kept = kept_points(lines, n, stretches);
  while (kept.size() > max_points && stretches > 1) {
    stretches = std::max<std::size_t>(1, stretches * 2 / 3);
    kept = kept_points(lines, n, stretches);
  }
  return kept;
}

Series picked(const Series& line, const Indices& points) {
  Series result{line.name, line.engine, {}, {}};
  for (const std::size_t i : points) {
    result.x.push_back(line.x[i]);
    result.y.push_back(line.y[i]);
  }
  return result;
}

}  // namespace

std::vector<Series> thinned(const std::vector<Series>& lines, std::size_t max_points) {
  std::vector<Series> result = lines;
  std::vector<bool> done(lines.size(), false);
  for (std::size_t first = 0; first < lines.size(); ++first) {
    if (done[first] || lines[first].x.size() <= max_points) continue;

    Indices group;
    std::vector<const Series*> members;
    for (std::size_t i = first; i < lines.size(); ++i) {
      if (done[i] || lines[i].x != lines[first].x) continue;
      done[i] = true;
      group.push_back(i);
      members.push_back(&lines[i]);
    }
    const Indices points = kept_points(members, max_points);
    for (const std::size_t i : group) result[i] = picked(lines[i], points);
  }
  return result;
}

}  // namespace signorini::validation
