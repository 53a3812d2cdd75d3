// ODE's bodies and ODE's collision detection, our contact solver: contact geometry and body states
// are handed over (ODE keeps the rows of its joints to itself), velocities come back, and ODE moves
// the bodies.
#include <signorini/core/response/contact_solver.h>

#include <cstdint>
#include <cstdio>
#include <map>
#include <ode/ode.h>
#include <vector>

using signorini::Vec3;

namespace {

constexpr double kStep = 1.0 / 240.0;  // s
constexpr double kFriction = 0.4;
constexpr double kSide = 0.5;  // m
const Vec3 kGravity(0.0, 0.0, -9.81);

Vec3 vec3(const dReal* v) {
  return {v[0], v[1], v[2]};
}

/// A world whose step is ours. Body 0 is whatever ODE has no body for: the ground.
class World {
 public:
  World() : world_(dWorldCreate()), space_(dHashSpaceCreate(nullptr)), bodies_(1) {
    dCreatePlane(space_, 0, 0, 1, 0);
    bodies_[0].kind = signorini::BodyKind::kFixed;
    ode_.push_back(nullptr);
  }
  ~World() {
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  dBodyID add_cube(double x, double height) {
    dMass mass;
    dMassSetBoxTotal(&mass, 1.0, kSide, kSide, kSide);
    const dBodyID body = dBodyCreate(world_);
    dBodySetMass(body, &mass);
    dBodySetPosition(body, x, 0, height);
    dGeomSetBody(dCreateBox(space_, kSide, kSide, kSide), body);
    number_of_[body] = static_cast<int>(ode_.size());
    ode_.push_back(body);
    signorini::Body ours;
    ours.mass = mass.mass;
    ours.inertia = Vec3(mass.I[0], mass.I[5], mass.I[10]).asDiagonal();
    bodies_.push_back(ours);
    return body;
  }

  /// @return whether every contact was solved
  bool step() {
    signorini::State state(bodies_.size());
    for (std::size_t k = 1; k < bodies_.size(); ++k) {
      const dReal* q = dBodyGetQuaternion(ode_[k]);  // w, x, y, z
      state[k].x = vec3(dBodyGetPosition(ode_[k]));
      state[k].q = signorini::Quat(q[0], q[1], q[2], q[3]);
      const Vec3 v = vec3(dBodyGetLinearVel(ode_[k])) + kStep * kGravity;  // after the forces
      set_velocity(bodies_[k], {v, vec3(dBodyGetAngularVel(ode_[k]))}, state[k]);
    }
    contacts_.clear();
    dSpaceCollide(space_, this, &World::near);

    solver_.solve(bodies_, contacts_,
                  allowances(bodies_, state, contacts_, kStep, /*touching_tolerance=*/1e-6,
                             /*restitution_threshold=*/0.2),
                  state, solution_);

    for (std::size_t k = 1; k < bodies_.size(); ++k) {
      const signorini::Velocity v = velocity(bodies_[k], state[k]);
      dBodySetLinearVel(ode_[k], v.linear.x(), v.linear.y(), v.linear.z());
      dBodySetAngularVel(ode_[k], v.angular.x(), v.angular.y(), v.angular.z());
    }
    dWorldStep(world_, kStep);  // no gravity, no joints: it moves the bodies
    return is_solved(solution_.status);
  }

 private:
  static void near(void* world, dGeomID a, dGeomID b) { static_cast<World*>(world)->find(a, b); }

  void find(dGeomID a, dGeomID b) {
    dContactGeom found[8];
    const int count = dCollide(a, b, 8, found, sizeof found[0]);
    for (int i = 0; i < count; ++i) {
      signorini::Contact contact;
      contact.body_a = number_of_.at(dGeomGetBody(found[i].g1));
      contact.body_b = number_of_.at(dGeomGetBody(found[i].g2));
      contact.normal = vec3(found[i].normal);  // into the first body: from B to A
      contact.gap = -found[i].depth;
      contact.point_a = vec3(found[i].pos);
      contact.point_b = contact.point_a - contact.gap * contact.normal;
      contact.material = {.friction = kFriction, .restitution = 0.0};
      contact.feature_id = static_cast<std::uint64_t>(i);
      contacts_.push_back(contact);
    }
  }

  dWorldID world_;
  dSpaceID space_;
  std::vector<dBodyID> ode_;
  std::map<dBodyID, int> number_of_{{nullptr, 0}};  // into bodies_
  signorini::Bodies bodies_;
  signorini::ContactSet contacts_;
  signorini::ContactSolver solver_;
  signorini::ContactSolution solution_;
};

}  // namespace

int main() {
  dInitODE();
  {
    World world;
    dBodyID top = nullptr;
    for (int k = 0; k < 5; ++k) {
      top = world.add_cube(0.0, 0.499 * k + 0.249);  // ODE sees contacts of shapes that overlap
    }
    const dBodyID slider = world.add_cube(3.0, 0.249);
    dBodySetLinearVel(slider, 2.0, 0, 0);
    int solved = 0;
    for (int i = 0; i < 480; ++i) {
      solved += world.step() ? 1 : 0;
    }
    std::printf(
        "after 2 s the top cube is at %.4f m, the slider slid %.4f m; %d of 480 steps solved\n",
        dBodyGetPosition(top)[2], dBodyGetPosition(slider)[0] - 3.0, solved);
  }
  dCloseODE();
}
