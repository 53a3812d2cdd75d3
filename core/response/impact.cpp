#include <signorini/core/model/number_text.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/friction_impact.h>
#include <signorini/core/response/impact.h>
#include <signorini/core/response/impact_energy.h>
#include <signorini/core/response/sequential_impulses.h>
#include <signorini/core/response/set_impact.h>
#include <signorini/core/response/tangent_rows.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace signorini {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("impact settings: " + what);
}

/// Keeps the worse of two results: not run, solved by growing residual, not solved (the first).
void keep_worst(lcp::Result&& candidate, lcp::Result& worst) {
  const auto rank = [](const lcp::Result& result) {
    if (result.status == lcp::Status::kNotRun) {
      return -1.0;
    }
    return lcp::is_solved(result.status) ? result.certificate.unit_free_residual
                                         : std::numeric_limits<double>::infinity();
  };
  if (rank(candidate) > rank(worst)) {
    worst = std::move(candidate);
  }
}

std::vector<std::vector<int>> members_of_sets(const std::vector<int>& set_of_contact) {
  std::vector<std::vector<int>> members;
  for (std::size_t i = 0; i < set_of_contact.size(); ++i) {
    if (set_of_contact[i] == static_cast<int>(members.size())) {
      members.emplace_back();
    }
    members[set_of_contact[i]].push_back(static_cast<int>(i));
  }
  return members;
}

void check_turning(const ContactSet& contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Material& material = contacts[i].material;
    if (material.resists_turning()) {
      throw std::invalid_argument("contact " + std::to_string(i) +
                                  ": rolling and spinning friction must be 0 in an impact with "
                                  "friction, got " +
                                  number_text(material.rolling_friction) + " and " +
                                  number_text(material.spinning_friction) + " m");
    }
  }
}

void note(int set, const std::string& text, std::string& detail) {
  if (!text.empty()) {
    detail += (detail.empty() ? "set " : "; set ") + std::to_string(set) + ": " + text;
  }
}

void resolve_simultaneously(const Bodies& bodies, const ContactSet& contacts,
                            const ImpactSettings& settings, lcp::Solver& solver,
                            const State& before, State& after, ImpactReport& report) {
  const auto members = members_of_sets(report.set_of_contact);
  report.theta.setConstant(members.size(), kNaN);
  report.status = report.law_status = lcp::Status::kSolved;
  for (std::size_t k = 0; k < members.size(); ++k) {
    ContactSet set;
    for (const int i : members[k]) {
      set.push_back(contacts[i]);
    }
    SetOutcome outcome =
        settings.friction ? resolve_set_with_friction(bodies, set, settings, solver, before, after)
                          : resolve_set(bodies, set, settings, solver, before, after);
    for (std::size_t j = 0; j < set.size(); ++j) {
      report.impulses[members[k][j]] = outcome.impulses[j];
      report.contact_impulses[members[k][j]] = outcome.contact_impulses[j];
    }
    report.passes = std::max(report.passes, outcome.reflections);
    report.theta[k] = outcome.theta;
    report.law_status_of_set.push_back(outcome.law.status);
    report.status = worse(report.status, outcome.status);
    report.law_status = worse(report.law_status, outcome.law.status);
    note(static_cast<int>(k), outcome.detail, report.detail);
    keep_worst(std::move(outcome.law), report.law_result);
    keep_worst(std::move(outcome.plastic), report.plastic_result);
  }
}

void resolve_sequentially(const Bodies& bodies, const ContactSet& contacts,
                          const ImpactSettings& settings, State& after, ImpactReport& report) {
  SequentialOutcome outcome = sequential_impulses(bodies, contacts, settings, after);
  report.status = report.law_status = outcome.status;
  report.impulses = std::move(outcome.impulses);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    report.contact_impulses[i] = report.impulses[static_cast<lcp::Index>(i)] * contacts[i].normal;
  }
  report.passes = outcome.passes;
  const auto sets = std::max_element(report.set_of_contact.begin(), report.set_of_contact.end());
  report.theta.setOnes(sets == report.set_of_contact.end() ? 0 : *sets + 1);
}

/// The driver's work and the gain by the impulses of a solved impact.
void account(const Bodies& bodies, const ContactSet& contacts, const ImpactSettings& settings,
             const State& before, const State& after, ImpactReport& report) {
  if (!settings.friction) {
    report.driver_work = driver_work(bodies, before, contacts, report.impulses);
    const lcp::Vector d_dot_after = gap_velocities(bodies, after, contacts);
    report.gain_from_impulses =
        impulse_energy(report.impulses, report.d_dot_before, d_dot_after).gain;
    return;
  }
  report.driver_work = driver_work(bodies, before, contacts, report.contact_impulses);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3 sum =
        slip_velocity(bodies, before, contacts[i]) + slip_velocity(bodies, after, contacts[i]);
    report.gain_from_impulses += 0.5 * report.contact_impulses[i].dot(sum);
  }
}

bool is_sequential(ImpactLaw law) {
  return law == ImpactLaw::kSequentialOnce || law == ImpactLaw::kSequentialRepeated;
}

void validate_order(const std::vector<int>& order, int contact_count) {
  if (static_cast<int>(order.size()) != contact_count) {
    refuse("order: must be empty or have one entry a contact (" + std::to_string(contact_count) +
           "), got " + std::to_string(order.size()));
  }
  std::vector<bool> seen(contact_count, false);
  for (const int i : order) {
    if (i < 0 || i >= contact_count || seen[i]) {
      refuse("order: must hold each of 0 .. " + std::to_string(contact_count - 1) + " once, got " +
             std::to_string(i) + (i < 0 || i >= contact_count ? "" : " a second time"));
    }
    seen[i] = true;
  }
}

}  // namespace

std::string_view to_string(ImpactLaw law) {
  switch (law) {
    case ImpactLaw::kSequentialOnce: return "sequential, once";
    case ImpactLaw::kSequentialRepeated: return "sequential, repeated";
    case ImpactLaw::kNewton: return "Newton";
    case ImpactLaw::kNotes: return "notes";
    case ImpactLaw::kPoisson: return "Poisson";
    case ImpactLaw::kReflections: return "reflections";
  }
  return "unknown law";
}

void ImpactSettings::validate(int contact_count) const {
  if (law > ImpactLaw::kReflections) {
    refuse("law: not one of the six laws, got " + std::to_string(static_cast<int>(law)));
  }
  if (friction && law != ImpactLaw::kNewton && law != ImpactLaw::kReflections) {
    refuse("friction: must be off but for the laws Newton and reflections, got it with " +
           std::string(to_string(law)));
  }
  if (!(colliding_threshold >= 0.0) || !std::isfinite(colliding_threshold)) {
    refuse("colliding_threshold: must be finite and >= 0 m/s, got " +
           number_text(colliding_threshold));
  }
  if (max_passes < 1) {
    refuse("max_passes: must be >= 1, got " + std::to_string(max_passes));
  }
  if (!order.empty()) {
    validate_order(order, contact_count);
  }
  lcp.validate();
}

double ImpactReport::relative_energy_gain() const {
  return signorini::relative_energy_gain(energy_gain(), energy_before, driver_work);
}

void resolve_impact(const Bodies& bodies, const ContactSet& contacts,
                    const ImpactSettings& settings, State& state, ImpactReport& report) {
  for (const Body& body : bodies) {
    validate(body);
  }
  validate(bodies, state);
  validate(contacts, static_cast<int>(bodies.size()));
  settings.validate(static_cast<int>(contacts.size()));
  check_dynamic(bodies, contacts);
  if (settings.friction) {
    check_turning(contacts);
  }
  const std::unique_ptr<lcp::Solver> solver = lcp::make_solver(
      settings.friction ? settings.friction_solver : settings.solver, settings.lcp);

  ImpactReport fresh;
  fresh.set_of_contact = connected_sets(bodies, contacts);
  fresh.impulses.setZero(contacts.size());
  fresh.contact_impulses.assign(contacts.size(), Vec3::Zero());
  fresh.d_dot_before = gap_velocities(bodies, state, contacts);
  fresh.energy_before = kinetic_energy(bodies, state);
  State after = state;
  if (is_sequential(settings.law)) {
    resolve_sequentially(bodies, contacts, settings, after, fresh);
  } else {
    resolve_simultaneously(bodies, contacts, settings, *solver, state, after, fresh);
  }
  if (lcp::is_solved(fresh.status)) {
    account(bodies, contacts, settings, state, after, fresh);
    state = std::move(after);
  }
  fresh.d_dot_after = gap_velocities(bodies, state, contacts);
  fresh.energy_after = kinetic_energy(bodies, state);
  report = std::move(fresh);
}

}  // namespace signorini
