#pragma once

#include <signorini/validation/bullet_profile.h>
#include <signorini/validation/bullet_shapes.h>
#include <signorini/validation/scene.h>
#include <signorini/validation/track.h>

#include "tools/stopwatch.h"

#include <btBulletDynamicsCommon.h>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace signorini::validation {

/// Bullet's sequential impulses, which say how long they took.
class TimedBulletSolver final : public btSequentialImpulseConstraintSolver {
 public:
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** constraints, int constraint_count,
                      const btContactSolverInfo& info, btIDebugDraw* drawer,
                      btDispatcher* dispatcher) override {
    const tools::Stopwatch stopwatch;
    const btScalar residual = btSequentialImpulseConstraintSolver::solveGroup(
        bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, drawer,
        dispatcher);
    seconds_ += stopwatch.seconds();
    return residual;
  }
  /// Of all calls so far: wall time, or CPU time where that is less.
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  double seconds_ = 0.0;
};

/// A scene as a Bullet world. Bullet wants a diagonal inertia, so its body frame is our body frame
/// turned to the principal axes.
class BulletWorld {
 public:
  BulletWorld(const Scene& scene, const BulletProfile& profile);
  ~BulletWorld();
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  void step(double seconds);
  /// Poses and velocities of all bodies, our body frames.
  [[nodiscard]] std::vector<BodySample> sample() const;
  /// The contact points of the last step, with the impulses that Bullet's solver left on them over
  /// the step [s].
  [[nodiscard]] std::vector<ContactSample> contacts(double step) const;
  /// Inside the solver of contacts and joints so far, s.
  [[nodiscard]] double solver_seconds() const { return solver_.seconds(); }
  /// How Bullet's shapes differ from the scene's, one line a kind.
  [[nodiscard]] const std::set<std::string>& remarks() const { return remarks_; }

 private:
  struct BodyParts {
    Quat principal = Quat::Identity();  ///< Bullet's body frame in ours
    std::vector<BulletShape> shapes;
    std::unique_ptr<btCompoundShape> compound;
    std::unique_ptr<btRigidBody> body;
  };

  void add_body(int index);
  void add_joint(const Joint& joint);
  void add_shapes(int index, BodyParts& parts);
  /// Leaves out pairs of bodies of which no colliders meet, by their filters.
  class PairFilter final : public btOverlapFilterCallback {
   public:
    explicit PairFilter(const Scene& scene);
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;

   private:
    std::vector<std::vector<collision::CollisionFilter>> filters_;  ///< of each body's colliders
  };

  static bool set_pair_material(btManifoldPoint& point, const btCollisionObjectWrapper* a,
                                int part_a, int index_a, const btCollisionObjectWrapper* b,
                                int part_b, int index_b);

  const Scene& scene_;
  BulletProfile profile_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  TimedBulletSolver solver_;
  btDiscreteDynamicsWorld world_;
  PairFilter filter_;
  std::vector<BodyParts> parts_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::set<std::string> remarks_;
};

}  // namespace signorini::validation
