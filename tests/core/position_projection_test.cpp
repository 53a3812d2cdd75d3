#include <signorini/core/response/position_projection.h>

#include "plane_contacts.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <memory>
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

const Vec3 kGravity(0.0, 0.0, -9.81);

std::unique_ptr<lcp::Solver> solver() {
  return lcp::make_solver("lemke", {.tolerance = 1e-10});
}

ContactSet contacts_of(PlaneContacts& finder, const State& state) {
  ContactSet contacts;
  finder.find(state, 0.01, contacts);
  return contacts;
}

TEST(PositionProjection, LiftsABoxToTheSurfaceAndKeepsItsMomenta) {
  const Vec3 half(0.5, 0.5, 0.5);
  const Bodies bodies{fixed_body(), box_body(2.0, half)};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.499))};
  state[1].p = Vec3(1, 2, 3);
  state[1].L = Vec3(0.1, 0.2, 0.3);
  const State before = state;
  PlaneContacts finder(Vec3::UnitZ(), {{TestBox{half}, {}}});
  ProjectionReport report;
  PositionProjection().project(bodies, contacts_of(finder, state), kGravity, *solver(), state,
                               report);
  EXPECT_TRUE(lcp::is_solved(report.status));
  EXPECT_NEAR(state[1].x.z(), 0.5, 1e-12);
  EXPECT_NEAR(report.largest_displacement, 0.001, 1e-12);
  EXPECT_NEAR(report.energy_change, 2.0 * 9.81 * 0.001, 1e-12);
  EXPECT_EQ(state[1].p, before[1].p);
  EXPECT_EQ(state[1].L, before[1].L);
  EXPECT_EQ(state[0].x, before[0].x);
}

TEST(PositionProjection, SharesTheDisplacementByTheMasses) {
  const Bodies bodies{fixed_body(), ball_body(1.0, 0.5), ball_body(3.0, 0.5)};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0)), at(Vec3(0.96, 0, 0))};
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {}}, {TestBall{0.5}, {}}});
  finder.without_plane();
  finder.pair_balls(1, 2);
  ProjectionReport report;
  PositionProjection().project(bodies, contacts_of(finder, state), Vec3::Zero(), *solver(), state,
                               report);
  EXPECT_NEAR(state[1].x.x(), -0.03, 1e-13);
  EXPECT_NEAR(state[2].x.x(), 0.97, 1e-13);
  EXPECT_EQ(report.energy_change, 0.0);
}

TEST(PositionProjection, TurnsATiltedBoxOutOfThePlane) {
  const Vec3 half(0.5, 0.5, 0.1);
  const Bodies bodies{fixed_body(), box_body(1.0, half)};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.0995))};
  state[1].q = Quat(Eigen::AngleAxisd(0.002, Vec3::UnitY()));
  PlaneContacts finder(Vec3::UnitZ(), {{TestBox{half}, {}}});
  // Each linear step leaves an error of the order of its turn squared times the size: the first
  // turns by about 1 mrad, 5e-7 m; later ones by next to nothing. Too far out is left as it is.
  for (int i = 0; i < 3; ++i) {
    ProjectionReport report;
    PositionProjection().project(bodies, contacts_of(finder, state), kGravity, *solver(), state,
                                 report);
  }
  double least = 1.0;
  for (const Contact& contact : contacts_of(finder, state)) least = std::min(least, contact.gap);
  EXPECT_GE(least, -kToleratedOverlap);
  EXPECT_LE(least, 1e-6);
  EXPECT_NEAR(state[1].q.norm(), 1.0, 1e-15);
}

TEST(PositionProjection, DoesNotPushIntoAnotherBodyThatIsClose) {
  // Ball 1 overlaps the plane by 1 mm; ball 2 hovers 0.4 mm above it and has to rise with it.
  const Bodies bodies{fixed_body(), ball_body(1.0, 0.5), ball_body(1.0, 0.5)};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.499)), at(Vec3(0, 0, 1.4994))};
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {}}, {TestBall{0.5}, {}}});
  finder.pair_balls(2, 1);
  ProjectionReport report;
  PositionProjection().project(bodies, contacts_of(finder, state), kGravity, *solver(), state,
                               report);
  EXPECT_NEAR(state[1].x.z(), 0.5, 1e-13);
  EXPECT_NEAR(state[2].x.z(), 1.5, 1e-13);
}

TEST(PositionProjection, DoesNothingWithoutOverlap) {
  const Bodies bodies{fixed_body(), ball_body(1.0, 0.5)};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.5 - 0.5 * kToleratedOverlap))};
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {}}});
  ProjectionReport report;
  PositionProjection().project(bodies, contacts_of(finder, state), kGravity, *solver(), state,
                               report);
  EXPECT_EQ(report.status, lcp::Status::kNotRun);
  EXPECT_EQ(state[1].x.z(), 0.5 - 0.5 * kToleratedOverlap);
}

/// Of three balls on the plane one overlaps it, and one hangs on a joint that is off: the third,
/// within what is left alone, stays where it is to the bit.
TEST(PositionProjection, LeavesAloneWhatNothingLinksToWhatIsOff) {
  const Bodies bodies{fixed_body(), ball_body(1.0, 0.5), ball_body(1.0, 0.5), ball_body(1.0, 0.5)};
  const double almost = 0.5 - 0.5 * kToleratedOverlap;
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.49)), at(Vec3(5, 0, almost)), at(Vec3(10, 0, 0.6))};
  Joints joints{joint_at(JointKind::kBall, 3, 0, state, Vec3(10, 0, 1.0))};
  state[3].x.z() = 0.601;  // a millimetre off
  joints.push_back(joint_at(JointKind::kBall, 2, 0, state, Vec3(5, 0, 1.0)));
  PlaneContacts finder(Vec3::UnitZ(),
                       {{TestBall{0.5}, {}}, {TestBall{0.5}, {}}, {TestBall{0.5}, {}}});
  const State before = state;
  PositionProjection projection;
  ProjectionReport report;
  const auto lcp_solver = lcp::make_solver("auto");
  projection.project(bodies, contacts_of(finder, state), kGravity, *lcp_solver, state, report,
                     joints);
  EXPECT_TRUE(lcp::is_solved(report.status)) << report.detail;
  EXPECT_NEAR(state[1].x.z(), 0.5, 1e-10);
  EXPECT_EQ(state[2].x, before[2].x);
  EXPECT_EQ(state[2].q.coeffs(), before[2].q.coeffs());
  EXPECT_NEAR(state[3].x.z(), 0.6, 1e-9);
  // And once more, with nothing off, then with the third alone.
  projection.project(bodies, contacts_of(finder, state), kGravity, *lcp_solver, state, report,
                     joints);
  EXPECT_EQ(report.status, lcp::Status::kNotRun);
  state[2].x.x() += 1e-3;
  const State third = state;
  projection.project(bodies, contacts_of(finder, state), kGravity, *lcp_solver, state, report,
                     joints);
  EXPECT_TRUE(lcp::is_solved(report.status)) << report.detail;
  EXPECT_LT(state[2].x.x(), third[2].x.x() - 1e-4);  // it also turns
  EXPECT_EQ(state[1].x, third[1].x);
  EXPECT_EQ(state[3].x, third[3].x);
}

TEST(PositionProjection, MovesNothingWhereThereIsNoRoom) {
  // A ball between two walls that are closer than its diameter: J D >= 1 mm and -J D >= 1 mm.
  const Bodies bodies{fixed_body(), ball_body(1.0, 0.5)};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.499))};
  PlaneContacts finder(Vec3::UnitZ(), {{TestBall{0.5}, {}}});
  ContactSet contacts = contacts_of(finder, state);
  contacts.push_back(contacts[0]);
  contacts[1].normal = -Vec3::UnitZ();
  contacts[1].point_a = Vec3(0, 0, 0.999);
  contacts[1].point_b = Vec3(0, 0, 0.998);
  const State before = state;
  ProjectionReport report;
  PositionProjection().project(bodies, contacts, kGravity, *solver(), state, report);
  EXPECT_FALSE(lcp::is_solved(report.status));
  EXPECT_NE(report.status, lcp::Status::kNotRun);
  EXPECT_NE(report.detail.find("left as they are"), std::string::npos) << report.detail;
  EXPECT_EQ(state[1].x, before[1].x);
}

}  // namespace
}  // namespace signorini
