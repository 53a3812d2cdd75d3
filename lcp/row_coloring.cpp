#include <signorini/lcp/row_coloring.h>

#include <algorithm>
#include <bit>

namespace signorini::lcp {

void RowColoring::set(std::span<const int> starts, std::span<const int> resources,
                      int resource_count) {
  const std::size_t groups = starts.empty() ? 0 : starts.size() - 1;
  taken_.assign(resource_count, 0);
  colors_.resize(groups);
  color_count_ = 0;
  for (std::size_t k = 0; k < groups; ++k) {
    const auto mine = resources.subspan(starts[k], starts[k + 1] - starts[k]);
    std::uint64_t taken = 0;
    for (const int resource : mine) {
      taken |= taken_[resource];
    }
    colors_[k] = std::countr_one(taken);
    if (colors_[k] == kColors) {
      continue;
    }
    color_count_ = std::max(color_count_, colors_[k] + 1);
    for (const int resource : mine) {
      taken_[resource] |= std::uint64_t{1} << colors_[k];
    }
  }
}

}  // namespace signorini::lcp
