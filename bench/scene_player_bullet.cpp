#include <signorini/collision/hull.h>

#include "bench/scene_player.h"

#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>
#include <vector>

namespace signorini::bench {
namespace {

btVector3 bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// A box, ball or hull about the body's axes. @throws std::invalid_argument for other shapes
std::unique_ptr<btCollisionShape> bullet_shape(const collision::Shape& shape) {
  if (const auto* box = std::get_if<collision::Box>(&shape)) {
    return std::make_unique<btBoxShape>(bullet(box->half_extents));
  }
  if (const auto* ball = std::get_if<collision::Sphere>(&shape)) {
    return std::make_unique<btSphereShape>(ball->radius);
  }
  if (const auto* hull = std::get_if<collision::ConvexHull>(&shape)) {
    auto points = std::make_unique<btConvexHullShape>();
    points->setMargin(0.0);  // so that it is the shape that was given
    for (const Vec3& vertex : hull->data->vertices) {
      points->addPoint(bullet(vertex), false);
    }
    points->recalcLocalAabb();
    return points;
  }
  throw std::invalid_argument("scene player: Bullet is given boxes, balls and hulls only");
}

class BulletPlayer final : public ScenePlayer {
 public:
  BulletPlayer(const SteppedScene& scene, int iterations)
      : step_(scene.step),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
    world_.getSolverInfo().m_numIterations = iterations;
    world_.setGravity(bullet(scene.gravity));
    for (const collision::Collider& collider : scene.colliders) {
      add(scene.bodies[collider.body], scene.state[collider.body], collider);
    }
  }
  ~BulletPlayer() override {
    for (const auto& body : bodies_) {
      world_.removeRigidBody(body.get());
    }
  }
  BulletPlayer(const BulletPlayer&) = delete;
  BulletPlayer& operator=(const BulletPlayer&) = delete;

  void step() override { world_.stepSimulation(step_, 0); }  // 0: one step of just this length
  [[nodiscard]] State poses() const override {
    State state;
    state.reserve(bodies_.size());
    for (const auto& body : bodies_) {
      const btTransform& pose = body->getWorldTransform();
      const btQuaternion q = pose.getRotation();
      state.emplace_back();
      state.back().x = Vec3(pose.getOrigin().x(), pose.getOrigin().y(), pose.getOrigin().z());
      state.back().q = Quat(q.w(), q.x(), q.y(), q.z()).normalized();
    }
    return state;
  }
  [[nodiscard]] std::vector<Velocity> velocities() const override {
    std::vector<Velocity> all;
    for (const auto& body : bodies_) {
      const btVector3& v = body->getLinearVelocity();
      const btVector3& w = body->getAngularVelocity();
      all.push_back({Vec3(v.x(), v.y(), v.z()), Vec3(w.x(), w.y(), w.z())});
    }
    return all;
  }
  [[nodiscard]] double worst_residual() const override {
    return std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] int unsolved_steps() const override { return 0; }
  [[nodiscard]] lcp::Status status() const override { return lcp::Status::kNotRun; }

 private:
  /// @throws std::invalid_argument for what Bullet would take for another body
  void add(const Body& body, const BodyState& state, const collision::Collider& collider) {
    if (!collider.local.position.isZero() || collider.local.orientation.w() != 1.0 ||
        !body.inertia.isDiagonal()) {
      throw std::invalid_argument(
          "scene player: Bullet is given bodies with one shape about their principal axes only");
    }
    shapes_.push_back(bullet_shape(collider.shape));
    btRigidBody::btRigidBodyConstructionInfo info(body.is_dynamic() ? body.mass : 0.0, nullptr,
                                                  shapes_.back().get(),
                                                  bullet(body.inertia.diagonal()));
    info.m_startWorldTransform = btTransform(
        btQuaternion(state.q.x(), state.q.y(), state.q.z(), state.q.w()), bullet(state.x));
    info.m_friction = std::sqrt(collider.material.friction);  // of a pair: multiplied
    info.m_restitution = std::sqrt(collider.material.restitution);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    const Velocity motion = velocity(body, state);
    bodies_.back()->setLinearVelocity(bullet(motion.linear));
    bodies_.back()->setAngularVelocity(bullet(motion.angular));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get());
  }

  double step_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace

Contestant bullet_stepper(int iterations) {
  return {fmt::format("Bullet SI{}", iterations),
          [iterations](const SteppedScene& scene) {
            return std::make_unique<BulletPlayer>(scene, iterations);
          },
          false};
}

}  // namespace signorini::bench
