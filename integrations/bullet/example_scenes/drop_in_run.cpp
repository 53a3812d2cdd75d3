#include <signorini/integrations/bullet/example_scenes/drop_in_run.h>
#include <signorini/integrations/bullet/example_scenes/example_scenes.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace signorini::bullet {
namespace {

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Passes everything on and adds up the time of solveGroup().
class TimedSolver final : public btConstraintSolver {
 public:
  explicit TimedSolver(btConstraintSolver& inner) : inner_(inner) {}

  void prepareSolve(int bodies, int manifolds) override { inner_.prepareSolve(bodies, manifolds); }
  btScalar solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                      int manifold_count, btTypedConstraint** joints, int joint_count,
                      const btContactSolverInfo& info, btIDebugDraw* debug_draw,
                      btDispatcher* dispatcher) override {
    const double start = thread_seconds();
    const btScalar result = inner_.solveGroup(bodies, body_count, manifolds, manifold_count, joints,
                                              joint_count, info, debug_draw, dispatcher);
    seconds_ += thread_seconds() - start;
    return result;
  }
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_draw) override {
    inner_.allSolved(info, debug_draw);
  }
  void reset() override { inner_.reset(); }
  btConstraintSolverType getSolverType() const override { return inner_.getSolverType(); }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  btConstraintSolver& inner_;
  double seconds_ = 0.0;
};

}  // namespace

DropInSolver bullet_si(int iterations) {
  return {"Bullet SI" + std::to_string(iterations), iterations,
          [] { return std::make_unique<btSequentialImpulseConstraintSolver>(); }};
}

DropInSolver ours(FrictionModel friction, lcp::SolveRecorder* recorder) {
  const Settings settings{.friction = friction, .recorder = recorder};
  return {friction == FrictionModel::kCone ? "signorini" : "signorini box", 0,
          [settings] { return std::make_unique<ConstraintSolver>(settings); }};
}

double DropInRun::moved_at(double distance) const {
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (!(moved[i] <= distance)) {  // NaN has moved
      return time[i];
    }
  }
  return -1.0;
}

double DropInRun::median_solver_seconds() const {
  if (solver_seconds.empty()) {
    return 0.0;
  }
  std::vector<double> sorted = solver_seconds;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

DropInRun run_drop_in(const std::string& scene, const DropInSolver& solver, double seconds,
                      const std::function<bool()>& stop) {
  const std::unique_ptr<btConstraintSolver> made = solver.make();
  TimedSolver timed(*made);
  ExampleScene running(scene, timed);
  if (solver.iterations > 0) {
    running.world().getSolverInfo().m_numIterations = solver.iterations;
  }
  std::vector<btVector3> starts;
  for (const btRigidBody* body : running.bodies()) {
    starts.push_back(body->getWorldTransform().getOrigin());
  }
  DropInRun run;
  const int steps = static_cast<int>(std::lround(seconds * 60.0));
  for (int step = 1; step <= steps && !(stop && stop()); ++step) {
    const double before = timed.seconds();
    running.step();
    run.solver_seconds.push_back(timed.seconds() - before);
    run.time.push_back(step / 60.0);
    double moved = 0.0;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const btVector3& now = running.bodies()[i]->getWorldTransform().getOrigin();
      moved = std::max(moved, double((now - starts[i]).length()));
    }
    run.moved.push_back(moved);
    run.height.push_back(double(running.bodies().back()->getWorldTransform().getOrigin().y()));
    run.kinetic_energy.push_back(running.kinetic_energy());
    run.overlap.push_back(running.deepest_overlap());
    run.joint_error.push_back(running.joint_error());
  }
  if (const auto* our_solver = dynamic_cast<const ConstraintSolver*>(made.get())) {
    run.counters = our_solver->counters();
  }
  return run;
}

}  // namespace signorini::bullet
