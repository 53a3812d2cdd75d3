#include <signorini/integrations/bullet/example_scenes/example_scenes.h>

#include <BulletDynamics/ConstraintSolver/btHinge2Constraint.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace signorini::bullet {
namespace {

const btScalar kTimeStep = btScalar(1.0 / 60.0);
const btScalar kPi = SIMD_PI;

btTransform at(double x, double y, double z, double turn_z = 0.0) {
  return btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(turn_z)),
                     btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

/// A joint's frame in its body, by Bullet's Euler angles.
btTransform frame(btScalar ex, btScalar ey, btScalar ez, double x, double y, double z) {
  btTransform made = at(x, y, z);
  made.getBasis().setEulerZYX(ex, ey, ez);
  return made;
}

}  // namespace

ExampleScene::ExampleScene(const std::string& name, btConstraintSolver& solver)
    : dispatcher_(&configuration_),
      world_(std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, &solver,
                                                       &configuration_)) {
  world_->setGravity(btVector3(0, btScalar(-9.81), 0));
  const btScalar edge = 100;
  add(new btBoxShape(btVector3(edge, edge, edge)), 0.0, at(0.0, -edge, 0.0));
  if (name == "stack") {
    make_stack();
  } else if (name == "wall" || name == "wall-hit") {
    make_wall();
    if (name == "wall-hit") {
      make_ball();
    }
  } else if (name == "ragdoll") {
    make_ragdoll();
  } else if (name == "vehicle") {
    make_vehicle();
  } else {
    std::string known;
    for (const std::string& one : names()) {
      known += " " + one;
    }
    throw std::invalid_argument("Bullet example: '" + name + "' is none of" + known);
  }
}

ExampleScene::~ExampleScene() {
  for (const auto& joint : joints_) {
    world_->removeConstraint(joint.get());
  }
  for (const auto& body : bodies_) {
    world_->removeRigidBody(body.get());
  }
}

std::vector<std::string> ExampleScene::names() {
  return {"stack", "wall", "wall-hit", "ragdoll", "vehicle"};
}

void ExampleScene::step() {
  world_->stepSimulation(kTimeStep, 0);  // 0 substeps: one step of exactly this length
}

btRigidBody* ExampleScene::add(btCollisionShape* shape, double mass, const btTransform& pose) {
  shapes_.emplace_back(shape);
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) {
    shape->calculateLocalInertia(btScalar(mass), inertia);
  }
  btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shape, inertia);
  info.m_startWorldTransform = pose;
  btRigidBody* body = bodies_.emplace_back(std::make_unique<btRigidBody>(info)).get();
  body->setActivationState(DISABLE_DEACTIVATION);
  world_->addRigidBody(body);
  if (mass > 0.0) {
    movable_.push_back(body);
  } else {
    body->setFriction(1);  // the pairs' friction is that of the other body
  }
  return body;
}

void ExampleScene::add(btTypedConstraint* joint) {
  joints_.emplace_back(joint);
  world_->addConstraint(joint, true);
}

void ExampleScene::make_stack() {
  for (int i = 0; i < 30; ++i) {
    add(new btBoxShape(btVector3(0.5, 0.5, 0.5)), 1.0, at(0.0, 0.5 + i, 0.0));
  }
}

void ExampleScene::make_wall() {
  constexpr int kCourses = 6;
  constexpr double kPitch = 1.01;  // of the bricks of a course; each rests on two
  for (int course = 0; course < kCourses; ++course) {
    const int count = course % 2 == 0 ? 6 : 5;
    for (int i = 0; i < count; ++i) {
      btRigidBody* brick =
          add(new btBoxShape(btVector3(btScalar(0.5), btScalar(0.25), btScalar(0.25))), 1.0,
              at(kPitch * (i - 0.5 * (count - 1)), 0.25 + 0.5 * course, 0.0));
      brick->setFriction(btScalar(0.7));  // brick on brick .49
    }
  }
}

void ExampleScene::make_ball() {
  btRigidBody* ball = add(new btSphereShape(btScalar(0.6)), 20.0, at(0.1, 1.5, 6.0));
  ball->setLinearVelocity(btVector3(0, 1, -15));
}

void ExampleScene::make_ragdoll() {
  struct Part {
    double radius, height, x, y, turn;
  };
  enum {
    kPelvis,
    kSpine,
    kHead,
    kLeftThigh,
    kLeftShin,
    kRightThigh,
    kRightShin,
    kLeftArm,
    kLeftForearm,
    kRightArm,
    kRightForearm,
    kParts
  };
  const double quarter = kPi / 2;
  const std::array<Part, kParts> parts = {{{0.15, 0.20, 0.0, 1.0, 0.0},
                                           {0.15, 0.28, 0.0, 1.2, 0.0},
                                           {0.10, 0.05, 0.0, 1.6, 0.0},
                                           {0.07, 0.45, -0.18, 0.65, 0.0},
                                           {0.05, 0.37, -0.18, 0.2, 0.0},
                                           {0.07, 0.45, 0.18, 0.65, 0.0},
                                           {0.05, 0.37, 0.18, 0.2, 0.0},
                                           {0.05, 0.33, -0.35, 1.45, quarter},
                                           {0.04, 0.25, -0.7, 1.45, quarter},
                                           {0.05, 0.33, 0.35, 1.45, -quarter},
                                           {0.04, 0.25, 0.7, 1.45, -quarter}}};
  std::array<btRigidBody*, kParts> body{};
  for (int i = 0; i < kParts; ++i) {
    const Part& part = parts[i];
    body[i] = add(new btCapsuleShape(btScalar(part.radius), btScalar(part.height)), 1.0,
                  at(part.x, part.y + 0.5, 0.0, part.turn));
    body[i]->setDamping(btScalar(0.05), btScalar(0.85));
  }
  const auto hinge = [&](int a, int b, const btTransform& in_a, const btTransform& in_b,
                         btScalar low, btScalar high) {
    auto* joint = new btHingeConstraint(*body[a], *body[b], in_a, in_b);
    joint->setLimit(low, high);
    add(joint);
  };
  const auto cone = [&](int a, int b, const btTransform& in_a, const btTransform& in_b,
                        btScalar swing, btScalar twist) {
    auto* joint = new btConeTwistConstraint(*body[a], *body[b], in_a, in_b);
    joint->setLimit(swing, swing, twist);
    add(joint);
  };
  const btScalar h = kPi / 2;
  const btScalar e = kPi / 4;
  hinge(kPelvis, kSpine, frame(0, h, 0, 0, 0.15, 0), frame(0, h, 0, 0, -0.15, 0), -e, h);
  cone(kSpine, kHead, frame(0, 0, h, 0, 0.30, 0), frame(0, 0, h, 0, -0.14, 0), e, h);
  cone(kPelvis, kLeftThigh, frame(0, 0, -5 * e, -0.18, -0.10, 0), frame(0, 0, -5 * e, 0, 0.225, 0),
       e, 0);
  hinge(kLeftThigh, kLeftShin, frame(0, h, 0, 0, -0.225, 0), frame(0, h, 0, 0, 0.185, 0), 0, h);
  cone(kPelvis, kRightThigh, frame(0, 0, e, 0.18, -0.10, 0), frame(0, 0, e, 0, 0.225, 0), e, 0);
  hinge(kRightThigh, kRightShin, frame(0, h, 0, 0, -0.225, 0), frame(0, h, 0, 0, 0.185, 0), 0, h);
  cone(kSpine, kLeftArm, frame(0, 0, kPi, -0.2, 0.15, 0), frame(0, 0, h, 0, -0.18, 0), h, 0);
  hinge(kLeftArm, kLeftForearm, frame(0, h, 0, 0, 0.18, 0), frame(0, h, 0, 0, -0.14, 0), 0, h);
  cone(kSpine, kRightArm, frame(0, 0, 0, 0.2, 0.15, 0), frame(0, 0, h, 0, -0.18, 0), h, 0);
  hinge(kRightArm, kRightForearm, frame(0, h, 0, 0, 0.18, 0), frame(0, h, 0, 0, -0.14, 0), -h, 0);
}

void ExampleScene::make_vehicle() {
  btRigidBody* chassis =
      add(new btBoxShape(btVector3(1, btScalar(0.5), 2)), 80.0, at(0.0, 1.3, 0.0));
  for (const double x : {-1.4, 1.4}) {
    for (const double z : {-1.5, 1.5}) {
      auto* wheel =
          add(new btCylinderShapeX(btVector3(btScalar(0.25), btScalar(0.5), btScalar(0.5))), 10.0,
              at(x, 0.55, z));
      wheel->setFriction(1);
      btVector3 anchor = wheel->getWorldTransform().getOrigin();
      btVector3 up(0, 1, 0);
      btVector3 axle(1, 0, 0);
      auto* joint = new btHinge2Constraint(*chassis, *wheel, anchor, up, axle);
      joint->setLowerLimit(-kPi / 4);
      joint->setUpperLimit(kPi / 4);
      joint->enableMotor(3, true);  // drives
      joint->setMaxMotorForce(3, 60);
      joint->setTargetVelocity(3, 6);
      joint->enableMotor(5, true);  // steers straight on
      joint->setMaxMotorForce(5, 1000);
      joint->setTargetVelocity(5, 0);
      add(joint);
    }
  }
}

double ExampleScene::kinetic_energy() const {
  double sum = 0.0;
  for (const btRigidBody* body : movable_) {
    const btMatrix3x3& basis = body->getWorldTransform().getBasis();
    const btVector3 spin = body->getAngularVelocity() * basis;  // in the body's frame
    const btVector3 inertia = body->getLocalInertia();
    sum += 0.5 * double(body->getLinearVelocity().length2() / body->getInvMass() +
                        (inertia * spin).dot(spin));
  }
  return sum;
}

double ExampleScene::deepest_overlap() const {
  btScalar least = 0;
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    const btPersistentManifold* manifold = dispatcher_.getManifoldByIndexInternal(m);
    for (int p = 0; p < manifold->getNumContacts(); ++p) {
      least = std::min(least, manifold->getContactPoint(p).getDistance());
    }
  }
  return -double(least);
}

double ExampleScene::joint_error() const {
  btScalar most = 0;
  const auto apart = [](const btTypedConstraint& joint, const btTransform& a,
                        const btTransform& b) {
    return (joint.getRigidBodyA().getWorldTransform() * a).getOrigin() -
           (joint.getRigidBodyB().getWorldTransform() * b).getOrigin();
  };
  for (const auto& one : joints_) {
    btVector3 gap(0, 0, 0);
    if (const auto* hinge = dynamic_cast<btHingeConstraint*>(one.get())) {
      gap = apart(*hinge, hinge->getAFrame(), hinge->getBFrame());
    } else if (const auto* cone = dynamic_cast<btConeTwistConstraint*>(one.get())) {
      gap = apart(*cone, cone->getAFrame(), cone->getBFrame());
    } else if (auto* wheel = dynamic_cast<btHinge2Constraint*>(one.get())) {
      gap = apart(*wheel, wheel->getFrameOffsetA(), wheel->getFrameOffsetB());
      const btVector3 spring = wheel->getRigidBodyA().getWorldTransform().getBasis().getColumn(1);
      gap -= spring * spring.dot(gap);
    }
    most = std::max(most, gap.length());
  }
  return double(most);
}

}  // namespace signorini::bullet
