#include "saved_world.h"

#include <LinearMath/btSerializer.h>

namespace signorini::validation {
namespace {

btTransform at(double x, double y, double z) {
  return btTransform(btQuaternion::getIdentity(), btVector3(btScalar(x), btScalar(y), btScalar(z)));
}
btVector3 place(double x, double y, double z) {
  return at(x, y, z).getOrigin();
}

}  // namespace

SavedWorld::SavedWorld()
    : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
  world_.setGravity(place(0, 0, -9.75));
  add("ground", new btBoxShape(place(32, 32, 1)), 0, place(0, 0, -1));
  for (int i = 0; i < 3; ++i) {
    add(i == 0   ? "cube 1"
        : i == 1 ? "cube 2"
                 : "cube 3",
        new btBoxShape(place(0.5, 0.5, 0.5)), 1.0 + i, place(0, 0, 0.5 + i));
  }
  // A bar on a hinge to the world, level at first: it falls until a limit stops it.
  btRigidBody& bar = add("bar", new btBoxShape(place(0.5, 0.0625, 0.0625)), 2.0, place(4.5, 0, 4));
  btTransform axle = at(-0.5, 0, 0);
  axle.setRotation(btQuaternion(btVector3(1, 0, 0), -SIMD_HALF_PI));  // its z is the bar's y
  auto* hinge = new btHingeConstraint(bar, axle);
  hinge->setLimit(btScalar(-0.75), btScalar(0.75));
  add(hinge);
  btRigidBody& ball = add("ball", new btSphereShape(btScalar(0.25)), 0.5, place(-4, 0, 4));
  ball.setLinearVelocity(place(0, 1, 0));
  add(new btPoint2PointConstraint(ball, place(0, 0, 1)));
  btRigidBody& capsule =
      add("capsule", new btCapsuleShape(btScalar(0.25), btScalar(1)), 1.5, place(8, 0, 0.25));
  capsule.setLinearVelocity(place(-1, 0, 0));
  capsule.setAngularVelocity(place(0, -4, 0));  // it rolls: its axis is y
  capsule.setFriction(btScalar(0.75));
  auto* hull = new btConvexHullShape();
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) hull->addPoint(place(x, y, -0.25));
  }
  hull->addPoint(place(0, 0, 0.5));
  add("hull", hull, 1.0, place(0, 6, 3));
  // Two shapes on a slider along x.
  auto* dumbbell = new btCompoundShape();
  for (const double x : {-0.5, 0.5}) {
    dumbbell->addChildShape(at(x, 0, 0), shapes_.emplace_back(new btSphereShape(0.25)).get());
  }
  btRigidBody& sled = add("sled", dumbbell, 1.0, place(0, -6, 3));
  sled.setLinearVelocity(place(2, 0, 0));
  auto* slider = new btSliderConstraint(*bodies[0], sled, at(0, -6, 4), at(0, 0, 0), true);
  slider->setLowerLinLimit(btScalar(-1));
  slider->setUpperLinLimit(btScalar(0.5));
  add(slider);
  btRigidBody& left = add("left", new btBoxShape(place(0.25, 0.25, 0.25)), 1.0, place(6, 6, 2));
  btRigidBody& right =
      add("right", new btCylinderShapeX(place(0.5, 0.25, 0.25)), 1.0, place(7, 6, 2));
  add(new btFixedConstraint(left, right, at(0.5, 0, 0), at(-0.5, 0, 0)));
}

SavedWorld::~SavedWorld() {
  for (const auto& constraint : constraints_) world_.removeConstraint(constraint.get());
  for (const auto& body : bodies) world_.removeRigidBody(body.get());
}

btRigidBody& SavedWorld::add(const char* name, btCollisionShape* shape, double mass,
                             const btVector3& where) {
  shapes_.emplace_back(shape);
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) shape->calculateLocalInertia(btScalar(mass), inertia);
  btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shape, inertia);
  info.m_startWorldTransform.setOrigin(where);
  btRigidBody& body = *bodies.emplace_back(std::make_unique<btRigidBody>(info));
  body.setActivationState(DISABLE_DEACTIVATION);
  world_.addRigidBody(&body);
  names_.emplace_back(&body, name);
  return body;
}

void SavedWorld::add(btTypedConstraint* constraint) {
  constraints_.emplace_back(constraint);
  world_.addConstraint(constraint, true);
}

std::string SavedWorld::bytes() {
  btDefaultSerializer serializer;
  for (const auto& [body, name] : names_) serializer.registerNameForPointer(body, name);
  world_.serialize(&serializer);
  return {reinterpret_cast<const char*>(serializer.getBufferPointer()),
          static_cast<std::size_t>(serializer.getCurrentBufferSize())};
}

void SavedWorld::step(double seconds, int steps) {
  for (int k = 0; k < steps; ++k) world_.stepSimulation(btScalar(seconds), 0);
}

}  // namespace signorini::validation
