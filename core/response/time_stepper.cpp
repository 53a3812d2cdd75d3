#include <signorini/core/model/contact_kinematics.h>
#include <signorini/core/model/number_text.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/joint_stiffness.h>
#include <signorini/core/response/position_projection.h>
#include <signorini/core/response/set_impact.h>
#include <signorini/core/response/time_stepper.h>
#include <signorini/lcp/certificate.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>

namespace signorini {
namespace {

void require(bool good, const char* field, const std::string& bound, const std::string& value) {
  if (!good) {
    throw std::invalid_argument(std::string("time step settings: ") + field + ": must be " + bound +
                                ", got " + value);
  }
}

void require_not_negative(double value, const char* field, const char* unit) {
  require(value >= 0.0 && std::isfinite(value), field, "finite and >= 0",
          number_text(value) + " " + unit);
}

void append(const std::string& text, std::string& detail) {
  if (!text.empty()) {
    detail += (detail.empty() ? "" : "; ") + text;
  }
}

double deepest_overlap(const ContactSet& contacts) {
  double depth = 0.0;
  for (const Contact& contact : contacts) {
    depth = std::max(depth, -contact.gap);
  }
  return depth;
}

/// The pairs of bodies that joints keep from colliding, smaller number first, sorted.
BodyPairs never_colliding(const Joints& joints) {
  BodyPairs pairs;
  for (const Joint& joint : joints) {
    if (!joint.bodies_collide) {
      pairs.emplace_back(std::minmax(joint.body_a, joint.body_b));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Wall time between laps.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

int dynamic_bodies(const Bodies& bodies) {
  return static_cast<int>(std::count_if(bodies.begin(), bodies.end(),
                                        [](const Body& body) { return body.is_dynamic(); }));
}

/// " of island 2", or nothing where there is one.
std::string of_island(const StepReport& report) {
  const std::size_t number = report.islands.size();
  return number == 1 ? "" : " of island " + std::to_string(number - 1);
}

}  // namespace

/// Which contacts are in a step's problem, and how fast each may close.
class TimeStepper::Selection {
 public:
  Selection(const ContactSet& found, const lcp::Vector& d_dot, const lcp::Vector& d_dot_free,
            const TimeStepSettings& settings, const Bodies& bodies, const Sleepers& sleepers)
      : found_(found), fate_(found.size(), Fate::kInProblem), allowance_(found.size()) {
    const double h = settings.step;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Contact& contact = found[i];
      const double e = contact.material.restitution;
      const bool touching = contact.gap <= settings.touching_tolerance;
      const double one_step = std::abs(d_dot_free[i] - d_dot[i]);
      const bool fast = d_dot[i] < -std::max(settings.restitution_threshold, one_step);
      const bool would_be_caught = contact.gap + h * d_dot_free[i] < 0.0;
      const bool bounces = touching && classify(d_dot[i], settings.restitution_threshold) ==
                                           ContactClass::kColliding;
      allowance_[i] = bounces ? e * d_dot[i] : closable_gap(contact.gap) / h;
      const bool a_sleeps = sleepers.is_asleep(contact.body_a);
      const bool b_sleeps = sleepers.is_asleep(contact.body_b);
      const bool one_sleeps = a_sleeps || b_sleeps;  // does not act, or it would have woken it
      const bool keeps_apart = !settings.full_model && !touching &&
                               contact.gap > kToleratedOverlap &&
                               d_dot_free[i] + allowance_[i] > 0.0;
      if ((a_sleeps && (b_sleeps || !bodies[contact.body_b].is_dynamic())) ||
          (b_sleeps && !bodies[contact.body_a].is_dynamic())) {
        fate_[i] = Fate::kAsleep;
      } else if (!one_sleeps && e > 0.0 && !touching && fast && would_be_caught) {
        fate_[i] = Fate::kAboutToBounce;
      } else if (one_sleeps || keeps_apart) {
        fate_[i] = Fate::kApart;
      }
    }
  }

  /// Those in the problem, or those apart with them.
  [[nodiscard]] ContactSet contacts(bool with_apart) const {
    ContactSet chosen;
    chosen.reserve(found_.size());
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (fate_[i] == Fate::kInProblem || (with_apart && fate_[i] == Fate::kApart)) {
        chosen.push_back(found_[i]);
      }
    }
    return chosen;
  }
  /// Of the contacts in the problem.
  [[nodiscard]] lcp::Vector allowance() const {
    lcp::Vector chosen(static_cast<lcp::Index>(found_.size()));
    lcp::Index count = 0;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      if (fate_[i] == Fate::kInProblem) {
        chosen[count++] = allowance_[i];
      }
    }
    chosen.conservativeResize(count);
    return chosen;
  }
  [[nodiscard]] int apart() const { return count(Fate::kApart); }
  [[nodiscard]] int about_to_bounce() const { return count(Fate::kAboutToBounce); }
  [[nodiscard]] int asleep() const { return count(Fate::kAsleep); }

  /// Puts back those that close farther than allowed. When it happens again, all of bodies awake:
  /// in a loose stack, which falls as one, every contact would else wait for the one below it.
  /// @return them; empty: none closes too far
  BodyPairs put_back(const std::vector<Velocity>& velocities, const State& state,
                     const Sleepers& sleepers) {
    constexpr double kRounding = 1e-13;  // m/s
    std::vector<bool> closes(found_.size());
    for (std::size_t i = 0; i < found_.size(); ++i) {
      closes[i] = fate_[i] == Fate::kApart &&
                  gap_velocity(velocities, state, found_[i]) + allowance_[i] < -kRounding;
    }
    BodyPairs back;
    if (std::find(closes.begin(), closes.end(), true) == closes.end()) {
      return back;
    }
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const int a = found_[i].body_a;
      const int b = found_[i].body_b;
      const bool awake = !sleepers.is_asleep(a) && !sleepers.is_asleep(b);
      if (fate_[i] == Fate::kApart && (closes[i] || (has_put_back_ && awake))) {
        fate_[i] = Fate::kInProblem;
        back.emplace_back(a, b);
      }
    }
    has_put_back_ = true;
    return back;
  }

 private:
  enum class Fate : std::uint8_t { kInProblem, kAboutToBounce, kApart, kAsleep };
  [[nodiscard]] int count(Fate fate) const {
    return static_cast<int>(std::count(fate_.begin(), fate_.end(), fate));
  }

  const ContactSet& found_;
  std::vector<Fate> fate_;
  std::vector<double> allowance_;  // m/s
  bool has_put_back_ = false;
};

void TimeStepSettings::validate() const {
  require(step > 0.0 && std::isfinite(step), "step", "finite and > 0", number_text(step) + " s");
  require(gravity.allFinite(), "gravity", "finite", number_text(gravity) + " m/s^2");
  require(pyramid_sides >= 4 && pyramid_sides % 2 == 0, "pyramid_sides", "even and >= 4",
          std::to_string(pyramid_sides));
  require(friction_model <= FrictionModel::kBox, "friction_model", "one of the three models",
          std::to_string(static_cast<int>(friction_model)));
  require_not_negative(margin, "margin", "m");
  require_not_negative(touching_tolerance, "touching_tolerance", "m");
  require_not_negative(restitution_threshold, "restitution_threshold", "m/s");
  require(threads >= 1, "threads", ">= 1", std::to_string(threads));
  require(accuracy.has_value() || !budget.is_limited(), "budget", "unlimited without accuracy",
          number_text(budget.work) + " units, " + number_text(budget.seconds) + " s");
  budget.validate();
  sleep.validate();
  lcp.validate();
}

TimeStepper::TimeStepper(Bodies bodies, ContactFinder& finder, const TimeStepSettings& settings,
                         Joints joints)
    : bodies_(std::move(bodies)),
      finder_(finder),
      settings_(settings),
      joints_(std::move(joints)),
      island_threads_(island_settings(),
                      settings.lcp.recorder != nullptr ? 1 : std::max(settings.threads, 1)),
      sleepers_(settings.sleep, static_cast<int>(bodies_.size())),
      joint_memory_(joints_.size()) {
  settings_.validate();
  for (const Body& body : bodies_) {
    validate(body);
  }
  validate(joints_, bodies_);
  joined_ = never_colliding(joints_);
  const std::string& of_settings = joints_.empty() ? settings_.solver : settings_.joint_solver;
  projection_solver_ = lcp::make_solver(settings_.accuracy ? "auto" : of_settings, settings_.lcp);
  for (const std::string& name :
       {settings_.solver, settings_.cone_solver, settings_.joint_solver}) {
    (void)lcp::make_solver(name, settings_.lcp);  // names known now, not in the first step
  }
}

void TimeStepper::set_motor(int joint, const JointMotor& motor) {
  if (joint < 0 || joint >= static_cast<int>(joints_.size())) {
    throw std::invalid_argument("joint: must be in [0, " + std::to_string(joints_.size()) +
                                "), got " + std::to_string(joint));
  }
  Joints changed = joints_;
  changed[joint].motor = motor;
  validate(changed, bodies_);
  joints_ = std::move(changed);
  sleepers_.wake(joints_[joint].body_a);
  sleepers_.wake(joints_[joint].body_b);
}

void TimeStepper::wake(int body) {
  if (body < 0 || body >= static_cast<int>(bodies_.size())) {
    throw std::invalid_argument("body: must be in [0, " + std::to_string(bodies_.size()) +
                                "), got " + std::to_string(body));
  }
  sleepers_.wake(body);
}

bool TimeStepper::is_asleep(const Joint& joint) const {
  return sleepers_.is_asleep(joint.body_a) || sleepers_.is_asleep(joint.body_b);
}

/// The bodies with the inertia that the step's problems have.
Bodies TimeStepper::solved_bodies(const State& state, StepReport& report) const {
  report.stiffened_bodies = 0;
  if (!settings_.joint_stiffness || joints_before_.empty()) {
    return bodies_;
  }
  std::vector<JointReport> before = joints_before_;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (is_asleep(joints_[i])) {
      before[i] = {};
    }
  }
  Bodies solved =
      stiffened(bodies_, state, joints_, before, settings_.step, report.stiffened_bodies);
  if (report.stiffened_bodies > 0) {
    append(std::to_string(report.stiffened_bodies) + " links under a heavy load stiffened",
           report.detail);
  }
  return solved;
}

State TimeStepper::with_forces_applied(const State& start) const {
  State state = start;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (bodies_[k].is_dynamic() && !sleepers_.is_asleep(static_cast<int>(k))) {
      state[k].p += settings_.step * bodies_[k].mass * bodies_[k].gravity_scale * settings_.gravity;
    }
  }
  return state;
}

FrictionModel TimeStepper::friction_model() const {
  return settings_.accuracy ? FrictionModel::kCone : settings_.friction_model;
}

IslandSettings TimeStepper::island_settings() const {
  return {.solver = settings_.solver,
          .cone_solver = settings_.cone_solver,
          .joint_solver = settings_.joint_solver,
          .lcp = settings_.lcp,
          .accuracy = settings_.accuracy,
          .warm_start = settings_.warm_start};
}

/// found_ for the state, kept where the poses are those that it was found for.
void TimeStepper::find(const State& state) {
  const auto same = [](const BodyState& body, const Pose& pose) {
    return body.x == pose.position && body.q.coeffs() == pose.orientation.coeffs();
  };
  if (std::equal(state.begin(), state.end(), found_poses_.begin(), found_poses_.end(), same)) {
    return;
  }
  forget_contacts();  // should the finder throw
  found_.clear();
  finder_.find(state, settings_.margin, found_);
  if (!joined_.empty()) {
    std::erase_if(found_, [&](const Contact& contact) {
      const std::pair<int, int> bodies = std::minmax(contact.body_a, contact.body_b);
      return std::binary_search(joined_.begin(), joined_.end(), bodies);
    });
  }
  validate(found_, static_cast<int>(bodies_.size()));
  found_poses_.reserve(state.size());
  for (const BodyState& body : state) {
    found_poses_.push_back(body.pose());
  }
}

void TimeStepper::solve_islands(const std::vector<ContactIsland>& islands, const State& start,
                                StepReport& report) {
  std::vector<int> sizes;
  int contacts_and_joints = 0;
  for (const ContactIsland& island : islands) {
    sizes.push_back(static_cast<int>(island.members.size() + island.joints.size()));
    contacts_and_joints += sizes.back();
  }
  if (answers_.size() < islands.size()) {
    answers_.resize(islands.size());
  }
  const StepMemory memory{memory_, joint_memory_};
  island_threads_.run(sizes, [&](int k, IslandSolver& solver) {
    const ContactIsland& island = islands[k];
    IslandAnswer& answer = answers_[k];
    answer.contacts.clear();
    for (const int i : island.members) {
      answer.contacts.push_back(report.contacts[i]);
    }
    answer.velocity.assemble(friction_model(), island.bodies, island.state, island.contacts,
                             island.allowance, settings_.pyramid_sides, island.joints);
    const double share = static_cast<double>(sizes[k]) / contacts_and_joints;
    solver.solve(answer.velocity, answer.contacts, island.joints, memory,
                 settings_.budget.share(share), answer.result, answer.work);
  });

  report.normal_impulses = lcp::Vector::Zero(static_cast<lcp::Index>(report.contacts.size()));
  report.impulses.assign(report.contacts.size(), Vec3::Zero());
  report.moments.assign(report.contacts.size(), Vec3::Zero());
  report.island_of.assign(report.contacts.size(), -1);
  report.joints.assign(joints_.size(), {});
  report.islands.clear();
  report.result = {};
  report.rows = report.joint_rows = report.tangents_left_out = 0;
  report.dynamic_bodies_without_rows = dynamic_bodies(bodies_);
  report.status = lcp::Status::kSolved;
  next_memory_.forget();
  for (std::size_t k = 0; k < islands.size(); ++k) {
    collect(answers_[k], islands[k], start, report);
  }
  if (islands.empty()) {
    VelocityProblem none;
    none.assemble(friction_model(), bodies_, {}, {}, lcp::Vector(), settings_.pyramid_sides);
    projection_solver_->solve(none.problem(), report.result);
  }
}

/// An island's solution, or its best iterate, into the report and the next memory.
void TimeStepper::collect(IslandAnswer& answer, const ContactIsland& island, const State& start,
                          StepReport& report) {
  lcp::Result& result = answer.result;
  report.islands.push_back(describe(island, answer.velocity.problem(), result, friction_model()));
  report.islands.back().work = answer.work;
  report.work += answer.work;
  report.rows += report.islands.back().rows;
  report.joint_rows += report.islands.back().joint_rows;
  report.dynamic_bodies_without_rows -= report.islands.back().bodies;
  for (const int i : island.members) {
    report.island_of[i] = static_cast<int>(report.islands.size()) - 1;
    report.tangents_left_out += report.contacts[i].material.friction > 0.0 ? 0 : 2;
  }
  const bool usable = result.z.allFinite();
  if (!lcp::is_solved(result.status)) {
    append("velocity problem" + of_island(report) + ": " +
               std::string(lcp::to_string(result.status)) +
               (usable ? ", best iterate applied" : ", no impulses applied"),
           report.detail);
  }
  report.status = worse(report.status, result.status);
  if (usable) {
    answer.velocity.remember(answer.contacts, result.z, next_memory_);
    const lcp::Vector normals = answer.velocity.normal_impulses(result.z);
    const std::vector<Vec3> impulses = answer.velocity.impulses(answer.contacts, result.z);
    const std::vector<Vec3> moments = answer.velocity.moments(result.z);
    for (std::size_t j = 0; j < island.members.size(); ++j) {
      report.normal_impulses[island.members[j]] = normals[static_cast<lcp::Index>(j)];
      report.impulses[island.members[j]] = impulses[j];
      report.moments[island.members[j]] = moments[j];
    }
    const lcp::Vector joint_impulses = answer.velocity.joint_impulses(result.z);
    remember_joints(island.joints, joint_impulses, next_joint_memory_);
    add_joint_impulses(joints_, start, island.joints, joint_impulses, report.joints);
  }
  keep_worse(std::move(result), report.result);
}

// `state` has the momenta after the impulses and the positions of the start.
void TimeStepper::move(const State& start, const ContactSet& contacts, State& state) const {
  std::vector<bool> in_contact(bodies_.size(), false);
  for (const Contact& contact : contacts) {
    in_contact[contact.body_a] = true;
    in_contact[contact.body_b] = true;
  }
  for (const Joint& joint : joints_) {
    in_contact[joint.body_a] = true;
    in_contact[joint.body_b] = true;
  }
  const Integrator in_rows = settings_.integrator == Integrator::kEnergyMomentum
                                 ? Integrator::kEnergyMomentum
                                 : Integrator::kSemiImplicit;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (sleepers_.is_asleep(static_cast<int>(k))) {
      continue;
    }
    if (in_contact[k]) {
      integrate_free(bodies_[k], Vec3::Zero(), Vec3::Zero(), settings_.step, in_rows,
                     settings_.orientation, state[k]);
    } else {
      const Vec3 weight = bodies_[k].mass * bodies_[k].gravity_scale * settings_.gravity;
      state[k] = start[k];
      integrate_free(bodies_[k], weight, Vec3::Zero(), settings_.step, settings_.integrator,
                     settings_.orientation, state[k]);
    }
  }
}

void TimeStepper::project(const Bodies& solved, State& state, StepReport& report) {
  find(state);
  const ContactSet& contacts = found_;
  const lcp::Vector d_dot = gap_velocities(bodies_, state, contacts);
  const double bounce_speed = std::max(kRestingSpeed, settings_.restitution_threshold);
  ContactSet chosen;
  chosen.reserve(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const bool leaves = d_dot[i] > kRestingSpeed;
    const bool will_bounce = contacts[i].material.restitution > 0.0 && d_dot[i] < -bounce_speed;
    const bool asleep =
        sleepers_.is_asleep(contacts[i].body_a) || sleepers_.is_asleep(contacts[i].body_b);
    if (!asleep && (contacts[i].gap >= 0.0 || !(leaves || will_bounce))) {
      chosen.push_back(contacts[i]);
    }
  }
  Joints awake = joints_;
  std::erase_if(awake, [&](const Joint& joint) { return is_asleep(joint); });
  ProjectionReport projection;
  project_positions(bodies_, chosen, settings_.gravity, *projection_solver_, state, projection,
                    awake, &solved);
  report.projection_status = projection.status;
  report.energy_change_projection = projection.energy_change;
  append(projection.detail, report.detail);
}

// The impulses on `state`, which has the free momenta.
void TimeStepper::apply(const Bodies& solved, State& state, StepReport& report) const {
  const double before = kinetic_energy(bodies_, state);
  apply_contact_impulses(bodies_, report.contacts, report.impulses, state);
  apply_contact_moments(bodies_, report.contacts, report.moments, state);
  apply_joint_impulses(bodies_, joints_, report.joints, state);
  if (report.stiffened_bodies > 0) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      if (solved[k].inertia != bodies_[k].inertia) {
        set_velocity(bodies_[k], velocity(solved[k], state[k]), state[k]);
      }
    }
  }
  report.energy_change_impact = kinetic_energy(bodies_, state) - before;
}

/// Wakes what acts with bodies that move: contacts that the free motion closes, all contacts of
/// driven bodies that move (they may leave), joints. @return how many bodies woke
int TimeStepper::wake_touched(const State& state, const State& free,
                              const std::vector<JointRow>& joined) {
  const std::vector<Velocity> velocities = velocities_of(bodies_, free);
  BodyPairs acting = body_pairs(joined);
  const auto may_wake = [&](int sleeper, int other) {
    return sleepers_.is_asleep(sleeper) && bodies_[other].kind != BodyKind::kFixed &&
           !sleepers_.is_asleep(other);
  };
  for (const Contact& contact : found_) {
    if (!may_wake(contact.body_a, contact.body_b) && !may_wake(contact.body_b, contact.body_a)) {
      continue;
    }
    const double reach = contact.gap + settings_.step * gap_velocity(velocities, free, contact);
    if (reach <= kToleratedOverlap || bodies_[contact.body_a].kind == BodyKind::kKinematic ||
        bodies_[contact.body_b].kind == BodyKind::kKinematic) {
      acting.emplace_back(contact.body_a, contact.body_b);
    }
  }
  return sleepers_.wake_touched(bodies_, state, acting);
}

void TimeStepper::settle(State& state, StepReport& report) {
  if (!sleepers_.is_on()) {
    return;
  }
  BodyPairs pairs = body_pairs(report.contacts);
  for (const Joint& joint : joints_) {
    if (!is_asleep(joint)) {
      pairs.emplace_back(joint.body_a, joint.body_b);
    }
  }
  report.energy_asleep = sleepers_.settle(bodies_, pairs, settings_.step, state);
  report.bodies_asleep = sleepers_.count();
}

/// Solves for the selected contacts until what was left out keeps apart, and moves the bodies.
/// @return false, with nothing moved, if bodies woke: the selection is then another
bool TimeStepper::solve_selection(Selection& selection, const Bodies& solved, const State& state,
                                  const State& free, const std::vector<JointRow>& joined,
                                  const std::string& detail, State& next, StepReport& report) {
  report.contacts_left_out = selection.about_to_bounce();
  for (;;) {
    report.detail = detail;
    if (report.contacts_left_out > 0) {
      append(std::to_string(report.contacts_left_out) + " contacts about to bounce left out",
             report.detail);
    }
    report.contacts = selection.contacts(false);
    next_joint_memory_ = joint_memory_;
    solve_islands(contact_islands(solved, free, report.contacts, selection.allowance(), joined,
                                  settings_.full_model),
                  state, report);
    next = free;
    apply(solved, next, report);
    if (selection.apart() == 0) {
      break;
    }
    const BodyPairs back = selection.put_back(velocities_of(bodies_, next), next, sleepers_);
    if (back.empty()) {
      break;
    }
    report.contacts_put_back += static_cast<int>(back.size());
    int woken = 0;
    for (const auto& [a, b] : back) {
      woken += sleepers_.wake(a) + sleepers_.wake(b);
    }
    report.bodies_woken += woken;
    if (woken > 0) {
      return false;
    }
  }
  report.contacts_apart = selection.apart();
  report.contacts_asleep = selection.asleep();
  move(state, selection.contacts(true), next);
  return true;
}

void TimeStepper::step(State& state, StepReport& report) {
  validate(bodies_, state);
  report = {};
  if (settings_.accuracy) {
    report.accuracy = settings_.accuracy->name();
  }
  report.is_deterministic = settings_.budget.seconds == StepBudget::kNone &&
                            settings_.lcp.time_limit == std::numeric_limits<double>::infinity();
  Stopwatch watch;
  find(state);
  check_dynamic(bodies_, found_);
  report.deepest_overlap = deepest_overlap(found_);
  report.seconds.find = watch.lap();

  std::vector<JointRow> all_joined;
  joint_rows(joints_, state, settings_.step, all_joined);
  State free = with_forces_applied(state);
  report.bodies_woken = sleepers_.notice(bodies_, state);
  while (sleepers_.count() > 0 || report.bodies_woken > 0) {
    free = with_forces_applied(state);  // of those that woke too
    const int woken = wake_touched(state, free, all_joined);
    report.bodies_woken += woken;
    if (woken == 0) {
      break;
    }
  }
  State next;
  Bodies solved;
  for (bool done = false; !done;) {
    report.detail.clear();
    solved = solved_bodies(state, report);
    const std::string detail = report.detail;
    std::vector<JointRow> joined = all_joined;
    std::erase_if(joined, [&](const JointRow& row) { return is_asleep(joints_[row.joint]); });
    Selection selection(found_, gap_velocities(bodies_, state, found_),
                        gap_velocities(bodies_, free, found_), settings_, bodies_, sleepers_);
    done = solve_selection(selection, solved, state, free, joined, detail, next, report);
    if (!done) {  // some woke
      free = with_forces_applied(state);
    }
  }
  next_memory_.sort();
  std::swap(memory_, next_memory_);
  std::swap(joint_memory_, next_joint_memory_);
  joints_before_.resize(joints_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!is_asleep(joints_[i])) {  // else what they did when they fell asleep
      joints_before_[i] = report.joints[i];
    }
  }
  report.seconds.solve = watch.lap();

  project(solved, next, report);
  measure_joints(joints_, next, report.joints);
  settle(next, report);
  report.kinetic_energy = kinetic_energy(bodies_, next);
  report.potential_energy = potential_energy(bodies_, next, settings_.gravity);
  state = std::move(next);
  report.seconds.project = watch.lap();
}

}  // namespace signorini
