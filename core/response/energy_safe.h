#pragma once

#include <signorini/core/response/assembly.h>

namespace signorini {

/// How far f and A f + d'- may miss their bounds, m/s: tolerance |d'-|_inf, or four times the
/// rounding of A f + d'- (the rounding floor of lcp::Certificate) where that is larger.
[[nodiscard]] double residual_allowed(const NormalRows& rows, const lcp::VectorRef& f,
                                      double tolerance);

/// True if f >= 0 and A f + d'- >= 0, each to residual_allowed() (A_ii f_i for f, so that both are
/// in m/s).
[[nodiscard]] bool is_admissible(const NormalRows& rows, const lcp::VectorRef& f, double tolerance);

/// The energy gain along f(theta) = f_c + theta (f_e - f_c) (design, section 4.4):
///
///     E(theta) = plastic + slope theta + 1/2 curvature theta^2,
///     plastic   = -1/2 f_c.A f_c + f_c.d'_c   <= 0,    d'_c = A f_c + d'-
///     slope     = (f_e - f_c).d'_c            (>= 0 without friction)
///     curvature = (f_e - f_c).A (f_e - f_c)   >= 0,
///
/// (without friction f_c.d'_c = 0 but for rounding), each a sum without cancellation: the A
/// products are |J^T f|^2 in M^-1. J.
struct EnergyLine {
  double plastic = 0.0;
  double slope = 0.0;
  double curvature = 0.0;
};
/// @param f_c solution of the plastic LCP. @param f_e admissible
[[nodiscard]] EnergyLine energy_line(const NormalRows& rows, const lcp::VectorRef& f_c,
                                     const lcp::VectorRef& f_e);
/// The same over any rows, tangents among them (friction): d'_c is then u_c = A f_c + before, and
/// with the plastic Coulomb solution f_c.u_c <= 0.
/// @param before velocities of the rows before the impact, m/s
[[nodiscard]] EnergyLine energy_line(const lcp::FactoredMatrix& A, const lcp::VectorRef& before,
                                     const lcp::VectorRef& f_c, const lcp::VectorRef& f_e);

/// The largest theta in [0, 1] with E(theta) <= 0: min(1, the positive root), the root as
/// 2c / (slope + sqrt(slope^2 + 2 curvature c)) with c = -plastic, or, where slope < 0, as
/// (-slope + sqrt(slope^2 + 2 curvature c)) / curvature, in which nothing cancels. 0 if there is
/// none (c <= 0 by rounding, and E(1) > 0).
[[nodiscard]] double largest_theta(const EnergyLine& line);

}  // namespace signorini
