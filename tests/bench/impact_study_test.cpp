#include "bench/impact_study.h"

#include <signorini/core/response/assembly.h>

#include "bench/laws_study.h"
#include "bench/random_impact.h"

#include <gtest/gtest.h>
#include <sstream>

namespace signorini::bench {
namespace {

TEST(ImpactStudy, EnergySafeFormsNeverGainOn100RandomImpacts) {
  std::ostringstream out;
  const ImpactCounts counts = run_impact_study({.impacts = 100, .seed = 1}, out);
  EXPECT_TRUE(counts.passed()) << out.str();
  EXPECT_EQ(counts.impacts, 100);
  EXPECT_GE(counts.separating_share, 0.3);
  EXPECT_LE(counts.worst_safe_gain, 1e-12);
  EXPECT_EQ(counts.unanswered, 0);
  // The study must be able to find what it looks for.
  EXPECT_GT(counts.newton_gains, 0);
  EXPECT_GT(counts.notes_gains, 0);
  for (const ImpactRow& row : counts.rows) {
    EXPECT_EQ(row.inadmissible, 0);
    // Poisson's law and the reflections seldom or never need to be drawn back.
    if (row.energy_safe && (row.law == ImpactLaw::kNewton || row.law == ImpactLaw::kNotes)) {
      EXPECT_GT(row.reduced, 0);
    }
  }
  EXPECT_NE(out.str().find("PASS"), std::string::npos);
}

TEST(ImpactStudy, WithFrictionImpulsesStayInTheConesAndEnergyNeverRises) {
  ImpactOptions options;
  options.impacts = 3;
  options.impact = {.mass_ratio = 1e9, .most_friction = 1.0};
  std::ostringstream out;
  const ImpactCounts counts = run_impact_study(options, out);
  EXPECT_TRUE(counts.passed()) << out.str();
  EXPECT_EQ(counts.rows.size(), 4u);  // Newton and reflections
  EXPECT_EQ(counts.unsolved_coulomb, 0);
  EXPECT_LE(counts.worst_safe_gain, 1e-12);
}

// The blend approaches by all the rounding that it may have, and turning its impulses into the
// world's axes and back adds some.
TEST(ImpactStudy, RoundingOfTurnedImpulsesIsNoComplaint) {
  ImpactOptions options;
  options.seed = 20261127;
  options.first = 1203;
  options.impacts = 1;
  options.impact = {.mass_ratio = 1e9, .most_friction = 1.0};
  options.laws = {ImpactLaw::kNewton};
  options.plain_forms = false;
  std::ostringstream out;
  const ImpactCounts counts = run_impact_study(options, out);
  ASSERT_EQ(counts.rows.size(), 1u);
  EXPECT_EQ(counts.rows[0].inadmissible, 0);
  EXPECT_TRUE(counts.passed()) << out.str();
}

TEST(LawsStudy, ReflectionsHaveAllFiveAndNewtonLacksBreakAwayAndEnergy) {
  std::ostringstream out;
  const std::vector<LawRow> rows = run_laws_study({.impacts = 15}, our_laws(), out);
  ASSERT_EQ(rows.size(), 10u);
  for (const LawRow& row : rows) {
    if (row.name.starts_with("reflections")) {
      EXPECT_EQ(row.letters(), "BSEMO") << out.str();
    } else if (row.name == "Newton") {
      EXPECT_EQ(row.letters(), "-S-MO") << out.str();
    } else {
      EXPECT_NE(row.letters(), "BSEMO") << out.str();
    }
    EXPECT_LE(row.momentum, 1e-12);
  }
}

TEST(ImpactStudy, TheSameSeedGivesTheSameTable) {
  std::ostringstream first;
  std::ostringstream second;
  std::ostringstream other;
  run_impact_study({.impacts = 8, .seed = 7}, first);
  run_impact_study({.impacts = 8, .seed = 7}, second);
  run_impact_study({.impacts = 8, .seed = 8}, other);
  EXPECT_EQ(first.str(), second.str());
  EXPECT_NE(first.str(), other.str());
}

TEST(ImpactStudy, NoImpactsAndANegativeNumber) {
  std::ostringstream out;
  EXPECT_EQ(run_impact_study({.impacts = 0, .seed = 1}, out).impacts, 0);
  EXPECT_THROW(run_impact_study({.impacts = -1, .seed = 1}, out), std::invalid_argument);
}

TEST(ImpactStudy, AGainFailsTheVerdict) {
  ImpactCounts counts;
  counts.contacts = 10;
  counts.separating_share = 0.4;
  ImpactRow row;
  row.energy_safe = true;
  counts.rows = {row};
  EXPECT_TRUE(counts.passed());
  counts.rows[0].gained = 1;
  EXPECT_FALSE(counts.passed());
  counts.rows[0] = row;
  counts.rows[0].inadmissible = 1;
  EXPECT_FALSE(counts.passed());
  counts.rows[0] = row;
  counts.unanswered = 1;
  EXPECT_FALSE(counts.passed());
  counts.unanswered = 0;
  counts.separating_share = 0.2;
  EXPECT_FALSE(counts.passed());
}

TEST(RandomImpacts, AreValidAndHoldWhatTheStudyPromises) {
  double least_mass = 1e9;
  double most_mass = 0.0;
  std::size_t most_bodies = 0;
  std::size_t least_bodies = 99;
  int faces_or_copies = 0;
  for (int index = 0; index < 500; ++index) {
    const RandomImpact impact = draw_random_impact(3, index);
    for (const Body& body : impact.bodies) {
      validate(body);
      least_mass = std::min(least_mass, body.mass);
      most_mass = std::max(most_mass, body.mass);
    }
    validate(impact.bodies, impact.state);
    validate(impact.contacts, static_cast<int>(impact.bodies.size()));
    check_dynamic(impact.bodies, impact.contacts);
    most_bodies = std::max(most_bodies, impact.bodies.size());
    least_bodies = std::min(least_bodies, impact.bodies.size());
    for (std::size_t i = 1; i < impact.contacts.size(); ++i) {
      faces_or_copies += impact.contacts[i].normal == impact.contacts[i - 1].normal ? 1 : 0;
    }
  }
  EXPECT_EQ(least_bodies, 2u);
  EXPECT_EQ(most_bodies, 20u);
  EXPECT_LE(most_mass / least_mass, 1000.0 * (1 + 1e-12));
  EXPECT_GT(most_mass / least_mass, 900.0);
  EXPECT_GT(faces_or_copies, 500);
}

}  // namespace
}  // namespace signorini::bench
