#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

struct ContactTimeOptions {
  long throws = 100000;  ///< of all pairs together, > 0
  std::uint64_t seed = 1;
};

/// One pair of kinds of shapes.
struct ContactTimeRow {
  std::string pair;
  long throws = 0;
  long hits = 0;    ///< a contact time was returned
  long missed = 0;  ///< the gap was below 0 before it, or at any time where none was returned
  long off = 0;     ///< the gap is not 0 at it, or it is not the time that a bisection finds
  double worst_error = 0.0;  ///< of the times that a bisection finds, over what is allowed
  std::string first_wrong;   ///< the shapes, poses and velocities
};

struct ContactTimeReport {
  std::vector<ContactTimeRow> rows;
  [[nodiscard]] bool passed() const;
  [[nodiscard]] std::string to_csv() const;
};

/// Random throws of every pair of convex shapes, apart by 0.01 to 2 sizes at the start, for one
/// second. The gap is looked at 60 times up to the returned time (else the whole second) and must
/// never be below 0; at the time it must be 0; and where it then closes faster than 0.05 sizes per
/// second the time must be that of a bisection of the gap, to 1e-9 s and what the gap's own error
/// makes of it.
///
/// Allowed of a gap: 1e-8 of the smaller size (1e-9 between sphere, box and half-space) and 64
/// roundings of the pair's numbers.
[[nodiscard]] ContactTimeReport run_contact_time_study(const ContactTimeOptions& options,
                                                       std::ostream& out);

}  // namespace signorini::bench
