#pragma once

#include <signorini/validation/scene.h>

#include <optional>
#include <string>

namespace signorini::validation {

struct ReadOptions {
  /// Leave out collision shapes, joints and other elements that are not supported, each with a
  /// notice, instead of refusing the scene. A dynamic body that loses its last shape is left out
  /// too: it could only fall for ever.
  bool skip_unsupported = false;
  /// Adds a fixed half-space z <= ground (m), friction 1, restitution 1. For a URDF, which has no
  /// world; under the pairing rule "minimum" the model's own values then decide.
  std::optional<double> ground = {};
};

/// Reads an SDFormat world or model, or a URDF robot, through libsdformat 12.
///
/// Bodies: one a link, its frame in the centre of mass with the link's axes; links of static models
/// are fixed. Poses are resolved through the frame graph. Colliders: box, sphere, cylinder,
/// capsule, ellipsoid, cone, plane (a half-space with any normal; static models only; its size is
/// ignored), mesh (triangles; of a dynamic body their convex hull: sdf_shapes.h); several a link
/// move as one. <inertial auto="true"> is computed from the shapes. Two colliders meet if their
/// <collide_bitmask>s have a bit in common. Joints: sdf_joints.h. Materials: friction from
/// <surface><friction><ode><mu>, restitution from <bounce><restitution_coefficient>; a pair has the
/// minimum of the two (Gazebo's rule). Links of one model collide only with <self_collide>. Gravity
/// and <max_step_size> are the world's.
///
/// SDFormat has no place for these, so they are namespaced elements, which libsdformat carries
/// along:
///
///     in <world>  <signorini:title>, <signorini:description>, <signorini:duration> (s),
///                 <signorini:pairing> minimum | multiply | maximum | mean,
///                 <signorini:error> (the name of the check whose error stands for the scene),
///                 <signorini:error_scale> (> 0: an error of this size is wholly wrong),
///                 <signorini:kind> stands | slides | bounces | free
///                 <signorini:stepper> time-stepping | event-driven (who of ours runs it)
///     in <link>   <signorini:linear_velocity> (of the centre of mass, m/s, world axes),
///                 <signorini:angular_velocity> (rad/s, world axes)
///
/// Everything else that the file says and a run ignores is in Scene::notices: one line for what has
/// no physics (visuals, sensors, plugins, lights ...), one for physics that is ignored.
///
/// @throws InputError naming the file, the model or link, and the element or field: file missing,
/// XML malformed or nested deeper than tinyxml2 reads, <include>s that never end (xml_includes.h),
/// numbers that are not finite or out of bounds, inertia that violates the triangle
/// inequality, collision shapes and joints that are not supported.
[[nodiscard]] Scene read_scene_file(const std::string& path, const ReadOptions& options = {});

/// The same from text. @param source how messages name it; Scene::source
[[nodiscard]] Scene read_scene_text(const std::string& text, const std::string& source,
                                    const ReadOptions& options = {});

/// The version of libsdformat, for the report.
[[nodiscard]] std::string sdformat_version();

}  // namespace signorini::validation
