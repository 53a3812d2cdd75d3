#include <signorini/core/response/contact_solver.h>
#include <signorini/core/response/time_stepper.h>

#include "plane_contacts.h"

#include <gtest/gtest.h>
#include <limits>
#include <string>

namespace signorini {
namespace {

using testing_tools::at;
using testing_tools::ball_body;
using testing_tools::box_body;
using testing_tools::fixed_body;
using testing_tools::PlaneContacts;
using testing_tools::TestBall;
using testing_tools::TestBox;

constexpr double kStep = 1.0 / 60.0;

/// Two boxes, one on the other, and a ball beside them, sliding on a plane.
struct Stack {
  Vec3 half = Vec3(0.5, 0.4, 0.1);
  PlaneContacts finder{
      Vec3::UnitZ(),
      {{TestBox{half}, {0.5, 0.0}}, {TestBox{half}, {0.5, 0.0}}, {TestBall{0.3}, {0.5, 0.0}}}};
  Bodies bodies{fixed_body(), box_body(2.0, half), box_body(1.0, half), ball_body(1.0, 0.3)};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.1)), at(Vec3(0, 0, 0.3)), at(Vec3(3, 0, 0.3))};

  Stack() {
    finder.stack(2, 1);
    state[1].p = Vec3(1.0, 0.2, 0.0);
    state[3].p = Vec3(2.0, 0.0, 0.0);
  }
  [[nodiscard]] State with_weight() const {
    State free = state;
    for (std::size_t k = 1; k < bodies.size(); ++k) {
      free[k].p += kStep * bodies[k].mass * Vec3(0.0, 0.0, -9.81);
    }
    return free;
  }
  /// @return the state with weight and impulses
  [[nodiscard]] State solve(ContactSolver& solver, ContactSolution& solution) {
    ContactSet contacts;
    finder.find(state, 0.01, contacts);
    State after = with_weight();
    solver.solve(bodies, contacts, allowances(bodies, state, contacts, kStep, 1e-6, 0.0), after,
                 solution);
    return after;
  }
};

class Solves : public testing::TestWithParam<FrictionModel> {};

INSTANTIATE_TEST_SUITE_P(All, Solves,
                         testing::Values(FrictionModel::kPyramid, FrictionModel::kCone,
                                         FrictionModel::kBox),
                         [](const auto& tested) { return std::string(to_string(tested.param)); });

TEST_P(Solves, GiveTheTimeSteppersImpulsesToTheBit) {
  Stack stack;
  TimeStepper stepper(stack.bodies, stack.finder,
                      {.step = kStep, .friction_model = GetParam(), .solver = "auto"});
  ContactSolver solver({.friction_model = GetParam()});
  StepReport report;
  ContactSolution solution;
  for (int i = 0; i < 5; ++i) {  // later ones start warm
    const State after = stack.solve(solver, solution);
    stepper.step(stack.state, report);
    ASSERT_EQ(solution.status, report.status);
    ASSERT_EQ(solution.impulses, report.impulses) << "step " << i;
    ASSERT_EQ(solution.normal_impulses, report.normal_impulses);
    EXPECT_EQ(solution.island_of, report.island_of);
    EXPECT_EQ(solution.islands.size(), 2u);
    EXPECT_EQ(solution.energy_change, report.energy_change_impact);
    EXPECT_EQ(after[1].p, stack.state[1].p);
    EXPECT_EQ(solution.detail, "");
  }
}

TEST(ContactSolver, TheDialIsTheTimeSteppers) {
  for (const char* name : {"preview", "game", "engineering", "reference", "1e-6"}) {
    SCOPED_TRACE(name);
    const Accuracy accuracy = Accuracy::named(name);
    Stack stack;
    TimeStepSettings settings{.step = kStep};
    settings.accuracy = accuracy;
    TimeStepper stepper(stack.bodies, stack.finder, settings);
    ContactSolver solver({.friction_model = FrictionModel::kBox, .accuracy = accuracy});
    StepReport report;
    ContactSolution solution;
    for (int i = 0; i < 5; ++i) {
      (void)stack.solve(solver, solution);
      stepper.step(stack.state, report);
      ASSERT_EQ(solution.impulses, report.impulses) << "step " << i;
      EXPECT_EQ(solution.work, report.work);
      EXPECT_TRUE(lcp::is_solved(solution.status));
      for (const IslandReport& island : solution.islands) {
        EXPECT_TRUE(island.status != lcp::Status::kSolved ||
                    island.residual <= accuracy.residual() * (1.0 + 1e-9));
      }
    }
    EXPECT_EQ(solution.accuracy, accuracy.name());
    EXPECT_TRUE(solution.is_deterministic);
  }
}

TEST(ContactSolver, ABudgetIsKeptAndWhatItDidNotPayForIsSaid) {
  Stack stack;
  ContactSet contacts;
  stack.finder.find(stack.state, 0.01, contacts);
  const auto solve = [&](const StepBudget& budget, ContactSolution& solution) {
    ContactSolver solver({.accuracy = Accuracy::engineering(), .budget = budget});
    State after = stack.with_weight();
    solver.solve(stack.bodies, contacts, lcp::Vector::Zero(contacts.size()), after, solution);
  };
  ContactSolution solution;
  solve({.work = 1.0}, solution);  // some sweeps, not one factorisation
  EXPECT_EQ(solution.status, lcp::Status::kIterationLimit);
  EXPECT_NE(solution.detail.find("best iterate applied"), std::string::npos) << solution.detail;
  EXPECT_NE(solution.result.detail.find("budget used up"), std::string::npos);
  EXPECT_GT(solution.work, 0.5);
  EXPECT_LE(solution.work, 1.0 + 1e-9);
  EXPECT_TRUE(solution.is_deterministic);
  solve({.work = 1000.0}, solution);
  EXPECT_EQ(solution.status, lcp::Status::kSolved);
  solve({.seconds = 1e-9}, solution);
  EXPECT_EQ(solution.status, lcp::Status::kTimeLimit);
  EXPECT_FALSE(solution.is_deterministic);
  EXPECT_THROW(ContactSolver({.budget = {.work = 1.0}}), std::invalid_argument);
  EXPECT_THROW(ContactSolver({.accuracy = Accuracy::game(), .budget = {.work = -1.0}}),
               std::invalid_argument);
}

TEST(ContactSolver, AllowancesLetGapsCloseAndBallsBounce) {
  const Bodies bodies{fixed_body(), ball_body(1.0, 0.5)};
  State state{at(Vec3::Zero()), at(Vec3(0.0, 0.0, 0.5))};
  state[1].p = Vec3(0.0, 0.0, -2.0);
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {0.0, 0.5}}});
  ContactSet contacts;
  finder.find(state, 1.0, contacts);
  EXPECT_EQ(allowances(bodies, state, contacts, 0.1, 1e-6, 0.0)[0], -1.0);
  EXPECT_EQ(allowances(bodies, state, contacts, 0.1, 1e-6, 3.0)[0], 0.0);  // slower than 3 m/s
  contacts[0].gap = 0.05;
  EXPECT_EQ(allowances(bodies, state, contacts, 0.1, 1e-6, 0.0)[0], 0.5);
  contacts[0].gap = -0.05;
  contacts[0].material.restitution = 0.0;
  EXPECT_EQ(allowances(bodies, state, contacts, 0.1, 1e-6, 0.0)[0], 0.0);

  ContactSolver solver;
  ContactSolution solution;
  solver.solve(bodies, contacts, lcp::Vector::Constant(1, -1.0), state, solution);
  EXPECT_NEAR(state[1].p.z(), 1.0, 1e-12);  // it must open at 1 m/s
  EXPECT_NEAR(solution.normal_impulses[0], 3.0, 1e-12);
}

TEST(ContactSolver, NothingTouchesNothingHappens) {
  const Bodies bodies{ball_body(1.0, 0.5)};
  State state{at(Vec3::Zero())};
  ContactSolver solver;
  ContactSolution solution;
  solver.solve(bodies, {}, lcp::Vector(), state, solution);
  EXPECT_EQ(solution.status, lcp::Status::kSolved);
  EXPECT_EQ(solution.result.status, lcp::Status::kNotRun);
  solver.solve({}, {}, lcp::Vector(), state = {}, solution);
  EXPECT_EQ(solution.status, lcp::Status::kSolved);
}

TEST(ContactSolver, AnIterationLimitIsSaid) {
  Stack stack;
  ContactSet contacts;
  stack.finder.find(stack.state, 0.01, contacts);
  ContactSolver solver(
      {.solver = "nsgs", .lcp = {.tolerance = 1e-12, .max_iterations = 1}, .warm_start = false});
  ContactSolution solution;
  State after = stack.with_weight();
  solver.solve(stack.bodies, contacts, lcp::Vector::Zero(contacts.size()), after, solution);
  EXPECT_EQ(solution.status, lcp::Status::kIterationLimit);
  EXPECT_NE(solution.detail.find("best iterate applied"), std::string::npos) << solution.detail;
}

TEST(ContactSolver, BadInputIsRefusedAndChangesNothing) {
  Stack stack;
  ContactSet contacts;
  stack.finder.find(stack.state, 0.01, contacts);
  ContactSolver solver;
  ContactSolution solution;
  const State before = stack.state;
  const lcp::Vector none = lcp::Vector::Zero(contacts.size());
  const auto solve = [&](const ContactSet& set, const lcp::Vector& allowance) {
    solver.solve(stack.bodies, set, allowance, stack.state, solution);
  };
  EXPECT_THROW(solve(contacts, lcp::Vector::Zero(1)), std::invalid_argument);
  lcp::Vector nan = none;
  nan[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(solve(contacts, nan), std::invalid_argument);
  ContactSet wrong = contacts;
  wrong[1].normal *= 2.0;
  EXPECT_THROW(solve(wrong, none), std::invalid_argument);
  wrong = contacts;
  wrong[0].body_a = 99;
  EXPECT_THROW(solve(wrong, none), std::invalid_argument);
  EXPECT_EQ(stack.state[1].p, before[1].p);
  EXPECT_EQ(solution.status, lcp::Status::kNotRun);
  EXPECT_THROW(ContactSolver({.pyramid_sides = 5}), std::invalid_argument);
  EXPECT_THROW(ContactSolver({.solver = "none"}), std::invalid_argument);
  EXPECT_THROW(ContactSolver({.lcp = {.tolerance = 2.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace signorini
