#include "bench/broad_phase_study.h"
#include "bench/contact_study.h"
#include "bench/contact_time_study.h"
#include "bench/narrow_phase_study.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>

namespace signorini::bench {
namespace {

TEST(ContactStudy, EveryPairKeepsItsPropertiesOnASample) {
  std::ostringstream out;
  const ContactStudyReport report = run_contact_study({.poses = 600, .seed = 1}, out);
  EXPECT_TRUE(report.passed()) << out.str();
  for (const ContactStudyRow& row : report.rows) {
    EXPECT_EQ(row.poses, 600) << row.pair;
    EXPECT_GT(row.overlapping, 60) << row.pair;
  }
}

TEST(ContactStudy, OnePairAloneOrARefusal) {
  std::ostringstream out;
  const ContactStudyReport report = run_contact_study({.poses = 10, .pair = "sphere-box"}, out);
  ASSERT_EQ(report.rows.size(), 1U);
  EXPECT_NE(report.to_csv().find("sphere-box,10,5,"), std::string::npos) << report.to_csv();
  EXPECT_THROW((void)run_contact_study({.poses = 10, .pair = "box-sphere"}, out),
               std::invalid_argument);
}

/// A checker that passes everything proves nothing.
TEST(PairChecks, SeeARefusal) {
  using namespace collision;  // NOLINT
  testing::Random random(3);
  testing::PlacedPair pair{Sphere{1.0}, {Vec3(0.0, 0.0, 1.9), Quat::Identity()}, Sphere{1.0}, {}};
  pair.size = 1.0;
  pair.rounding = 1e-15;
  const auto worst = [&](const JudgedPair& judged) {
    return *std::max_element(judged.verdict.begin(), judged.verdict.end());
  };
  EXPECT_LE(worst(judge_pair(pair, 0.1, random)), 1.0);
  pair.pose_b.orientation = Quat(2.0, 0.0, 0.0, 0.0);  // refused by the queries
  EXPECT_GT(worst(judge_pair(pair, 0.1, random)), 1.0);
}

TEST(ContactTimeStudy, MissesNothingOnASample) {
  std::ostringstream out;
  const ContactTimeReport report = run_contact_time_study({.throws = 105, .seed = 7}, out);
  EXPECT_TRUE(report.passed()) << out.str();
  ASSERT_EQ(report.rows.size(), 35U);
  long hits = 0;
  for (const ContactTimeRow& row : report.rows) {
    EXPECT_EQ(row.throws, 3) << row.pair;
    hits += row.hits;
  }
  EXPECT_GT(hits, 35);
  EXPECT_NE(report.to_csv().find("sphere-sphere,3,"), std::string::npos);
}

TEST(NarrowPhaseStudy, AllOurPointsAreValid) {
  std::ostringstream out;
  const NarrowPhaseReport report = run_narrow_phase_study({.poses = 50, .repeats = 1}, out);
  for (const NarrowPhaseRow& row : report.rows) {
    if (row.name == "signorini") {
      EXPECT_GE(row.points, 1.0) << row.pair;
      EXPECT_NEAR(row.valid, row.points, 1e-9) << row.pair;
    }
  }
  // Nobody has more points that carry something.
  std::map<std::string, double> ours;
  for (const NarrowPhaseRow& row : report.rows) {
    const double most = ours.try_emplace(row.pair, row.corners).first->second;  // ours comes first
    EXPECT_LE(row.corners, most) << row.pair << ", " << row.name;
    EXPECT_LE(row.corners, row.valid) << row.pair << ", " << row.name;
  }
}

TEST(BroadPhaseStudy, FindsWhatThePlainSweepFinds) {
  std::ostringstream out;
  const BroadPhaseReport report = run_broad_phase_study({.bodies = 300, .steps = 3}, out);
  EXPECT_TRUE(report.passed()) << out.str();
  for (const BroadPhaseRow& row : report.rows) {
    EXPECT_EQ(row.missed, 0) << row.crowd << ", " << row.motion << ", " << row.name;
  }
  EXPECT_NE(report.to_csv().find("\"signorini\""), std::string::npos);
}

}  // namespace
}  // namespace signorini::bench
