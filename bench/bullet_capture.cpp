#include "bench/bullet_capture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace signorini::bench {
namespace {

Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
Quat ours(const btQuaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}
btVector3 bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

template <typename Visit>
void for_each_point(const BulletGroup& group, const Visit& visit) {
  for (int m = 0; m < group.manifold_count; ++m) {
    for (int p = 0; p < group.manifolds[m]->getNumContacts(); ++p) {
      visit(*group.manifolds[m], group.manifolds[m]->getContactPoint(p));
    }
  }
}

/// What the step adds to the velocities before the contacts act: forces, torques, and the
/// gyroscopic term that the body's flags ask for (as btSequentialImpulseConstraintSolver's
/// convertBodies() does).
Velocity free_velocity(const btRigidBody& body, const btContactSolverInfo& info) {
  const btScalar dt = info.m_timeStep;
  btVector3 angular = body.getTotalTorque() * body.getInvInertiaTensorWorld() * dt;
  if ((body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT) != 0) {
    angular -= body.computeGyroscopicForceExplicit(info.m_maxGyroscopicForce) *
               body.getInvInertiaTensorWorld() * dt;
  }
  if ((body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD) != 0) {
    angular += body.computeGyroscopicImpulseImplicit_World(dt);
  }
  if ((body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY) != 0) {
    angular += body.computeGyroscopicImpulseImplicit_Body(dt);
  }
  const btVector3 linear = body.getTotalForce() * body.getInvMass() * dt;
  return {.linear = ours(body.getLinearVelocity() + linear),
          .angular = ours(body.getAngularVelocity() + angular)};
}

void read_body(const btRigidBody& source, const btContactSolverInfo& info, Body& body,
               BodyState& state) {
  state.x = ours(source.getWorldTransform().getOrigin());
  state.q = ours(source.getWorldTransform().getRotation()).normalized();
  state.p.setZero();
  state.L.setZero();
  if (source.getInvMass() > 0.0) {
    body.kind = BodyKind::kDynamic;
    body.mass = 1.0 / source.getInvMass();
    body.inertia = ours(source.getLocalInertia()).asDiagonal();
    set_velocity(body, free_velocity(source, info), state);
  } else if (source.isKinematicObject()) {
    body.kind = BodyKind::kKinematic;
    state.p = ours(source.getLinearVelocity());
    state.L = ours(source.getAngularVelocity());
  } else {
    body.kind = BodyKind::kFixed;
  }
}

/// e times the approach velocity before the step's forces, where it is fast enough.
double bounce(const btRigidBody& a, const btRigidBody& b, const btManifoldPoint& point,
              const btContactSolverInfo& info) {
  const btVector3 u =
      a.getVelocityInLocalPoint(point.getPositionWorldOnA() - a.getWorldTransform().getOrigin()) -
      b.getVelocityInLocalPoint(point.getPositionWorldOnB() - b.getWorldTransform().getOrigin());
  const double d_dot = point.m_normalWorldOnB.dot(u);
  return std::abs(d_dot) < info.m_restitutionVelocityThreshold
             ? 0.0
             : std::max(0.0, -point.m_combinedRestitution * d_dot);
}

double gap_allowance(double gap, const btManifoldPoint& point, const btContactSolverInfo& info) {
  if (gap > 0.0) {
    return gap / info.m_timeStep;
  }
  if (info.m_splitImpulse != 0 && gap <= info.m_splitImpulsePenetrationThreshold) {
    return 0.0;
  }
  const bool has_own = (point.m_contactPointFlags & BT_CONTACT_FLAG_HAS_CONTACT_ERP) != 0;
  return gap * (has_own ? point.m_contactERP : info.m_erp2) / info.m_timeStep;
}

void check_point(const btManifoldPoint& point, const btContactSolverInfo& info) {
  const int soft = BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
  if ((point.m_contactPointFlags & soft) != 0 || info.m_globalCfm != 0.0) {
    throw std::invalid_argument("Bullet contacts: soft contacts (cfm, stiffness) are not read");
  }
}

/// Velocity of contact point A against contact point B.
Vec3 contact_velocity(const BulletContacts& all, const Contact& contact) {
  const auto at = [&](int body, const Vec3& point) {
    return velocity(all.bodies[body], all.free_state[body]).at(point - all.free_state[body].x);
  };
  return at(contact.body_a, contact.point_a) - at(contact.body_b, contact.point_b);
}

/// Gives the impulse to both bodies of a contact, each at its own point.
void push(const BulletContacts& all, const Contact& contact, const Vec3& impulse, State& state) {
  const auto push_one = [&](int body, const Vec3& point, const Vec3& p) {
    if (all.bodies[body].is_dynamic()) {
      state[body].p += p;
      state[body].L += (point - state[body].x).cross(p);
    }
  };
  push_one(contact.body_a, contact.point_a, impulse);
  push_one(contact.body_b, contact.point_b, -impulse);
}

void write_velocities(const BulletGroup& group, const BulletContacts& contacts,
                      const State& state) {
  for (int i = 0; i < group.body_count; ++i) {
    if (contacts.bodies[i].is_dynamic()) {
      const Velocity v = velocity(contacts.bodies[i], state[i]);
      btRigidBody& body = *btRigidBody::upcast(group.bodies[i]);
      body.setLinearVelocity(bullet(v.linear));
      body.setAngularVelocity(bullet(v.angular));
    }
  }
}

bool is_movable(const btRigidBody& body) {
  return body.getInvMass() > 0.0;
}

}  // namespace

void BulletGroup::solve(btConstraintSolver& solver, const btContactSolverInfo& settings) const {
  solver.solveGroup(bodies, body_count, manifolds, manifold_count, joints, joint_count, settings,
                    debug_draw, dispatcher);
}

BulletState::BulletState(const BulletGroup& group) {
  for (int i = 0; i < group.body_count; ++i) {
    const btRigidBody* body = btRigidBody::upcast(group.bodies[i]);
    bodies_.push_back(body == nullptr
                          ? BodyPart{}
                          : BodyPart{body->getWorldTransform(), body->getLinearVelocity(),
                                     body->getAngularVelocity()});
  }
  for_each_point(group, [this](const btPersistentManifold&, const btManifoldPoint& point) {
    points_.push_back(point);
  });
}

void BulletState::restore(const BulletGroup& group) const {
  for (int i = 0; i < group.body_count; ++i) {
    group.bodies[i]->setCompanionId(-1);
    if (btRigidBody* body = btRigidBody::upcast(group.bodies[i])) {
      body->setWorldTransform(bodies_[i].pose);
      body->setLinearVelocity(bodies_[i].linear_velocity);
      body->setAngularVelocity(bodies_[i].angular_velocity);
    }
  }
  std::size_t next = 0;
  for_each_point(
      group, [&](const btPersistentManifold&, btManifoldPoint& point) { point = points_[next++]; });
}

bool BulletState::operator==(const BulletState& other) const {
  const auto same_vector = [](const btVector3& a, const btVector3& b) {
    const auto bits = [](btScalar value) { return std::bit_cast<std::uint64_t>(value); };
    return std::ranges::equal(a.m_floats, b.m_floats, {}, bits, bits);
  };
  const auto same_body = [&](const BodyPart& a, const BodyPart& b) {
    bool same = same_vector(a.pose.getOrigin(), b.pose.getOrigin()) &&
                same_vector(a.linear_velocity, b.linear_velocity) &&
                same_vector(a.angular_velocity, b.angular_velocity);
    for (int row = 0; row < 3; ++row) {
      same = same && same_vector(a.pose.getBasis().getRow(row), b.pose.getBasis().getRow(row));
    }
    return same;
  };
  const auto same_point = [&](const btManifoldPoint& a, const btManifoldPoint& b) {
    return same_vector(a.m_positionWorldOnA, b.m_positionWorldOnA) &&
           same_vector(a.m_positionWorldOnB, b.m_positionWorldOnB) &&
           same_vector(a.m_normalWorldOnB, b.m_normalWorldOnB) &&
           same_vector(a.m_lateralFrictionDir1, b.m_lateralFrictionDir1) &&
           same_vector(a.m_lateralFrictionDir2, b.m_lateralFrictionDir2) &&
           a.m_distance1 == b.m_distance1 && a.m_appliedImpulse == b.m_appliedImpulse &&
           a.m_appliedImpulseLateral1 == b.m_appliedImpulseLateral1 &&
           a.m_appliedImpulseLateral2 == b.m_appliedImpulseLateral2 && a.m_prevRHS == b.m_prevRHS &&
           a.m_contactPointFlags == b.m_contactPointFlags;
  };
  return std::equal(bodies_.begin(), bodies_.end(), other.bodies_.begin(), other.bodies_.end(),
                    same_body) &&
         std::equal(points_.begin(), points_.end(), other.points_.begin(), other.points_.end(),
                    same_point);
}

void BulletContacts::read(const BulletGroup& group) {
  if (group.joint_count > 0) {
    throw std::invalid_argument("Bullet contacts: joints are not read");
  }
  const btContactSolverInfo& info = *group.info;
  bodies.resize(group.body_count);
  free_state.resize(group.body_count);
  // Manifolds name their bodies by address; companion ids are free between solves.
  for (int i = 0; i < group.body_count; ++i) {
    const btRigidBody* body = btRigidBody::upcast(group.bodies[i]);
    if (body == nullptr) {
      throw std::invalid_argument("Bullet contacts: body " + std::to_string(i) + " is not rigid");
    }
    read_body(*body, info, bodies[i], free_state[i]);
    group.bodies[i]->setCompanionId(i);
  }
  contacts.clear();
  points.clear();
  std::vector<const btRigidBody*> outside;  // immovable bodies need not be among the group's
  const auto index_of = [&](const btRigidBody& body) {
    if (body.getCompanionId() >= 0) {
      return body.getCompanionId();
    }
    const auto known = std::find(outside.begin(), outside.end(), &body);
    if (known == outside.end()) {
      outside.push_back(&body);
      read_body(body, info, bodies.emplace_back(), free_state.emplace_back());
      return static_cast<int>(bodies.size()) - 1;
    }
    return group.body_count + static_cast<int>(known - outside.begin());
  };
  const auto add_point = [&](const btPersistentManifold& manifold, btManifoldPoint& point) {
    const btRigidBody& a = *btRigidBody::upcast(manifold.getBody0());
    const btRigidBody& b = *btRigidBody::upcast(manifold.getBody1());
    if ((!is_movable(a) && !is_movable(b)) ||
        point.getDistance() > manifold.getContactProcessingThreshold()) {
      return;
    }
    check_point(point, info);
    Contact& contact = contacts.emplace_back();
    contact.body_a = index_of(a);
    contact.body_b = index_of(b);
    contact.point_a = ours(point.getPositionWorldOnA());
    contact.point_b = ours(point.getPositionWorldOnB());
    contact.normal = ours(point.m_normalWorldOnB);
    contact.gap = point.getDistance();
    contact.material = {.friction = point.m_combinedFriction,
                        .restitution = point.m_combinedRestitution};
    points.push_back(&point);
  };
  for_each_point(group, add_point);
  allowance.resize(static_cast<lcp::Index>(contacts.size()));
  std::size_t i = 0;
  for_each_point(group, [&](const btPersistentManifold& manifold, const btManifoldPoint& point) {
    if (i < points.size() && points[i] == &point) {
      allowance[static_cast<lcp::Index>(i)] =
          gap_allowance(point.getDistance() + info.m_linearSlop, point, info) -
          bounce(*btRigidBody::upcast(manifold.getBody0()),
                 *btRigidBody::upcast(manifold.getBody1()), point, info);
      ++i;
    }
  });
  for (int k = 0; k < group.body_count; ++k) {
    group.bodies[k]->setCompanionId(-1);
  }
}

void forget_impulses(const BulletGroup& group) {
  for_each_point(group, [](const btPersistentManifold&, btManifoldPoint& point) {
    point.m_appliedImpulse = 0.0;
    point.m_appliedImpulseLateral1 = 0.0;
    point.m_appliedImpulseLateral2 = 0.0;
    point.m_prevRHS = 0.0;
  });
}

lcp::Vector written_impulses(const BulletContacts& contacts) {
  lcp::Vector f(static_cast<lcp::Index>(contacts.points.size()));
  for (std::size_t i = 0; i < contacts.points.size(); ++i) {
    f[static_cast<lcp::Index>(i)] = contacts.points[i]->m_appliedImpulse;
  }
  return f;
}

lcp::Vector targets_now(const BulletGroup& group, const BulletContacts& contacts) {
  State now = contacts.free_state;
  for (int i = 0; i < group.body_count; ++i) {
    const btRigidBody& body = *btRigidBody::upcast(group.bodies[i]);
    set_velocity(
        contacts.bodies[i],
        {.linear = ours(body.getLinearVelocity()), .angular = ours(body.getAngularVelocity())},
        now[i]);
  }
  return gap_velocities(contacts.bodies, now, contacts.contacts) + contacts.allowance;
}

void write_solution(const BulletGroup& group, const BulletContacts& contacts,
                    const lcp::VectorRef& f) {
  State state = contacts.free_state;
  apply_impulses(contacts.bodies, contacts.contacts, f, state);
  write_velocities(group, contacts, state);
  for (std::size_t i = 0; i < contacts.points.size(); ++i) {
    contacts.points[i]->m_appliedImpulse = f[static_cast<lcp::Index>(i)];
  }
}

void assemble_cones(const BulletContacts& contacts, BulletCones& cones) {
  NormalRows normals;  // for its masses
  assemble_normals(contacts.bodies, contacts.free_state, contacts.contacts, normals);
  lcp::FactoredMatrix A;
  A.mass = normals.A.mass;
  const std::size_t count = contacts.contacts.size();
  cones.frames.resize(count);
  cones.problem.cones.clear();
  cones.problem.q.resize(3 * static_cast<lcp::Index>(count));
  for (std::size_t c = 0; c < count; ++c) {
    const Contact& contact = contacts.contacts[c];
    const Vec3 u = contact_velocity(contacts, contact);
    cones.frames[c] = tangent_frame(contact.normal, u);
    cones.problem.cones.push_back(
        {.normal_row = A.rows(), .dimension = 3, .coefficient = contact.material.friction});
    for (const Vec3& direction : {contact.normal, cones.frames[c].t1, cones.frames[c].t2}) {
      cones.problem.q[A.add_row()] = direction.dot(u);
      const auto add_body = [&](int body, const Vec3& point, double sign) {
        if (const int block = normals.block_of_body[body]; block >= 0) {
          lcp::Vector values(6);
          values << sign * direction, sign * (point - contacts.free_state[body].x).cross(direction);
          A.add_entry(block, values);
        }
      };
      add_body(contact.body_a, contact.point_a, 1.0);
      add_body(contact.body_b, contact.point_b, -1.0);
    }
    cones.problem.q[3 * static_cast<lcp::Index>(c)] +=
        contacts.allowance[static_cast<lcp::Index>(c)];
  }
  cones.problem.M = std::move(A);
}

lcp::Vector written_impulses(const BulletContacts& contacts, const BulletCones& cones) {
  lcp::Vector z(3 * static_cast<lcp::Index>(contacts.points.size()));
  for (std::size_t c = 0; c < contacts.points.size(); ++c) {
    const btManifoldPoint& point = *contacts.points[c];
    // Bullet's second direction is only in use where it has an impulse.
    const Vec3 friction = point.m_appliedImpulseLateral1 * ours(point.m_lateralFrictionDir1) +
                          point.m_appliedImpulseLateral2 * ours(point.m_lateralFrictionDir2);
    z.segment<3>(3 * static_cast<lcp::Index>(c)) << point.m_appliedImpulse,
        friction.dot(cones.frames[c].t1), friction.dot(cones.frames[c].t2);
  }
  return z;
}

void write_solution(const BulletGroup& group, const BulletContacts& contacts,
                    const BulletCones& cones, const lcp::VectorRef& z) {
  State state = contacts.free_state;
  for (std::size_t c = 0; c < contacts.points.size(); ++c) {
    const Vec3 parts = z.segment<3>(3 * static_cast<lcp::Index>(c));
    const TangentFrame& frame = cones.frames[c];
    const Contact& contact = contacts.contacts[c];
    push(contacts, contact, parts[0] * contact.normal + parts[1] * frame.t1 + parts[2] * frame.t2,
         state);
    btManifoldPoint& point = *contacts.points[c];
    point.m_appliedImpulse = parts[0];
    point.m_appliedImpulseLateral1 = parts[1];
    point.m_appliedImpulseLateral2 = parts[2];
    point.m_lateralFrictionDir1 = bullet(frame.t1);
    point.m_lateralFrictionDir2 = bullet(frame.t2);
  }
  write_velocities(group, contacts, state);
}

btScalar CapturingSolver::solveGroup(btCollisionObject** bodies, int body_count,
                                     btPersistentManifold** manifolds, int manifold_count,
                                     btTypedConstraint** joints, int joint_count,
                                     const btContactSolverInfo& info, btIDebugDraw* debug_draw,
                                     btDispatcher* dispatcher) {
  if (visitor_) {
    const BulletGroup group{bodies,      body_count, manifolds,  manifold_count, joints,
                            joint_count, &info,      debug_draw, dispatcher};
    const BulletState before(group);
    visitor_(group);
    before.restore(group);
  }
  return btSequentialImpulseConstraintSolver::solveGroup(bodies, body_count, manifolds,
                                                         manifold_count, joints, joint_count, info,
                                                         debug_draw, dispatcher);
}

}  // namespace signorini::bench
