#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/solver.h>

#include <gmpxx.h>
#include <limits>
#include <vector>

namespace signorini::lcp {

/// An LCP in rational numbers: w = M z + q, z >= 0, w >= 0, z.w = 0.
struct ExactProblem {
  int n = 0;
  std::vector<mpq_class> M;  ///< n x n, row by row
  std::vector<mpq_class> q;  ///< n

  [[nodiscard]] const mpq_class& at(int row, int column) const { return M[row * n + column]; }
};

/// The problem that the doubles state, converted without rounding. A factored M is multiplied out
/// in rationals as J W J^T + diag(c), with the W that BlockMass::apply_inverse() applies: the
/// inverse mass given, or L^-T L^-1 of the Cholesky factor L kept for a mass. So this is the same
/// matrix that certify() and judge_ray() use; it differs from the one of the mass given by the
/// rounding of L alone, and no proof of infeasibility depends on that rounding: A y <= 0 for a
/// y >= 0 means J^T y = 0 and c y = 0, whatever W is positive definite.
///
/// @param problem an LCP (is_lcp()) of finite numbers, shapes checked
[[nodiscard]] ExactProblem to_rational(const Problem& problem);

/// How solve_exactly() ended.
enum class ExactEnding {
  kSolution,    ///< z solves the problem, exactly
  kRay,         ///< Lemke's secondary ray; what it proves is said beside it
  kPivotLimit,  ///< z is the last basic solution
  kTimeLimit,   ///< z is the last basic solution
};

/// How often solve_exactly() starts again.
inline constexpr int kExactRestarts = 16;

/// A result in rational numbers.
struct ExactSolution {
  ExactEnding ending = ExactEnding::kPivotLimit;
  std::vector<mpq_class> z;  ///< n: the solution, or the last basic solution (z >= 0, z.w = 0)
  /// n: the z-part of the secondary ray if the path ended on one (integers without a common
  /// factor, >= 0), else empty.
  std::vector<mpq_class> ray;
  bool ray_proves_infeasible = false;  ///< M^T ray <= 0 and q.ray < 0: no feasible z exists
  int pivots = 0;                      ///< of all paths
  int restarts = 0;                    ///< paths beyond the first
};

/// Lemke's method in exact arithmetic on w = M z + q + d z0, d = (1, ..., 1): complementary pivots
/// with the lexicographic ratio test on the perturbed right-hand side q + (e, e^2, ..., e^n), so
/// that no basis repeats and the path ends. Degenerate ties that z0 shares let z0 leave.
///
/// A solution is found for every q if M is a P matrix, and for every q with a feasible z if M is
/// copositive-plus (every positive semidefinite M is) or row sufficient; then the ray of a
/// problem without a solution proves so. For other matrices a ray proves nothing by itself.
///
/// A ray that does not prove infeasibility is not the end: the path is followed again from another
/// complementary basis B_0 (drawn from a fixed pseudo-random sequence), with a cover B_0 d whose d
/// are small integers, which is Lemke's method for the principal transform of the problem
/// and solves some that it does not (bimatrix games), up to `restarts` times. The ray returned then
/// is the first one, or the one that proves.
///
/// The tableau holds integers (rows multiplied by their common denominator) that stay minors of
/// the data: Edmonds' integer pivoting with exact divisions, after Bareiss, Math. Comp. 22 (1968).
/// Cost: O(n^2) products a pivot of integers as long as the basis determinant, at most about
/// (pivots so far) x (bits of a row's data); 2^n pivots are possible, about n are usual. n = 60 of
/// full 53-bit data: seconds. Memory: the tableau, n^2 such integers.
/// Source: Cottle, Pang, Stone, The Linear Complementarity Problem (1992), algorithm 4.4.5, the
/// lexicographic rule of its section 4.9; we perturb by the identity.
///
/// @param problem an LCP (is_lcp()) of finite numbers, shapes checked
/// @param max_pivots of all paths together, -1: no limit
/// @param restarts paths beyond the first at most, >= 0
[[nodiscard]] ExactSolution solve_exactly(
    const Problem& problem, int max_pivots = -1,
    const Deadline& deadline = Deadline(std::numeric_limits<double>::infinity()),
    int restarts = kExactRestarts);

/// The double nearest to x; +-infinity beyond the largest double. (mpq_class::get_d() truncates.)
[[nodiscard]] double to_nearest_double(const mpq_class& x);

/// Writes a positive multiple of the ray to `rounded`, its largest entry in [1/2, 1).
/// @param ray integers, not all 0. @return whether the multiple is exact.
bool scale_ray(const std::vector<mpq_class>& ray, Vector& rounded);

}  // namespace signorini::lcp
