#pragma once

#include <signorini/core/response/assembly.h>
#include <signorini/lcp/solver.h>

namespace signorini {

/// Contact forces of least norm.
struct LeastNorm {
  int redundancy = 0;                         ///< columns of Z
  lcp::Status status = lcp::Status::kNotRun;  ///< of the LCP; kSolved if there was none to solve
  lcp::Vector forces;                         ///< the new g if solved, else the old one
};

/// Among all g >= 0 that vanish where g may not act and put the same force and torque on every body
/// as a given g*, the one of least |g|.
///
/// With P the contacts where g may act and Z an orthonormal basis of the null space of J_P^T, every
/// candidate is g* + Z y. Where the one of least norm without g >= 0, g_0 = g* - Z Z^T g*, has a
/// negative entry, the KKT conditions of min |g|^2, g >= 0, are the LCP
///
///     0 <= alpha ⊥ g = Z Z^T alpha + g_0 >= 0,
///
/// with a positive semidefinite matrix, and feasible since g* is. The answer is unique, and depends
/// on the order of the contacts by rounding alone. Rank: column-pivoted QR of J_P, pivots below
/// 1e-12 of the largest are redundant. Cost: O(n^2 degrees of freedom).
/// @param g g* >= 0, N. @param active P: true where g may act; g* = 0 elsewhere
[[nodiscard]] LeastNorm least_norm(const NormalRows& rows, const lcp::VectorRef& g,
                                   const std::vector<bool>& active, lcp::Solver& solver);

}  // namespace signorini
