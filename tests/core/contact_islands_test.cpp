#include <signorini/core/response/contact_islands.h>
#include <signorini/core/response/time_stepper.h>

#include "plane_contacts.h"

#include <gtest/gtest.h>
#include <string>

namespace signorini {
namespace {

using testing_tools::at;
using testing_tools::ball_body;
using testing_tools::box_body;
using testing_tools::fixed_body;
using testing_tools::PlaneContacts;
using testing_tools::TestBall;
using testing_tools::TestBody;
using testing_tools::TestBox;

const Vec3 kHalf(0.5, 0.4, 0.2);

Contact contact_of(int a, int b) {
  Contact contact;
  contact.body_a = a;
  contact.body_b = b;
  contact.point_a = contact.point_b = Vec3::Zero();
  contact.normal = Vec3::UnitZ();
  contact.gap = 0.0;
  return contact;
}

TEST(ContactIslands, FixedBodiesConnectNothingAndBodiesAreNumberedAnew) {
  const Bodies bodies{fixed_body(), ball_body(1, 1), ball_body(2, 1), ball_body(3, 1),
                      ball_body(4, 1)};
  State state(5);
  state[4].x = Vec3(1, 2, 3);
  const ContactSet contacts{contact_of(4, 0), contact_of(1, 0), contact_of(2, 4), contact_of(1, 0)};
  const std::vector<double> allowance{1, 2, 3, 4};
  ContactIslands finder;
  const auto islands = finder.find(bodies, state, contacts, allowance);
  ASSERT_EQ(islands.size(), 2u);
  EXPECT_EQ(islands[0].members, (std::vector<int>{0, 2}));
  EXPECT_EQ(islands[1].members, (std::vector<int>{1, 3}));
  EXPECT_EQ(islands[0].body, (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(islands[1].body, (std::vector<int>{0, 1}));
  EXPECT_EQ(islands[0].contacts[0].body_a, 2);
  EXPECT_EQ(islands[0].contacts[1].body_a, 1);
  EXPECT_EQ(islands[0].contacts[1].body_b, 2);
  EXPECT_EQ(islands[0].bodies[2].mass, 4.0);
  EXPECT_EQ(islands[0].state[2].x, Vec3(1, 2, 3));
  EXPECT_EQ(islands[0].allowance, Eigen::Vector2d(1, 3));
  EXPECT_EQ(islands[1].allowance, Eigen::Vector2d(2, 4));
  EXPECT_TRUE(finder.find(bodies, state, {}, {}).empty());
}

/// Boxes that slide and turn on a plane, 3 m apart; `count` of them from number `first`.
struct Field {
  PlaneContacts finder;
  Bodies bodies{fixed_body()};
  State state{at(Vec3::Zero())};

  Field(int first, int count) : finder(Vec3::UnitZ(), shapes(count)) {
    for (int i = first; i < first + count; ++i) {
      bodies.push_back(box_body(1.0 + i, kHalf));
      state.push_back(at(Vec3(3.0 * i, 0, kHalf.z())));
      state.back().p = (1.0 + i) * Vec3(0.4, 0.1 * i, 0);
      state.back().L = Vec3(0, 0, 0.05 * (1.0 + i));
    }
  }
  static std::vector<TestBody> shapes(int count) {
    return std::vector<TestBody>(count, {TestBox{kHalf}, {0.4, 0.0}});
  }
};

class Islands : public testing::TestWithParam<FrictionModel> {};

INSTANTIATE_TEST_SUITE_P(All, Islands,
                         testing::Values(FrictionModel::kPyramid, FrictionModel::kCone,
                                         FrictionModel::kBox),
                         [](const auto& tested) { return std::string(to_string(tested.param)); });

TEST_P(Islands, EachGivesTheBitsThatItGivesAlone) {
  const TimeStepSettings settings{.friction_model = GetParam()};
  Field all(0, 3);
  TimeStepper together(all.bodies, all.finder, settings);
  StepReport report;
  for (int i = 0; i < 60; ++i) {
    together.step(all.state, report);
    ASSERT_TRUE(lcp::is_solved(report.status)) << report.detail;
    ASSERT_EQ(report.islands.size(), 3u);
  }
  for (int k = 0; k < 3; ++k) {
    Field one(k, 1);
    TimeStepper alone(one.bodies, one.finder, settings);
    for (int i = 0; i < 60; ++i) {
      alone.step(one.state, report);
    }
    EXPECT_EQ(one.state[1].x, all.state[1 + k].x);
    EXPECT_EQ(one.state[1].p, all.state[1 + k].p);
    EXPECT_EQ(one.state[1].L, all.state[1 + k].L);
    EXPECT_EQ(one.state[1].q.coeffs(), all.state[1 + k].q.coeffs());
  }
}

TEST_P(Islands, AThousandSeparatedBodiesAddNoRow) {
  Field field(0, 2);
  TimeStepper few(field.bodies, field.finder, {.friction_model = GetParam()});
  State state = field.state;
  StepReport small;
  few.step(state, small);

  auto shapes = Field::shapes(2);
  Bodies bodies = field.bodies;
  State many = field.state;
  for (int i = 0; i < 1000; ++i) {
    shapes.push_back({TestBall{0.1}, {0.4, 0.0}});
    bodies.push_back(ball_body(1.0, 0.1));
    many.push_back(at(Vec3(i, 50.0, 10.0)));
  }
  PlaneContacts finder(Vec3::UnitZ(), shapes);
  TimeStepper stepper(bodies, finder, {.friction_model = GetParam()});
  StepReport large;
  stepper.step(many, large);
  EXPECT_EQ(large.rows, small.rows);
  EXPECT_EQ(large.islands.size(), small.islands.size());
  EXPECT_EQ(large.result.statistics.iterations, small.result.statistics.iterations);
  EXPECT_EQ(large.result.statistics.pivots, small.result.statistics.pivots);
  EXPECT_EQ(small.dynamic_bodies_without_rows, 0);
  EXPECT_EQ(large.dynamic_bodies_without_rows, 1000);
  EXPECT_EQ(many[1].p, state[1].p);
  EXPECT_EQ(many[2].L, state[2].L);
}

TEST(StepReport, SaysWhatWasMadeAndLeftOutAndHowEachIslandWasSolved) {
  // A brick with friction, a ball that grips, a ball without friction, one in the air.
  PlaneContacts finder(Vec3::UnitZ(), {{TestBox{kHalf}, {0.4, 0.0}},
                                       {TestBall{0.5}, {0.4, 0.0}},
                                       {TestBall{0.5}, {0.0, 0.0}},
                                       {TestBall{0.5}, {0.4, 0.0}}});
  const Bodies bodies{fixed_body(), box_body(1, kHalf), ball_body(1, 0.5), ball_body(1, 0.5),
                      ball_body(1, 0.5)};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.2)), at(Vec3(5, 0, 0.5)), at(Vec3(10, 0, 0.5)),
              at(Vec3(15, 0, 5))};
  TimeStepper stepper(bodies, finder, {.friction_model = FrictionModel::kCone});
  StepReport report;
  stepper.step(state, report);
  ASSERT_EQ(report.islands.size(), 3u);
  EXPECT_EQ(report.rows, 12 + 3 + 1);
  EXPECT_EQ(report.tangents_left_out, 2);
  EXPECT_EQ(report.dynamic_bodies_without_rows, 1);
  EXPECT_EQ(report.islands[0].model, "cone");
  EXPECT_EQ(report.islands[1].model, "single contact, cone");
  EXPECT_EQ(report.islands[1].solver, "closed form");
  EXPECT_EQ(report.islands[2].model, "single contact, frictionless");
  EXPECT_EQ(report.islands[2].solver, "closed form");
  EXPECT_EQ(report.island_of, (std::vector<int>{0, 0, 0, 0, 1, 2}));
  const std::string text = to_text(report);
  EXPECT_NE(text.find("6 contacts, 3 islands, 16 rows; left out: 0 contacts about to bounce, 0 "
                      "contacts apart (put back: 0), 2 tangents without friction, 1 rotations of "
                      "bodies that nothing can turn, 1 bodies without "
                      "contact"),
            std::string::npos)
      << text;
  EXPECT_NE(
      text.find("island 2: 1 bodies, 1 contacts, 1 rows, single contact, frictionless, closed "
                "form: solved"),
      std::string::npos)
      << text;
}

TEST(StepReport, ASlidingSingleContactIsLeftToTheSolver) {
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {0.2, 0.0}}});
  TimeStepper stepper({fixed_body(), ball_body(1, 0.5)}, finder,
                      {.friction_model = FrictionModel::kCone});
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.5))};
  state[1].p = Vec3(3, 0, 0);
  StepReport report;
  stepper.step(state, report);
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_NE(report.islands[0].solver, "closed form");
  EXPECT_NEAR(state[1].p.x(), 3.0 - 0.2 * 9.81 / 240.0, 1e-9);
}

}  // namespace
}  // namespace signorini
