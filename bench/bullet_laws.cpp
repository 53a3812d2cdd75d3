#include "bench/bullet_laws.h"

#include <Eigen/Eigenvalues>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>
#include <memory>

namespace signorini::bench {
namespace {

btVector3 bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// The bodies and contacts of an impact as Bullet's solver takes them.
class BulletImpact {
 public:
  explicit BulletImpact(const RandomImpact& impact) : impact_(impact) {
    for (std::size_t k = 0; k < impact.bodies.size(); ++k) {
      add_body(impact.bodies[k], impact.state[k]);
    }
    for (const Contact& contact : impact.contacts) {
      add_contact(contact);
    }
  }

  LawAnswer solve(int iterations) {
    btContactSolverInfo info;
    info.m_timeStep = 1.0 / 240.0;
    info.m_numIterations = iterations;
    info.m_restitutionVelocityThreshold = 0.0;
    info.m_warmstartingFactor = 0.0;
    std::vector<btCollisionObject*> bodies;
    for (const auto& body : bodies_) {
      bodies.push_back(body.get());
    }
    std::vector<btPersistentManifold*> manifolds;
    for (const auto& manifold : manifolds_) {
      manifolds.push_back(manifold.get());
    }
    btSequentialImpulseConstraintSolver solver;
    solver.solveGroup(bodies.data(), static_cast<int>(bodies.size()), manifolds.data(),
                      static_cast<int>(manifolds.size()), nullptr, 0, info, nullptr, nullptr);
    return read();
  }

 private:
  /// In principal axes, which is what Bullet's bodies have.
  void add_body(const Body& body, const BodyState& state) {
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(body.inertia);
    Mat3 rotation = axes.eigenvectors();
    if (rotation.determinant() < 0.0) {
      rotation.col(0) = -rotation.col(0);
    }
    const Quat q = state.q * Quat(rotation);
    const Vec3 moments = body.is_dynamic() ? Vec3(axes.eigenvalues()) : Vec3::Zero();
    btRigidBody::btRigidBodyConstructionInfo made(body.is_dynamic() ? body.mass : 0.0, nullptr,
                                                  nullptr, bullet(moments));
    made.m_startWorldTransform =
        btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), bullet(state.x));
    bodies_.push_back(std::make_unique<btRigidBody>(made));
    bodies_.back()->setFlags(0);  // no gyroscopic torque: an impact takes no time
    const Velocity v = velocity(body, state);
    bodies_.back()->setLinearVelocity(bullet(v.linear));
    bodies_.back()->setAngularVelocity(bullet(v.angular));
  }

  void add_contact(const Contact& contact) {
    const btRigidBody* a = bodies_[contact.body_a].get();
    const btRigidBody* b = bodies_[contact.body_b].get();
    btManifoldPoint point(a->getWorldTransform().invXform(bullet(contact.point_a)),
                          b->getWorldTransform().invXform(bullet(contact.point_b)),
                          bullet(contact.normal), 0.0);
    point.m_positionWorldOnA = bullet(contact.point_a);
    point.m_positionWorldOnB = bullet(contact.point_b);
    point.m_combinedFriction = 0.0;
    point.m_combinedRestitution = contact.material.restitution;
    manifolds_.push_back(
        std::make_unique<btPersistentManifold>(a, b, 0, BT_LARGE_FLOAT, BT_LARGE_FLOAT));
    manifolds_.back()->addManifoldPoint(point);
  }

  LawAnswer read() const {
    LawAnswer answer;
    answer.answered = true;
    answer.after = impact_.state;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      if (impact_.bodies[k].is_dynamic()) {
        set_velocity(
            impact_.bodies[k],
            {ours(bodies_[k]->getLinearVelocity()), ours(bodies_[k]->getAngularVelocity())},
            answer.after[k]);
      }
    }
    answer.impulses.resize(static_cast<lcp::Index>(manifolds_.size()));
    for (std::size_t i = 0; i < manifolds_.size(); ++i) {
      answer.impulses[static_cast<lcp::Index>(i)] =
          manifolds_[i]->getContactPoint(0).m_appliedImpulse;
    }
    return answer;
  }

  const RandomImpact& impact_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btPersistentManifold>> manifolds_;
};

}  // namespace

LawContestant bullet_law(int iterations) {
  return {fmt::format("Bullet SI {}", iterations), [iterations](const RandomImpact& impact) {
            return BulletImpact(impact).solve(iterations);
          }};
}

}  // namespace signorini::bench
