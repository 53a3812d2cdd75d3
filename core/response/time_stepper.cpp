#include <signorini/core/model/contact_kinematics.h>
#include <signorini/core/model/number_text.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/position_projection.h>
#include <signorini/core/response/time_stepper.h>
#include <signorini/lcp/certificate.h>

#include <algorithm>
#include <cmath>
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

// The contacts of a step's problem and how fast each may close.
struct Selection {
  ContactSet contacts;
  lcp::Vector allowance;  // m/s
  int left_out = 0;
};

Selection select(const ContactSet& found, const lcp::Vector& d_dot, const lcp::Vector& d_dot_free,
                 const TimeStepSettings& settings) {
  const double h = settings.step;
  Selection selection;
  std::vector<double> allowance;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Contact& contact = found[i];
    const double e = contact.material.restitution;
    const bool touching = contact.gap <= settings.touching_tolerance;
    const double one_step = std::abs(d_dot_free[i] - d_dot[i]);
    const bool fast = d_dot[i] < -std::max(settings.restitution_threshold, one_step);
    const bool would_be_caught = contact.gap + h * d_dot_free[i] < 0.0;
    if (e > 0.0 && !touching && fast && would_be_caught) {
      ++selection.left_out;
      continue;
    }
    const bool bounces =
        touching && classify(d_dot[i], settings.restitution_threshold) == ContactClass::kColliding;
    selection.contacts.push_back(contact);
    allowance.push_back(bounces ? e * d_dot[i] : std::max(contact.gap, 0.0) / h);
  }
  selection.allowance =
      Eigen::Map<const lcp::Vector>(allowance.data(), static_cast<lcp::Index>(allowance.size()));
  return selection;
}

// One row without bounds: 0 <= f ⊥ A f + q >= 0.
lcp::Vector closed_form(const lcp::Problem& problem) {
  lcp::Vector A;
  lcp::diagonal(problem.M, A);
  return (-problem.q.array() / A.array()).max(0.0);
}

}  // namespace

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
  lcp.validate();
}

TimeStepper::TimeStepper(Bodies bodies, ContactFinder& finder, const TimeStepSettings& settings)
    : bodies_(std::move(bodies)), finder_(finder), settings_(settings) {
  settings_.validate();
  for (const Body& body : bodies_) {
    validate(body);
  }
  solver_ = lcp::make_solver(settings_.solver, settings_.lcp);
  cone_solver_ = lcp::make_solver(settings_.cone_solver, settings_.lcp);
}

State TimeStepper::with_forces_applied(const State& start) const {
  State state = start;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (bodies_[k].is_dynamic()) {
      state[k].p += settings_.step * bodies_[k].mass * bodies_[k].gravity_scale * settings_.gravity;
    }
  }
  return state;
}

void TimeStepper::find(const State& state, ContactSet& contacts) {
  contacts.clear();
  finder_.find(state, settings_.margin, contacts);
  validate(contacts, static_cast<int>(bodies_.size()));
}

void TimeStepper::solve(const VelocityProblem& velocity, const ContactSet& contacts,
                        lcp::Result& result) {
  const lcp::Problem& problem = velocity.problem();
  if (problem.size() != 1) {
    const bool warm = settings_.warm_start && velocity.recall(contacts, memory_, start_) > 0;
    lcp::Solver& solver = problem.cones.empty() ? *solver_ : *cone_solver_;
    solver.solve(problem, result, warm ? &start_ : nullptr);
    return;
  }
  result = {};
  result.solver = "closed form";
  result.z = closed_form(problem);
  result.certificate = lcp::certify(problem, result.z, &result.w);
  result.status =
      lcp::judge(result.certificate, settings_.lcp.tolerance, lcp::Status::kNumericalBreakdown);
}

// `state` has the momenta after the impulses and the positions of the start.
void TimeStepper::move(const State& start, const ContactSet& contacts, State& state) const {
  std::vector<bool> in_contact(bodies_.size(), false);
  for (const Contact& contact : contacts) {
    in_contact[contact.body_a] = true;
    in_contact[contact.body_b] = true;
  }
  const Integrator in_rows = settings_.integrator == Integrator::kEnergyMomentum
                                 ? Integrator::kEnergyMomentum
                                 : Integrator::kSemiImplicit;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
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

void TimeStepper::project(State& state, StepReport& report) {
  ContactSet contacts;
  find(state, contacts);
  const lcp::Vector d_dot = gap_velocities(bodies_, state, contacts);
  const double bounce_speed = std::max(kRestingSpeed, settings_.restitution_threshold);
  ContactSet chosen;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const bool leaves = d_dot[i] > kRestingSpeed;
    const bool will_bounce = contacts[i].material.restitution > 0.0 && d_dot[i] < -bounce_speed;
    if (contacts[i].gap >= 0.0 || !(leaves || will_bounce)) {
      chosen.push_back(contacts[i]);
    }
  }
  ProjectionReport projection;
  project_positions(bodies_, chosen, settings_.gravity, *solver_, state, projection);
  report.projection_status = projection.status;
  report.energy_change_projection = projection.energy_change;
  append(projection.detail, report.detail);
}

// The solution, or the best iterate, as impulses on `state`, which has the free momenta.
void TimeStepper::apply(const VelocityProblem& velocity, State& state, StepReport& report) const {
  const auto count = static_cast<lcp::Index>(report.contacts.size());
  const bool usable = report.result.z.allFinite();
  if (!lcp::is_solved(report.status)) {
    append("velocity problem: " + std::string(lcp::to_string(report.status)) +
               (usable ? ", best iterate applied" : ", no impulses applied"),
           report.detail);
  }
  report.normal_impulses = lcp::Vector::Zero(count);
  report.impulses.assign(report.contacts.size(), Vec3::Zero());
  if (usable) {
    const double before = kinetic_energy(bodies_, state);
    report.normal_impulses = velocity.normal_impulses(report.result.z);
    report.impulses = velocity.impulses(report.contacts, report.result.z);
    apply_contact_impulses(bodies_, report.contacts, report.impulses, state);
    report.energy_change_impact = kinetic_energy(bodies_, state) - before;
  }
}

void TimeStepper::step(State& state, StepReport& report) {
  validate(bodies_, state);
  report = {};
  ContactSet found;
  find(state, found);
  report.deepest_overlap = deepest_overlap(found);

  State next = with_forces_applied(state);
  Selection selection = select(found, gap_velocities(bodies_, state, found),
                               gap_velocities(bodies_, next, found), settings_);
  report.contacts = std::move(selection.contacts);
  report.contacts_left_out = selection.left_out;
  if (selection.left_out > 0) {
    append(std::to_string(selection.left_out) + " contacts about to bounce left out",
           report.detail);
  }

  VelocityProblem velocity;
  velocity.assemble(settings_.friction_model, bodies_, next, report.contacts, selection.allowance,
                    settings_.pyramid_sides);
  solve(velocity, report.contacts, report.result);
  if (report.result.z.allFinite()) {
    velocity.remember(report.contacts, report.result.z, memory_);
  } else {
    memory_.forget();
  }
  report.status = report.result.status;
  apply(velocity, next, report);
  move(state, report.contacts, next);
  project(next, report);
  report.kinetic_energy = kinetic_energy(bodies_, next);
  report.potential_energy = potential_energy(bodies_, next, settings_.gravity);
  state = std::move(next);
}

}  // namespace signorini
