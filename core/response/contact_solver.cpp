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

/// An island's impulses into the solution. @return whether they are finite
bool collect(const VelocityProblem& velocity, const ContactSet& contacts,
             const std::vector<int>& members, const lcp::Result& result,
             ContactSolution& solution) {
  const bool usable = result.z.allFinite();
  if (!lcp::is_solved(result.status)) {
    solution.detail += (solution.detail.empty() ? "island " : "; island ") +
                       std::to_string(solution.islands.size() - 1) + ": " +
                       std::string(lcp::to_string(result.status)) +
                       (usable ? ", best iterate applied" : ", no impulses applied");
  }
  solution.status = worse(solution.status, result.status);
  if (usable) {
    const lcp::Vector normals = velocity.normal_impulses(result.z);
    const std::vector<Vec3> impulses = velocity.impulses(contacts, result.z);
    const std::vector<Vec3> moments = velocity.moments(result.z);
    for (std::size_t j = 0; j < members.size(); ++j) {
      solution.normal_impulses[members[j]] = normals[static_cast<lcp::Index>(j)];
      solution.impulses[members[j]] = impulses[j];
      solution.moments[members[j]] = moments[j];
    }
  }
  return usable;
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
    : settings_(settings), solver_(island_settings(settings)) {
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

  ContactSolution fresh;
  fresh.status = lcp::Status::kSolved;
  fresh.normal_impulses = lcp::Vector::Zero(allowance.size());
  fresh.impulses.assign(contacts.size(), Vec3::Zero());
  fresh.moments.assign(contacts.size(), Vec3::Zero());
  fresh.island_of.assign(contacts.size(), -1);
  fresh.accuracy = settings_.accuracy ? settings_.accuracy->name() : "";
  fresh.is_deterministic =
      !std::isfinite(settings_.budget.seconds) && !std::isfinite(settings_.lcp.time_limit);
  const FrictionModel model = settings_.accuracy ? FrictionModel::kCone : settings_.friction_model;
  next_memory_.forget();
  VelocityProblem velocity;
  for (const ContactIsland& island : contact_islands(bodies, state, contacts, allowance)) {
    velocity.assemble(model, island.bodies, island.state, island.contacts, island.allowance,
                      settings_.pyramid_sides);
    ContactSet members;  // with the body numbers of the scene, which memory knows
    members.reserve(island.members.size());
    for (const int i : island.members) {
      members.push_back(contacts[i]);
      fresh.island_of[i] = static_cast<int>(fresh.islands.size());
    }
    lcp::Result result;
    const double part = static_cast<double>(members.size()) / static_cast<double>(contacts.size());
    double work = 0.0;
    solver_.solve(velocity, members, {}, {memory_, {}}, settings_.budget.share(part), result, work);
    fresh.islands.push_back(describe(island, velocity.problem(), result, model));
    fresh.islands.back().work = work;
    fresh.work += work;
    if (collect(velocity, members, island.members, result, fresh)) {
      velocity.remember(members, result.z, next_memory_);
    }
    keep_worse(std::move(result), fresh.result);
  }
  next_memory_.sort();
  std::swap(memory_, next_memory_);

  const double before = kinetic_energy(bodies, state);
  apply_contact_impulses(bodies, contacts, fresh.impulses, state);
  apply_contact_moments(bodies, contacts, fresh.moments, state);
  fresh.energy_change = kinetic_energy(bodies, state) - before;
  solution = std::move(fresh);
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
