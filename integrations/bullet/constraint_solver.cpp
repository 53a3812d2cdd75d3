#include <signorini/integrations/bullet/constraint_solver.h>

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <LinearMath/btQuickprof.h>
#include <algorithm>

namespace signorini::bullet {

bool StepReport::is_solved() const {
  return std::ranges::all_of(
      islands, [](const IslandReport& island) { return lcp::is_solved(island.status); });
}

ConstraintSolver::ConstraintSolver(const Settings& settings)
    : settings_(settings), solver_(settings) {}

void ConstraintSolver::prepareSolve(int body_count, int manifold_count) {
  btSequentialImpulseConstraintSolver::prepareSolve(body_count, manifold_count);
  step_.clear();
  in_step_ = true;
}

void ConstraintSolver::allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_draw) {
  btSequentialImpulseConstraintSolver::allSolved(info, debug_draw);
  in_step_ = false;
}

void ConstraintSolver::reset() {
  btSequentialImpulseConstraintSolver::reset();
  counters_ = {};
}

btScalar ConstraintSolver::solveGroup(btCollisionObject** bodies, int body_count,
                                      btPersistentManifold** manifolds, int manifold_count,
                                      btTypedConstraint** joints, int joint_count,
                                      const btContactSolverInfo& info, btIDebugDraw* debug_draw,
                                      btDispatcher* dispatcher) {
  const lcp::Deadline clock(std::numeric_limits<double>::infinity());
  if (!in_step_) {
    step_.clear();
  }
  const std::size_t first = step_.islands.size();
  warm_ = (info.m_solverMode & SOLVER_USE_WARMSTARTING) != 0;
  btContactSolverInfo ours = info;
  // Both friction directions get rows, and impulses are written back.
  ours.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_USE_WARMSTARTING;
  btSequentialImpulseConstraintSolver::solveGroup(bodies, body_count, manifolds, manifold_count,
                                                  joints, joint_count, ours, debug_draw,
                                                  dispatcher);
  const double seconds = clock.elapsed_seconds();
  step_.seconds += seconds;
  counters_.seconds += seconds;
  if (step_.islands.size() > first) {
    ++counters_.groups;
    counters_.groups_solved +=
        std::all_of(step_.islands.begin() + static_cast<std::ptrdiff_t>(first), step_.islands.end(),
                    [](const IslandReport& island) { return lcp::is_solved(island.status); })
            ? 1
            : 0;
  }
  return btScalar(0);
}

btScalar ConstraintSolver::solveGroupCacheFriendlySetup(btCollisionObject** bodies, int body_count,
                                                        btPersistentManifold** manifolds,
                                                        int manifold_count,
                                                        btTypedConstraint** joints, int joint_count,
                                                        const btContactSolverInfo& info,
                                                        btIDebugDraw* debug_draw) {
  remembered_.clear();
  if (warm_) {
    remember_friction(manifolds, manifold_count);
  }
  return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlySetup(
      bodies, body_count, manifolds, manifold_count, joints, joint_count, info, debug_draw);
}

void ConstraintSolver::remember_friction(btPersistentManifold** manifolds, int manifold_count) {
  for (int m = 0; m < manifold_count; ++m) {
    for (int p = 0; p < manifolds[m]->getNumContacts(); ++p) {
      const btManifoldPoint& point = manifolds[m]->getContactPoint(p);
      remembered_.push_back(
          {&point, point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                       point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2});
    }
  }
}

/// The rows come in the order of the points, some of which were left out.
void ConstraintSolver::match_friction() {
  friction_.clear();
  std::size_t next = 0;
  for (int c = 0; c < m_tmpSolverContactConstraintPool.size(); ++c) {
    while (remembered_[next].point != m_tmpSolverContactConstraintPool[c].m_originalContactPoint) {
      ++next;
    }
    friction_.push_back(remembered_[next].impulse);
  }
}

btScalar ConstraintSolver::solveGroupCacheFriendlyIterations(btCollisionObject**, int,
                                                             btPersistentManifold**, int,
                                                             btTypedConstraint**, int,
                                                             const btContactSolverInfo& info,
                                                             btIDebugDraw*) {
  BT_PROFILE("signorini::bullet::ConstraintSolver");
  if (warm_) {
    match_friction();
  }
  rows_.read({&m_tmpSolverBodyPool, &m_tmpSolverNonContactConstraintPool,
              &m_tmpSolverContactConstraintPool, &m_tmpSolverContactFrictionConstraintPool,
              &m_tmpSolverContactRollingFrictionConstraintPool});
  for (int island = 0; island < rows_.island_count(); ++island) {
    if (info.m_splitImpulse != 0) {
      rows_.assemble_push(island, island_);
      if (!island_.rows.empty()) {
        solve(true, nullptr);
      }
    }
    rows_.assemble(island, settings_.friction, warm_ ? &friction_ : nullptr, island_);
    if (!island_.rows.empty()) {
      solve(false, warm_ && island_.contact_count > 0 ? &island_.warm_start : nullptr);
    }
  }
  return btScalar(0);
}

/// Solves the island at hand, reports it, and gives the impulses to its bodies and rows.
void ConstraintSolver::solve(bool is_push, const lcp::Vector* warm_start) {
  Route route = Route::kNone;
  if (island_.bad.empty()) {
    route = solver_.solve(island_.problem, warm_start, result_);
  } else {
    result_ = {};
    result_.status = lcp::Status::kInvalidInput;
    result_.detail = island_.bad;
    result_.z.setZero(island_.problem.size());
  }
  report(is_push, route);
  if (!result_.z.allFinite()) {
    result_.z.setZero();  // kInvalidInput: the report has said it
  }
  if (is_push) {
    rows_.write_push(island_, result_.z);
  } else {
    rows_.write(island_, result_.z);
  }
}

void ConstraintSolver::report(bool is_push, Route route) {
  IslandReport& entry = step_.islands.emplace_back();
  entry.is_push = is_push;
  entry.bodies = static_cast<int>(island_.blocks.size());
  entry.contacts = island_.contact_count;
  entry.joint_rows = island_.joint_row_count;
  entry.rows = static_cast<int>(island_.rows.size());
  entry.route = route;
  entry.status = result_.status;
  entry.certificate = result_.certificate;
  entry.statistics = result_.statistics;
  entry.solver = result_.solver;
  entry.detail = result_.detail;
  ++counters_.islands;
  ++counters_.by_status[static_cast<std::size_t>(entry.status)];
  ++counters_.by_route[static_cast<std::size_t>(route)];
  if (!lcp::is_solved(entry.status) && not_solved_) {
    not_solved_(entry);
  }
}

}  // namespace signorini::bullet
