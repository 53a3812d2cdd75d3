#include <signorini/validation/bullet_joints.h>
#include <signorini/validation/bullet_world.h>
#include <signorini/validation/input_error.h>

#include <BulletCollision/CollisionDispatch/btCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace signorini::validation {
namespace {

/// Bullet's hooks are plain functions: the scene whose world is stepping.
const Scene* stepping_scene = nullptr;

btVector3 bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
btQuaternion bullet(const Quat& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}
Quat ours(const btQuaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}
btTransform bullet(const Pose& pose) {
  return btTransform(bullet(pose.orientation), bullet(pose.position));
}

/// The collider whose shape, or a part of it (a triangle of a mesh), this is; null if none.
const collision::Collider* collider_of(const btCollisionObjectWrapper* wrapper) {
  for (; wrapper != nullptr; wrapper = wrapper->m_parent) {
    const int index = wrapper->getCollisionShape()->getUserIndex();
    if (index >= 0) return &stepping_scene->colliders[index];
  }
  return nullptr;
}

/// Parts of compounds meet if their colliders' filters let them.
bool parts_may_meet(const btCollisionShape* a, const btCollisionShape* b) {
  if (a->getUserIndex() < 0 || b->getUserIndex() < 0) return true;
  return collision::may_collide(stepping_scene->colliders[a->getUserIndex()].filter,
                                stepping_scene->colliders[b->getUserIndex()].filter);
}

/// The turn to the principal axes, and the moments about them. A diagonal inertia stays as it is.
Quat principal_axes(const Mat3& inertia, Vec3& moments) {
  const Mat3 diagonal = inertia.diagonal().asDiagonal();
  if (inertia == diagonal) {
    moments = inertia.diagonal();
    return Quat::Identity();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(inertia);
  moments = eigen.eigenvalues();
  Mat3 axes = eigen.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) = -axes.col(0);
  return Quat(axes);
}

int gyroscopic_flag(BulletGyroscopic gyroscopic) {
  switch (gyroscopic) {
    case BulletGyroscopic::kNone: return 0;
    case BulletGyroscopic::kExplicit: return BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT;
    case BulletGyroscopic::kImplicitBody: return BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY;
    case BulletGyroscopic::kImplicitWorld: return BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD;
  }
  return 0;
}

}  // namespace

BulletWorld::BulletWorld(const Scene& scene, const BulletProfile& profile)
    : scene_(scene),
      profile_(profile),
      dispatcher_(&configuration_),
      world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
      filter_(scene),
      parts_(scene.bodies.size()) {
  world_.getPairCache()->setOverlapFilterCallback(&filter_);
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = profile.iterations;
  info.m_splitImpulse = 1;
  info.m_splitImpulsePenetrationThreshold = profile.split_impulse_penetration_threshold;
  info.m_restitutionVelocityThreshold = profile.restitution_velocity_threshold;
  info.m_warmstartingFactor = profile.warm_starting_factor;
  world_.setGravity(bullet(scene.gravity));
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) add_body(i);
  for (const auto& [first, second] : scene.never_collide) {
    parts_[first].body->setIgnoreCollisionCheck(parts_[second].body.get(), true);
    parts_[second].body->setIgnoreCollisionCheck(parts_[first].body.get(), true);
  }
  for (const Joint& joint : scene.joints) add_joint(joint);
}

void BulletWorld::add_joint(const Joint& joint) {
  const BodyParts& a = parts_[joint.body_a];
  const BodyParts& b = parts_[joint.body_b];
  auto made = make_bullet_joint(joint, *a.body, a.principal, *b.body, b.principal, scene_.step);
  if (made == nullptr) {
    throw InputError(scene_.source + ": joint '" + joint.name +
                     "': Bullet has no constraint for a distance");
  }
  world_.addConstraint(made.get(), !joint.bodies_collide);
  joints_.push_back(std::move(made));
}

BulletWorld::~BulletWorld() {
  for (const auto& joint : joints_) world_.removeConstraint(joint.get());
  for (BodyParts& parts : parts_) world_.removeRigidBody(parts.body.get());
}

BulletWorld::PairFilter::PairFilter(const Scene& scene) : filters_(scene.bodies.size()) {
  for (const collision::Collider& collider : scene.colliders) {
    std::vector<collision::CollisionFilter>& filters = filters_[collider.body];
    if (std::find(filters.begin(), filters.end(), collider.filter) == filters.end()) {
      filters.push_back(collider.filter);
    }
  }
}

bool BulletWorld::PairFilter::needBroadphaseCollision(btBroadphaseProxy* a,
                                                      btBroadphaseProxy* b) const {
  // Bullet's own rule first: it keeps fixed bodies from each other.
  if ((a->m_collisionFilterGroup & b->m_collisionFilterMask) == 0 ||
      (b->m_collisionFilterGroup & a->m_collisionFilterMask) == 0) {
    return false;
  }
  const auto filters_of = [this](const btBroadphaseProxy* proxy) -> const auto& {
    const auto* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
    return filters_[object->getUserIndex()];
  };
  for (const collision::CollisionFilter& first : filters_of(a)) {
    for (const collision::CollisionFilter& second : filters_of(b)) {
      if (collision::may_collide(first, second)) return true;
    }
  }
  return false;
}

void BulletWorld::add_shapes(int index, BodyParts& parts) {
  parts.compound = std::make_unique<btCompoundShape>();
  const Quat to_principal = parts.principal.conjugate();
  for (std::size_t c = 0; c < scene_.colliders.size(); ++c) {
    const collision::Collider& collider = scene_.colliders[c];
    if (collider.body != index) continue;
    for (BulletShape& made : make_bullet_shapes(collider.shape, profile_.ground_half_edge)) {
      const Pose pose = Pose{Vec3::Zero(), to_principal} * collider.local * made.in_ours;
      made.shape->setUserIndex(static_cast<int>(c));
      parts.compound->addChildShape(bullet(pose), made.shape.get());
      if (!made.remark.empty()) remarks_.insert(made.remark);
      parts.shapes.push_back(std::move(made));
    }
  }
}

void BulletWorld::add_body(int index) {
  const Body& body = scene_.bodies[index];
  const BodyState& state = scene_.state[index];
  if (body.kind == BodyKind::kKinematic) {
    throw InputError(scene_.source + ": body '" + body.name + "': kinematic bodies are not run");
  }
  BodyParts& parts = parts_[index];
  Vec3 moments = Vec3::Zero();
  if (body.is_dynamic()) parts.principal = principal_axes(body.inertia, moments);
  add_shapes(index, parts);

  // One shape in the body's own frame needs no compound, which has its own contact algorithm.
  btCollisionShape* shape = parts.compound.get();
  const bool single = parts.shapes.size() == 1 &&
                      parts.compound->getChildTransform(0) == btTransform::getIdentity();
  if (single) shape = parts.shapes.front().shape.get();
  btRigidBody::btRigidBodyConstructionInfo info(body.is_dynamic() ? body.mass : 0.0, nullptr, shape,
                                                bullet(moments));
  info.m_startWorldTransform = bullet(Pose{state.x, (state.q * parts.principal).normalized()});
  info.m_linearDamping = 0.0;
  info.m_angularDamping = 0.0;
  parts.body = std::make_unique<btRigidBody>(info);
  btRigidBody& made = *parts.body;
  made.setUserIndex(index);
  made.setContactProcessingThreshold(std::isfinite(profile_.contact_processing_threshold)
                                         ? btScalar(profile_.contact_processing_threshold)
                                         : BT_LARGE_FLOAT);
  made.setCollisionFlags(made.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
  made.setFlags(gyroscopic_flag(profile_.gyroscopic) | BT_DISABLE_WORLD_GRAVITY);
  if (body.is_dynamic()) {
    if (!profile_.sleeping) made.setActivationState(DISABLE_DEACTIVATION);
    const Velocity v = velocity(body, state);
    made.setLinearVelocity(bullet(v.linear));
    made.setAngularVelocity(bullet(v.angular));
  }
  world_.addRigidBody(&made);
  made.setGravity(bullet((body.gravity_scale * scene_.gravity).eval()));
}

bool BulletWorld::set_pair_material(btManifoldPoint& point, const btCollisionObjectWrapper* a, int,
                                    int, const btCollisionObjectWrapper* b, int, int) {
  const collision::Collider* const first = collider_of(a);
  const collision::Collider* const second = collider_of(b);
  if (first == nullptr || second == nullptr) return false;
  const Material material = pair(first->material, second->material, stepping_scene->rule);
  point.m_combinedFriction = material.friction;
  point.m_combinedRestitution = material.restitution;
  point.m_combinedRollingFriction = material.rolling_friction;
  point.m_combinedSpinningFriction = material.spinning_friction;
  return true;
}

void BulletWorld::step(double seconds) {
  stepping_scene = &scene_;
  gContactAddedCallback = set_pair_material;
  gCompoundChildShapePairCallback = parts_may_meet;
  gCompoundCompoundChildShapePairCallback = parts_may_meet;
  world_.stepSimulation(seconds, 0);  // 0 substeps: one step of exactly this length
  gCompoundCompoundChildShapePairCallback = nullptr;
  gCompoundChildShapePairCallback = nullptr;
  gContactAddedCallback = nullptr;
  stepping_scene = nullptr;
}

std::vector<BodySample> BulletWorld::sample() const {
  std::vector<BodySample> samples(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const btRigidBody& body = *parts_[i].body;
    const btTransform& pose = body.getWorldTransform();
    samples[i].pose = {ours(pose.getOrigin()),
                       (ours(pose.getRotation()) * parts_[i].principal.conjugate()).normalized()};
    samples[i].velocity = {ours(body.getLinearVelocity()), ours(body.getAngularVelocity())};
  }
  return samples;
}

std::vector<ContactSample> BulletWorld::contacts(double step) const {
  std::vector<ContactSample> samples;
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    // Bullet has no const access to its manifolds.
    const btPersistentManifold& manifold =
        *const_cast<btCollisionDispatcher&>(dispatcher_).getManifoldByIndexInternal(m);
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold.getContactPoint(p);
      // Points that the solver left out keep the impulse of an earlier step.
      if (point.getDistance() > manifold.getContactProcessingThreshold()) continue;
      btVector3 impulse = point.m_appliedImpulse * point.m_normalWorldOnB;
      // The directions are not set before the first friction impulse.
      if (point.m_appliedImpulseLateral1 != 0.0) {
        impulse += point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1;
      }
      if (point.m_appliedImpulseLateral2 != 0.0) {
        impulse += point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
      }
      samples.push_back({manifold.getBody0()->getUserIndex(), manifold.getBody1()->getUserIndex(),
                         ours(0.5 * (point.getPositionWorldOnA() + point.getPositionWorldOnB())),
                         ours(impulse / step)});
    }
  }
  return samples;
}

}  // namespace signorini::validation
