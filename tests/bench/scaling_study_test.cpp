#include "bench/scaling_study.h"

#include <signorini/lcp/io/input_error.h>

#include "bench/memory_bandwidth.h"
#include "bench/scaling_baseline.h"
#include "bench/scaling_csv.h"
#include "bench/scaling_scenes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <string>

namespace signorini::bench {
namespace {

/// A row of ours with an answer.
ScalingRow answer(const std::string& scene, int bodies) {
  ScalingRow row{.scene = scene,
                 .bodies = bodies,
                 .engine = kOurEngine,
                 .accuracy = "engineering",
                 .threads = 1,
                 .steps = 10};
  long next = 7;
  for (const auto& [name, count] : kScalingCounts) row.counts.*count = next++;
  double cost = 0.25;
  for (const auto& [name, of] : kScalingCosts) row.costs.*of = cost *= 2.0;
  return row;
}

class ScalingFile : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }
  void write(const std::string& text) const { std::ofstream(file_) << text; }
  /// What reading it as a baseline for `planned` is refused with.
  [[nodiscard]] std::string refusal(const std::vector<ScalingRow>& planned) const {
    try {
      (void)read_baseline(file_, planned);
    } catch (const lcp::InputError& error) {
      return error.what();
    }
    return "not refused";
  }
  /// The file of one answer, its field in this column replaced.
  [[nodiscard]] std::string with_field(const std::string& column, const std::string& value) const {
    std::istringstream csv(write_scaling_csv({answer("stacks", 10)}));
    std::string head;
    std::string line;
    std::getline(csv, head);
    std::getline(csv, line);
    std::istringstream names(head);
    std::istringstream fields(line);
    std::string changed;
    for (std::string name, field; std::getline(names, name, ',');) {
      std::getline(fields, field, ',');
      changed += (changed.empty() ? "" : ",") + (name == column ? value : field);
    }
    return head + "\n" + changed + "\n";
  }

  const std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".csv");
  const std::vector<ScalingRow> planned_ = {answer("stacks", 10)};
};

TEST_F(ScalingFile, IsReadBackAsItWasWritten) {
  std::vector<ScalingRow> rows = {answer("stacks", 10), answer("pile", 30)};
  rows[1].failure = "step 3: stalled, residual";
  rows[1].is_wrong = true;
  rows[1].costs.floor = ScalingCosts::kUnknown;
  write(write_scaling_csv(rows));
  const std::vector<ScalingRow> read = read_scaling_csv(file_);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(scaling_key(read[0]), scaling_key(rows[0]));
  EXPECT_EQ(read[0].counts, rows[0].counts);
  EXPECT_EQ(read[0].costs.error, rows[0].costs.error);
  EXPECT_EQ(read[1].failure, "step 3: stalled; residual");  // commas end fields
  EXPECT_TRUE(read[1].is_wrong);
  EXPECT_FALSE(read[0].is_wrong);
  EXPECT_TRUE(std::isnan(read[1].costs.floor));
}

TEST_F(ScalingFile, ThatIsNoneIsRefusedByNameLineAndField) {
  const std::string name = file_.string();
  EXPECT_NE(refusal(planned_).find(name), std::string::npos) << "missing";
  EXPECT_NE(refusal(planned_).find("cannot be read"), std::string::npos);
  write("");
  EXPECT_NE(refusal(planned_).find("empty"), std::string::npos);
  write("scene,bodies\nstacks,10\n");
  EXPECT_NE(refusal(planned_).find(name + ":1: must start with"), std::string::npos);
  write(write_scaling_csv({}));
  EXPECT_NE(refusal(planned_).find("no rows"), std::string::npos);
  write(write_scaling_csv(planned_) + "stacks,10\n");
  EXPECT_NE(refusal(planned_).find(name + ":3: must have"), std::string::npos);
  const std::string once = write_scaling_csv(planned_);
  write(once + once.substr(once.find('\n') + 1));
  EXPECT_NE(refusal(planned_).find(name + ":3: a second row of stacks of 10"), std::string::npos);
}

TEST_F(ScalingFile, WithABadNumberIsRefusedByFieldValueAndBound) {
  const auto expect = [&](const std::string& column, const std::string& value,
                          const std::string& bound) {
    write(with_field(column, value));
    const std::string text = refusal(planned_);
    EXPECT_NE(text.find(file_.string() + ":2: " + column + ": must be " + bound), std::string::npos)
        << text;
    EXPECT_NE(text.find(value), std::string::npos) << text;
  };
  expect("bodies", "0", "an integer >= 1");
  expect("bodies", "9999999999", "at most 1000000000");
  expect("threads", "two", "an integer >= 1");
  expect("steps", "1.5", "an integer >= 1");
  expect("pivots", "-2", "an integer >= -1");
  expect("factorizations", "99999999999999999999", "an integer >= -1");
  expect("step_s", "-0.5", "nan, or finite and >= 0");
  expect("floor_s", "inf", "nan, or finite and >= 0");
  expect("error", "0.1x", "nan, or finite and >= 0");
  write(with_field("step_s", "0.5"));
  EXPECT_EQ(refusal(planned_), "not refused");
}

TEST_F(ScalingFile, OfOtherRunsAloneIsRefused) {
  write(write_scaling_csv({answer("stacks", 30)}));
  EXPECT_NE(refusal(planned_).find("none of the runs"), std::string::npos);
  EXPECT_NE(refusal(planned_).find("stacks of 10 bodies"), std::string::npos);
}

TEST(ScalingBaseline, TheSameRunPasses) {
  const std::vector<ScalingRow> rows = {answer("stacks", 10), answer("pile", 10)};
  const BaselineComparison same = compare(rows, rows);
  EXPECT_TRUE(same.passed());
  EXPECT_EQ(same.compared, 2);
  EXPECT_TRUE(same.better.empty());
  EXPECT_TRUE(same.slower.empty());
}

TEST(ScalingBaseline, AnyCountThatGrewFailsAndOneThatFellDoesNot) {
  const std::vector<ScalingRow> stored = {answer("stacks", 10)};
  for (const auto& [name, count] : kScalingCounts) {
    std::vector<ScalingRow> rows = stored;
    rows[0].counts.*count += 1;
    const BaselineComparison grown = compare(rows, stored);
    EXPECT_FALSE(grown.passed()) << name;
    ASSERT_EQ(grown.worse.size(), 1U) << name;
    EXPECT_NE(grown.worse[0].find(name), std::string::npos);
    const BaselineComparison fell = compare(stored, rows);
    EXPECT_TRUE(fell.passed()) << name;
    EXPECT_EQ(fell.better.size(), 1U) << name;
  }
}

TEST(ScalingBaseline, ATimeIsOnlyTold) {
  const std::vector<ScalingRow> stored = {answer("stacks", 10)};
  std::vector<ScalingRow> rows = stored;
  rows[0].costs.step *= 3.0;
  const BaselineComparison comparison = compare(rows, stored);
  EXPECT_TRUE(comparison.passed());
  EXPECT_EQ(comparison.slower.size(), 1U);
  EXPECT_NE(to_text(comparison).find("slower (no failure): stacks of 10"), std::string::npos);
}

TEST(ScalingBaseline, AnAnswerThatIsGoneFails) {
  const std::vector<ScalingRow> stored = {answer("stacks", 10)};
  std::vector<ScalingRow> rows = stored;
  rows[0].failure = "time limit";
  EXPECT_FALSE(compare(rows, stored).passed());
  EXPECT_TRUE(compare(stored, rows).passed());
}

TEST(ScalingBaseline, OtherSizesAreNamedAndAreNoFailure) {
  const BaselineComparison comparison =
      compare({answer("stacks", 10), answer("stacks", 30)}, {answer("stacks", 10)});
  EXPECT_TRUE(comparison.passed());
  EXPECT_EQ(comparison.compared, 1);
  ASSERT_EQ(comparison.not_stored.size(), 1U);
  EXPECT_NE(comparison.not_stored[0].find("stacks of 30"), std::string::npos);
}

TEST(ScalingReport, GrowthIsTheSlopeInLogarithmsOfTheLargeSizes) {
  ScalingReport report;
  for (const int bodies : {10, 100, 1000, 10000}) {
    ScalingRow row = answer("stacks", bodies);
    row.costs.step = bodies < kGrowthFrom ? 1.0 : 1e-6 * std::pow(bodies, 1.5);
    row.costs.move = ScalingCosts::kUnknown;
    report.rows.push_back(row);
    row.threads = 2;
    row.costs.step = 1.0;
    report.rows.push_back(row);
  }
  const std::vector<ScalingGrowth> growth = report.growth();
  const auto of = [&](std::string_view cost) {
    return std::ranges::find(growth, cost, &ScalingGrowth::cost);
  };
  ASSERT_NE(of("step_s"), growth.end());
  EXPECT_NEAR(of("step_s")->exponent, 1.5, 1e-12);
  EXPECT_EQ(of("move_s"), growth.end());
  EXPECT_TRUE(report.passed());
  report.rows[0].failure = "time limit";
  EXPECT_TRUE(report.passed());
  report.rows[0].is_wrong = true;
  EXPECT_FALSE(report.passed());
}

TEST(ScalingOptions, OutOfRangeAreRefusedByName) {
  const auto refusal = [](const ScalingOptions& options) -> std::string {
    try {
      validate(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "not refused";
  };
  ScalingOptions good;
  good.run.bytes = 1;
  EXPECT_EQ(refusal(good), "not refused");
  ScalingOptions bad = good;
  bad.max_bodies = 100001;
  EXPECT_NE(refusal(bad).find("bodies: must be in [10, 100000], got 100001"), std::string::npos);
  bad = good;
  bad.scenes = {"castle"};
  EXPECT_NE(refusal(bad).find("castle"), std::string::npos);
  bad = good;
  bad.run.steps = 0;
  EXPECT_NE(refusal(bad).find("steps"), std::string::npos);
  bad = good;
  bad.run.threads = {2, 1};
  EXPECT_NE(refusal(bad).find("threads"), std::string::npos);
  bad = good;
  bad.run.threads = {1, 1};
  EXPECT_NE(refusal(bad).find("threads"), std::string::npos);
  bad = good;
  bad.run.accuracy = "rough";
  EXPECT_NE(refusal(bad), "not refused");
}

TEST(ScalingScenes, HaveTheBodiesThatAreAskedForAndStartApart) {
  for (const std::string_view name : scaling_scene_names()) {
    for (const int bodies : {1, 10, 55, 210}) {  // whole pyramids
      const ScalingScene scaling = make_scaling_scene(name, bodies);
      EXPECT_EQ(scaling.scene.bodies.size(), static_cast<std::size_t>(bodies) + 1) << name;
      EXPECT_EQ(scaling.scene.state.size(), scaling.scene.bodies.size());
    }
  }
  EXPECT_THROW((void)make_scaling_scene("stacks", 0), std::invalid_argument);
  EXPECT_THROW((void)make_scaling_scene("castle", 10), std::invalid_argument);
}

TEST(MemoryBandwidth, IsANumberOfBytes) {
  EXPECT_GT(measure_memory_bandwidth(2), 1e6);
}

/// The study itself, as small as it can be.
class SmallStudy : public testing::Test {
 protected:
  static ScalingOptions options() {
    ScalingOptions options;
    options.max_bodies = 10;
    options.run.threads = {1, 2};
    options.run.steps = 2;
    options.run.bytes = std::size_t{4} << 30;
    return options;
  }
};

TEST_F(SmallStudy, AnswersEveryPlannedRowTheSameTwice) {
  const ScalingReport first = run_scaling_study(options());
  const ScalingReport second = run_scaling_study(options());
  std::ostringstream log;
  print(first, log);
  EXPECT_TRUE(first.passed()) << log.str();
  for (const ScalingRow& planned : planned_rows(options())) {
    const auto found = std::ranges::find(first.rows, scaling_key(planned), scaling_key);
    ASSERT_NE(found, first.rows.end()) << scaling_key(planned);
    EXPECT_EQ(found->failure, "");
    EXPECT_GT(found->costs.step, 0.0);
    EXPECT_GT(found->counts.contacts, 0);
    EXPECT_GT(found->counts.solves, 0);
    EXPECT_LE(found->costs.residual, 1e-8);
    if (found->threads == 1) {
      EXPECT_GT(found->costs.broad, 0.0);
      EXPECT_GT(found->costs.narrow, 0.0);
      EXPECT_GE(found->counts.allocations, 0);
    }
  }
  EXPECT_TRUE(compare(first.rows, second.rows).worse.empty())
      << to_text(compare(first.rows, second.rows));
  EXPECT_NE(log.str().find("stacks"), std::string::npos);
}

TEST_F(SmallStudy, ALimitOfMemoryOrTimeIsNamedAndNoWrongAnswer) {
  ScalingOptions tight = options();
  tight.scenes = {"stacks"};
  tight.bullet_iterations = 0;
  tight.run.cpu_seconds = 1e-9;
  const ScalingReport report = run_scaling_study(tight);
  ASSERT_EQ(report.rows.size(), 1U);
  EXPECT_NE(report.rows[0].failure.find("time limit"), std::string::npos);
  EXPECT_TRUE(report.passed());
}

}  // namespace
}  // namespace signorini::bench
