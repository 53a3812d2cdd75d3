#pragma once

#include <signorini/lcp/problem.h>

#include <cstdint>
#include <string>

namespace signorini::bench {

/// A random or adversarial problem, and how it was made.
struct FuzzProblem {
  lcp::Problem problem;
  std::string recipe;  ///< "psd-repeated, rows scaled, q = 0"
};

/// Problem `index` of the stream with this seed, the same whatever else is drawn: n = 1 .. 30, most
/// <= 8. It starts as an exactness family (exactness_families.h), as a random positive semidefinite
/// or arbitrary matrix, or factored with masses from 1e-150 to 1e150; then some of these are done
/// to it: units scaled by powers of ten to 1e+-150 (rarely beyond), rows scaled apart, a row
/// repeated, rows and columns of zeros, entries moved by one rounding or by 1e-9, q = 0, q made
/// solvable, a 1 x 1 near 0, a value that is NaN or infinite; bounds, fixed and free rows, crossed
/// bounds; coupled limits; friction cones of both laws.
[[nodiscard]] FuzzProblem draw_fuzz_problem(std::uint64_t seed, std::int64_t index);

}  // namespace signorini::bench
