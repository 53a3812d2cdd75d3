#include <signorini/core/response/assembly.h>
#include <signorini/core/response/single_impulse.h>

#include "response_scenes.h"

#include <gtest/gtest.h>
#include <stdexcept>

namespace signorini {
namespace {

using scenes::Scene;

/// 200 random contacts of bodies in any pose and motion, those that approach.
template <typename Check>
void for_random_approaching_contacts(std::uint64_t seed, Check check) {
  std::mt19937_64 random(seed);
  int approaching = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Scene scene = scenes::random_scene(random, 2, 1);
    if (gap_velocity(scene.bodies, scene.state, scene.contacts[0]) < 0.0) {
      SCOPED_TRACE("trial " + std::to_string(trial));
      check(scene);
      ++approaching;
    }
  }
  EXPECT_GT(approaching, 50);
}

TEST(SingleImpulse, DenominatorIsTheDiagonalOfA) {
  for_random_approaching_contacts(1, [](const Scene& scene) {
    NormalRows rows;
    assemble_normals(scene.bodies, scene.state, scene.contacts, rows);
    lcp::Vector diagonal;
    rows.A.diagonal(diagonal);
    const SingleImpulse single = single_impulse(scene.bodies, scene.state, scene.contacts[0]);
    EXPECT_NEAR(single.denominator, diagonal[0], 1e-13 * diagonal[0]);
    EXPECT_EQ(single.d_dot, rows.d_dot[0]);
  });
}

TEST(SingleImpulse, RestitutionReversesTheApproach) {
  for_random_approaching_contacts(2, [](const Scene& scene) {
    for (const double e : {0.0, 0.3, 1.0}) {
      const Contact& contact = scene.contacts[0];
      const SingleImpulse single = single_impulse(scene.bodies, scene.state, contact);
      State after = scene.state;
      apply_impulse(scene.bodies, contact, single.with_restitution(e), after);
      // rounding of u = v + w x r, in which the parts may be larger than d'
      EXPECT_NEAR(gap_velocity(scene.bodies, after, contact), -e * single.d_dot, 1e-13 * 20);
    }
  });
}

TEST(SingleImpulse, FMinLosesAllThatCanBeLostAndFMaxLosesNothing) {
  for_random_approaching_contacts(3, [](const Scene& scene) {
    const Contact& contact = scene.contacts[0];
    if (scene.bodies[contact.body_a].kind == BodyKind::kKinematic ||
        scene.bodies[contact.body_b].kind == BodyKind::kKinematic) {
      return;  // its work is in the balance: see impact_test
    }
    const SingleImpulse single = single_impulse(scene.bodies, scene.state, contact);
    const double before = kinetic_energy(scene.bodies, scene.state);
    const auto gain = [&](double f) {
      State after = scene.state;
      apply_impulse(scene.bodies, contact, f, after);
      return kinetic_energy(scene.bodies, after) - before;
    };
    EXPECT_EQ(single.f_max, 2.0 * single.f_min);
    EXPECT_NEAR(gain(single.f_max), 0.0, 1e-13 * before);
    EXPECT_NEAR(gain(single.f_min), 0.5 * single.f_min * single.d_dot, 1e-13 * before);
    EXPECT_LT(gain(single.f_min), gain(0.99 * single.f_min));
    EXPECT_LT(gain(single.f_min), gain(1.01 * single.f_min));
    EXPECT_GT(gain(1.01 * single.f_max), 0.0);
  });
}

TEST(SingleImpulse, TheNotesWedgeOneImpulseAlone) {
  const double s = 3.0;
  for (const auto& [i, expected] :
       {std::pair<int, Vec3>{0, Vec3(s, 0, 0)}, {1, Vec3(-0.8 * s, -0.6 * s, 0)}}) {
    Scene scene = scenes::wedge(s, 1.0);
    const Contact& contact = scene.contacts[i];
    const SingleImpulse single = single_impulse(scene.bodies, scene.state, contact);
    apply_impulse(scene.bodies, contact, single.with_restitution(1.0), scene.state);
    EXPECT_LE((scene.velocity_of(0).linear - expected).norm(), 1e-12);
  }
}

TEST(SingleImpulse, BallOnFloorInNumbers) {
  Scene scene;
  scene.add(scenes::ball(2.0), Vec3(0, 0, 0.5), {Vec3(1, 0, -3), Vec3::Zero()});
  scene.add(scenes::fixed_body(), Vec3::Zero());
  const Contact& contact = scene.touch(0, 1, Vec3::Zero(), Vec3::UnitZ(), 0.5);
  const SingleImpulse single = single_impulse(scene.bodies, scene.state, contact);
  EXPECT_DOUBLE_EQ(single.denominator, 0.5);
  EXPECT_DOUBLE_EQ(single.d_dot, -3.0);
  EXPECT_DOUBLE_EQ(single.f_min, 6.0);
  EXPECT_DOUBLE_EQ(single.f_max, 12.0);
}

TEST(SingleImpulse, WhatDoesNotApproachGetsNone) {
  for (const double speed : {0.0, 2.0}) {
    Scene scene;
    scene.add(scenes::ball(), Vec3(0, 0, 0.5), {Vec3(0, 0, speed), Vec3::Zero()});
    scene.add(scenes::fixed_body(), Vec3::Zero());
    const Contact& contact = scene.touch(0, 1, Vec3::Zero(), Vec3::UnitZ(), 1.0);
    const SingleImpulse single = single_impulse(scene.bodies, scene.state, contact);
    EXPECT_EQ(single.f_min, 0.0);
    EXPECT_EQ(single.f_max, 0.0);
    EXPECT_EQ(single.d_dot, speed);
  }
}

TEST(SingleImpulse, TwoBodiesThatCannotMoveAreRefused) {
  Scene scene;
  scene.add(scenes::fixed_body(), Vec3::Zero());
  scene.add(scenes::kinematic_body(), Vec3::Zero());
  const Contact& contact = scene.touch(0, 1, Vec3::Zero(), Vec3::UnitZ(), 1.0);
  EXPECT_THROW(static_cast<void>(single_impulse(scene.bodies, scene.state, contact)),
               std::invalid_argument);
}

}  // namespace
}  // namespace signorini
