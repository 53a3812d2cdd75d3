#pragma once

#include <signorini/lcp/problem.h>

#include <cstdint>
#include <span>
#include <string_view>

namespace signorini::bench {

/// The standard families of frictionless contact problems, A = J M^-1 J^T, q = J v*. Boxes are unit
/// cubes (inertia m/6), spheres have diameter 1 (inertia m/10); z up; the ground is immovable. Free
/// velocity v*: 9.81 * 0.01 m/s downwards + N(0, 0.1) on every degree of freedom; every seventh
/// body also falls at 1 m/s. A is positive semidefinite, mostly singular; every problem is
/// solvable.
struct FamilySpec {
  std::string_view family;  ///< one of family_names()
  int size = 1;             ///< tower4, tower8: boxes; pyramid2d, wall: rows; pyramid3d: layers;
                            ///< spheres: contacts
  double mass_ratio =
      1.0;  ///< R >= 1: towers alternate 1, R from the bottom; others draw R^u, u in [0, 1]
  std::uint64_t seed = 1;
  bool at_rest = false;  ///< v* is gravity alone
};

/// tower4 tower8 (4 or 8 contacts a face), pyramid2d (n = 4 size^2), wall (side faces touch),
/// pyramid3d, spheres.
[[nodiscard]] std::span<const std::string_view> family_names();

/// @throws std::invalid_argument naming family, size or mass_ratio and the bound.
[[nodiscard]] lcp::Problem make_family(const FamilySpec& spec);

}  // namespace signorini::bench
