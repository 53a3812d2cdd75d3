// Bullet with Signorini inside: one line of a Bullet program changed.
#include <signorini/integrations/bullet/constraint_solver.h>

#include <btBulletDynamicsCommon.h>
#include <cstdio>
#include <memory>
#include <vector>

int main() {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  const auto solver = std::make_unique<signorini::bullet::ConstraintSolver>();  // the one line
  // was: std::make_unique<btSequentialImpulseConstraintSolver>();
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, solver.get(), &configuration);
  world.setGravity(btVector3(0, -9.81, 0));

  btBoxShape ground(btVector3(50, 50, 50));
  btBoxShape cube(btVector3(0.5, 0.5, 0.5));
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  const auto add = [&](btCollisionShape& shape, double mass, double height) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    bodies.push_back(std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia));
    bodies.back()->getWorldTransform().setOrigin(btVector3(0, height, 0));
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);  // no sleeping
    world.addRigidBody(bodies.back().get());
  };
  add(ground, 0.0, -50.0);
  for (int i = 0; i < 30; ++i) add(cube, 1.0, 0.5 + i);

  for (int step = 0; step < 600; ++step) world.stepSimulation(1.0 / 60.0, 0);

  const signorini::bullet::Counters& counters = solver->counters();
  std::printf("after 10 s the top cube is at %.3f m; %d of %d steps solved\n",
              bodies.back()->getWorldTransform().getOrigin().y(),
              static_cast<int>(counters.groups_solved), static_cast<int>(counters.groups));
  for (const auto& body : bodies) world.removeRigidBody(body.get());
}
