#include <signorini/core/model/number_text.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/joint_stiffness.h>
#include <signorini/core/response/set_impact.h>
#include <signorini/core/response/time_stepper.h>
#include <signorini/lcp/certificate.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

namespace signorini {
namespace {

void append(std::string_view text, std::string& detail) {
  if (!text.empty()) {
    detail += detail.empty() ? "" : "; ";
    detail += text;
  }
}

/// "3 contacts ..", where there are any.
void append_count(int count, std::string_view what, std::string& detail) {
  if (count > 0) {
    append(std::to_string(count), detail);
    detail += what;
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
std::string of_island(int number, const StepReport& report) {
  return report.islands.size() == 1 ? "" : " of island " + std::to_string(number);
}

}  // namespace

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
  accuracy_name_ = settings_.accuracy ? settings_.accuracy->name() : "";
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
const Bodies& TimeStepper::solved_bodies(const State& state, StepReport& report) {
  report.stiffened_bodies = 0;
  if (!settings_.joint_stiffness || joints_before_.empty()) {
    return bodies_;
  }
  loads_before_ = joints_before_;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (is_asleep(joints_[i])) {
      loads_before_[i] = {};
    }
  }
  report.stiffened_bodies =
      stiffen(bodies_, state, joints_, loads_before_, settings_.step, loads_, stiff_);
  return report.stiffened_bodies > 0 ? stiff_ : bodies_;
}

void TimeStepper::apply_forces(const State& start, State& free) const {
  free = start;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (bodies_[k].is_dynamic() && !sleepers_.is_asleep(static_cast<int>(k))) {
      free[k].p += settings_.step * bodies_[k].mass * bodies_[k].gravity_scale * settings_.gravity;
    }
  }
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

void TimeStepper::solve_islands(std::span<const ContactIsland> islands, const State& start,
                                StepReport& report) {
  island_sizes_.clear();
  int contacts_and_joints = 0;
  for (const ContactIsland& island : islands) {
    island_sizes_.push_back(static_cast<int>(island.members.size() + island.joints.size()));
    contacts_and_joints += island_sizes_.back();
  }
  if (answers_.size() < islands.size()) {
    answers_.resize(islands.size());
  }
  const StepMemory memory{memory_, joint_memory_};
  const auto solve = [&](int k, IslandSolver& solver) {
    const ContactIsland& island = islands[k];
    IslandAnswer& answer = answers_[k];
    answer.contacts.clear();
    for (const int i : island.members) {
      answer.contacts.push_back(report.contacts[i]);
    }
    Stopwatch watch;
    answer.velocity.assemble(
        friction_model(), island.bodies, island.state, island.contacts, island.allowance,
        settings_.pyramid_sides, island.joints,
        settings_.full_model ? BodyColumns::kSix : BodyColumns::kThatForcesReach);
    answer.assemble_seconds = watch.lap();
    const double share = static_cast<double>(island_sizes_[k]) / contacts_and_joints;
    solver.solve(island.joints, memory, settings_.budget.share(share), answer);
  };
  island_threads_.run(island_sizes_, std::ref(solve));

  report.normal_impulses.setZero(static_cast<lcp::Index>(report.contacts.size()));
  report.impulses.assign(report.contacts.size(), Vec3::Zero());
  report.moments.assign(report.contacts.size(), Vec3::Zero());
  report.island_of.assign(report.contacts.size(), -1);
  report.joints.assign(joints_.size(), {});
  report.islands.resize(islands.size());
  report.rows = report.joint_rows = report.tangents_left_out = report.rotations_left_out = 0;
  report.dynamic_bodies_without_rows = dynamic_bodies(bodies_);
  report.status = lcp::Status::kSolved;
  next_memory_.forget();
  std::size_t worst = 0;
  double seconds = 0.0;
  for (std::size_t k = 0; k < islands.size(); ++k) {
    collect(static_cast<int>(k), islands[k], start, report);
    seconds += std::max(answers_[k].result.statistics.solve_seconds, 0.0);
    report.seconds.assemble += answers_[k].assemble_seconds;
    worst = is_worse(answers_[k].result, answers_[worst].result) ? k : worst;
  }
  report.seconds.solvers += seconds;
  if (islands.empty()) {
    nothing_.assemble(friction_model(), bodies_, start, {}, lcp::Vector(), settings_.pyramid_sides);
    projection_solver_->solve(nothing_.problem(), report.result);
  } else {
    std::swap(report.result, answers_[worst].result);
    report.result.statistics.solve_seconds = seconds;
  }
}

/// An island's solution, or its best iterate, into the report and the next memory.
void TimeStepper::collect(int number, const ContactIsland& island, const State& start,
                          StepReport& report) {
  const IslandAnswer& answer = answers_[number];
  const lcp::Result& result = answer.result;
  IslandReport& told = report.islands[number];
  describe(island, answer.velocity, result, friction_model(), told);
  told.work = answer.work;
  report.work += answer.work;
  report.rows += told.rows;
  report.joint_rows += told.joint_rows;
  report.rotations_left_out += 2 * told.bodies - told.columns / 3;
  report.dynamic_bodies_without_rows -= told.bodies;
  for (const int i : island.members) {
    report.island_of[i] = number;
    report.tangents_left_out += report.contacts[i].material.friction > 0.0 ? 0 : 2;
  }
  const bool usable = result.z.allFinite();
  if (!lcp::is_solved(result.status)) {
    append("velocity problem" + of_island(number, report) + ": " +
               std::string(lcp::to_string(result.status)) +
               (usable ? ", best iterate applied" : ", no impulses applied"),
           report.detail);
  }
  report.status = worse(report.status, result.status);
  if (usable) {
    answer.velocity.remember(answer.contacts, result.z, answer.corrected, next_memory_);
    answer.velocity.impulses(answer.contacts, result.z, impulses_);
    answer.velocity.moments(result.z, moments_);
    for (std::size_t j = 0; j < island.members.size(); ++j) {
      report.normal_impulses[island.members[j]] = answer.velocity.normal_impulse(result.z, j);
      report.impulses[island.members[j]] = impulses_[j];
      report.moments[island.members[j]] = moments_[j];
    }
    const lcp::VectorRef joint_impulses = answer.velocity.joint_impulses(result.z);
    remember_joints(island.joints, joint_impulses, next_joint_memory_);
    add_joint_impulses(joints_, start, island.joints, joint_impulses, report.joints);
  }
}

// `state` has the momenta after the impulses and the positions of the start.
void TimeStepper::move(const State& start, State& state) {
  in_contact_.assign(bodies_.size(), false);
  selection_.mark_bodies(found_, in_contact_);
  for (const Joint& joint : joints_) {
    in_contact_[joint.body_a] = true;
    in_contact_[joint.body_b] = true;
  }
  const Integrator in_rows = settings_.integrator == Integrator::kEnergyMomentum
                                 ? Integrator::kEnergyMomentum
                                 : Integrator::kSemiImplicit;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (sleepers_.is_asleep(static_cast<int>(k))) {
      continue;
    }
    if (in_contact_[k]) {
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
  velocities_of(bodies_, state, velocities_);
  gap_velocities(velocities_, state, found_, d_dot_);
  const double bounce_speed = std::max(kRestingSpeed, settings_.restitution_threshold);
  overlapping_.clear();
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const Contact& contact = found_[i];
    const bool leaves = d_dot_[i] > kRestingSpeed;
    const bool will_bounce = contact.material.restitution > 0.0 && d_dot_[i] < -bounce_speed;
    const bool asleep = sleepers_.is_asleep(contact.body_a) || sleepers_.is_asleep(contact.body_b);
    if (!asleep && (contact.gap >= 0.0 || !(leaves || will_bounce))) {
      overlapping_.push_back(contact);
    }
  }
  const bool some_sleep = sleepers_.count() > 0;
  if (some_sleep) {
    awake_ = joints_;
    std::erase_if(awake_, [&](const Joint& joint) { return is_asleep(joint); });
  }
  projection_.project(bodies_, overlapping_, settings_.gravity, *projection_solver_, state,
                      projection_report_, some_sleep ? awake_ : joints_, &solved);
  report.projection_status = projection_report_.status;
  report.energy_change_projection = projection_report_.energy_change;
  append(projection_report_.detail, report.detail);
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
int TimeStepper::wake_touched(const State& state) {
  velocities_of(bodies_, free_, velocities_);
  pairs_.clear();
  add_body_pairs(joint_rows_, pairs_);
  const auto may_wake = [&](int sleeper, int other) {
    return sleepers_.is_asleep(sleeper) && bodies_[other].kind != BodyKind::kFixed &&
           !sleepers_.is_asleep(other);
  };
  for (const Contact& contact : found_) {
    if (!may_wake(contact.body_a, contact.body_b) && !may_wake(contact.body_b, contact.body_a)) {
      continue;
    }
    const double reach = contact.gap + settings_.step * gap_velocity(velocities_, free_, contact);
    if (reach <= kToleratedOverlap || bodies_[contact.body_a].kind == BodyKind::kKinematic ||
        bodies_[contact.body_b].kind == BodyKind::kKinematic) {
      pairs_.emplace_back(contact.body_a, contact.body_b);
    }
  }
  return sleepers_.wake_touched(bodies_, state, pairs_);
}

void TimeStepper::settle(State& state, StepReport& report) {
  if (!sleepers_.is_on()) {
    return;
  }
  pairs_.clear();
  add_body_pairs(report.contacts, pairs_);
  for (const Joint& joint : joints_) {
    if (!is_asleep(joint)) {
      pairs_.emplace_back(joint.body_a, joint.body_b);
    }
  }
  report.energy_asleep = sleepers_.settle(bodies_, pairs_, settings_.step, state);
  report.bodies_asleep = sleepers_.count();
}

/// Fills selection_ and awake_joint_rows_ for who is awake.
void TimeStepper::choose_contacts(const State& state) {
  awake_joint_rows_ = joint_rows_;
  std::erase_if(awake_joint_rows_,
                [&](const JointRow& row) { return is_asleep(joints_[row.joint]); });
  velocities_of(bodies_, state, velocities_);
  gap_velocities(velocities_, state, found_, d_dot_);
  velocities_of(bodies_, free_, velocities_);
  gap_velocities(velocities_, free_, found_, d_dot_free_);
  selection_.choose(found_, d_dot_, d_dot_free_, settings_, bodies_, sleepers_);
}

/// Solves for the selected contacts until what was left out keeps apart, and moves the bodies.
/// @return false, with nothing moved, if bodies woke: the selection is then another
bool TimeStepper::solve_selection(const Bodies& solved, const State& state, StepReport& report) {
  report.contacts_left_out = selection_.about_to_bounce();
  for (;;) {
    report.detail.clear();
    append_count(report.stiffened_bodies, " links under a heavy load stiffened", report.detail);
    append_count(report.contacts_left_out, " contacts about to bounce left out", report.detail);
    selection_.fill(found_, report.contacts, allowance_);
    next_joint_memory_ = joint_memory_;
    solve_islands(islands_.find(solved, free_, report.contacts, allowance_, awake_joint_rows_,
                                settings_.full_model),
                  state, report);
    next_ = free_;
    apply(solved, next_, report);
    if (selection_.apart() == 0) {
      break;
    }
    velocities_of(bodies_, next_, velocities_);
    selection_.put_back(found_, velocities_, next_, sleepers_, pairs_);
    if (pairs_.empty()) {
      break;
    }
    report.contacts_put_back += static_cast<int>(pairs_.size());
    int woken = 0;
    for (const auto& [a, b] : pairs_) {
      woken += sleepers_.wake(a) + sleepers_.wake(b);
    }
    report.bodies_woken += woken;
    if (woken > 0) {
      return false;
    }
  }
  report.contacts_apart = selection_.apart();
  report.contacts_asleep = selection_.asleep();
  Stopwatch watch;
  move(state, next_);
  report.seconds.move = watch.lap();
  return true;
}

void TimeStepper::step(State& state, StepReport& report) {
  validate(bodies_, state);
  start_report(report);
  report.accuracy = accuracy_name_;
  report.is_deterministic = settings_.budget.seconds == StepBudget::kNone &&
                            settings_.lcp.time_limit == std::numeric_limits<double>::infinity();
  Stopwatch watch;
  find(state);
  check_dynamic(bodies_, found_);
  report.deepest_overlap = deepest_overlap(found_);
  report.seconds.find = watch.lap();

  joint_rows(joints_, state, settings_.step, joint_rows_);
  apply_forces(state, free_);
  report.bodies_woken = sleepers_.notice(bodies_, state);
  while (sleepers_.count() > 0 || report.bodies_woken > 0) {
    apply_forces(state, free_);  // of those that woke too
    const int woken = wake_touched(state);
    report.bodies_woken += woken;
    if (woken == 0) {
      break;
    }
  }
  const Bodies* solved = nullptr;
  for (bool done = false; !done;) {
    solved = &solved_bodies(state, report);
    choose_contacts(state);
    done = solve_selection(*solved, state, report);
    if (!done) {  // some woke
      apply_forces(state, free_);
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

  project(*solved, next_, report);
  measure_joints(joints_, next_, report.joints);
  settle(next_, report);
  report.kinetic_energy = kinetic_energy(bodies_, next_);
  report.potential_energy = potential_energy(bodies_, next_, settings_.gravity);
  std::swap(state, next_);
  report.seconds.project = watch.lap();
}

}  // namespace signorini
