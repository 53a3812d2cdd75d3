#include <signorini/core/model/number_text.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/contact_islands.h>
#include <signorini/core/response/contact_solver.h>
#include <signorini/core/response/position_projection.h>
#include <signorini/core/response/set_impact.h>
#include <signorini/core/response/tangent_rows.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace signorini {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("contact solver: " + what);
}

void check_allowance(const lcp::VectorRef& allowance, std::size_t contacts) {
  if (allowance.size() != static_cast<lcp::Index>(contacts)) {
    refuse("allowance: " + std::to_string(allowance.size()) + " numbers for " +
           std::to_string(contacts) + " contacts");
  }
  for (lcp::Index i = 0; i < allowance.size(); ++i) {
    if (!std::isfinite(allowance[i])) {
      refuse("allowance[" + std::to_string(i) + "]: must be finite, got " +
             number_text(allowance[i]) + " m/s");
    }
  }
}

/// One solver for whatever an island is.
IslandSettings island_settings(const ContactSolverSettings& settings) {
  return {.solver = settings.solver,
          .cone_solver = settings.solver,
          .joint_solver = settings.solver,
          .lcp = settings.lcp,
          .accuracy = settings.accuracy,
          .warm_start = settings.warm_start};
}

}  // namespace

void ContactSolverSettings::validate() const {
  if (pyramid_sides < 4 || pyramid_sides % 2 != 0) {
    refuse("pyramid_sides: must be even and >= 4, got " + std::to_string(pyramid_sides));
  }
  if (friction_model > FrictionModel::kBox) {
    refuse("friction_model: must be one of the three models, got " +
           std::to_string(static_cast<int>(friction_model)));
  }
  if (!accuracy && budget.is_limited()) {
    refuse("budget: must be unlimited without accuracy, got " + number_text(budget.work) +
           " units, " + number_text(budget.seconds) + " s");
  }
  budget.validate();
  lcp.validate();
  (void)lcp::make_solver(solver, lcp);  // a name that is not known is said now
}

ContactSolver::ContactSolver(const ContactSolverSettings& settings)
    : settings_(settings),
      accuracy_name_(settings.accuracy ? settings.accuracy->name() : ""),
      solver_(island_settings(settings)) {
  settings_.validate();
}

void ContactSolver::solve(const Bodies& bodies, const ContactSet& contacts,
                          const lcp::VectorRef& allowance, State& state,
                          ContactSolution& solution) {
  for (const Body& body : bodies) {
    validate(body);
  }
  validate(bodies, state);
  validate(contacts, static_cast<int>(bodies.size()));
  check_allowance(allowance, contacts.size());
  check_dynamic(bodies, contacts);
  start(contacts.size());
  const auto islands = islands_.find(
      bodies, state, contacts, {allowance.data(), static_cast<std::size_t>(allowance.size())});
  if (answers_.size() < islands.size()) {
    answers_.resize(islands.size());
  }
  fresh_.islands.resize(islands.size());
  std::size_t worst = 0;
  double seconds = 0.0;
  for (std::size_t k = 0; k < islands.size(); ++k) {
    IslandAnswer& answer = answers_[k];
    answer.velocity.assemble(friction_model(), islands[k].bodies, islands[k].state,
                             islands[k].contacts, islands[k].allowance, settings_.pyramid_sides);
    answer.contacts.clear();
    for (const int i : islands[k].members) {
      answer.contacts.push_back(contacts[i]);
      fresh_.island_of[i] = static_cast<int>(k);
    }
    const double part =
        static_cast<double>(answer.contacts.size()) / static_cast<double>(contacts.size());
    solver_.solve({}, {memory_, {}}, settings_.budget.share(part), answer);
    collect(k, islands[k]);
    seconds += std::max(answer.result.statistics.solve_seconds, 0.0);
    worst = is_worse(answer.result, answers_[worst].result) ? k : worst;
  }
  if (!islands.empty()) {
    std::swap(fresh_.result, answers_[worst].result);
    fresh_.result.statistics.solve_seconds = seconds;
  }
  next_memory_.sort();
  std::swap(memory_, next_memory_);

  const double before = kinetic_energy(bodies, state);
  apply_contact_impulses(bodies, contacts, fresh_.impulses, state);
  apply_contact_moments(bodies, contacts, fresh_.moments, state);
  fresh_.energy_change = kinetic_energy(bodies, state) - before;
  std::swap(solution, fresh_);
}

FrictionModel ContactSolver::friction_model() const {
  return settings_.accuracy ? FrictionModel::kCone : settings_.friction_model;
}

/// Makes fresh_ the solution of so many contacts that are not solved yet.
void ContactSolver::start(std::size_t contacts) {
  fresh_.status = lcp::Status::kSolved;
  fresh_.normal_impulses.setZero(static_cast<lcp::Index>(contacts));
  fresh_.impulses.assign(contacts, Vec3::Zero());
  fresh_.moments.assign(contacts, Vec3::Zero());
  fresh_.island_of.assign(contacts, -1);
  lcp::start_result(contacts > 0 ? fresh_.result.z.size() : 0, fresh_.result);
  fresh_.accuracy = accuracy_name_;
  fresh_.work = 0.0;
  fresh_.is_deterministic =
      !std::isfinite(settings_.budget.seconds) && !std::isfinite(settings_.lcp.time_limit);
  fresh_.detail.clear();
  next_memory_.forget();
}

/// An island's solution into fresh_ and the next memory.
void ContactSolver::collect(std::size_t number, const ContactIsland& island) {
  const IslandAnswer& answer = answers_[number];
  const lcp::Result& result = answer.result;
  IslandReport& told = fresh_.islands[number];
  describe(island, answer.velocity, result, friction_model(), told);
  told.work = answer.work;
  fresh_.work += answer.work;
  const bool usable = result.z.allFinite();
  if (!lcp::is_solved(result.status)) {
    fresh_.detail += (fresh_.detail.empty() ? "island " : "; island ") + std::to_string(number) +
                     ": " + std::string(lcp::to_string(result.status)) +
                     (usable ? ", best iterate applied" : ", no impulses applied");
  }
  fresh_.status = worse(fresh_.status, result.status);
  if (usable) {
    answer.velocity.impulses(answer.contacts, result.z, impulses_);
    answer.velocity.moments(result.z, moments_);
    for (std::size_t j = 0; j < island.members.size(); ++j) {
      fresh_.normal_impulses[island.members[j]] = answer.velocity.normal_impulse(result.z, j);
      fresh_.impulses[island.members[j]] = impulses_[j];
      fresh_.moments[island.members[j]] = moments_[j];
    }
    answer.velocity.remember(answer.contacts, result.z, answer.corrected, next_memory_);
  }
}

lcp::Vector allowances(const Bodies& bodies, const State& state, const ContactSet& contacts,
                       double h, double touching_tolerance, double restitution_threshold) {
  const lcp::Vector d_dot = gap_velocities(bodies, state, contacts);
  lcp::Vector allowance(d_dot.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const double e = contacts[i].material.restitution;
    const bool bounces = contacts[i].gap <= touching_tolerance &&
                         d_dot[static_cast<lcp::Index>(i)] < -restitution_threshold;
    allowance[static_cast<lcp::Index>(i)] =
        bounces ? e * d_dot[static_cast<lcp::Index>(i)] : closable_gap(contacts[i].gap) / h;
  }
  return allowance;
}

}  // namespace signorini
