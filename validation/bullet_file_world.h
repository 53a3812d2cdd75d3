#pragma once

#include <signorini/validation/bullet_file_contents.h>

#include <btBulletDynamicsCommon.h>
#include <memory>
#include <string>
#include <vector>

namespace signorini::validation {

/// A .bullet file as Bullet's own world: btBulletWorldImporter, and what that leaves out of the
/// file's bodies (velocities, moments of inertia, damping, their own gravity). Bullet's loader
/// trusts the bytes it reads, so this belongs in a child process: whatever they are, a crash, a
/// hang or a wild write stays there. That is all: the child has this program's rights.
class BulletFileWorld {
 public:
  /// @throws std::runtime_error if Bullet's loader refuses the bytes
  explicit BulletFileWorld(std::string bytes);
  ~BulletFileWorld();
  BulletFileWorld(const BulletFileWorld&) = delete;
  BulletFileWorld& operator=(const BulletFileWorld&) = delete;

  [[nodiscard]] FileContents contents() const;
  /// Runs the world as it is, sleeping off, in steps of this length.
  /// @param stride a sample is kept at the start, after every stride-th step and after the last
  [[nodiscard]] FileRun run(double step, long steps, long stride);

 private:
  class Importer;
  [[nodiscard]] std::vector<double> sample() const;

  std::string bytes_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::unique_ptr<Importer> importer_;
};

}  // namespace signorini::validation
