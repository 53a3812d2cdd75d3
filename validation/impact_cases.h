#pragma once

#include <signorini/core/response/impact.h>
#include <signorini/validation/scene.h>

#include <string>

namespace signorini::validation {

/// The contacts of the scene's start that touch: gap at most 1e-9 m.
[[nodiscard]] ContactSet touching_contacts(const Scene& scene);
/// The same contacts with another restitution.
[[nodiscard]] ContactSet with_restitution(ContactSet contacts, double e);

/// What an impact law made of a scene's start.
struct ImpactOutcome {
  State state;
  ImpactReport report;

  /// v of the centre of mass of a body, m/s.
  [[nodiscard]] Vec3 linear(const Scene& scene, int body) const;
  /// w of a body, rad/s.
  [[nodiscard]] Vec3 angular(const Scene& scene, int body) const;
  /// (T+ - T-) / T-.
  [[nodiscard]] double energy_gain() const;
};
[[nodiscard]] ImpactOutcome impact(const Scene& scene, const ContactSet& contacts,
                                   const ImpactSettings& settings);

/// "solved", or "plastic solved; law infeasible" where they differ.
[[nodiscard]] std::string describe_status(const ImpactReport& report);

}  // namespace signorini::validation
