#pragma once

#include <signorini/lcp/exact_solution.h>

#include <gmpxx.h>
#include <optional>
#include <vector>

namespace signorini::bench {

/// Decides whether w = M z + q, z >= 0, w >= 0, z.w = 0 has a solution, by brute force and without
/// any pivoting rule: q must lie in one of the complementary cones. Every cone's point is a
/// non-negative combination of linearly independent generators of that cone (Caratheodory), so
/// every choice of e_i, -M_i or neither is tried, singular cones included: 3^n linear systems in
/// rationals. n = 6 takes milliseconds; each further row three times as long.
///
/// @return z of the first solution found, or nothing: there is none.
/// Source: Cottle, Pang, Stone, The Linear Complementarity Problem (1992), section 1.3.
[[nodiscard]] std::optional<std::vector<mpq_class>> find_in_complementary_cones(
    const lcp::ExactProblem& problem);

}  // namespace signorini::bench
