#pragma once

#include <signorini/lcp/factored_matrix.h>
#include <signorini/lcp/types.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace signorini::lcp {

/// M of w = M z + q in one of three forms. The dense and the sparse form may be nonsymmetric; the
/// factored form is symmetric positive semidefinite by construction.
using MatrixForm = std::variant<Matrix, SparseMatrix, FactoredMatrix>;

/// Couples the bounds of a friction row to a normal row: |z_row| <= coefficient * z_normal_row.
struct CoupledLimit {
  int row;
  int normal_row;
  double coefficient;  ///< friction coefficient mu >= 0, dimensionless
};

/// Friction at one contact: the rows normal_row (N) and, right after it, the tangential ones (T),
/// bound by K = {|z_T| <= coefficient z_N}, |.| the Euclidean norm.
struct FrictionCone {
  int normal_row;
  int dimension;       ///< rows of the contact: 2 in the plane, 3 in space
  double coefficient;  ///< friction coefficient mu >= 0, dimensionless
};

/// What the rows of a cone must satisfy; z in K in both.
enum class FrictionLaw : std::uint8_t {
  /// Signorini and Coulomb in De Saxce's form: w~ = w + mu |w_T| n in K*, z.w~ = 0. That is: 0 <=
  /// z_N ⊥ w_N >= 0, and where w_T is not zero z_T = -mu z_N w_T / |w_T|. (De Saxce, Feng,
  /// Mathematical and Computer Modelling 28, 1998, eq. 23; K* the dual cone, {w_N >= mu |w_T|}.)
  kCoulomb,
  /// The convex model: w in K*, z.w = 0. A sliding contact separates at w_N = mu |w_T|, which
  /// Coulomb's does not; with symmetric positive semidefinite M it is the optimum of a convex
  /// program. (Anitescu, Mathematical Programming 105, 2006.)
  kAssociated,
};

/// "Coulomb" or "associated".
[[nodiscard]] std::string_view to_string(FrictionLaw law);

/// Find z, w with w = M z + q and, for every row i that is in no cone,
///
///     lower_i <= z_i <= upper_i,
///     w_i >= 0 where z_i = lower_i,   w_i <= 0 where z_i = upper_i,   w_i = 0 in between.
///
/// lower = 0, upper = +inf is the LCP 0 <= z, 0 <= w, z.w = 0. lower = -inf, upper = +inf is a free
/// row, w_i = 0 (mixed LCP). A coupled row has the bounds -+ mu z_n, with z_n of the solution. The
/// rows of a cone obey friction_law.
/// Units are the caller's: with z in N s and w in m/s, M is in 1/kg.
struct Problem {
  MatrixForm M;                          ///< n x n
  Vector q;                              ///< n
  Vector lower;                          ///< n, or empty: all 0
  Vector upper;                          ///< n, or empty: all +inf
  std::vector<CoupledLimit> limits;      ///< friction rows; overrides lower and upper of its row
  std::vector<FrictionCone> cones = {};  ///< ascending, disjoint; overrides lower and upper
  FrictionLaw friction_law = FrictionLaw::kCoulomb;  ///< of all cones

  [[nodiscard]] Index size() const { return q.size(); }
  [[nodiscard]] bool has_bounds() const { return lower.size() > 0 || upper.size() > 0; }
  /// True when every row is 0 <= z_i ⊥ w_i >= 0.
  [[nodiscard]] bool is_lcp() const { return cones.empty() && is_unilateral(); }
  /// True when every row that is in no cone is 0 <= z_i ⊥ w_i >= 0.
  [[nodiscard]] bool is_unilateral() const;
};

/// Checks shapes and indices. @throws std::invalid_argument that names the field, its value and the
/// bound. Values (NaN, infinity, crossed bounds) are not checked here: they end a solve with
/// Status::kInvalidInput, see find_bad_value().
void check_shapes(const Problem& problem);

/// The first value that no solver can work with, as text ("q[3] is nan"), or empty if all are good:
/// NaN or infinity in M or q, NaN in the bounds, lower > upper, a friction coefficient that is
/// negative or not finite.
[[nodiscard]] std::string find_bad_value(const Problem& problem);

/// Rows of M. For the square check see check_shapes().
[[nodiscard]] Index rows(const MatrixForm& M);

/// w = M z in double or long double, with the form's own arithmetic (a factored M is not formed).
template <typename Scalar>
void multiply(const MatrixForm& M, const Scalar* z, Scalar* w);

/// out = M^T y in long double.
void transpose_multiply(const MatrixForm& M, const VectorRef& y, std::vector<long double>& out);

/// M_ii for every i.
void diagonal(const MatrixForm& M, Vector& d);

/// M as a dense matrix (n^2 numbers).
[[nodiscard]] Matrix to_dense(const MatrixForm& M);

}  // namespace signorini::lcp
