#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace signorini::lcp {

/// Colours for groups of rows so that two groups of one colour share nothing (no block of
/// velocities, no normal row): in which order, or on how many threads, a colour's groups are swept
/// cannot change a bit. Greedy: in the given order, the first colour that is free.
class RowColoring {
 public:
  /// A group that finds kColors colours taken (a block with more groups than that) gets this one,
  /// whose groups may share and are swept one after the other.
  static constexpr int kColors = 64;

  /// @param starts group k uses resources[starts[k]] .. resources[starts[k + 1] - 1]
  /// @param resource_count resources are 0 .. resource_count - 1
  /// Cost: one look at each resource of each group. Allocates nothing once capacity is reached.
  void set(std::span<const int> starts, std::span<const int> resources, int resource_count);

  [[nodiscard]] std::span<const int> colors() const { return colors_; }  ///< of every group
  /// Colours that share nothing; at most kColors.
  [[nodiscard]] int color_count() const { return color_count_; }

 private:
  std::vector<std::uint64_t> taken_;  // a resource's colours, one bit each
  std::vector<int> colors_;
  int color_count_ = 0;
};

}  // namespace signorini::lcp
