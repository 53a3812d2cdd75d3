#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/status.h>

#include <limits>

namespace signorini::lcp {

/// How good a vector z is, recomputed from the caller's own M, q and bounds, in long double. With
/// w = M z + q, D_i = M_ii where M_ii > 0 and 1 elsewhere, and the step
///
///     r_i(s) = z_i - clamp(z_i - w_i / s, lower_i, upper_i)     ( = min(z_i, w_i / s) for an LCP),
///
/// coupled rows with the bounds -+ mu z_n of the given z (z_n < 0 counts as 0). Starts as NaN.
struct Certificate {
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  /// max_i |r_i(1)| / (1 + |q|_inf): the natural residual, for an LCP max|min(z, w)| / (1 + |q|).
  /// Its value depends on the caller's units.
  double natural_residual = kNaN;
  /// max_i D_i |r_i(D_i)| / |q|_inf, for an LCP max|min(M_ii z_i, w_i)| / |q|. Unit-free: other
  /// units of z and of w (one factor each) change nothing; rows are measured against the largest q,
  /// so a row whose q is far below it counts for little. With q = 0: 0 if the numerator is 0,
  /// +infinity otherwise.
  double unit_free_residual = kNaN;
  /// eps max_i (|M||z| + |q|)_i / |q|_inf: what rounding z and w to double costs the unit-free
  /// residual. No solver that returns doubles can be asked for much less.
  double rounding_floor = kNaN;
  /// The same rounding error in the terms of the natural residual:
  /// eps max_i (|M||z| + |q|)_i / (1 + |q|_inf).
  double natural_floor = kNaN;
  /// max_i |D_i r_i(D_i)| / (D_i |z_i| + (|M||z|)_i + |q_i|): small when z is exact for slightly
  /// other data.
  double backward_error = kNaN;
  double min_z = kNaN;  ///< min_i z_i over the rows with lower = 0 (else NaN), caller's units
  double min_w = kNaN;  ///< min_i w_i over the rows with upper = inf and lower = 0
  double complementarity = kNaN;  ///< |z.w| over the rows that are neither free nor boxed
  int worst_row = -1;             ///< the row of the unit-free residual, -1 if n = 0
};

/// Recomputes the certificate of z. Cost: one product with M in long double, one with |M|.
/// @param problem must have passed check_shapes(), with finite values; numbers from 1e-150 to 1e150
/// neither overflow nor underflow on the way (long double has the range), residuals beyond double
/// are +infinity
/// @param z n numbers; anything not finite gives residuals of +infinity, never a small number
/// @param w if not null, receives M z + q rounded to double
[[nodiscard]] Certificate certify(const Problem& problem, const VectorRef& z, Vector* w = nullptr);

/// The only definition of "solved": kSolved if both residuals are <= tolerance; else
/// kSolvedToRounding if each residual is <= tolerance, or <= 4 of its floors and <= 1e-5 (a floor
/// above that says that z is too large to mean anything beside q); else `otherwise`.
[[nodiscard]] Status judge(const Certificate& certificate, double tolerance, Status otherwise);

}  // namespace signorini::lcp
