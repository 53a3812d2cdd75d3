#pragma once

#include <signorini/lcp/problem.h>

#include "bench/contact_families.h"

namespace signorini::bench {

/// The contacts of a family with Coulomb friction mu > 0 at all of them, as the friction pyramid's
/// LCP of core/response/friction_pyramid.h: n = contacts (2 + sides), nonsymmetric.
/// @throws std::invalid_argument for an odd number of sides, sides < 4, or mu <= 0.
[[nodiscard]] lcp::Problem make_pyramid_lcp(const FamilyScene& scene, double mu, int sides = 4);

/// The same contacts with box friction coupled to the normal impulse: n = 3 contacts, the normals
/// first, then two tangents a contact with |f_t| <= mu f_n each. M stays factored and symmetric.
/// @throws std::invalid_argument for mu <= 0.
[[nodiscard]] lcp::Problem make_coupled_box(const FamilyScene& scene, double mu);

/// The same contacts with Coulomb's cones in De Saxce's form: rows 3 c (normal), 3 c + 1 and
/// 3 c + 2 (tangents) for contact c. @throws std::invalid_argument for mu <= 0.
[[nodiscard]] lcp::Problem make_cones(const FamilyScene& scene, double mu);

}  // namespace signorini::bench
