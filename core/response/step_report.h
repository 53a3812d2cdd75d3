#pragma once

#include <signorini/core/model/contact.h>
#include <signorini/core/response/joint_rows.h>
#include <signorini/lcp/result.h>

#include <limits>
#include <string>
#include <vector>

namespace signorini {

/// What was solved for one island of a step.
struct IslandReport {
  int bodies = 0;      ///< dynamic
  int contacts = 0;    ///< rows of normals
  int joint_rows = 0;  ///< those of joints
  int rows = 0;        ///< of the problem
  int columns = 0;     ///< of its J: 6 a body, 3 where no contact can turn it
  std::string model;   ///< "frictionless", or the friction model; "single contact, " before it
  std::string solver;
  lcp::Status status = lcp::Status::kNotRun;
  double unit_free_residual = std::numeric_limits<double>::quiet_NaN();
  double residual = std::numeric_limits<double>::quiet_NaN();  ///< that times |q|_inf, m/s
  double work = 0.0;  ///< with the dial, units of StepBudget::work
};

/// Wall time of the stages of a step, s.
struct StageSeconds {
  double find = 0.0;     ///< contacts at the start
  double solve = 0.0;    ///< rows made, islands solved, bodies moved
  double project = 0.0;  ///< contacts at the end, overlap projected, the rest
  // Parts of `solve`; of islands on several threads the sums over all threads.
  double assemble = 0.0;  ///< the islands' rows made
  double solvers = 0.0;   ///< the islands' problems solved and certified
  double move = 0.0;      ///< bodies moved
};

/// What one step did.
struct StepReport {
  /// Of the velocity problem: of the islands the first that is not solved, else solved to rounding
  /// if one is.
  lcp::Status status = lcp::Status::kNotRun;
  ContactSet contacts;                ///< those in the problem
  lcp::Vector normal_impulses;        ///< N s, one for each of `contacts`
  std::vector<Vec3> impulses;         ///< whole contact impulses on A, world, N s
  std::vector<Vec3> moments;          ///< of rolling and spinning friction, on A, world, N m s
  std::vector<int> island_of;         ///< of each of `contacts`, into `islands`
  std::vector<IslandReport> islands;  ///< solved apart, in the order of their first contact
  std::vector<JointReport> joints;    ///< one a joint of the stepper; no impulse while asleep
  int joint_rows = 0;                 ///< of all joints
  int stiffened_bodies = 0;           ///< links under a heavy load: joint_stiffness.h
  int rows = 0;                       ///< of all islands
  /// Contacts found but left out of the problem: apart, with restitution, and approaching fast.
  int contacts_left_out = 0;
  /// Contacts found, apart, left out because the free motion does not close them, and looked at
  /// after the solve; and those that were put back in, whose step was then solved again.
  int contacts_apart = 0;
  int contacts_put_back = 0;
  int contacts_asleep = 0;     ///< found, of bodies asleep: no rows
  int bodies_asleep = 0;       ///< after the step
  int bodies_woken = 0;        ///< in this step
  double energy_asleep = 0.0;  ///< kinetic energy that bodies lost by falling asleep, J
  int tangents_left_out = 0;   ///< tangential rows not made: contacts without friction
  int rotations_left_out = 0;  ///< bodies with rows that none of them can turn: 3 columns, not 6
  int dynamic_bodies_without_rows = 0;
  double kinetic_energy = 0.0;        ///< after the step, J
  double potential_energy = 0.0;      ///< after the step, J
  double energy_change_impact = 0.0;  ///< kinetic energy change by the contact impulses (what
                                      ///< driven bodies did through them included), J
  /// Energy change by the position projection: potential, and kinetic where turning a body changes
  /// J with L fixed; J.
  double energy_change_projection = 0.0;
  double deepest_overlap = 0.0;  ///< max(0, -gap) over the contacts at the start of the step, m
  lcp::Status projection_status = lcp::Status::kNotRun;  ///< kNotRun: nothing to project
  /// Of the island that ended worst (not solved before solved, then by the unit-free residual);
  /// statistics.solve_seconds: of all islands. Solver "closed form" for one contact that needs
  /// none.
  lcp::Result result;
  std::string accuracy;          ///< position of the dial, empty without
  double work = 0.0;             ///< of all islands, with the dial, units of StepBudget::work
  bool is_deterministic = true;  ///< false where a clock decides when a solver stops
  StageSeconds seconds;
  std::string detail;  ///< one line: anything beyond the plain scheme
};

/// Makes it the report of a step that did nothing yet; keeps its memory.
void start_report(StepReport& report);

/// The report as text: a line on rows made and left out, by reason, then a line an island.
[[nodiscard]] std::string to_text(const StepReport& report);

}  // namespace signorini
