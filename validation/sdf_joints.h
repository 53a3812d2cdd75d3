#pragma once

#include <signorini/validation/scene.h>
#include <signorini/validation/sdf_survey.h>

#include <map>
#include <sdf/Model.hh>
#include <string>
#include <string_view>

namespace signorini::validation {

/// Why a joint of this type is refused, or empty.
[[nodiscard]] std::string unsupported_joint(std::string_view type);

/// Bodies by the scoped name of their link: "model::link", "model::inner::link".
using BodyOfLink = std::map<std::string, int>;

/// Adds the joints of a model, links of inner models included: revolute and continuous (hinge),
/// prismatic (slider), ball and fixed. A is the child, B the parent ("world": a fixed body that is
/// added), c = 0 as the file poses them. Anchor: the joint's frame; axis: <xyz> as it is expressed.
///
/// <limit><lower>, <upper> are kept; |value| >= 1e16 is none. A hinge keeps both or none: limits of
/// one side, or a turn or more apart, are left out with a notice. <dynamics><friction> is a motor
/// of speed 0 with that force: dry friction. <damping> and <spring_stiffness> other than 0 are left
/// out with a notice; <effort> and <velocity> bound controllers, of which there are none.
/// The two bodies of a joint do not collide. Joints of two fixed bodies, or of a link that was left
/// out, are left out with a notice.
/// @param name the model's, scoped
/// @throws InputError naming file, model, joint and field
void add_joints(const sdf::Model& model, const Pose& model_pose, const std::string& name,
                const BodyOfLink& body_of_link, const SdfSurvey& survey, Scene& scene);

}  // namespace signorini::validation
