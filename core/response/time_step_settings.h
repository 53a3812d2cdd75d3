#pragma once

#include <signorini/core/model/types.h>
#include <signorini/core/model/unconstrained_motion.h>
#include <signorini/core/response/accuracy.h>
#include <signorini/core/response/sleeping.h>
#include <signorini/core/response/velocity_problem.h>
#include <signorini/lcp/solver.h>

#include <optional>
#include <string>

namespace signorini {

/// Settings of TimeStepper.
struct TimeStepSettings {
  double step = 1.0 / 240.0;             ///< h, s, finite and > 0
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);  ///< m/s^2, finite
  OrientationScheme orientation = OrientationScheme::kQuaternion;
  /// Of the bodies that no contact row touches in the step. The others always move semi-implicitly
  /// in x, with their velocity after the impulses: that is what the contact rows speak about. Their
  /// rotation is by kEnergyMomentum if that is chosen here, else semi-implicit too. kEnergyMomentum
  /// keeps energy and momentum of a free spin, and between impulses of a spin in contact.
  Integrator integrator = Integrator::kEnergyMomentum;
  FrictionModel friction_model = FrictionModel::kPyramid;
  /// kPyramid: sides k of the friction pyramid, even, >= 4. More sides: closer to the cone, k rows
  /// a contact.
  int pyramid_sides = 8;
  /// Contacts closer than this are in the LCP, with gap/h as their allowance; m, finite and >= 0.
  /// A pair that is farther apart and closes more than this in one step is first seen overlapping.
  double margin = 0.01;
  /// Contacts with gap at most this are touching: restitution acts there; m, finite and >= 0.
  double touching_tolerance = 1e-6;
  /// Restitution acts at touching contacts that approach faster than this; m/s, finite and >= 0.
  double restitution_threshold = 0.0;
  /// A name that lcp::make_solver() knows: of the projection, and of the velocity problem but with
  /// cones, which most solvers cannot take.
  std::string solver = "lemke";
  std::string cone_solver = "auto";  ///< of the velocity problem with kCone
  /// Of the velocity problem with joints but no cones, and of the projection with joints: takes
  /// free rows, with kBox coupled limits too ("auto", "dantzig", "lemke", "alart-curnier", "pgs"
  /// ..).
  std::string joint_solver = "auto";
  /// A tolerance of 1e-8 leaves velocity errors of up to 1e-8 |q|, in a resting scene 1e-8 h g =
  /// 4e-10 m/s. Such errors come back in the q of the next step; with mass ratios of 1000 and more
  /// Lemke does not always reach 1e-9 against them.
  lcp::SolverSettings lcp = {.tolerance = 1e-8, .quick_certificate = true};
  /// Keeps light links under a heavy load from whipping (joint_stiffness.h). Off: the plain scheme.
  bool joint_stiffness = true;
  /// Starts the velocity problem from the impulses of the step before (contact_memory.h), for
  /// solvers that use a warm start.
  bool warm_start = true;
  /// The dial, one setting for whoever wants no others: chooses model (Coulomb's cone), solvers and
  /// tolerance for each island (island_solver.h); friction_model, solver, cone_solver, joint_solver
  /// and lcp.tolerance then count for nothing, but for the projection, which takes "auto".
  std::optional<Accuracy> accuracy = std::nullopt;
  StepBudget budget = {};  ///< of one step; needs accuracy
  /// Threads that solve islands, >= 1: the same bits for any number. One where a recorder is told
  /// of the solves, whose order then stays.
  int threads = 1;
  /// Bodies asleep have no rows, no forces and do not move; the finder is told nothing of it (a
  /// CollisionWorld asks no pair that stands still).
  SleepSettings sleep = {};
  /// Every contact found has its rows, every body of theirs six columns, and all islands are one
  /// problem: what the reduced model is checked against.
  bool full_model = false;

  /// @throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

}  // namespace signorini
