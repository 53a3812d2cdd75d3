#pragma once

#include <signorini/validation/bullet_profile.h>
#include <signorini/validation/scene.h>
#include <signorini/validation/track.h>

#include <btBulletDynamicsCommon.h>
#include <memory>
#include <vector>

namespace signorini::validation {

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

 private:
  struct BodyParts {
    Quat principal = Quat::Identity();  ///< Bullet's body frame in ours
    std::vector<std::unique_ptr<btCollisionShape>> shapes;
    std::unique_ptr<btCompoundShape> compound;
    std::unique_ptr<btRigidBody> body;
  };

  void add_body(int index);
  void add_shapes(int index, BodyParts& parts);
  [[nodiscard]] btCollisionShape* make_shape(const collision::Collider& collider, Pose& pose) const;
  static bool set_pair_material(btManifoldPoint& point, const btCollisionObjectWrapper* a,
                                int part_a, int index_a, const btCollisionObjectWrapper* b,
                                int part_b, int index_b);

  const Scene& scene_;
  BulletProfile profile_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<BodyParts> parts_;
};

}  // namespace signorini::validation
