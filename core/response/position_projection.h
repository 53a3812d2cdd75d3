#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/lcp/solver.h>
#include <signorini/lcp/status.h>

#include <string>

namespace signorini {

/// What a position projection did.
struct ProjectionReport {
  /// Of the displacement LCP. Not solved: nothing was moved. kNotRun: there was nothing to do.
  lcp::Status status = lcp::Status::kNotRun;
  /// Mechanical energy gained: m g times the heights, plus the change of kinetic energy that comes
  /// from turning J with L fixed. J.
  double energy_change = 0.0;
  double largest_displacement = 0.0;  ///< of a centre of mass, m
  std::string detail;                 ///< why it failed, one line; else empty
};

/// Overlaps up to this are left alone, m.
inline constexpr double kToleratedOverlap = 1e-10;

/// Moves bodies out of overlap by the smallest displacement in the metric of the masses:
///
///     min 1/2 D^T M D   s.t.   gap + J D >= 0,   i.e.   D = M^-1 J^T l,  0 <= l ⊥ A l + gap >= 0,
///
/// D = (dx, dtheta) of every body, J the normal rows (assembly.h), one linear step: what the
/// curvature leaves is of second order in D and is seen by the next call. Gaps > 0 among the
/// contacts are kept from closing further than to zero. Only x and q change: p and L (world axes)
/// are the same bits, so no velocity of translation is added and both momenta are conserved; w =
/// J^-1 L follows the new orientation. Does nothing if no contact is deeper than kToleratedOverlap.
///
/// @param gravity for energy_change, m/s^2
/// @param solver takes a factored symmetric LCP; l in kg m
/// @throws std::invalid_argument as assemble_normals() and Solver::solve(); state is then unchanged
void project_positions(const Bodies& bodies, const ContactSet& contacts, const Vec3& gravity,
                       lcp::Solver& solver, State& state, ProjectionReport& report);

}  // namespace signorini
