// One line changed in a DART program: a stack of three boxes, every step certified.
#include <signorini/integrations/dart/boxed_lcp_solver.h>

#include <cstdio>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/simulation/World.hpp>
#include <memory>
#include <string>

using namespace dart::dynamics;

namespace {

SkeletonPtr add_box(dart::simulation::World& world, const Eigen::Vector3d& size, double height) {
  SkeletonPtr skeleton = Skeleton::create("box at " + std::to_string(height));
  BodyNode* body = skeleton->createJointAndBodyNodePair<FreeJoint>().second;
  body->createShapeNodeWith<CollisionAspect, DynamicsAspect>(std::make_shared<BoxShape>(size));
  body->setInertia(
      Inertia(1.0, Eigen::Vector3d::Zero(), BoxShape::computeInertia(size, /*mass=*/1.0)));
  skeleton->setPosition(5, height);  // of the centre, m
  world.addSkeleton(skeleton);
  return skeleton;
}

}  // namespace

int main() {
  auto world = dart::simulation::World::create();  // 1 ms a step
  world->setGravity(Eigen::Vector3d(0.0, 0.0, -9.81));

  auto lcp = std::make_shared<signorini::dartsim::BoxedLcpSolver>();
  world->setConstraintSolver(  // was: DantzigBoxedLcpSolver
      std::make_unique<dart::constraint::BoxedLcpConstraintSolver>(lcp));

  add_box(*world, Eigen::Vector3d(20.0, 20.0, 1.0), -0.5)->setMobile(false);
  SkeletonPtr top;
  for (int k = 0; k < 3; ++k) {
    top = add_box(*world, Eigen::Vector3d(0.5, 0.5, 0.5), 0.25 + 0.5 * k);
  }
  for (int i = 0; i < 500; ++i) {
    world->step();
  }
  const auto& counters = lcp->counters();
  std::printf("after 0.5 s the top box is at %.2f m; %lld of %lld problems solved\n",
              top->getBodyNode(0)->getTransform().translation().z(),
              static_cast<long long>(counters.problems - counters.not_solved()),
              static_cast<long long>(counters.problems));
}
