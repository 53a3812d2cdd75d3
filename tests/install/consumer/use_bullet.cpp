#include <signorini/integrations/bullet/constraint_solver.h>

#include <btBulletDynamicsCommon.h>

int main() {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  signorini::bullet::ConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  btBoxShape box(btVector3(1, 1, 1));
  btRigidBody ground(0, nullptr, &box);
  btRigidBody cube(1, nullptr, &box, btVector3(1, 1, 1));
  cube.getWorldTransform().setOrigin(btVector3(0, 2, 0));
  world.addRigidBody(&ground);
  world.addRigidBody(&cube);
  world.stepSimulation(btScalar(1.0 / 60.0), 0);
  world.removeRigidBody(&cube);
  world.removeRigidBody(&ground);
  return solver.counters().groups_solved == 1 ? 0 : 1;
}
