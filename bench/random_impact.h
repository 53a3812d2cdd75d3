#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>

#include <cstdint>

namespace signorini::bench {

/// Bodies in motion and the contacts at which they touch.
struct RandomImpact {
  Bodies bodies;
  State state;
  ContactSet contacts;
};

/// What may vary from study to study.
struct RandomImpactOptions {
  double mass_ratio = 1e3;     ///< heaviest over lightest mass, >= 1
  double most_friction = 0.0;  ///< mu of a contact: 0 in a fifth of them, else 0 .. this; >= 0
};

/// Draws impact `index` of a seed; the same whatever else was drawn.
///
/// 2..20 bodies (log-uniform), the first one dynamic, of the others one in eight fixed and one in
/// sixteen kinematic. Masses mass_ratio^[-1/2, 1/2] kg; inertias from random second moments, so
/// that the triangle inequality holds, in random axes; one body in five at rest. Contacts come in
/// groups: one alone, one given two or three times, two or three with normals that differ by 1e-9
/// .. 1e-1, four corners of a face. The normal of a group is turned so that with probability 0.45
/// it separates. Restitution is 0, 1 or anything between, drawn for every contact.
[[nodiscard]] RandomImpact draw_random_impact(std::uint64_t seed, int index,
                                              const RandomImpactOptions& options = {});

}  // namespace signorini::bench
