#pragma once

#include <signorini/validation/run_control.h>
#include <signorini/validation/scene.h>
#include <signorini/validation/sdf_reader.h>
#include <signorini/validation/track.h>

#include <string>

namespace signorini::validation {

/// Reads a .bullet file (btDefaultSerializer's) into a scene, which ours runs, while Bullet runs
/// the file's own world (run_bullet_file()).
///
/// Bodies: poses, masses, moments of inertia, velocities, gravity; one of mass 0 is fixed. Shapes:
/// box, sphere, capsule, cylinder, cone, plane, convex hull, triangle mesh, compounds of them, of
/// the size that Bullet gives them, margins of boxes and cylinders included (a plane and a mesh on
/// fixed bodies only). Constraints: point to point, hinge (limits, motor), slider (limits), fixed.
/// Materials: friction and restitution, a pair's multiplied, as Bullet does. The file has no step
/// and no duration: 1/240 s and 5 s.
///
/// What else the file has and ours cannot do is refused by name: damping, rolling friction,
/// anisotropic friction, kinematic bodies, scaled or foreign forces, other shapes and constraints,
/// soft bodies, multi bodies; with ReadOptions::skip_unsupported it is left out with a notice each.
///
/// Bullet's loader trusts the bytes it reads. The file's chunks are checked first
/// (bullet_file_chunks.h); the loader then runs in a child process under limits of memory and time
/// (tools/child_process.h), so that a hostile file ends in an error and not in a crash. What the
/// child does with this program's rights before it ends is not guarded against.
///
/// @throws InputError naming the file and what is wrong with it
[[nodiscard]] Scene read_bullet_bytes(const std::string& bytes, const std::string& source,
                                      const ReadOptions& options = {});

/// Runs the world of a scene's file in Bullet (double precision) as the file says: its shapes,
/// margins, materials, constraints and solver settings, sleeping off, in the scene's steps; in a
/// child process. Contacts are not recorded. @throws InputError if the run does not end
[[nodiscard]] Track run_bullet_file(const Scene& scene, const StopFlag* stop);

/// A scene from a file of any kind: .bullet, SDFormat, URDF. @throws InputError
[[nodiscard]] Scene read_any_scene_file(const std::string& path, const ReadOptions& options = {});
/// The same from what is in the file, whose kind its name `source` says.
[[nodiscard]] Scene read_any_scene_text(const std::string& text, const std::string& source,
                                        const ReadOptions& options = {});

}  // namespace signorini::validation
