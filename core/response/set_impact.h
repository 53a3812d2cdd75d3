#pragma once

#include <signorini/core/response/impact.h>

#include <limits>
#include <string>
#include <vector>

namespace signorini {

/// How the impact of one connected set came out; the members as in ImpactReport.
struct SetOutcome {
  lcp::Status status = lcp::Status::kNotRun;
  lcp::Vector impulses;
  std::vector<Vec3> contact_impulses;  ///< on A, world, N s
  int reflections = 0;                 ///< kReflections
  double theta = std::numeric_limits<double>::quiet_NaN();
  lcp::Result law;
  lcp::Result plastic;
  std::string detail;
};

/// What energy_safe promises, relative to T- + |driver work|: some thousand roundings of a double,
/// room for the sums over the bodies and contacts of a set.
inline constexpr double kMostEnergyGain = 1e-12;

/// Of two endings: the first if it is not solved, else the less solved.
[[nodiscard]] inline lcp::Status worse(lcp::Status a, lcp::Status b) {
  if (!lcp::is_solved(a)) {
    return a;
  }
  return b == lcp::Status::kSolved ? a : b;
}

/// The impact of one connected set of contacts by a simultaneous law without friction, made
/// energy-safe if the settings say so. A set of one contact is answered in closed form.
/// @param contacts one connected set, valid. @param solver settings.solver
/// @param before the state of all bodies
/// @param after receives the new momenta of the set's bodies if the outcome is solved; other bodies
/// are not touched
[[nodiscard]] SetOutcome resolve_set(const Bodies& bodies, const ContactSet& contacts,
                                     const ImpactSettings& settings, lcp::Solver& solver,
                                     const State& before, State& after);

}  // namespace signorini
