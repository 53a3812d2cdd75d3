#pragma once

#include <signorini/integrations/bullet/group_rows.h>
#include <signorini/integrations/bullet/report.h>
#include <signorini/integrations/bullet/settings.h>

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <functional>

namespace signorini::bullet {

/// Solves Bullet's contacts and joints at once, in place of btSequentialImpulseConstraintSolver:
///
///     btDiscreteDynamicsWorld world(&dispatcher, &broadphase, new ConstraintSolver,
///     &configuration);
///
/// Bullet's own set-up makes the rows (getInfo1(), getInfo2() of the joints; restitution, erp, cfm,
/// split impulse, gyroscopic terms and friction coefficients as the world's btContactSolverInfo
/// says), and Bullet writes the result back: impulses to the manifold points, feedback to the
/// joints, velocities and split-impulse poses to the bodies. In between, instead of sweeps,
/// every island (bodies that rows connect) is solved as one complementarity problem, whose matrix
/// is never formed, and certified (group_rows.h, contact_solver.h).
///
/// Differences from Bullet's solver, all of them:
/// - friction acts in both tangential directions, whatever the solver mode, and by default in
///   Coulomb's cone (Settings::friction);
/// - the slip includes what torques add to it in the step;
/// - rolling and spinning friction are bound by their coefficient times the normal impulse, without
///   Bullet's further bound, the coefficient itself;
/// - the split impulse is solved exactly, m_numIterations, m_sor and the number of iterations of a
///   joint play no part, and solveConstraintObsolete() is not called;
/// - impulses are written to the manifold points with warm starting off as well, which then
///   means that the solver starts without them.
///
/// What is not solved is never silent: the best iterate is applied, last_step() and counters() say
/// so, and set_not_solved() names who is told at once.
///
/// One object for one thread, as Bullet's own; btConstraintSolverPoolMt takes several.
class ConstraintSolver : public btSequentialImpulseConstraintSolver {
 public:
  /// Who is told of an island that was not solved.
  using NotSolved = std::function<void(const IslandReport& island)>;

  /// @throws std::invalid_argument for a setting out of its range.
  explicit ConstraintSolver(const Settings& settings = {});

  /// As Bullet calls it, for one island or a batch of them.
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** joints, int joint_count,
                      const btContactSolverInfo& info, btIDebugDraw* debug_draw,
                      btDispatcher* dispatcher) override;
  /// Bullet calls these before and after the groups of a step.
  void prepareSolve(int body_count, int manifold_count) override;
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_draw) override;
  /// Counters to zero.
  void reset() override;

  /// All groups of the step that is solved or was solved last; of solveGroup() alone where it is
  /// called outside a step.
  [[nodiscard]] const StepReport& last_step() const { return step_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }
  /// Is called inside solveGroup() for every island that is not solved, before Bullet writes its
  /// impulses back. null: nobody.
  void set_not_solved(NotSolved visitor) { not_solved_ = std::move(visitor); }

 protected:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject** bodies, int body_count,
                                        btPersistentManifold** manifolds, int manifold_count,
                                        btTypedConstraint** joints, int joint_count,
                                        const btContactSolverInfo& info,
                                        btIDebugDraw* debug_draw) override;
  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int body_count,
                                             btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** joints, int joint_count,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* debug_draw) override;

 private:
  void remember_friction(btPersistentManifold** manifolds, int manifold_count);
  void match_friction();
  void solve(bool is_push, const lcp::Vector* warm_start);
  void report(bool is_push, Route route);

  Settings settings_;
  ContactSolver solver_;
  GroupRows rows_;
  IslandProblem island_;
  lcp::Result result_;
  StepReport step_;
  bool in_step_ = false;
  Counters counters_;
  NotSolved not_solved_;
  bool warm_ = false;
  struct Remembered {
    const btManifoldPoint* point;
    btVector3 impulse;
  };
  std::vector<Remembered> remembered_;  // of all points, before the set-up turns directions
  FrictionImpulses friction_;           // of the contacts that became rows
};

}  // namespace signorini::bullet
