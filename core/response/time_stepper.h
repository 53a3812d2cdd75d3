#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact_finder.h>
#include <signorini/core/model/unconstrained_motion.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <string>
#include <vector>

namespace signorini {

struct TimeStepSettings {
  double step = 1.0 / 240.0;             ///< h, s, > 0
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);  ///< m/s^2
  OrientationScheme orientation = OrientationScheme::kQuaternion;
  Integrator integrator = Integrator::kSemiImplicit;
  /// Sides k of the friction pyramid, even, >= 4. More sides: closer to the cone, k rows a contact.
  int pyramid_sides = 8;
  /// Contacts closer than this are in the LCP, with gap/h as their allowance; m, >= 0.
  double margin = 0.01;
  /// Restitution acts at touching contacts that approach faster than this; m/s, >= 0.
  double restitution_threshold = 0.0;
  std::string solver = "lemke";
  lcp::SolverSettings lcp = {.tolerance = 1e-9};

  /// @throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// What one step did.
struct StepReport {
  lcp::Status status = lcp::Status::kNotRun;  ///< of the velocity problem
  ContactSet contacts;                        ///< those in the problem
  lcp::Vector normal_impulses;                ///< N s
  std::vector<Vec3> impulses;                 ///< whole contact impulses on A, world, N s
  double kinetic_energy = 0.0;                ///< after the step, J
  double potential_energy = 0.0;              ///< J
  double energy_change_impact = 0.0;          ///< kinetic energy change by the contact impulses, J
  double energy_change_projection = 0.0;  ///< potential energy change by the position projection, J
  double deepest_overlap = 0.0;  ///< max(0, -gap) over the contacts at the start of the step, m
  lcp::Result result;
  std::string detail;  ///< one line: anything beyond the plain scheme
};

/// Velocity-level time stepping with Coulomb friction as a k-sided pyramid (Stewart and Trinkle
/// 1996; Anitescu and Potra 1997), all contacts in one LCP:
///
///     M (v+ - v-) = h F + J_n^T f_n + J_t^T beta
///     0 <= f_n  ⊥ J_n v+ + gap/h (gap > 0 only) + e d'- (touching, colliding) >= 0
///     0 <= beta ⊥ J_t v+ + E lambda >= 0
///     0 <= lambda ⊥ mu f_n - E^T beta >= 0
///
/// then x, q move with v+. Overlap is removed by a position projection that leaves p and L alone.
class TimeStepper {
 public:
  /// @param finder is asked for contacts; must outlive the stepper
  /// @throws std::invalid_argument for bad bodies or settings
  TimeStepper(Bodies bodies, ContactFinder& finder, const TimeStepSettings& settings);

  /// One step. If the velocity problem is not solved, the best iterate is applied and report.status
  /// says so: the caller decides whether to go on.
  void step(State& state, StepReport& report);

  [[nodiscard]] const Bodies& bodies() const { return bodies_; }

 private:
  Bodies bodies_;
  ContactFinder& finder_;
  TimeStepSettings settings_;
  std::unique_ptr<lcp::Solver> solver_;
};

}  // namespace signorini
