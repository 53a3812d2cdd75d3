#include <signorini/validation/impact_cases.h>
#include <signorini/validation/scene_contacts.h>

#include <fmt/format.h>

namespace signorini::validation {
namespace {

constexpr double kTouching = 1e-9;

}  // namespace

ContactSet touching_contacts(const Scene& scene) {
  SceneContacts finder(scene);
  ContactSet contacts;
  finder.find(scene.state, kTouching, contacts);
  return contacts;
}

ContactSet with_restitution(ContactSet contacts, double e) {
  for (Contact& contact : contacts) contact.material.restitution = e;
  return contacts;
}

Vec3 ImpactOutcome::linear(const Scene& scene, int body) const {
  return velocity(scene.bodies[body], state[body]).linear;
}

Vec3 ImpactOutcome::angular(const Scene& scene, int body) const {
  return velocity(scene.bodies[body], state[body]).angular;
}

double ImpactOutcome::energy_gain() const {
  return (report.energy_after - report.energy_before) / report.energy_before;
}

ImpactOutcome impact(const Scene& scene, const ContactSet& contacts,
                     const ImpactSettings& settings) {
  ImpactOutcome outcome;
  outcome.state = scene.state;
  resolve_impact(scene.bodies, contacts, settings, outcome.state, outcome.report);
  return outcome;
}

std::string describe_status(const ImpactReport& report) {
  const std::string_view status = lcp::to_string(report.status);
  const std::string_view law = lcp::to_string(report.law_status);
  if (status == law || report.law_status == lcp::Status::kNotRun) return std::string(status);
  return fmt::format("plastic: {}; law: {}", status, law);
}

}  // namespace signorini::validation
