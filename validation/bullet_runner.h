#pragma once

#include <signorini/validation/bullet_profile.h>
#include <signorini/validation/run_control.h>
#include <signorini/validation/scene.h>
#include <signorini/validation/track.h>

#include <string>

namespace signorini::validation {

/// Runs the scene in Bullet (double precision, btDiscreteDynamicsWorld, sequential impulses), one
/// Bullet step a step of the scene, friction and restitution of a pair by the scene's rule instead
/// of Bullet's product. Not for two threads at once: Bullet's material hook is global.
/// @param stop null, or a flag that ends the run early (Track::interrupted)
/// @param watch empty, or told after every step
/// A scene from a .bullet file is run as the file says (bullet_file.h).
/// @throws InputError for a kinematic body, which no scene file can hold
[[nodiscard]] Track run_bullet(const Scene& scene, const BulletProfile& profile,
                               const StopFlag* stop = nullptr, const StepWatcher& watch = nullptr);

/// "3.24".
[[nodiscard]] std::string bullet_version();

}  // namespace signorini::validation
