#include <signorini/lcp/io/dump_recorder.h>
#include <signorini/lcp/io/input_error.h>

#include "bench/contact_families.h"
#include "bench/sequence_study.h"
#include "tests/lcp/temporary_folder.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <sstream>

namespace signorini::bench {
namespace {

using lcp::TemporaryFolder;
using lcp::Vector;

/// Dumps three solves of a tower whose velocities change by 1 % from step to step, each started
/// from the answer before, and one problem that has no solution.
void dump_sequence(const std::filesystem::path& folder) {
  lcp::DumpRecorder recorder({.folder = folder});
  const auto solver = lcp::make_solver("interior-point", {.recorder = &recorder});
  lcp::Problem problem = make_family({.family = "tower4", .size = 5});
  lcp::Result result;
  solver->solve(problem, result);
  for (int k = 0; k < 2; ++k) {
    const Vector start = result.z;
    problem.q *= 1.01;
    solver->solve(problem, result, &start);
  }
  lcp::Problem walls;
  walls.M = lcp::Matrix(lcp::Matrix{{1.0, -1.0}, {-1.0, 1.0}});
  walls.q = Vector::Constant(2, -1.0);
  lcp::make_solver("lemke", {.recorder = &recorder})->solve(walls, result);
}

TEST(SequenceStudy, ReplaysInOrderColdAndWarm) {
  const TemporaryFolder folder;
  dump_sequence(folder.path());
  std::ostringstream out;
  const SequenceCounts counts =
      run_sequence_study({.folder = folder.path(), .solver = "recorded", .lcp = {}}, out);
  ASSERT_EQ(counts.rows.size(), 4U);
  for (int k = 0; k < 3; ++k) {
    const SequenceRow& row = counts.rows[k];
    EXPECT_EQ(row.name, "00000" + std::to_string(k + 1));
    EXPECT_EQ(row.rows, 20);
    EXPECT_EQ(row.solver, "interior-point");
    EXPECT_EQ(row.recorded_status, "solved");
    EXPECT_TRUE(is_solved(row.cold.status));
    EXPECT_EQ(row.warm.ran, k > 0) << "the first has nothing to start from";
  }
  EXPECT_EQ(counts.rows[3].cold.status, lcp::Status::kInfeasible);
  EXPECT_FALSE(counts.rows[3].warm.ran) << "the answer before has another size";
  EXPECT_EQ(counts.unsolved(), 1);
  const std::string csv = counts.to_csv();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_NE(out.str().find("2 of them also warm"), std::string::npos) << out.str();
}

TEST(SequenceStudy, TakesTheAnswerBeforeWhereNoStartWasRecorded) {
  const TemporaryFolder folder;
  dump_sequence(folder.path());
  std::filesystem::remove(folder.path() / "000002" / "warm_start.txt");
  std::ostringstream out;
  const SequenceCounts counts =
      run_sequence_study({.folder = folder.path(), .solver = "pgs", .lcp = {}}, out);
  EXPECT_TRUE(counts.rows[1].warm.ran);
  EXPECT_LE(counts.rows[1].warm.work, counts.rows[1].cold.work);
}

TEST(SequenceStudy, SaysWhichProblemsASolverRefuses) {
  const TemporaryFolder folder;
  dump_sequence(folder.path());
  std::ostringstream out;
  const SequenceCounts counts =
      run_sequence_study({.folder = folder.path(), .solver = "apgd", .lcp = {}}, out);
  EXPECT_NE(counts.rows[3].refused, "");
  EXPECT_GE(counts.unsolved(), 1);
}

TEST(SequenceStudy, RefusesBadOptionsAndFolders) {
  const TemporaryFolder folder;
  std::ostringstream out;
  EXPECT_THROW(run_sequence_study({.folder = folder.path(), .lcp = {}}, out), lcp::InputError);
  EXPECT_THROW(run_sequence_study({.folder = folder.path(), .lcp = {}, .repeats = 0}, out),
               std::invalid_argument);
}

}  // namespace
}  // namespace signorini::bench
