#include <signorini/validation/bullet_file_world.h>

#include "tools/stopwatch.h"

#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletFileLoader/btBulletFile.h>
#include <BulletWorldImporter/btBulletWorldImporter.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace signorini::validation {
namespace {

FileVector vector_of(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
FilePose pose_of(const btTransform& pose) {
  const btVector3& x = pose.getOrigin();
  const btQuaternion q = pose.getRotation();
  return {x.x(), x.y(), x.z(), q.w(), q.x(), q.y(), q.z()};
}
/// Numbers of the file in either precision.
btVector3 numbers(const auto& stored) {
  return {btScalar(stored.m_floats[0]), btScalar(stored.m_floats[1]), btScalar(stored.m_floats[2])};
}

/// The turn of z to an axis 0, 1 or 2.
btQuaternion turn_z_to(int axis) {
  if (axis == 0) return {btVector3(0, 1, 0), SIMD_HALF_PI};
  if (axis == 1) return {btVector3(1, 0, 0), -SIMD_HALF_PI};
  return btQuaternion::getIdentity();
}

/// What the file says of a body and the importer does not pass on.
struct BodyFacts {
  btVector3 linear, angular, inverse_inertia, gravity, linear_factor, angular_factor, force, torque;
  double linear_damping, angular_damping, rolling_friction;
  int flags, additional_damping, anisotropic;
};
BodyFacts facts_of(const auto& data) {
  const auto& object = data.m_collisionObjectData;
  return {.linear = numbers(data.m_linearVelocity),
          .angular = numbers(data.m_angularVelocity),
          .inverse_inertia = numbers(data.m_invInertiaLocal),
          .gravity = numbers(data.m_gravity_acceleration),
          .linear_factor = numbers(data.m_linearFactor),
          .angular_factor = numbers(data.m_angularFactor),
          .force = numbers(data.m_totalForce),
          .torque = numbers(data.m_totalTorque),
          .linear_damping = double(data.m_linearDamping),
          .angular_damping = double(data.m_angularDamping),
          .rolling_friction = double(object.m_rollingFriction),
          .flags = object.m_collisionFlags,
          .additional_damping = data.m_additionalDamping,
          .anisotropic = object.m_hasAnisotropicFriction};
}

bool is_one(const btVector3& factor) {
  return factor == btVector3(1, 1, 1);
}

/// The file's objects as plain numbers.
class ContentsWriter {
 public:
  ContentsWriter(FileContents& contents, const btVector3& gravity)
      : contents_(contents), gravity_(gravity) {
    contents.gravity = vector_of(gravity);
  }

  void add_body(const std::string& name, const btRigidBody& body, const BodyFacts& facts) {
    FileBody added;
    added.name = name;
    added.mass = body.getInvMass() > 0 ? 1.0 / double(body.getInvMass()) : 0.0;
    added.pose = pose_of(body.getWorldTransform());
    added.friction = double(body.getFriction());
    added.restitution = double(body.getRestitution());
    const auto refuse = [&](bool is_wrong, const char* field, const std::string& what) {
      if (is_wrong)
        contents_.unsupported.push_back(fmt::format("body '{}': {}: {}", name, field, what));
    };
    if (added.mass > 0.0) {
      added.moments = vector_of(body.getLocalInertia());
      added.linear = vector_of(facts.linear);
      added.angular = vector_of(facts.angular);
      added.gravity_scale = gravity_scale(facts.gravity, refuse);
      for (int k = 0; k < 3; ++k) {
        refuse(!(facts.inverse_inertia[k] > 0), "m_invInertiaLocal",
               "a body that cannot turn about an axis");
      }
      refuse(facts.linear_damping != 0, "m_linearDamping", "damping");
      refuse(facts.angular_damping != 0, "m_angularDamping", "damping");
      refuse(facts.additional_damping != 0, "m_additionalDamping", "damping");
      refuse(!is_one(facts.linear_factor), "m_linearFactor", "motion that is scaled");
      refuse(!is_one(facts.angular_factor), "m_angularFactor", "motion that is scaled");
      refuse(!facts.force.isZero() || !facts.torque.isZero(), "m_totalForce, m_totalTorque",
             "forces that act beside gravity");
    }
    refuse(facts.rolling_friction != 0, "m_rollingFriction", "Bullet's rolling friction");
    refuse(facts.anisotropic != 0, "m_hasAnisotropicFriction", "Bullet's anisotropic friction");
    refuse((facts.flags & ~btCollisionObject::CF_STATIC_OBJECT & kMotionFlags) != 0,
           "m_collisionFlags",
           fmt::format("kinematic bodies, bodies without contact response, contact stiffness and "
                       "friction anchors (flags {})",
                       facts.flags));
    add_shape(name, *body.getCollisionShape(), btTransform::getIdentity(), added);
    contents_.bodies.push_back(std::move(added));
  }

  void add_joint(FileJoint joint, const btTypedConstraint& constraint) {
    if (!constraint.isEnabled()) {
      contents_.notices.push_back(joint.name + ": left out, it is not enabled");
      return;
    }
    // "Never" is the largest number of the precision that wrote the file.
    if (constraint.getBreakingImpulseThreshold() < btScalar(1e30)) {
      contents_.unsupported.push_back(joint.name + ": m_breakingImpulseThreshold: breaking joints");
    }
    std::string why;
    // Bullet's casts by type: it has no const access to limits.
    auto& open = const_cast<btTypedConstraint&>(constraint);
    switch (constraint.getConstraintType()) {
      case POINT2POINT_CONSTRAINT_TYPE:
        fill_ball(static_cast<btPoint2PointConstraint&>(open), joint);
        break;
      case HINGE_CONSTRAINT_TYPE:
        why = fill_hinge(static_cast<btHingeConstraint&>(open), joint);
        break;
      case SLIDER_CONSTRAINT_TYPE:
        why = fill_slider(static_cast<btSliderConstraint&>(open), joint);
        break;
      case D6_SPRING_2_CONSTRAINT_TYPE:  // so the importer makes a btFixedConstraint
        why = fill_fixed(static_cast<btGeneric6DofSpring2Constraint&>(open), joint);
        break;
      default:
        why = fmt::format(
            "m_objectType: constraints of type {} (supported: point to point, "
            "hinge, slider, fixed)",
            int(constraint.getConstraintType()));
    }
    if (!why.empty()) {
      contents_.unsupported.push_back(joint.name + ": " + why);
      return;
    }
    contents_.joints.push_back(std::move(joint));
  }

 private:
  static constexpr int kMotionFlags =
      btCollisionObject::CF_KINEMATIC_OBJECT | btCollisionObject::CF_NO_CONTACT_RESPONSE |
      btCollisionObject::CF_CHARACTER_OBJECT | btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING |
      btCollisionObject::CF_HAS_FRICTION_ANCHOR;

  double gravity_scale(const btVector3& own, const auto& refuse) const {
    const btScalar square = gravity_.length2();
    const btScalar scale = square > 0 ? own.dot(gravity_) / square : btScalar(0);
    refuse((own - scale * gravity_).length() > 1e-6 * (own.length() + gravity_.length()),
           "m_gravity_acceleration", "gravity in another direction than the world's");
    return double(scale);
  }

  void add_shape(const std::string& body, const btCollisionShape& shape, const btTransform& pose,
                 FileBody& added) {
    FileShape made;
    made.pose = pose_of(pose);
    // Along an axis of the shape: ours are along z.
    const auto along = [&](int axis) { made.pose = pose_of(pose * btTransform(turn_z_to(axis))); };
    switch (shape.getShapeType()) {
      case COMPOUND_SHAPE_PROXYTYPE: {
        const auto& compound = static_cast<const btCompoundShape&>(shape);
        for (int i = 0; i < compound.getNumChildShapes(); ++i) {
          add_shape(body, *compound.getChildShape(i), pose * compound.getChildTransform(i), added);
        }
        return;
      }
      case SPHERE_SHAPE_PROXYTYPE:
        made.kind = FileShapeKind::kSphere;
        made.size = {double(static_cast<const btSphereShape&>(shape).getRadius()), 0.0, 0.0};
        break;
      case BOX_SHAPE_PROXYTYPE:
        made.kind = FileShapeKind::kBox;
        made.size = vector_of(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
        break;
      case CAPSULE_SHAPE_PROXYTYPE: {
        const auto& capsule = static_cast<const btCapsuleShape&>(shape);
        made.kind = FileShapeKind::kCapsule;
        made.size = {double(capsule.getRadius()), double(capsule.getHalfHeight()), 0.0};
        along(capsule.getUpAxis());
        break;
      }
      case CYLINDER_SHAPE_PROXYTYPE: {
        const auto& cylinder = static_cast<const btCylinderShape&>(shape);
        made.kind = FileShapeKind::kCylinder;
        made.size = {double(cylinder.getRadius()),
                     double(cylinder.getHalfExtentsWithMargin()[cylinder.getUpAxis()]), 0.0};
        along(cylinder.getUpAxis());
        break;
      }
      case CONE_SHAPE_PROXYTYPE: {
        const auto& cone = static_cast<const btConeShape&>(shape);
        made.kind = FileShapeKind::kCone;
        made.size = {double(cone.getRadius()), 0.5 * double(cone.getHeight()), 0.0};
        along(cone.getConeUpIndex());
        break;
      }
      case STATIC_PLANE_PROXYTYPE: {
        const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
        made.kind = FileShapeKind::kHalfSpace;
        const btVector3 n = plane.getPlaneNormal();
        made.pose = pose_of(pose * btTransform(shortestArcQuat(btVector3(0, 0, 1), n),
                                               n * plane.getPlaneConstant()));
        break;
      }
      case CONVEX_HULL_SHAPE_PROXYTYPE: {
        const auto& hull = static_cast<const btConvexHullShape&>(shape);
        made.kind = FileShapeKind::kHull;
        for (int i = 0; i < hull.getNumPoints(); ++i) {
          made.points.push_back(vector_of(hull.getScaledPoint(i)));
        }
        contents_.notices.push_back(fmt::format(
            "body '{}': Bullet's hull is larger than ours by its margin of {:g} m all round", body,
            double(hull.getMargin())));
        break;
      }
      case TRIANGLE_MESH_SHAPE_PROXYTYPE: {
        struct Collector final : btTriangleCallback {
          FileShape& made;
          explicit Collector(FileShape& shape) : made(shape) {}
          void processTriangle(btVector3* corners, int, int) override {
            const int first = static_cast<int>(made.points.size());
            for (int k = 0; k < 3; ++k) made.points.push_back(vector_of(corners[k]));
            made.triangles.push_back({first, first + 1, first + 2});
          }
        } collector(made);
        made.kind = FileShapeKind::kMesh;
        static_cast<const btBvhTriangleMeshShape&>(shape).processAllTriangles(
            &collector, btVector3(-BT_LARGE_FLOAT, -BT_LARGE_FLOAT, -BT_LARGE_FLOAT),
            btVector3(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT));
        break;
      }
      default:
        contents_.unsupported.push_back(fmt::format("body '{}': m_shapeType: shape {} ({})", body,
                                                    shape.getShapeType(), shape.getName()));
        return;
    }
    added.shapes.push_back(std::move(made));
  }

  static void fill_ball(btPoint2PointConstraint& ball, FileJoint& joint) {
    joint.kind = FileJointKind::kBall;
    joint.in_a = pose_of(btTransform(btQuaternion::getIdentity(), ball.getPivotInB()));
    joint.in_b = pose_of(btTransform(btQuaternion::getIdentity(), ball.getPivotInA()));
  }

  /// Bullet's angle is ours with the reference frame A, its negative without.
  static std::string fill_hinge(btHingeConstraint& hinge, FileJoint& joint) {
    joint.kind = FileJointKind::kHinge;
    joint.in_a = pose_of(hinge.getBFrame());
    joint.in_b = pose_of(hinge.getAFrame());
    if (hinge.getAngularOnly()) return "m_angularOnly: hinges that hold the axis alone";
    const bool is_ours = hinge.getUseReferenceFrameA();
    if (hinge.hasLimit()) {
      const double low = double(hinge.getLowerLimit());
      const double high = double(hinge.getUpperLimit());
      joint.lower = is_ours ? low : -high;
      joint.upper = is_ours ? high : -low;
    }
    if (hinge.getEnableAngularMotor()) {
      joint.motor_speed = (is_ours ? 1.0 : -1.0) * double(hinge.getMotorTargetVelocity());
      joint.motor_impulse = double(hinge.getMaxMotorImpulse());
    }
    return "";
  }

  static std::string fill_slider(btSliderConstraint& slider, FileJoint& joint) {
    joint.kind = FileJointKind::kSlider;
    joint.in_a = pose_of(slider.getFrameOffsetB());
    joint.in_b = pose_of(slider.getFrameOffsetA());
    if (slider.getLowerAngLimit() != 0 || slider.getUpperAngLimit() != 0) {
      return "m_angularLowerLimit, m_angularUpperLimit: sliders that turn";
    }
    const bool is_ours = slider.getUseLinearReferenceFrameA();
    const double low = double(slider.getLowerLinLimit());
    const double high = double(slider.getUpperLinLimit());
    if (low <= high) {
      joint.lower = is_ours ? low : -high;
      joint.upper = is_ours ? high : -low;
    }
    return "";
  }

  static std::string fill_fixed(btGeneric6DofSpring2Constraint& fixed, FileJoint& joint) {
    joint.kind = FileJointKind::kFixed;
    joint.in_a = pose_of(fixed.getFrameOffsetB());
    joint.in_b = pose_of(fixed.getFrameOffsetA());
    std::array<btVector3, 4> limits;
    fixed.getLinearLowerLimit(limits[0]);
    fixed.getLinearUpperLimit(limits[1]);
    fixed.getAngularLowerLimit(limits[2]);
    fixed.getAngularUpperLimit(limits[3]);
    const bool is_locked =
        std::ranges::all_of(limits, [](const btVector3& limit) { return limit.isZero(); });
    return is_locked ? "" : "m_objectType: constraints of six degrees of freedom with a free one";
  }

  FileContents& contents_;
  btVector3 gravity_;
};

}  // namespace

/// Bullet's importer with what it keeps to itself.
class BulletFileWorld::Importer final : public btBulletWorldImporter {
 public:
  Importer(btDynamicsWorld& world, std::string& bytes)
      : btBulletWorldImporter(&world), file_(bytes.data(), static_cast<int>(bytes.size())) {}

  bool load() { return loadFileFromMemory(&file_); }
  [[nodiscard]] bool is_double() const {
    return (file_.getFlags() & bParse::FD_DOUBLE_PRECISION) != 0;
  }
  [[nodiscard]] const bParse::btBulletFile& file() const { return file_; }
  /// The rigid body that was made of the file's k-th, null if none.
  [[nodiscard]] btRigidBody* body(int k) const {
    btCollisionObject* const* found = m_bodyMap.find(file_.m_rigidBodies[k]);
    return found == nullptr ? nullptr : btRigidBody::upcast(*found);
  }
  [[nodiscard]] BodyFacts facts(int k) const {
    const void* data = file_.m_rigidBodies[k];
    return is_double() ? facts_of(*static_cast<const btRigidBodyDoubleData*>(data))
                       : facts_of(*static_cast<const btRigidBodyFloatData*>(data));
  }
  [[nodiscard]] std::string name(const btRigidBody& body, int k) const {
    const char* given = getNameForPointer(&body);
    return given == nullptr || *given == '\0' ? fmt::format("body {}", k + 1) : std::string(given);
  }

 private:
  mutable bParse::btBulletFile file_;
};

BulletFileWorld::BulletFileWorld(std::string bytes)
    : bytes_(std::move(bytes)),
      dispatcher_(&configuration_),
      world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
      importer_(std::make_unique<Importer>(world_, bytes_)) {
  if (!importer_->load()) throw std::runtime_error("Bullet's loader refuses it");
  for (int k = 0; k < importer_->file().m_rigidBodies.size(); ++k) {
    btRigidBody* body = importer_->body(k);
    if (body == nullptr) throw std::runtime_error(fmt::format("body {}: it has no shape", k + 1));
    body->setActivationState(DISABLE_DEACTIVATION);
    if (body->getInvMass() == 0) continue;
    const BodyFacts facts = importer_->facts(k);
    const btVector3& inverse = facts.inverse_inertia;
    btVector3 moments(0, 0, 0);
    for (int i = 0; i < 3; ++i) moments[i] = inverse[i] > 0 ? 1 / inverse[i] : btScalar(0);
    body->setMassProps(1 / body->getInvMass(), moments);
    body->updateInertiaTensor();
    body->setLinearVelocity(facts.linear);
    body->setAngularVelocity(facts.angular);
    body->setDamping(btScalar(facts.linear_damping), btScalar(facts.angular_damping));
    body->setGravity(facts.gravity);
  }
}

BulletFileWorld::~BulletFileWorld() {
  importer_->deleteAllData();
}

FileContents BulletFileWorld::contents() const {
  FileContents contents;
  const bParse::btBulletFile& file = importer_->file();
  ContentsWriter writer(contents, world_.getGravity());
  std::vector<const btRigidBody*> bodies;
  for (int k = 0; k < file.m_rigidBodies.size(); ++k) {
    bodies.push_back(importer_->body(k));
    writer.add_body(importer_->name(*bodies.back(), k), *bodies.back(), importer_->facts(k));
  }
  const auto index_of = [&](const btRigidBody& body) {
    const auto found = std::ranges::find(bodies, &body);
    if (found == bodies.end()) return -1;  // the body that Bullet fixes joints to the world with
    return static_cast<int>(found - bodies.begin());
  };
  for (int k = 0; k < importer_->getNumConstraints(); ++k) {
    btTypedConstraint& constraint = *importer_->getConstraintByIndex(k);
    FileJoint joint;
    joint.name = fmt::format("constraint {}", k + 1);
    joint.body_a = index_of(constraint.getRigidBodyB());
    joint.body_b = index_of(constraint.getRigidBodyA());
    joint.bodies_collide = constraint.getRigidBodyA().checkCollideWith(&constraint.getRigidBodyB());
    writer.add_joint(std::move(joint), constraint);
  }
  const auto refuse = [&](int count, const char* what) {
    if (count > 0) contents.unsupported.push_back(fmt::format("{} {}", count, what));
  };
  refuse(file.m_constraints.size() - importer_->getNumConstraints(),
         "constraints that Bullet's importer does not make");
  refuse(file.m_softBodies.size(), "soft bodies");
  refuse(file.m_multiBodies.size(), "multi bodies");
  refuse(file.m_collisionObjects.size(), "collision objects that are no rigid bodies");
  return contents;
}

std::vector<double> BulletFileWorld::sample() const {
  std::vector<double> numbers;
  for (int k = 0; k < importer_->file().m_rigidBodies.size(); ++k) {
    const btRigidBody& body = *importer_->body(k);
    const FilePose pose = pose_of(body.getWorldTransform());
    numbers.insert(numbers.end(), pose.begin(), pose.end());
    for (const btVector3& v : {body.getLinearVelocity(), body.getAngularVelocity()}) {
      const FileVector velocity = vector_of(v);
      numbers.insert(numbers.end(), velocity.begin(), velocity.end());
    }
  }
  return numbers;
}

FileRun BulletFileWorld::run(double step, long steps, long stride) {
  FileRun run;
  run.iterations = world_.getSolverInfo().m_numIterations;
  run.samples.push_back(sample());
  for (long k = 1; k <= steps; ++k) {
    const tools::Stopwatch stopwatch;
    world_.stepSimulation(btScalar(step), 0);  // 0 substeps: one step of exactly this length
    run.seconds += stopwatch.seconds();
    if (k % stride == 0 || k == steps) run.samples.push_back(sample());
  }
  return run;
}

}  // namespace signorini::validation
