#pragma once

#include <signorini/lcp/absolute_product.h>
#include <signorini/lcp/interval.h>
#include <signorini/lcp/islands.h>
#include <signorini/lcp/problem.h>
#include <signorini/lcp/status.h>

#include <cmath>
#include <limits>
#include <vector>

namespace signorini::lcp {

/// How good a vector z is, recomputed from the caller's own M, q and bounds, in long double
/// (|M||z|, of which the rounding floors are made, in double where it has the range). With
/// w = M z + q, D_i = M_ii where M_ii > 0 and 1 elsewhere, and the step
///
///     r_i(s) = z_i - clamp(z_i - w_i / s, lower_i, upper_i)     ( = min(z_i, w_i / s) for an LCP),
///
/// coupled rows with the bounds -+ mu z_n of the given z (z_n < 0 counts as 0). The rows c of a
/// friction cone K are measured together, in the Euclidean norm: with w~ = w + mu |w_T| n
/// (Coulomb; associated: w~ = w) and D_c the largest eigenvalue of the symmetric part of M_cc,
///
///     r_c(s) = z_c - P_K(z_c - w~_c / s),
///
/// and a Coulomb cone's |r_c(s)| is at least
///
///     e_c(s) = |min(|z_c|, w_N / s)|,
///
/// its normal part, which no mu shrinks: P_K sees a contact that closes with -w_N <= mu |w_T| only
/// as (-w_N) / sqrt(1 + mu^2), nothing for a large mu. Where both are at most t / D_c, z_c and w_c
/// are within t of a pair that obeys the law exactly, D_c |z' - z| <= t, |w'_N - w_N| <= t,
/// |w'_T - w_T| <= t, whatever mu is. With p = P_K(z_c - w~_c / D_c), w~ - D r lies in the dual
/// cone K* and is orthogonal to p, so that z' = p, w' = (0, w_T - D r_T) slides or sticks; that is
/// the pair if |w_N| <= t. Else w_N > t and D |z_c| <= t: z' = 0, w' = w. (The associated law needs
/// no such term: there z' = p, w' = w - D r.)
///
/// Starts as NaN.
struct Certificate {
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  /// max_i |r_i(1)| / (1 + |q|_inf): the natural residual, for an LCP max|min(z, w)| / (1 + |q|).
  /// Its value depends on the caller's units.
  double natural_residual = kNaN;
  /// max_i D_i |r_i(D_i)| / |q|_inf, for an LCP max|min(M_ii z_i, w_i)| / |q|. Unit-free: other
  /// units of z and of w (one factor each) change nothing; rows are measured against the largest q,
  /// so a row whose q is far below it counts for little. A cone counts as one row, D_c |r_c(D_c)|.
  ///
  /// With q = 0 there is nothing to measure against: 0 if z solves the problem exactly, +infinity
  /// otherwise. The numerator is then compared with 0 without rounding (enclosed_product.h); what
  /// that leaves open (rows of a factored M whose J^T z is not 0, cones at their boundary) is
  /// +infinity. z = 0 is exact as it is and costs nothing extra; another z costs about ten products
  /// with M, and memory.
  double unit_free_residual = kNaN;
  /// eps max_i (|M||z| + |q|)_i / |q|_inf: what rounding z and w to double costs the unit-free
  /// residual. No solver that returns doubles can be asked for much less. Cones add
  /// eps D_c max(|z_T|, mu |z_N|) / |q|_inf, far inside at most mu eps (|M||z| + |q|)_T / |q|_inf.
  double rounding_floor = kNaN;
  /// The same rounding error in the terms of the natural residual:
  /// eps max_i (|M||z| + |q|)_i / (1 + |q|_inf), cones eps max(|z_T|, mu |z_N|) / (1 + |q|_inf);
  /// those far inside (by a thousandth of mu z_N or so): only what mu |w_T| costs, as above.
  double natural_floor = kNaN;
  /// max_i |D_i r_i(D_i)| / (D_i |z_i| + (|M||z|)_i + |q_i|): small when z is exact for slightly
  /// other data. NaN where the certificate is a quick one, whose residuals and floors are upper
  /// bounds (Certifier::certify_quickly()).
  double backward_error = kNaN;
  /// min_i z_i over the rows with lower = 0 and the normal rows of cones (else NaN), caller's
  /// units.
  double min_z = kNaN;
  double min_w =
      kNaN;  ///< min_i w_i over the rows with upper = inf and lower = 0, and cones' normals
  /// |z.w~| over the rows that are neither free nor boxed; w~ = w but in Coulomb's cones.
  double complementarity = kNaN;
  /// max over the cones of max(|z_T| - mu z_N, -z_N, 0), caller's units; NaN without cones.
  double cone_violation = kNaN;
  int worst_row = -1;  ///< the row (of a cone: the normal) of the unit-free residual, -1 if n = 0
};

/// Computes certificates, and keeps its memory: nothing is allocated once capacity was reached (but
/// for q = 0 and z != 0, see Certificate::unit_free_residual).
class Certifier {
 public:
  /// See certify(), which is this with new memory.
  [[nodiscard]] Certificate certify(const Problem& problem, const VectorRef& z,
                                    Vector* w = nullptr);
  /// The same where that costs O(n) and shows that z is solved to the tolerance (factored M,
  /// inverse masses that are kept as such, q not 0); else certify(). What is cheap is a bound: the
  /// residuals of groups of rows inside their bounds are at most |w~|, whatever D is, since
  /// projecting shortens distances, and count as that where it is below half the tolerance;
  /// the floors take |J||W||J^T||z| for |M||z|; backward_error is NaN. All else is as in certify().
  [[nodiscard]] Certificate certify_quickly(const Problem& problem, const VectorRef& z,
                                            double tolerance, Vector* w = nullptr);
  /// Finds D of every row and cone, which the iterates of a solve have in common. Cost: O(n) for a
  /// factored M.
  void start_iterates(const Problem& problem);
  /// certify_quickly() of an iterate on the way to the solution of the problem that
  /// start_iterates() was told of, also where it is not solved; certify() where its bounds do not
  /// hold, and where only the floors make it solved.
  [[nodiscard]] Certificate certify_iterate(const Problem& problem, const VectorRef& z,
                                            double tolerance);
  /// One certificate an island, each with its own |q|_inf and floors, as if it were the whole
  /// problem. Where one island is refused (not finite), all are.
  /// @param islands of this problem @param certificates receives islands.count
  void certify_islands(const Problem& problem, const VectorRef& z, const Islands& islands,
                       std::vector<Certificate>& certificates);

 private:
  struct Bounds {
    long double lower;
    long double upper;
    long double lost;  // what rounding cost them: mu z_n of a coupled limit has 106 bits
  };
  /// What a row, or the normal row of a cone for all its rows, adds to a certificate.
  struct Measure {
    long double natural = 0.0L;    // |r(1)|
    long double unit_free = 0.0L;  // D |r(D)|
    long double backward = 0.0L;
    long double z_dot_w = 0.0L;
    long double boundary = 0.0L;         // of a cone: max(|z_T|, mu |z_N|), and
    long double scaled_boundary = 0.0L;  // D times it: what rounding z does to z - P_K
    double min_z = Certificate::kNaN;
    double min_w = Certificate::kNaN;
    double cone_violation = Certificate::kNaN;
    [[nodiscard]] bool is_finite() const {
      return std::isfinite(natural) && std::isfinite(unit_free);
    }
  };
  /// Everything that a certificate is made of.
  struct Total {
    Measure most;  // of the rows; z_dot_w: the sum
    long double size = 0.0L;
    long double natural_size = 0.0L;
    double q_inf = 0.0;
    int worst_row = -1;
    bool is_zero = true;          // z, in all rows
    bool solved_exactly = false;  // what settle_exactly() says
    void add_row(long double row_size, double q, long double z);
    /// @param row of a cone: the normal
    void add_group(int row, const Measure& measure);
    /// Whether rounding hides if the numerator of a problem with q = 0 is 0.
    [[nodiscard]] bool needs_exactness() const;
    [[nodiscard]] Certificate certificate() const;
  };
  /// Fills everything below for z and adds it to the totals, which are new.
  /// @param island of every row; null: all are one @return false if a number is not finite
  [[nodiscard]] bool measure(const Problem& problem, const VectorRef& z,
                             const std::vector<int>* island);
  void multiply_by_matrix(const Problem& problem);
  void find_sizes(const Problem& problem);
  template <typename Number>
  void visit_entries(const Problem& problem, std::vector<Number>& absolute_z,
                     std::vector<Number>& size);
  /// @param scales_known scale_ is of this problem
  [[nodiscard]] bool bound(const Problem& problem, const VectorRef& z, double tolerance,
                           bool scales_known);
  void bound_sizes(const Problem& problem, const FactoredMatrix& A, const VectorRef& z);
  [[nodiscard]] double scale_of(const Problem& problem, int first, int cone);
  [[nodiscard]] Measure bound_group(const Problem& problem, int first, int cone, double fine,
                                    bool scales_known);
  void find_bounds(const Problem& problem);
  [[nodiscard]] Measure measure_row(Index i) const;
  [[nodiscard]] Measure measure_cone(const Problem& problem, std::size_t cone) const;
  void settle_exactly(const Problem& problem, const VectorRef& z, const std::vector<int>* island);
  [[nodiscard]] bool solves_row(const Problem& problem, const VectorRef& z, Index i) const;
  [[nodiscard]] bool solves_cone(const Problem& problem, const VectorRef& z,
                                 std::size_t cone) const;

  std::vector<long double> z_, w_;               // w = M z + q
  std::vector<long double> body_p_, body_v_;     // of a factored M
  std::vector<double> absolute_p_, absolute_v_;  // |J^T||z| and |W| times it
  std::vector<double> absolute_z_, absolute_w_;  // |z|, |M||z|
  std::vector<long double> long_z_;              // |z|, where doubles have not the range
  std::vector<long double> size_;                // (|M||z|)_i + |q_i|
  Vector scale_;                                 // D of every row; of a cone at its normal row
  Vector block_room_;                            // of diagonal_block()
  std::vector<Eigen::Matrix3d> cone_blocks_;     // M_cc
  std::vector<int> cone_of_row_;                 // -1: none
  std::vector<Bounds> bounds_;
  FactoredMatrix::VisitWorkspace visit_;
  AbsoluteProduct absolute_product_;
  std::vector<Total> totals_;      // of the problem, or of its islands
  std::vector<Interval> product_;  // M z without rounding, where q = 0
  std::vector<int> limit_of_row_;  // in problem.limits, -1: none; where q = 0
};

/// Recomputes the certificate of z. Cost: one product with M in long double, one with |M| (of a
/// factored M without forming it).
/// @param problem must have passed check_shapes(), with finite values; numbers from 1e-150 to 1e150
/// neither overflow nor underflow on the way (long double has the range), residuals beyond double
/// are +infinity
/// @param z n numbers; anything not finite gives residuals of +infinity, never a small number
/// @param w if not null, receives M z + q rounded to double
[[nodiscard]] Certificate certify(const Problem& problem, const VectorRef& z, Vector* w = nullptr);

/// The only definition of "solved": kSolved if both residuals are <= tolerance; else
/// kSolvedToRounding if each residual is <= tolerance, or <= 4 of its floors and <= 1e-5 (a floor
/// above that says that z is too large to mean anything beside q); else `otherwise`. 2^-10 of its
/// floor is added to each residual first: what computing it in long double may have lost. (What
/// that cost a cone's w_T, times mu, is in the residuals: with mu = 1e12 it is more than they.)
[[nodiscard]] Status judge(const Certificate& certificate, double tolerance, Status otherwise);

}  // namespace signorini::lcp
