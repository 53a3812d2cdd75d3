#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/friction_pyramid.h>

#include <btBulletDynamicsCommon.h>
#include <functional>
#include <vector>

namespace signorini::bench {

/// What a Bullet constraint solver is given for one step: the arguments of its solveGroup().
/// Borrowed; valid inside the call.
struct BulletGroup {
  btCollisionObject** bodies;
  int body_count;
  btPersistentManifold** manifolds;
  int manifold_count;
  btTypedConstraint** joints;
  int joint_count;
  const btContactSolverInfo* info;
  btIDebugDraw* debug_draw;
  btDispatcher* dispatcher;

  /// Runs a solver on the group with other settings than the world's.
  void solve(btConstraintSolver& solver, const btContactSolverInfo& settings) const;
};

/// Everything that a solver changes in a group: velocities and poses of the bodies, the contact
/// points whole. (Solvers also leave companion ids behind; restoring sets them to -1.)
class BulletState {
 public:
  BulletState() = default;
  explicit BulletState(const BulletGroup& group);
  /// Puts the group back, to the bit.
  void restore(const BulletGroup& group) const;
  [[nodiscard]] bool operator==(const BulletState& other) const;

 private:
  struct BodyPart {
    btTransform pose;
    btVector3 linear_velocity;
    btVector3 angular_velocity;
  };
  std::vector<BodyPart> bodies_;
  std::vector<btManifoldPoint> points_;  // manifold by manifold
};

/// The contacts that Bullet is about to solve, in core's types, and what Bullet asks of them:
///
///     0 <= f ⊥ d'+ + allowance >= 0,
///
/// d' = N.(u_A - u_B) with the velocities that the bodies have at the step's end without contact
/// impulses (forces and Bullet's gyroscopic term included). allowance_i, m/s, is gap/dt where the
/// gap is > 0; gap erp/dt where it is not (Bullet pushes overlap out through the velocity), but 0
/// where split impulses do that apart from it; less e times the approach velocity where the contact
/// is to bounce. Left out, as Bullet leaves them out: points beyond the contact processing
/// threshold and pairs of immovable bodies. Not covered: contact softness (cfm, stiffness and
/// damping of a point), joints, anisotropic and rolling friction, linear and angular factors.
struct BulletContacts {
  Bodies bodies;                         ///< those of the group, in its order
  State free_state;                      ///< poses of the step's start, momenta of its end
  ContactSet contacts;                   ///< body_a is Bullet's body 0; material is the point's own
  lcp::Vector allowance;                 ///< m/s
  std::vector<btManifoldPoint*> points;  ///< of the contacts; borrowed

  /// Fills all members from the group; memory is reused.
  /// @throws std::invalid_argument if the group has joints or a contact's softness is set.
  void read(const BulletGroup& group);
};

/// The contacts with Coulomb friction at all of them, in De Saxce's form: rows 3 c (N), 3 c + 1 and
/// 3 c + 2 (tangents) of contact c, each body's friction at its own contact point as in Bullet.
struct BulletCones {
  lcp::Problem problem;              ///< z in N s, w in m/s: M z + q, q with the allowance
  std::vector<TangentFrame> frames;  ///< one a contact
};
void assemble_cones(const BulletContacts& contacts, BulletCones& cones);

/// The impulses that Bullet's solver wrote into the points, as z of the cones: the normal one, and
/// its friction impulses along their directions in the frames.
[[nodiscard]] lcp::Vector written_impulses(const BulletContacts& contacts,
                                           const BulletCones& cones);

/// Sets applied impulses of all points to zero, as nothing of the last step may help a solver.
/// (Warm starting stays on: without it Bullet does not write impulses back.)
void forget_impulses(const BulletGroup& group);

/// Normal impulses as Bullet's solver wrote them into the points, N s.
[[nodiscard]] lcp::Vector written_impulses(const BulletContacts& contacts);

/// d'+ + allowance with the velocities that the bodies of the group have now, m/s.
[[nodiscard]] lcp::Vector targets_now(const BulletGroup& group, const BulletContacts& contacts);

/// Gives the bodies the velocities of free_state plus the impulses f (N s, one a contact), and the
/// points the impulses: what a Bullet solver would leave behind.
void write_solution(const BulletGroup& group, const BulletContacts& contacts,
                    const lcp::VectorRef& f);

/// The same for a solution of the cones.
void write_solution(const BulletGroup& group, const BulletContacts& contacts,
                    const BulletCones& cones, const lcp::VectorRef& z);

/// Bullet's sequential impulses that show every group to a visitor before they solve it.
/// The visitor may do what it likes with the group: it is restored after the visit.
class CapturingSolver : public btSequentialImpulseConstraintSolver {
 public:
  using Visitor = std::function<void(const BulletGroup& group)>;
  /// null: no visits.
  void set_visitor(Visitor visitor) { visitor_ = std::move(visitor); }
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** joints, int joint_count,
                      const btContactSolverInfo& info, btIDebugDraw* debug_draw,
                      btDispatcher* dispatcher) override;

 private:
  Visitor visitor_;
};

}  // namespace signorini::bench
