#include <signorini/c/signorini.h>

#include "c_testing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

namespace {

using signorini::testing_tools::expect_refused;
using signorini::testing_tools::kHuge;
using signorini::testing_tools::kInfinity;
using signorini::testing_tools::kNaN;

struct Destroy {
  void operator()(signorini_contact_solver* p) const { signorini_contact_solver_destroy(p); }
  void operator()(signorini_contact_result* p) const { signorini_contact_result_destroy(p); }
};
using ContactSolver = std::unique_ptr<signorini_contact_solver, Destroy>;
using ContactResult = std::unique_ptr<signorini_contact_result, Destroy>;

ContactSolver make_contact_solver() {
  signorini_contact_solver* made = nullptr;
  EXPECT_EQ(signorini_contact_solver_create(&made), SIGNORINI_OK);
  return ContactSolver(made);
}

ContactResult make_contact_result() {
  signorini_contact_result* made = nullptr;
  EXPECT_EQ(signorini_contact_result_create(&made), SIGNORINI_OK);
  return ContactResult(made);
}

/// A fixed floor and a ball on it that slides at 1 m/s and presses down at 0.1 m/s.
struct BallOnFloor {
  std::vector<signorini_body> bodies;
  std::vector<signorini_contact> contacts;
  ContactSolver solver = make_contact_solver();
  ContactResult result = make_contact_result();

  BallOnFloor() : bodies(2), contacts(1) {
    bodies[0].kind = SIGNORINI_FIXED;
    bodies[0].orientation[0] = 1.0;
    bodies[1].kind = SIGNORINI_DYNAMIC;
    bodies[1].mass = 2.0;
    bodies[1].inertia[0] = bodies[1].inertia[4] = bodies[1].inertia[8] = 0.2;
    bodies[1].position[2] = 0.5;
    bodies[1].orientation[0] = 1.0;
    bodies[1].linear_velocity[0] = 1.0;
    bodies[1].linear_velocity[2] = -0.1;
    contacts[0].body_a = 1;
    contacts[0].body_b = 0;
    contacts[0].normal[2] = 1.0;
    contacts[0].friction = 0.5;
    contacts[0].allowance = kNaN;
  }
  signorini_error solve(double step = 0.01) {
    return signorini_contact_solver_solve(
        solver.get(), step, static_cast<std::int64_t>(bodies.size()), bodies.data(),
        static_cast<std::int64_t>(contacts.size()), contacts.data(), result.get());
  }
};

TEST(CContacts, ASlidingBallIsBrakedByMuTimesItsNormalImpulse) {
  BallOnFloor scene;
  ASSERT_EQ(scene.solve(), SIGNORINI_OK) << signorini_last_error();
  const signorini_contact_result* result = scene.result.get();
  EXPECT_EQ(signorini_contact_result_status(result), SIGNORINI_SOLVED);
  EXPECT_STREQ(signorini_contact_result_detail(result), "");
  ASSERT_EQ(signorini_contact_result_body_count(result), 2);
  ASSERT_EQ(signorini_contact_result_contact_count(result), 1);
  EXPECT_NEAR(signorini_contact_result_normal_impulses(result)[0], 0.2, 1e-8);
  const double* impulse = signorini_contact_result_impulses(result);
  EXPECT_NEAR(impulse[0], -0.1, 1e-8);
  EXPECT_NEAR(impulse[2], 0.2, 1e-8);
  const double* v = signorini_contact_result_velocities(result) + 6;
  EXPECT_NEAR(v[0], 0.95, 1e-8);
  EXPECT_NEAR(v[2], 0.0, 1e-8);
  EXPECT_NEAR(v[4], 0.5 * 0.1 / 0.2, 1e-7);  // r x impulse / J
  EXPECT_NEAR(signorini_contact_result_energy_change(result),
              0.5 * 2.0 * (0.95 * 0.95 - 1.01) + 0.5 * 0.2 * 0.0625, 1e-7);
  signorini_certificate certificate{};
  ASSERT_EQ(signorini_contact_result_certificate(result, &certificate, sizeof certificate), 0);
  EXPECT_LE(certificate.unit_free_residual, 1e-8);
  signorini_statistics statistics{};
  ASSERT_EQ(signorini_contact_result_statistics(result, &statistics, sizeof statistics), 0);
  ASSERT_EQ(signorini_contact_result_island_count(result), 1);
  EXPECT_EQ(signorini_contact_result_island_of_contact(result)[0], 0);
  signorini_island island{};
  ASSERT_EQ(signorini_contact_result_island(result, 0, &island, sizeof island), 0);
  EXPECT_EQ(island.rows, 3);
  EXPECT_EQ(island.bodies, 1);
  EXPECT_EQ(island.status, SIGNORINI_SOLVED);
  expect_refused(signorini_contact_result_island(result, 1, &island, sizeof island), "number");
}

TEST(CContacts, RestitutionAndAllowance) {
  BallOnFloor scene;
  scene.contacts[0].friction = 0.0;
  scene.contacts[0].restitution = 0.5;
  const auto speed = [&] {
    EXPECT_EQ(scene.solve(), SIGNORINI_OK) << signorini_last_error();
    return signorini_contact_result_velocities(scene.result.get())[8];
  };
  EXPECT_NEAR(speed(), 0.05, 1e-12);
  ASSERT_EQ(signorini_contact_solver_set_number(scene.solver.get(), "restitution_threshold", 0.2),
            0);
  EXPECT_NEAR(speed(), 0.0, 1e-12);
  scene.contacts[0].gap = 0.0005;
  EXPECT_NEAR(speed(), -0.05, 1e-12);  // gap / step
  scene.contacts[0].allowance = -0.3;
  EXPECT_NEAR(speed(), 0.3, 1e-12);
  scene.contacts.clear();
  EXPECT_EQ(speed(), -0.1);
  scene.bodies.clear();
  EXPECT_EQ(scene.solve(), SIGNORINI_OK);
}

TEST(CContacts, SettingsAreReadAndRefused) {
  BallOnFloor scene;
  signorini_contact_solver* solver = scene.solver.get();
  for (const auto& [name, value] : {std::pair{"friction_model", 3.0},
                                    {"friction_model", 0.5},
                                    {"friction_model", -1.0},
                                    {"pyramid_sides", 5.0},
                                    {"pyramid_sides", 1e9},
                                    {"pyramid_sides", kNaN},
                                    {"warm_start", 2.0},
                                    {"touching_tolerance", -1.0},
                                    {"restitution_threshold", kInfinity},
                                    {"tolerance", 1.0},
                                    {"certify_islands", 1.0}}) {
    expect_refused(signorini_contact_solver_set_number(solver, name, value), name);
  }
  expect_refused(signorini_contact_solver_set_text(solver, "solver", "none"), "none");
  for (const double model : {SIGNORINI_PYRAMID, SIGNORINI_CONE, SIGNORINI_BOX}) {
    ASSERT_EQ(signorini_contact_solver_set_number(solver, "friction_model", model), 0);
    ASSERT_EQ(scene.solve(), 0);
    EXPECT_NEAR(signorini_contact_result_velocities(scene.result.get())[6], 0.95, 1e-7);
  }
  ASSERT_EQ(signorini_contact_solver_set_number(solver, "friction_model", SIGNORINI_CONE), 0);
  ASSERT_EQ(signorini_contact_solver_set_text(solver, "solver", "dantzig"), 0);
  expect_refused(scene.solve(), "dantzig");  // takes no cones
}

/// The ball replaced by a crate that slides and turns on four corners.
struct CrateOnFloor : BallOnFloor {
  CrateOnFloor() {
    bodies[1].angular_velocity[2] = 0.7;
    contacts.resize(4, contacts[0]);
    for (int k = 0; k < 4; ++k) {
      contacts[k].point_a[0] = contacts[k].point_b[0] = k % 2 == 0 ? 0.3 : -0.3;
      contacts[k].point_a[1] = contacts[k].point_b[1] = k < 2 ? 0.2 : -0.2;
      contacts[k].feature_id = static_cast<std::uint64_t>(k);
    }
  }
  signorini_island island() {
    signorini_island filled{};
    EXPECT_EQ(signorini_contact_result_island(result.get(), 0, &filled, sizeof filled), 0);
    return filled;
  }
};

TEST(CContacts, TheDialMeetsItsResidualAndSaysItsPosition) {
  for (const auto& [name, residual] :
       {std::pair{"preview", 1e-2}, {"game", 1e-4}, {"engineering", 1e-8}, {"1e-6", 1e-6}}) {
    CrateOnFloor scene;
    ASSERT_EQ(signorini_contact_solver_set_text(scene.solver.get(), "accuracy", name), 0);
    ASSERT_EQ(scene.solve(), SIGNORINI_OK) << signorini_last_error();
    const signorini_contact_result* result = scene.result.get();
    EXPECT_EQ(signorini_contact_result_status(result), SIGNORINI_SOLVED) << name;
    EXPECT_LE(scene.island().residual, residual * (1.0 + 1e-9));
    EXPECT_GT(scene.island().work, 0.0);
    EXPECT_EQ(signorini_contact_result_work(result), scene.island().work);
    EXPECT_STREQ(signorini_contact_result_accuracy(result),
                 name == std::string("1e-6") ? "1e-06 m/s" : name);
    EXPECT_EQ(signorini_contact_result_is_deterministic(result), 1);
  }
  CrateOnFloor off;
  ASSERT_EQ(off.solve(), SIGNORINI_OK);
  EXPECT_STREQ(signorini_contact_result_accuracy(off.result.get()), "");
  EXPECT_EQ(signorini_contact_result_work(off.result.get()), 0.0);
  EXPECT_STREQ(signorini_contact_result_accuracy(nullptr), "");
  EXPECT_EQ(signorini_contact_result_work(nullptr), 0.0);
}

TEST(CContacts, ABudgetThatRunsOutIsAStatus) {
  CrateOnFloor scene;
  signorini_contact_solver* solver = scene.solver.get();
  expect_refused(signorini_contact_solver_set_number(solver, "budget_work", 1.0), "accuracy");
  expect_refused(signorini_contact_solver_set_text(solver, "accuracy", "gaming"), "gaming");
  expect_refused(signorini_contact_solver_set_text(solver, "accuracy", "-1"), "residual");
  ASSERT_EQ(signorini_contact_solver_set_text(solver, "accuracy", "engineering"), 0);
  for (const double bad : {-1.0, kNaN}) {
    expect_refused(signorini_contact_solver_set_number(solver, "budget_work", bad), "work");
  }
  expect_refused(signorini_contact_solver_set_number(solver, "budget_seconds", 0.0), "seconds");
  ASSERT_EQ(signorini_contact_solver_set_number(solver, "budget_work", 0.0), 0);
  expect_refused(signorini_contact_solver_set_text(solver, "accuracy", ""), "budget");
  ASSERT_EQ(scene.solve(), SIGNORINI_OK);
  EXPECT_EQ(signorini_contact_result_status(scene.result.get()), SIGNORINI_ITERATION_LIMIT);
  EXPECT_STRNE(signorini_contact_result_detail(scene.result.get()), "");
  EXPECT_EQ(signorini_contact_result_work(scene.result.get()), 0.0);
  EXPECT_EQ(signorini_contact_result_is_deterministic(scene.result.get()), 1);
  ASSERT_EQ(signorini_contact_solver_set_number(solver, "budget_work", kInfinity), 0);
  ASSERT_EQ(signorini_contact_solver_set_number(solver, "budget_seconds", 1e-9), 0);
  ASSERT_EQ(scene.solve(), SIGNORINI_OK);
  EXPECT_EQ(signorini_contact_result_status(scene.result.get()), SIGNORINI_TIME_LIMIT);
  EXPECT_EQ(signorini_contact_result_is_deterministic(scene.result.get()), 0);
}

// A program compiled before the struct of an island grew hands in its smaller size.
TEST(CContacts, AnOlderIslandIsFilledAsFarAsItGoes) {
  CrateOnFloor scene;
  ASSERT_EQ(scene.solve(), SIGNORINI_OK);
  signorini_island island{};
  island.residual = island.work = -7.0;
  ASSERT_EQ(signorini_contact_result_island(scene.result.get(), 0, &island, 24), SIGNORINI_OK);
  EXPECT_EQ(island.contacts, 4);
  EXPECT_EQ(island.status, SIGNORINI_SOLVED);
  EXPECT_EQ(island.residual, -7.0);
  EXPECT_EQ(island.work, -7.0);
}

TEST(CContacts, BadBodiesContactsAndCountsAreRefused) {
  BallOnFloor scene;
  ASSERT_EQ(scene.solve(), SIGNORINI_OK);
  const auto refused = [](const std::string& part, auto change) {
    BallOnFloor bad;
    change(bad);
    expect_refused(bad.solve(), part);
    EXPECT_EQ(signorini_contact_result_status(bad.result.get()), SIGNORINI_NOT_RUN);
  };
  refused("kind", [](BallOnFloor& s) { s.bodies[1].kind = 7; });
  refused("mass", [](BallOnFloor& s) { s.bodies[1].mass = 0.0; });
  refused("mass", [](BallOnFloor& s) { s.bodies[1].mass = kNaN; });
  refused("inertia", [](BallOnFloor& s) { s.bodies[1].inertia[1] = 1.0; });
  refused("bodies[1]", [](BallOnFloor& s) { s.bodies[1].position[0] = kNaN; });
  refused("bodies[1]", [](BallOnFloor& s) { s.bodies[1].linear_velocity[0] = kInfinity; });
  refused("bodies[1]", [](BallOnFloor& s) { s.bodies[1].orientation[0] = 0.0; });
  refused("fixed", [](BallOnFloor& s) { s.bodies[0].linear_velocity[0] = 1.0; });
  refused("contact", [](BallOnFloor& s) { s.contacts[0].body_a = 2; });
  refused("contact", [](BallOnFloor& s) { s.contacts[0].body_b = -2147483647; });
  refused("contact", [](BallOnFloor& s) { s.contacts[0].normal[2] = 0.0; });
  refused("contact", [](BallOnFloor& s) { s.contacts[0].gap = kNaN; });
  refused("friction", [](BallOnFloor& s) { s.contacts[0].friction = -1.0; });
  refused("restitution", [](BallOnFloor& s) { s.contacts[0].restitution = 2.0; });
  refused("allowance", [](BallOnFloor& s) { s.contacts[0].allowance = kInfinity; });
  refused("contact", [](BallOnFloor& s) { s.bodies[1] = s.bodies[0]; });
  const auto counts = [&](std::int64_t bodies, std::int64_t contacts) {
    return signorini_contact_solver_solve(scene.solver.get(), 0.01, bodies, scene.bodies.data(),
                                          contacts, scene.contacts.data(), scene.result.get());
  };
  expect_refused(counts(-1, 1), "body_count");
  expect_refused(counts(kHuge, 1), "body_count");
  expect_refused(counts(2, -1), "contact_count");
  expect_refused(counts(2, kHuge), "contact_count");
  for (const double step : {0.0, -1.0, kNaN, kInfinity}) {
    expect_refused(scene.solve(step), "step");
  }
  expect_refused(signorini_contact_solver_solve(scene.solver.get(), 0.01, 2, nullptr, 0, nullptr,
                                                scene.result.get()),
                 "bodies: is null");
  expect_refused(signorini_contact_solver_create(nullptr), "solver");
  expect_refused(signorini_contact_solver_set_number(nullptr, "tolerance", 1.0), "solver");
  expect_refused(signorini_contact_solver_set_text(scene.solver.get(), nullptr, ""), "setting");
  expect_refused(signorini_contact_result_create(nullptr), "result");
  EXPECT_EQ(signorini_contact_result_status(nullptr), SIGNORINI_NOT_RUN);
  EXPECT_EQ(signorini_contact_result_impulses(nullptr), nullptr);
  signorini_contact_solver_destroy(nullptr);
  signorini_contact_result_destroy(nullptr);
}

}  // namespace
