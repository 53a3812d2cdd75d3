#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>

namespace signorini {

/// Limit analysis of a structure in a plane (Livesley, "Limit analysis of structures formed from
/// rigid blocks", International Journal for Numerical Methods in Engineering 12, 1978): whether
/// forces in the cones of friction exist that carry the weights.
struct LimitAnalysis {
  /// The least mu, the same for all contacts, with which such forces exist: with less the structure
  /// must move. Infinity: with none.
  double friction = 0.0;
  int programmes = 0;  ///< linear programmes solved
};

/// For a mu, with f_i >= 0 along N and t_i along the tangent in the plane,
///
///     s(mu) = min s   subject to   sum f_i N_i + t_i T_i = weights (forces and moments, each
///     body),
///                                  |t_i| <= mu f_i + s,
///
/// a linear programme (Clp's simplex method); s falls as mu grows, and mu_c is where it becomes 0,
/// found by bisection to 1e-9. Contacts act at their points, normals at P_A and P_B, tangents at
/// their middle, as in the stepper. In a plane of symmetry the forces across it change nothing, so
/// the two directions are the whole cone.
/// @param across unit, perpendicular to the plane
/// @param contacts those that touch; their own mu does not count
/// @throws std::runtime_error if a programme is not solved
[[nodiscard]] LimitAnalysis critical_friction(const Bodies& bodies, const State& state,
                                              const ContactSet& contacts, const Vec3& gravity,
                                              const Vec3& across);

}  // namespace signorini
