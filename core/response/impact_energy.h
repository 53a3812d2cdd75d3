#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/lcp/types.h>

#include <vector>

namespace signorini {

/// 1/2 f.(d'+ + d'-), J: the kinetic energy that the impulses f give (less the work of driven
/// bodies), and how much of it may be rounding: 4 eps sum_i |f_i| (|d_i'+| + |d_i'-|).
struct ImpulseEnergy {
  double gain = 0.0;
  double rounding = 0.0;
};
[[nodiscard]] ImpulseEnergy impulse_energy(const lcp::VectorRef& f, const lcp::VectorRef& before,
                                           const lcp::VectorRef& after);

/// The work of the driven bodies through the impulses, J: sum f N.u_B where B is kinematic, less
/// the same of A. T+ - T- - work = 1/2 f.(d'+ + d'-).
/// @param state before or after: driven bodies keep their velocity
[[nodiscard]] double driver_work(const Bodies& bodies, const State& state,
                                 const ContactSet& contacts, const lcp::VectorRef& f);

/// The same with whole contact impulses on A (world axes, N s), at friction_point().
[[nodiscard]] double driver_work(const Bodies& bodies, const State& state,
                                 const ContactSet& contacts, const std::vector<Vec3>& impulses);

/// gain / (before + |work|), dimensionless; 0 if gain = 0.
[[nodiscard]] double relative_energy_gain(double gain, double before, double work);

}  // namespace signorini
