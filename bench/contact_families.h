#pragma once

#include <signorini/lcp/problem.h>

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

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

/// A family before it becomes rows: bodies of isotropic inertia, contacts, free velocities.
struct FamilyScene {
  static constexpr int kGround = -1;
  struct Touch {
    int below;  ///< a body or kGround
    int above;  ///< a body
    Eigen::Vector3d point;
    Eigen::Vector3d normal;  ///< unit, from `below` to `above`
  };
  std::vector<Eigen::Vector3d> centres;  ///< of mass, m
  std::vector<double> masses;            ///< kg
  std::vector<double> inertias;          ///< about any axis, kg m^2
  std::vector<Touch> touches;
  lcp::Vector free_velocity;  ///< v*: [linear, angular] of every body, m/s and rad/s

  /// The inverse mass, one block of six a body.
  [[nodiscard]] lcp::FactoredMatrix inverse_mass() const;
  /// Adds the row of `direction` at a touch: + on the body above, - on the one below.
  void add_row(const Touch& touch, const Eigen::Vector3d& direction, lcp::FactoredMatrix& A) const;
  /// J v*, one number a row of A.
  [[nodiscard]] lcp::Vector free_row_velocities(const lcp::FactoredMatrix& A) const;
};

/// @throws std::invalid_argument naming family, size or mass_ratio and the bound.
[[nodiscard]] FamilyScene make_family_scene(const FamilySpec& spec);

/// The normal rows of make_family_scene() as an LCP. @throws as it does.
[[nodiscard]] lcp::Problem make_family(const FamilySpec& spec);

}  // namespace signorini::bench
