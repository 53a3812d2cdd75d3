#include <signorini/validation/bullet_world.h>
#include <signorini/validation/input_error.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <variant>

namespace signorini::validation {
namespace {

/// Bullet's material hook is a plain function: the scene whose world is stepping.
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
      parts_(scene.bodies.size()) {
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
}

BulletWorld::~BulletWorld() {
  for (BodyParts& parts : parts_) world_.removeRigidBody(parts.body.get());
}

btCollisionShape* BulletWorld::make_shape(const collision::Collider& collider, Pose& pose) const {
  if (const auto* sphere = std::get_if<collision::Sphere>(&collider.shape)) {
    return new btSphereShape(sphere->radius);
  }
  if (const auto* box = std::get_if<collision::Box>(&collider.shape)) {
    return new btBoxShape(bullet(box->half_extents));
  }
  if (!std::holds_alternative<collision::HalfSpace>(collider.shape)) {
    throw InputError(scene_.source + ": collider '" + collider.name +
                     "': Bullet is given spheres, boxes and half-spaces only");
  }
  // A half-space: the top face of a large box is its surface.
  const double edge = profile_.ground_half_edge;
  pose.position -= pose.orientation * Vec3(0.0, 0.0, edge);
  return new btBoxShape(btVector3(edge, edge, edge));
}

void BulletWorld::add_shapes(int index, BodyParts& parts) {
  parts.compound = std::make_unique<btCompoundShape>();
  const Quat to_principal = parts.principal.conjugate();
  for (std::size_t c = 0; c < scene_.colliders.size(); ++c) {
    const collision::Collider& collider = scene_.colliders[c];
    if (collider.body != index) continue;
    Pose pose = Pose{Vec3::Zero(), to_principal} * collider.local;
    parts.shapes.emplace_back(make_shape(collider, pose));
    parts.shapes.back()->setUserIndex(static_cast<int>(c));
    parts.compound->addChildShape(bullet(pose), parts.shapes.back().get());
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
  if (single) shape = parts.shapes.front().get();
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
  const auto& colliders = stepping_scene->colliders;
  const Material material =
      pair(colliders[a->getCollisionShape()->getUserIndex()].material,
           colliders[b->getCollisionShape()->getUserIndex()].material, stepping_scene->rule);
  point.m_combinedFriction = material.friction;
  point.m_combinedRestitution = material.restitution;
  return true;
}

void BulletWorld::step(double seconds) {
  stepping_scene = &scene_;
  gContactAddedCallback = set_pair_material;
  world_.stepSimulation(seconds, 0);  // 0 substeps: one step of exactly this length
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

}  // namespace signorini::validation
