#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact_finder.h>
#include <signorini/core/model/joint.h>
#include <signorini/core/response/contact_islands.h>
#include <signorini/core/response/contact_memory.h>
#include <signorini/core/response/contact_selection.h>
#include <signorini/core/response/island_threads.h>
#include <signorini/core/response/position_projection.h>
#include <signorini/core/response/sleeping.h>
#include <signorini/core/response/step_report.h>
#include <signorini/core/response/time_step_settings.h>
#include <signorini/core/response/velocity_problem.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace signorini {

/// After the impulses, a contact slower than this (m/s) neither leaves nor approaches.
inline constexpr double kRestingSpeed = 1e-6;

/// Velocity-level time stepping with Coulomb friction as a k-sided pyramid (Stewart and Trinkle
/// 1996; Anitescu and Potra 1997), all contacts in one LCP:
///
///     M (v+ - v-) = h F + J_n^T f_n + J_t^T beta
///     0 <= f_n  ⊥ J_n v+ + allowance >= 0
///     0 <= beta ⊥ J_t v+ + E lambda >= 0
///     0 <= lambda ⊥ mu f_n - E^T beta >= 0
///
/// (kCone: Coulomb's law itself, friction_cones.h, in the place of the last two lines; kBox: bounds
/// on both tangents) with the masses and the contacts of the step's start. In turn:
///
/// 1. Find the contacts with gap <= margin; those of the last step's end again if no body moved
///    since (forget_contacts()). v* = v- + h M^-1 F in momenta: p* = p + h m g, L* = L,
///    w* = J^-1 L*. Torque-free rotation keeps L exactly; the gyroscopic effect comes from the new
///    orientation in the next w: J^-1 is that of the orientation reached, so w* and the contact
///    rows have the gyroscopic torque of the rotation so far in them.
/// 2. allowance = e d'- (d'- from v-, not v*, so that a resting contact does not bounce) where gap
///    <= touching_tolerance and d'- < -restitution_threshold; else gap/h, 0 where gap <=
///    kToleratedOverlap (position_projection.h). Overlap is not pushed out in the velocities. A
///    contact that is apart, has e > 0 and would be caught by gap/h would lose its speed before it
///    touches. It is left out and bounces in the next step, if it approaches faster than
///    restitution_threshold and than the forces make it in one step (below that it cannot be told
///    from a resting one, and is caught). A bounce then starts up to h |d'-| deep.
/// 3. Leave out the contacts with gap > touching_tolerance that the free motion does not close.
///    Solve each island (contact_islands.h) apart; apply the impulses (driven and fixed bodies take
///    none), and look at what was left out: contacts that these would close farther than allowed
///    are put back, and the step is solved again; when it happens again, all that are apart are
///    put back. Then z = 0, w >= 0 solves the rows that were not made. Move x and q with v+.
///    Without contacts the problem is empty. An island of one contact is answered in closed form
///    where there is one, and certified like any other: without friction
///    f = max(0, -(d'* + allowance)/A); with a cone or a box z = 0 where it separates, -A^-1 q
///    where that sticks within the bounds.
/// 4. Project overlapping positions (position_projection.h). Contacts that leave faster than
///    kRestingSpeed are not projected, nor those with restitution that approach faster than
///    kRestingSpeed and restitution_threshold: a ball that bounces leaves by itself, and lifting it
///    would give it energy.
///
/// Rolling and spinning friction (turning_rows.h) add rows with limits coupled to their normals, in
/// every friction model; they start cold in every step. Anisotropic friction: friction_frame().
///
/// Joints (joint.h) add the rows of joint_rows.h, free or with bounds, to the same problem in every
/// friction model; islands are connected by them, and the projection closes what a step opened. A
/// body that swings at w loses (w h)^2 of the kinetic energy that its centre of mass has, a step,
/// as its velocity is turned into the new tangent by dropping what is across: first order in h.
///
/// With e = 0 the impulses never add kinetic energy unless a body or a motor is driven: T+ - T* =
/// f.d'+ + beta.u_t+ - 1/2 |J^T (f, beta)|^2_W, and at a solution f.d'+ = -f.allowance <= 0,
/// beta.u_t+ = -lambda mu f <= 0. With e > 0 in several contacts at once they can (Newton's law).
class TimeStepper {
 public:
  /// @param finder is asked for contacts, twice a step; must outlive the stepper
  /// @throws std::invalid_argument for bad bodies, settings or joints
  TimeStepper(Bodies bodies, ContactFinder& finder, const TimeStepSettings& settings,
              Joints joints = {});

  /// One step. If the velocity problem is not solved, the best iterate is applied and report.status
  /// says so: the caller decides whether to go on. A best iterate that is not finite is not applied
  /// (report.detail says so). Our own code allocates nothing once no count of bodies, contacts or
  /// rows of an island is other than in the step before (a sparse back-end does: lcp/back_end.h),
  /// with the accuracy dial; hand in the same report again, for its memory.
  /// @throws std::invalid_argument for a bad state, for contacts that validate() refuses or of
  /// which no body is dynamic, or if the solver refuses this kind of problem; state is then
  /// unchanged
  void step(State& state, StepReport& report);

  [[nodiscard]] const Bodies& bodies() const { return bodies_; }
  [[nodiscard]] const TimeStepSettings& settings() const { return settings_; }
  [[nodiscard]] const Joints& joints() const { return joints_; }
  /// Drives a joint otherwise from the next step on. @throws std::invalid_argument for a number out
  /// of range and for a motor that validate() refuses; nothing is then changed
  void set_motor(int joint, const JointMotor& motor);
  [[nodiscard]] bool is_asleep(int body) const { return sleepers_.is_asleep(body); }
  /// Wakes a body and what sleeps with it.
  /// @throws std::invalid_argument for a number out of range
  void wake(int body);
  /// After a change of the finder's own shapes or filters: asks it anew in the next step even if no
  /// body moved. Bodies asleep stay so: wake() those that the change may set free.
  void forget_contacts() { found_poses_.clear(); }

 private:
  [[nodiscard]] bool is_asleep(const Joint& joint) const;
  const Bodies& solved_bodies(const State& state, StepReport& report);
  void apply_forces(const State& start, State& free) const;
  [[nodiscard]] FrictionModel friction_model() const;
  [[nodiscard]] IslandSettings island_settings() const;
  void find(const State& state);
  int wake_touched(const State& state);
  void settle(State& state, StepReport& report);
  void choose_contacts(const State& state);
  void solve_islands(std::span<const ContactIsland> islands, const State& start,
                     StepReport& report);
  void collect(int number, const ContactIsland& island, const State& start, StepReport& report);
  void apply(const Bodies& solved, State& state, StepReport& report) const;
  void move(const State& start, State& state);
  void project(const Bodies& solved, State& state, StepReport& report);
  bool solve_selection(const Bodies& solved, const State& state, StepReport& report);

  Bodies bodies_;
  ContactFinder& finder_;
  TimeStepSettings settings_;
  std::string accuracy_name_;
  Joints joints_;
  BodyPairs joined_;  // of the joints whose bodies do not collide: smaller first, sorted
  std::unique_ptr<lcp::Solver> projection_solver_;
  IslandThreads island_threads_;
  Sleepers sleepers_;
  ContactSet found_;  // the contacts of these poses
  std::vector<Pose> found_poses_;
  ContactMemory memory_;
  ContactMemory next_memory_;
  JointMemory joint_memory_;
  JointMemory next_joint_memory_;
  std::vector<JointReport> joints_before_;  // what they did in their last step awake

  // Of the step at hand; kept for its memory.
  State free_;                        // the step's forces applied
  State next_;                        // with the impulses, then moved
  std::vector<JointRow> joint_rows_;  // of all joints
  std::vector<JointRow> awake_joint_rows_;
  ContactSelection selection_;
  std::vector<double> allowance_;  // of the contacts in the problem, m/s
  ContactIslands islands_;
  std::vector<int> island_sizes_;
  std::vector<IslandAnswer> answers_;
  VelocityProblem nothing_;  // of a step without islands
  std::vector<Vec3> impulses_, moments_;
  PositionProjection projection_;
  ProjectionReport projection_report_;
  ContactSet overlapping_;  // what is projected
  Joints awake_;
  std::vector<JointReport> loads_before_;  // joints_before_ of those awake
  std::vector<JointLoad> loads_;
  Bodies stiff_;
  std::vector<Velocity> velocities_;
  std::vector<double> d_dot_, d_dot_free_;
  std::vector<bool> in_contact_;
  BodyPairs pairs_;
};

}  // namespace signorini
