#pragma once

#include <btBulletDynamicsCommon.h>
#include <memory>
#include <string>
#include <vector>

namespace signorini::bullet {

/// Scenes of Bullet's examples, rebuilt: a world on a large box (top at y = 0), gravity -9.81
/// m/s^2, steps of 1/60 s, Bullet's default settings but for sleeping, which is off. For tests and
/// studies of whatever constraint solver a world is given; not installed.
///
/// | name | what it is |
/// |---|---|
/// | stack | 30 unit cubes of 1 kg |
/// | wall | 6 courses of 6 or 5 staggered bricks, friction .5 |
/// | wall-hit | the same, hit by a ball of 20 kg at 15 m/s |
/// | ragdoll | 11 capsules, 6 cone-twist and 5 hinge joints with limits, dropped from .5 m |
/// | vehicle | a chassis of 80 kg on four wheels with btHinge2Constraint: springs, motors, limits |
class ExampleScene {
 public:
  /// @param solver of the world; must outlive the scene
  /// @throws std::invalid_argument listing the names.
  ExampleScene(const std::string& name, btConstraintSolver& solver);
  ~ExampleScene();
  ExampleScene(const ExampleScene&) = delete;
  ExampleScene& operator=(const ExampleScene&) = delete;

  [[nodiscard]] static std::vector<std::string> names();

  void step();
  [[nodiscard]] btDiscreteDynamicsWorld& world() { return *world_; }
  /// The movable bodies, in the order in which they were made.
  [[nodiscard]] const std::vector<btRigidBody*>& bodies() const { return movable_; }

  /// Kinetic energy of all bodies, J.
  [[nodiscard]] double kinetic_energy() const;
  /// The deepest overlap among the contact points that the last step solved, m; 0 if none overlap.
  [[nodiscard]] double deepest_overlap() const;
  /// The largest distance between the two anchors of a joint, m. (A suspension moves along its
  /// spring, which does not count.)
  [[nodiscard]] double joint_error() const;

 private:
  btRigidBody* add(btCollisionShape* shape, double mass, const btTransform& pose);
  void add(btTypedConstraint* joint);
  void make_stack();
  void make_wall();
  void make_ball();
  void make_ragdoll();
  void make_vehicle();

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<btRigidBody*> movable_;
};

}  // namespace signorini::bullet
