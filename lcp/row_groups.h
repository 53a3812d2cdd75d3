#pragma once

#include <signorini/lcp/row_coloring.h>
#include <signorini/lcp/scaled_rows.h>

#include <array>
#include <span>
#include <vector>

namespace signorini::lcp {

/// The order in which sweeps take the rows.
enum class RowOrder : std::uint8_t {
  kNatural,   ///< the caller's
  kColoured,  ///< colour by colour (row_coloring.h), within a colour the caller's
};

/// Which rows go into which record (sweep_kernels.h), in the order of a sweep: consecutive rows on
/// the same two blocks together, up to four; coloured, also four single rows of a colour.
class RowGroups {
 public:
  struct Group {
    std::array<int, kLanes> rows;
    RowForm form;
    RowKind kind;
    bool general;  ///< one row for the plain loop; form and kind say nothing
  };

  /// Allocates nothing once capacity is reached.
  void set(const ScaledRows& scaled, std::span<const SweepRow> rows, RowOrder order);

  /// As a sweep takes them.
  [[nodiscard]] std::span<const Group> groups() const { return groups_; }
  /// Where a colour starts among the groups, and then where the last one ends: colours that share
  /// nothing, one entry a colour and one more. The groups behind may share. Natural order: {0}.
  [[nodiscard]] std::span<const int> color_starts() const { return color_starts_; }

 private:
  void collect(const ScaledRows& scaled);
  void color(const ScaledRows& scaled, std::span<const SweepRow> rows);
  void order_by_color();
  void make_packets(int first, int last);

  std::vector<Group> groups_;
  std::vector<int> color_starts_;
  RowColoring coloring_;
  std::vector<int> resource_starts_;
  std::vector<int> resources_;
  std::vector<int> bucket_starts_;
  std::vector<Group> ordered_;
};

}  // namespace signorini::lcp
