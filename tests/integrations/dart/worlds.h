#pragma once

#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/simulation/World.hpp>
#include <memory>
#include <string>

namespace signorini::dartsim {

inline ::dart::dynamics::SkeletonPtr cube(const std::string& name, double side, double mass,
                                          double friction) {
  using namespace ::dart::dynamics;  // NOLINT: in a function
  const auto shape = std::make_shared<BoxShape>(Eigen::Vector3d::Constant(side));
  auto skeleton = Skeleton::create(name);
  auto [joint, body] = skeleton->createJointAndBodyNodePair<FreeJoint>();
  auto* node = body->createShapeNodeWith<CollisionAspect, DynamicsAspect>(shape);
  node->getDynamicsAspect()->setFrictionCoeff(friction);
  body->setInertia(Inertia(mass, Eigen::Vector3d::Zero(), shape->computeInertia(mass)));
  return skeleton;
}

/// Puts the centre of a cube at x; at rest.
inline void place(::dart::dynamics::Skeleton& cube, const Eigen::Vector3d& x) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
  q.tail<3>() = x;
  cube.setPositions(q);
}

inline Eigen::Vector3d position(const ::dart::dynamics::SkeletonPtr& cube) {
  return cube->getBodyNode(0)->getTransform().translation();
}

/// A world in SI units with a floor whose top is z = 0, DART's own collision detection, and this
/// solver alone.
inline ::dart::simulation::WorldPtr world_with_floor(
    const ::dart::constraint::BoxedLcpSolverPtr& solver, double friction) {
  using namespace ::dart;  // NOLINT: in a function
  auto world = simulation::World::create();
  world->setGravity(Eigen::Vector3d(0.0, 0.0, -9.81));
  world->setTimeStep(1e-3);
  world->setConstraintSolver(
      std::make_unique<constraint::BoxedLcpConstraintSolver>(solver, nullptr));
  world->getConstraintSolver()->setCollisionDetector(collision::DARTCollisionDetector::create());
  auto floor = cube("floor", 20.0, 1.0, friction);
  floor->setMobile(false);
  place(*floor, Eigen::Vector3d(0.0, 0.0, -10.0));
  world->addSkeleton(floor);
  return world;
}

}  // namespace signorini::dartsim
