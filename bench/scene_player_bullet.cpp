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

class BulletPlayer final : public ScenePlayer {
 public:
  BulletPlayer(const SteppedScene& scene, int iterations)
      : step_(scene.step),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
    world_.getSolverInfo().m_numIterations = iterations;
    world_.setGravity(btVector3(0.0, 0.0, -9.81));
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
  [[nodiscard]] double worst_residual() const override {
    return std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] int unsolved_steps() const override { return 0; }

 private:
  /// @pre one box a body, along its axes
  void add(const Body& body, const BodyState& state, const collision::Collider& collider) {
    const auto* box = std::get_if<collision::Box>(&collider.shape);
    if (box == nullptr) {
      throw std::invalid_argument("stacks: Bullet is given boxes only");
    }
    shapes_.push_back(std::make_unique<btBoxShape>(bullet(box->half_extents)));
    btRigidBody::btRigidBodyConstructionInfo info(body.is_dynamic() ? body.mass : 0.0, nullptr,
                                                  shapes_.back().get(),
                                                  bullet(body.inertia.diagonal()));
    info.m_startWorldTransform = btTransform(
        btQuaternion(state.q.x(), state.q.y(), state.q.z(), state.q.w()), bullet(state.x));
    info.m_friction = std::sqrt(collider.material.friction);  // of a pair: multiplied
    info.m_restitution = std::sqrt(collider.material.restitution);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
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
