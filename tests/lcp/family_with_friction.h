#pragma once

#include <signorini/lcp/problem.h>

#include "bench/contact_families.h"

#include <Eigen/Geometry>
#include <utility>

namespace signorini::lcp {

/// A family of contact problems with friction mu at every contact.
inline Problem family_with_friction(const bench::FamilySpec& spec, double mu,
                                    FrictionLaw law = FrictionLaw::kCoulomb) {
  const bench::FamilyScene scene = bench::make_family_scene(spec);
  FactoredMatrix A = scene.inverse_mass();
  Problem problem;
  for (const auto& touch : scene.touches) {
    problem.cones.push_back({A.rows(), 3, mu});
    const Eigen::Vector3d tangent = touch.normal.unitOrthogonal();
    scene.add_row(touch, touch.normal, A);
    scene.add_row(touch, tangent, A);
    scene.add_row(touch, touch.normal.cross(tangent), A);
  }
  problem.q = scene.free_row_velocities(A);
  problem.M = std::move(A);
  problem.friction_law = law;
  return problem;
}

}  // namespace signorini::lcp
