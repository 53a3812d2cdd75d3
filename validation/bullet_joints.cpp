#include <signorini/validation/bullet_joints.h>

#include <algorithm>
#include <cmath>

namespace signorini::validation {
namespace {

btTransform frame(const Quat& principal, const Vec3& anchor, const Quat& orientation) {
  const Quat back = principal.conjugate();
  const Vec3 p = back * anchor;
  const Quat q = (back * orientation).normalized();
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), btVector3(p.x(), p.y(), p.z()));
}

bool has_limits(const Joint& joint) {
  return std::isfinite(joint.limits.lower) || std::isfinite(joint.limits.upper);
}

std::unique_ptr<btTypedConstraint> make_hinge(const Joint& joint, btRigidBody& a, btRigidBody& b,
                                              const btTransform& in_a, const btTransform& in_b,
                                              double step) {
  auto hinge = std::make_unique<btHingeConstraint>(b, a, in_b, in_a, true);
  if (has_limits(joint)) hinge->setLimit(joint.limits.lower, joint.limits.upper);
  if (joint.motor.max_force > 0.0) {
    hinge->enableAngularMotor(true, joint.motor.speed, joint.motor.max_force * step);
  }
  return hinge;
}

std::unique_ptr<btTypedConstraint> make_slider(const Joint& joint, btRigidBody& a, btRigidBody& b,
                                               const btTransform& in_a, const btTransform& in_b) {
  auto slider = std::make_unique<btSliderConstraint>(b, a, in_b, in_a, true);
  if (has_limits(joint)) {
    slider->setLowerLinLimit(std::max(joint.limits.lower, -double(BT_LARGE_FLOAT)));
    slider->setUpperLinLimit(std::min(joint.limits.upper, double(BT_LARGE_FLOAT)));
  }
  if (joint.motor.max_force > 0.0) {
    slider->setPoweredLinMotor(true);
    slider->setTargetLinMotorVelocity(joint.motor.speed);
    slider->setMaxLinMotorForce(joint.motor.max_force);
  }
  return slider;
}

}  // namespace

std::unique_ptr<btTypedConstraint> make_bullet_joint(const Joint& joint, btRigidBody& a,
                                                     const Quat& principal_a, btRigidBody& b,
                                                     const Quat& principal_b, double step) {
  const Vec3 along = joint.kind == JointKind::kSlider ? Vec3::UnitX() : Vec3::UnitZ();
  const Quat in_b = Quat::FromTwoVectors(along, joint.axis);
  const btTransform frame_a =
      frame(principal_a, joint.anchor_a, joint.reference.conjugate() * in_b);
  const btTransform frame_b = frame(principal_b, joint.anchor_b, in_b);
  switch (joint.kind) {
    case JointKind::kHinge: return make_hinge(joint, a, b, frame_a, frame_b, step);
    case JointKind::kSlider: return make_slider(joint, a, b, frame_a, frame_b);
    case JointKind::kBall:
      return std::make_unique<btPoint2PointConstraint>(b, a, frame_b.getOrigin(),
                                                       frame_a.getOrigin());
    case JointKind::kFixed: return std::make_unique<btFixedConstraint>(b, a, frame_b, frame_a);
    case JointKind::kDistance: break;
  }
  return nullptr;
}

}  // namespace signorini::validation
