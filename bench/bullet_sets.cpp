#include "bench/bullet_sets.h"

#include <signorini/lcp/solver.h>

#include "tools/stopwatch.h"

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btLemkeSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <map>
#include <ostream>
#include <random>
#include <stdexcept>

namespace signorini::bench {
namespace {

constexpr double kTimeStep = 1.0 / 60.0;

/// The numbers of a run that a child sends home; plain bytes.
struct Report {
  double residual = -1.0;
  double scaled_residual = -1.0;
  double seconds = std::numeric_limits<double>::infinity();
  double solve_seconds = -1.0;
  int negative_impulses = 0;
  char outcome[64] = "ok";

  void set_outcome(std::string_view text) {
    const std::size_t count = std::min(text.size(), sizeof outcome - 1);
    std::memcpy(outcome, text.data(), count);
    outcome[count] = '\0';
  }
};

/// What a set asks for, without friction or with it.
struct AssembledSet {
  BulletContacts contacts;
  NormalRows rows;
  BulletCones cones;
  bool has_friction = false;
  lcp::Problem problem;

  void read(const BulletGroup& group) {
    contacts.read(group);
    has_friction = std::any_of(contacts.contacts.begin(), contacts.contacts.end(),
                               [](const Contact& one) { return one.material.friction > 0.0; });
    if (has_friction) {
      assemble_cones(contacts, cones);
      return;
    }
    if (auto* used = std::get_if<lcp::FactoredMatrix>(&problem.M)) {
      rows.A = std::move(*used);  // its memory
    }
    assemble_normals(contacts.bodies, contacts.free_state, contacts.contacts, rows);
    problem.q = rows.d_dot + contacts.allowance;
    problem.M = std::move(rows.A);
  }
  [[nodiscard]] const lcp::Problem& asked() const { return has_friction ? cones.problem : problem; }
  [[nodiscard]] lcp::Vector written() const {
    return has_friction ? written_impulses(contacts, cones) : written_impulses(contacts);
  }
  void write(const BulletGroup& group, const lcp::Vector& z) const {
    if (has_friction) {
      write_solution(group, contacts, cones, z);
    } else {
      write_solution(group, contacts, z);
    }
  }
};

/// Judges the impulses that were left in the points, in long double, whoever wrote them.
void judge(const AssembledSet& set, const lcp::Vector& z, Report& report) {
  const lcp::Certificate certificate = lcp::certify(set.asked(), z);
  const double q = set.asked().q.lpNorm<Eigen::Infinity>();
  report.residual = certificate.natural_residual * (1.0 + q);
  report.scaled_residual = certificate.unit_free_residual * q;
  report.negative_impulses =
      static_cast<int>((written_impulses(set.contacts).array() < 0.0).count());
}

/// A contestant: what it does to the group counts, from the state on to the written impulses.
struct Solver {
  std::string name;
  /// Prepares once, then returns the call that is timed.
  std::function<std::function<void(Report&)>(const BulletGroup&)> make;
};

Solver bullet_solver(const std::string& name, int iterations,
                     const std::function<std::shared_ptr<btConstraintSolver>()>& make,
                     int more_modes = 0) {
  return {name,
          [iterations, make, more_modes](const BulletGroup& group) -> std::function<void(Report&)> {
            btContactSolverInfo info = *group.info;
            info.m_numIterations = iterations;
            info.m_solverMode |= more_modes;
            std::shared_ptr<btConstraintSolver> solver = make();
            return [&group, info, solver](Report&) { group.solve(*solver, info); };
          }};
}

/// btMLCPSolver falls back to sequential impulses without a word.
template <typename Inner>
Solver bullet_mlcp(const std::string& name) {
  return {name, [](const BulletGroup& group) -> std::function<void(Report&)> {
            struct Both {
              Inner inner;
              btMLCPSolver outer{&inner};
            };
            auto both = std::make_shared<Both>();
            return [&group, both](Report& report) {
              both->outer.setNumFallbacks(0);
              group.solve(both->outer, *group.info);
              report.set_outcome(both->outer.getNumFallbacks() > 0 ? "fallback" : "ok");
            };
          }};
}

/// One of ours: reads Bullet's contacts, assembles, solves, writes velocities and impulses back.
Solver our_solver(std::string_view name, double tolerance) {
  return {std::string(name),
          [name, tolerance](const BulletGroup& group) -> std::function<void(Report&)> {
            struct Workspace {
              std::unique_ptr<lcp::Solver> solver;
              AssembledSet set;
              lcp::Result result;
            };
            auto work = std::make_shared<Workspace>();
            // The verdict of a time step's solver: at O(n), see SolverSettings.
            work->solver =
                lcp::make_solver(name, {.tolerance = tolerance, .quick_certificate = true});
            return [&group, work](Report& report) {
              Workspace& w = *work;
              w.set.read(group);
              const tools::Stopwatch stopwatch;
              w.solver->solve(w.set.asked(), w.result);
              report.solve_seconds = stopwatch.seconds();
              w.set.write(group, w.result.z);
              report.set_outcome(lcp::to_string(w.result.status));
            };
          }};
}

std::vector<Solver> all_solvers(const BulletGroup& group, double tolerance) {
  std::vector<Solver> solvers;
  for (const int iterations : {10, 50, 200, 1000}) {
    solvers.push_back(bullet_solver(fmt::format("Bullet SI{}", iterations), iterations, [] {
      return std::make_shared<btSequentialImpulseConstraintSolver>();
    }));
  }
  solvers.push_back(bullet_solver("Bullet NNCG200", 200,
                                  [] { return std::make_shared<btNNCGConstraintSolver>(); }));
  solvers.push_back(bullet_mlcp<btDantzigSolver>("Bullet Dantzig"));
  solvers.push_back(bullet_mlcp<btLemkeSolver>("Bullet Lemke"));
  AssembledSet set;
  set.read(group);
  if (set.has_friction) {
    for (const int iterations : {200, 1000}) {
      solvers.push_back(bullet_solver(
          fmt::format("Bullet SI{} 2dir", iterations), iterations,
          [] { return std::make_shared<btSequentialImpulseConstraintSolver>(); },
          SOLVER_USE_2_FRICTION_DIRECTIONS));
    }
  }
  for (const std::string_view name : lcp::solver_names()) {
    if (name != "exact" && lcp::make_solver(name)->refuses(set.asked()).empty()) {
      solvers.push_back(our_solver(name, tolerance));
    }
  }
  return solvers;
}

std::string run_in_this_process(const Solver& solver, const BulletGroup& group,
                                const BulletState& start, int repeats) {
  Report report;
  const auto call = solver.make(group);
  for (int i = 0; i < repeats; ++i) {
    start.restore(group);
    forget_impulses(group);
    Report once;
    const tools::Stopwatch stopwatch;
    call(once);
    once.seconds = stopwatch.seconds();
    if (once.seconds < report.seconds) {
      report = once;
    }
  }
  // The problem is that of the state before the solve; the impulses are those that it left.
  const BulletState solved(group);
  start.restore(group);
  AssembledSet set;
  set.read(group);
  solved.restore(group);
  judge(set, set.written(), report);
  return {reinterpret_cast<const char*>(&report), sizeof report};
}

BulletSetRun to_run(const tools::ChildAnswer& child) {
  BulletSetRun run;
  if (child.end != tools::ChildEnd::kAnswered) {
    run.outcome.assign(1, child.end == tools::ChildEnd::kTimedOut ? 'T' : 'C');
    return run;
  }
  Report report;
  std::memcpy(&report, child.answer.data(), sizeof report);
  run.outcome = report.outcome;
  run.residual = report.residual;
  run.scaled_residual = report.scaled_residual;
  run.seconds = report.seconds;
  run.solve_seconds = report.solve_seconds;
  run.negative_impulses = report.negative_impulses;
  return run;
}

}  // namespace

struct BulletScene::Parts {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  CapturingSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btBoxShape ground{btVector3(100.0, 100.0, 100.0)};
  btBoxShape cube{btVector3(0.5, 0.5, 0.5)};
  btSphereShape sphere{0.5};
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  int steps = 0;
  double friction = 0.0;
};

std::vector<std::string> BulletScene::names() {
  return {"stack10", "stack30", "spheres125", "pyramid10"};
}

void BulletScene::add_body(btCollisionShape& shape, double mass, const btVector3& centre) {
  btVector3 inertia(0.0, 0.0, 0.0);
  if (mass > 0.0) {
    shape.calculateLocalInertia(mass, inertia);
  }
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
  info.m_startWorldTransform.setOrigin(centre);
  info.m_friction = std::sqrt(parts_->friction);  // Bullet multiplies the two
  auto body = std::make_unique<btRigidBody>(info);
  body->setActivationState(DISABLE_DEACTIVATION);
  parts_->world.addRigidBody(body.get());
  parts_->bodies.push_back(std::move(body));
}

BulletScene::BulletScene(const std::string& name, double friction)
    : parts_(std::make_unique<Parts>()) {
  Parts& parts = *parts_;
  parts.friction = friction;
  parts.world.setGravity(btVector3(0.0, 0.0, -9.81));
  parts.world.getSimulationIslandManager()->setSplitIslands(false);
  add_body(parts.ground, 0.0, btVector3(0.0, 0.0, -100.0));
  if (name == "stack10" || name == "stack30") {
    for (int i = 0; i < (name == "stack10" ? 10 : 30); ++i) {
      add_body(parts.cube, 1.0, btVector3(0.0, 0.0, 0.5 + i));
    }
    parts.steps = 10;
  } else if (name == "pyramid10") {
    for (int row = 0; row < 10; ++row) {
      for (int j = 0; j < 10 - row; ++j) {
        // Bricks a hair apart, so that each touches the row below alone.
        add_body(parts.cube, 1.0, btVector3(1.05 * (j + 0.5 * row), 0.0, 0.5 + row));
      }
    }
    parts.steps = 10;
  } else if (name == "spheres125") {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> jitter(-0.02, 0.02);
    for (int i = 0; i < 125; ++i) {
      const int row = i / 5 % 5;
      const int layer = i / 25;
      const double x = i % 5 + jitter(random);
      const double y = row + jitter(random);
      add_body(parts.sphere, 1.0, btVector3(x, y, 0.6 + layer + 0.3 * jitter(random)));
    }
    parts.steps = 20;
  } else {
    std::string known;
    for (const std::string& one : names()) {
      known.append(" ").append(one);
    }
    throw std::invalid_argument("Bullet set: must be one of" + known + ", got " + name);
  }
}

BulletScene::~BulletScene() {
  for (const auto& body : parts_->bodies) {
    parts_->world.removeRigidBody(body.get());
  }
}

void BulletScene::visit(const CapturingSolver::Visitor& visitor) {
  for (int step = 0; step < parts_->steps; ++step) {
    parts_->world.stepSimulation(kTimeStep, 0);
  }
  parts_->solver.set_visitor([&](const BulletGroup& group) {
    if (group.manifold_count > 0) {  // Bullet also solves the group of what touches nothing
      visitor(group);
    }
  });
  parts_->world.stepSimulation(kTimeStep, 0);
  parts_->solver.set_visitor(nullptr);
}

std::vector<BulletSetRun> run_bullet_sets(const BulletSetsOptions& options,
                                          std::ostream* progress) {
  std::vector<BulletSetRun> runs;
  for (const std::string& set : options.sets) {
    BulletScene scene(set, options.friction);
    scene.visit([&](const BulletGroup& group) {
      const BulletState start(group);
      BulletContacts contacts;
      contacts.read(group);
      for (const Solver& solver : all_solvers(group, options.tolerance)) {
        if (tools::children_are_stopped()) {
          return;
        }
        if (progress != nullptr) {
          *progress << fmt::format("\r\033[K{} ({} contacts): {}", set, contacts.points.size(),
                                   solver.name)
                    << std::flush;
        }
        BulletSetRun run = to_run(tools::run_in_child(
            [&](const std::function<void()>& loaded) {
              loaded();
              return run_in_this_process(solver, group, start, options.repeats);
            },
            options.limits));
        run.set = set;
        run.n = static_cast<int>(contacts.points.size());
        run.solver = solver.name;
        runs.push_back(std::move(run));
      }
    });
  }
  if (progress != nullptr) {
    *progress << "\r\033[K" << std::flush;
  }
  return runs;
}

std::string bullet_sets_csv(const std::vector<BulletSetRun>& runs) {
  std::string csv =
      "set,n,solver,outcome,residual,scaled_residual,negative_impulses,seconds,solve_seconds\n";
  for (const BulletSetRun& run : runs) {
    csv += fmt::format("{},{},{},{},{:.3e},{:.3e},{},{:.4g},{}\n", run.set, run.n, run.solver,
                       run.outcome, run.residual, run.scaled_residual, run.negative_impulses,
                       run.seconds,
                       run.solve_seconds < 0.0 ? "" : fmt::format("{:.4g}", run.solve_seconds));
  }
  return csv;
}

std::string bullet_sets_text(const std::vector<BulletSetRun>& runs) {
  std::vector<std::string> sets;
  std::vector<std::string> solvers;
  std::map<std::pair<std::string, std::string>, const BulletSetRun*> cells;
  const auto add_once = [](std::vector<std::string>& all, const std::string& one) {
    if (std::find(all.begin(), all.end(), one) == all.end()) {
      all.push_back(one);
    }
  };
  for (const BulletSetRun& run : runs) {
    add_once(sets, fmt::format("{}, n={}", run.set, run.n));
    add_once(solvers, run.solver);
    cells[{run.solver, sets.back()}] = &run;
  }
  std::string text = fmt::format("{:<18}", "m/s / us");
  for (const std::string& set : sets) {
    text += fmt::format("  {:>32}", set);
  }
  text += "\n";
  for (const std::string& solver : solvers) {
    text += fmt::format("{:<18}", solver);
    for (const std::string& set : sets) {
      const auto found = cells.find({solver, set});
      std::string cell;
      if (found != cells.end() && found->second->seconds < 0.0) {
        cell = found->second->outcome;
      } else if (found != cells.end()) {
        const BulletSetRun& run = *found->second;
        const bool is_plain = run.outcome == "ok" || run.outcome == "solved";
        cell = fmt::format("{}{:.0e} / {:.0f}", is_plain ? "" : fmt::format("{} ", run.outcome),
                           run.residual, 1e6 * run.seconds);
      }
      text += fmt::format("  {:>32}", cell);
    }
    text += "\n";
  }
  return text;
}

}  // namespace signorini::bench
