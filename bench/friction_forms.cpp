#include "bench/friction_forms.h"

#include <signorini/core/response/friction_pyramid.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace signorini::bench {
namespace {

void check_friction(double mu) {
  if (!(mu > 0.0) || mu == std::numeric_limits<double>::infinity()) {
    throw std::invalid_argument("mu: must be finite and > 0, got " + std::to_string(mu));
  }
}

/// Slip of the body above against the one below at a touch, free velocities.
Vec3 free_slip(const FamilyScene& scene, const FamilyScene::Touch& touch) {
  const auto at = [&](int body) -> Vec3 {
    if (body == FamilyScene::kGround) {
      return Vec3::Zero();
    }
    const Vec3 linear = scene.free_velocity.segment<3>(6 * body);
    const Vec3 angular = scene.free_velocity.segment<3>(6 * body + 3);
    return linear + angular.cross(touch.point - scene.centres[body]);
  };
  return at(touch.above) - at(touch.below);
}

/// The scene's bodies in core's types; the ground comes last.
struct CoreScene {
  Bodies bodies;
  State state;
  ContactSet contacts;
};

CoreScene to_core(const FamilyScene& scene, double mu) {
  CoreScene core;
  for (std::size_t i = 0; i < scene.centres.size(); ++i) {
    Body body;
    body.mass = scene.masses[i];
    body.inertia = scene.inertias[i] * Mat3::Identity();
    BodyState state;
    state.x = scene.centres[i];
    const auto velocity = scene.free_velocity.segment<6>(6 * static_cast<lcp::Index>(i));
    set_velocity(body, {.linear = velocity.head<3>(), .angular = velocity.tail<3>()}, state);
    core.bodies.push_back(body);
    core.state.push_back(state);
  }
  const int ground = static_cast<int>(core.bodies.size());
  core.bodies.emplace_back().kind = BodyKind::kFixed;
  core.state.emplace_back();
  for (const FamilyScene::Touch& touch : scene.touches) {
    Contact contact;
    contact.body_a = touch.above;
    contact.body_b = touch.below == FamilyScene::kGround ? ground : touch.below;
    contact.point_a = touch.point;
    contact.point_b = touch.point;
    contact.normal = touch.normal;
    contact.gap = 0.0;
    contact.material.friction = mu;
    core.contacts.push_back(contact);
  }
  return core;
}

}  // namespace

lcp::Problem make_pyramid_lcp(const FamilyScene& scene, double mu, int sides) {
  check_friction(mu);
  const CoreScene core = to_core(scene, mu);
  const auto contacts = static_cast<lcp::Index>(core.contacts.size());
  PyramidProblem pyramid;
  assemble_pyramid(core.bodies, core.state, core.contacts, lcp::Vector::Zero(contacts), sides,
                   pyramid);
  return std::move(pyramid.problem);
}

lcp::Problem make_coupled_box(const FamilyScene& scene, double mu) {
  check_friction(mu);
  lcp::FactoredMatrix A = scene.inverse_mass();
  for (const FamilyScene::Touch& touch : scene.touches) {
    scene.add_row(touch, touch.normal, A);
  }
  lcp::Problem problem;
  const int contacts = static_cast<int>(scene.touches.size());
  for (int i = 0; i < contacts; ++i) {
    const FamilyScene::Touch& touch = scene.touches[i];
    const TangentFrame frame = tangent_frame(touch.normal, free_slip(scene, touch));
    for (const Vec3& tangent : {frame.t1, frame.t2}) {
      problem.limits.push_back({.row = A.rows(), .normal_row = i, .coefficient = mu});
      scene.add_row(touch, tangent, A);
    }
  }
  problem.q = scene.free_row_velocities(A);
  problem.M = std::move(A);
  return problem;
}

lcp::Problem make_cones(const FamilyScene& scene, double mu) {
  check_friction(mu);
  lcp::FactoredMatrix A = scene.inverse_mass();
  lcp::Problem problem;
  for (const FamilyScene::Touch& touch : scene.touches) {
    problem.cones.push_back({.normal_row = A.rows(), .dimension = 3, .coefficient = mu});
    const TangentFrame frame = tangent_frame(touch.normal, free_slip(scene, touch));
    for (const Vec3& direction : {touch.normal, frame.t1, frame.t2}) {
      scene.add_row(touch, direction, A);
    }
  }
  problem.q = scene.free_row_velocities(A);
  problem.M = std::move(A);
  return problem;
}

}  // namespace signorini::bench
