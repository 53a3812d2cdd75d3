#pragma once

#include <signorini/core/response/joint_rows.h>

#include <vector>

namespace signorini {

/// One row of rolling or spinning friction: the relative turning of the bodies of a contact about a
/// unit axis e, measured at an arm l,
///
///     w = l e.(w_A - w_B)  m/s,     |z| <= (mu / l) f,     z l e is the moment on A, N m s
///
/// with mu the rolling or spinning friction (m) and f the contact's normal impulse: |moment| <= mu
/// f, against the turning. Spinning: e = N. Rolling: two axes across N, the first along the
/// rolling, each with its own limit (a box: up to sqrt 2 mu f between them). l is the longer
/// distance of the contact from the centre of a dynamic body of it, or mu if that is more, so that
/// w is the speed of a rim and counts beside those of the other rows.
///
/// With friction cones, whose rows take no part in coupled limits, the contact's own friction is a
/// box, t1 along the slip; IslandReport::model says so.
struct TurningRow {
  int contact = 0;     ///< its number in the contacts given
  double limit = 0.0;  ///< mu / l
  JointRow row;        ///< e and l as a row over the velocities of both bodies
};

/// The rows of all contacts that resist turning, in their order: spinning, then rolling.
/// @param free_state as assemble_cones(): its rolling chooses the axes
void turning_rows(const Bodies& bodies, const State& free_state, const ContactSet& contacts,
                  std::vector<TurningRow>& rows);

/// Adds to the moment of every contact on its body A (on B: minus that), world axes, N m s.
void add_contact_moments(const std::vector<TurningRow>& rows, const lcp::VectorRef& z,
                         std::vector<Vec3>& moments);

/// Gives every contact's moment to its dynamic bodies.
void apply_contact_moments(const Bodies& bodies, const ContactSet& contacts,
                           const std::vector<Vec3>& moments, State& state);

}  // namespace signorini
