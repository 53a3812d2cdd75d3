#pragma once

#include <signorini/validation/scene_run.h>

namespace signorini::validation {

/// How far the stepper's default scheme itself lets the mechanical energy rise above its start, J.
///
/// Flight: it keeps E - (h/2) g.p exactly, so E moves by (h/2) |g| times the change of the momenta
/// along g. Turning between impulses keeps E (Integrator::kEnergyMomentum).
[[nodiscard]] double scheme_energy_rise(const Scene& scene, const Track& track);

/// The greatest speed of any dynamic body's surface or centre that the track saw, m/s: |v| of the
/// centre of mass plus |w| times the farthest point of its shapes.
[[nodiscard]] double greatest_speed(const Scene& scene, const Track& track);

/// Checks for a scene without a closed form: energy never rises, no overlap deeper than one step's
/// motion, free fall exact where nothing is in the way; Bullet's answer beside it.
/// @throws RunInterrupted
void check_generic(const Scene& scene, const RunOptions& options, SceneReport& report);

/// The energy check and the overlap check alone, for scenes that have closed forms as well.
void add_energy_check(const Scene& scene, const Runs& runs, SceneReport& report);
void add_overlap_check(const Scene& scene, const Runs& runs, SceneReport& report);
/// "greatest error of a joint", over all samples.
void add_joint_check(const Scene& scene, const Runs& runs, SceneReport& report);

}  // namespace signorini::validation
