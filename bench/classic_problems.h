#pragma once

#include <signorini/lcp/problem.h>

#include <cstdint>

namespace signorini::bench {

/// Murty's example: M lower triangular, 1 on the diagonal and 2 below; a P-matrix, so that every q
/// has one solution. q_i = -(2^n + 2^(n-1) + ... + 2^(n-i+1)), i = 1 .. n: Lemke's method with the
/// covering vector (1, ..., 1) takes 2^n - 1 pivots (a Lemke that scales the rows does not).
/// Source: Murty, Linear Complementarity, Linear and Nonlinear Programming (1988), section 6.1. The
/// solution is z = (2^n, 0, ..., 0).
/// @param n in [1, 50]: every number is exact. @throws std::invalid_argument otherwise.
[[nodiscard]] lcp::Problem make_murty(int n);

/// Fathi's example: M = L L^T with L Murty's matrix, symmetric positive definite (M_ii = 4 i - 3,
/// M_ij = 4 min(i, j) - 2, i = 1 .. n), and q = -(1, ..., 1). Murty's least-index method takes
/// exponentially many pivots. Source: Fathi, Computational complexity of LCPs associated with
/// positive definite symmetric matrices, Mathematical Programming 17 (1979).
/// @param n >= 1. @throws std::invalid_argument otherwise.
[[nodiscard]] lcp::Problem make_fathi(int n);

/// A dense M = B B^T / rank, B n x rank with N(0, 1) numbers, and q = w* - M z* for a random
/// complementary pair (in every row one is |N(0, 1)|, the other 0): solvable whatever the rank is.
/// @param rank in [1, n]; below n M is singular. @throws std::invalid_argument otherwise.
[[nodiscard]] lcp::Problem make_random_psd(int n, int rank, std::uint64_t seed);

}  // namespace signorini::bench
