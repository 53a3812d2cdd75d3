#pragma once

#include <signorini/integrations/bullet/constraint_solver.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace signorini::bullet {

/// A constraint solver that a scene is run with.
struct DropInSolver {
  std::string name;    ///< "Bullet SI50", "signorini"
  int iterations = 0;  ///< m_numIterations; 0: Bullet's default, which ours does not use
  std::function<std::unique_ptr<btConstraintSolver>()> make;
};

/// Bullet's sequential impulses with so many iterations.
[[nodiscard]] DropInSolver bullet_si(int iterations);
/// Ours, by the model of its friction: "signorini" (cone) or "signorini box".
/// @param recorder is told of every problem; null: nobody
[[nodiscard]] DropInSolver ours(FrictionModel friction = FrictionModel::kCone,
                                lcp::SolveRecorder* recorder = nullptr);

/// What happened when a scene of Bullet's examples ran: one number a step, from the first step's
/// end on.
struct DropInRun {
  std::vector<double> time;            ///< s
  std::vector<double> height;          ///< of the last body's centre, m
  std::vector<double> moved;           ///< farthest that a body is from where it started, m
  std::vector<double> kinetic_energy;  ///< J
  std::vector<double> overlap;         ///< deepest, m
  std::vector<double> joint_error;     ///< m
  std::vector<double> solver_seconds;  ///< CPU time of the step's solveGroup(), set-up included
  Counters counters;                   ///< ours; all 0 for Bullet's solvers

  /// The time at which a body was first farther than this from its start; -1: never.
  [[nodiscard]] double moved_at(double distance) const;
  [[nodiscard]] double median_solver_seconds() const;
};

/// Runs a scene (ExampleScene) for so many seconds. @param stop is asked after every step; the run
/// then ends early. @throws std::invalid_argument for an unknown scene.
[[nodiscard]] DropInRun run_drop_in(const std::string& scene, const DropInSolver& solver,
                                    double seconds, const std::function<bool()>& stop = nullptr);

}  // namespace signorini::bullet
