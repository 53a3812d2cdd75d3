#pragma once

#include <signorini/core/model/joint.h>

#include <btBulletDynamicsCommon.h>
#include <memory>

namespace signorini::validation {

/// A joint of ours as Bullet's: btHingeConstraint, btSliderConstraint, btPoint2PointConstraint,
/// btFixedConstraint, with the same coordinate, limits and motor (a hinge's maximum impulse is
/// max_force times the step). Bullet's rbA is our B.
/// @param principal_a, principal_b Bullet's body frames in ours
/// @return null for a distance, which Bullet has no constraint for
[[nodiscard]] std::unique_ptr<btTypedConstraint> make_bullet_joint(
    const Joint& joint, btRigidBody& a, const Quat& principal_a, btRigidBody& b,
    const Quat& principal_b, double step);

}  // namespace signorini::validation
