#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

struct NarrowPhaseOptions {
  int poses = 1000;   ///< of each pair, > 0
  int repeats = 200;  ///< of all poses; the time is the least, > 0
  std::uint64_t seed = 1;
  std::string pair = {};  ///< "hull-hull": this one alone; empty: every pair
};

/// One narrow phase on one pair of shapes.
struct NarrowPhaseRow {
  std::string pair;
  std::string name;
  double nanoseconds = -1.0;  ///< a query
  double points = -1.0;       ///< a pose
  double valid = -1.0;        ///< of them valid, a pose
  double corners = -1.0;      ///< of the valid ones what reduce_contacts() keeps, a pose: no point
                              ///< between others (or beside them to 1e-6) counts
  double area = -1.0;         ///< of the patches' hulls (contact_reduction.h), m^2 a pose
};

struct NarrowPhaseReport {
  std::vector<NarrowPhaseRow> rows;
  [[nodiscard]] std::string to_csv() const;
};

/// Contact sets of overlapping shapes as a stack has them (overlaps up to 2 % of the size; half of
/// the poses flush): ours, Bullet's and FCL's on the same poses. A point is valid if its two places
/// lie in their shapes to 1e-3 of the size, and its normal parts the shapes as well as the best
/// does, to the same. Ours stands there twice: with all points, and reduced to 4 of a patch, so
/// that the area says what the reduction loses.
/// @throws std::invalid_argument for an unknown pair, naming those there are
[[nodiscard]] NarrowPhaseReport run_narrow_phase_study(const NarrowPhaseOptions& options,
                                                       std::ostream& out);

}  // namespace signorini::bench
