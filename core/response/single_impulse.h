#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>

namespace signorini {

/// The impulse of one contact in closed form (notes, sections 3 and 4).
struct SingleImpulse {
  /// A_ii = 1/m_A + 1/m_B + (r_A x N)^T J_A^-1 (r_A x N) + (r_B x N)^T J_B^-1 (r_B x N), 1/kg;
  /// bodies that are not dynamic add nothing.
  double denominator = 0.0;
  double d_dot = 0.0;  ///< d'-, m/s
  double f_min = 0.0;  ///< -d'- / A_ii, N s: the least that stops the approach (e = 0)
  double f_max = 0.0;  ///< 2 f_min, N s: the most that gains no kinetic energy (e = 1)

  /// f = (1 + e) f_min, N s. @param e in [0, 1]
  [[nodiscard]] double with_restitution(double e) const { return (1.0 + e) * f_min; }
};

/// f in [f_min, f_max] is e in [0, 1]: f = (1 + e) f_min. A contact that does not approach
/// (d'- >= 0) has f_min = f_max = 0. @throws std::invalid_argument if neither body is dynamic
/// (A_ii = 0).
[[nodiscard]] SingleImpulse single_impulse(const Bodies& bodies, const State& state,
                                           const Contact& contact);

/// p_A += f N, L_A += r_A x f N, and the opposite for B; bodies that are not dynamic keep their
/// state. @param f N s
void apply_impulse(const Bodies& bodies, const Contact& contact, double f, State& state);

}  // namespace signorini
