#pragma once

#include <btBulletDynamicsCommon.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace signorini::validation {

/// A world of Bullet's that saves itself as a .bullet file, in the precision it is compiled for:
/// three cubes on each other, a bar on a hinge with limits, a ball on a string, a rolling capsule,
/// a hull, a body of two shapes on a slider, a fixed pair, on a ground that is a box.
class SavedWorld {
 public:
  SavedWorld();
  ~SavedWorld();
  SavedWorld(const SavedWorld&) = delete;
  SavedWorld& operator=(const SavedWorld&) = delete;

  btRigidBody& add(const char* name, btCollisionShape* shape, double mass, const btVector3& place);
  void add(btTypedConstraint* constraint);
  /// The file's bytes.
  [[nodiscard]] std::string bytes();
  void step(double seconds, int steps);

  std::vector<std::unique_ptr<btRigidBody>> bodies;

 private:
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
  std::vector<std::pair<const btRigidBody*, const char*>> names_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
};

}  // namespace signorini::validation
