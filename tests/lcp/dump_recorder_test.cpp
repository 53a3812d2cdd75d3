#include <signorini/lcp/io/dump_recorder.h>
#include <signorini/lcp/io/recorded_solve.h>
#include <signorini/lcp/solver.h>

#include "tests/lcp/temporary_folder.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <limits>
#include <memory>
#include <string>

namespace signorini::lcp {
namespace {

using When = DumpSettings::When;

/// [2 1; 1 4] z + (-1, -2).
Problem small_problem() {
  Problem problem;
  problem.M = Matrix(Matrix{{2.0, 1.0}, {1.0, 4.0}});
  problem.q = Eigen::Vector2d(-1.0, -2.0);
  return problem;
}

/// 0 z - 1 >= 0.
Problem infeasible_problem() {
  Problem problem;
  problem.M = Matrix(Matrix::Zero(1, 1));
  problem.q = Vector::Constant(1, -1.0);
  return problem;
}

Result solve(const Problem& problem, SolveRecorder* recorder, const Vector* start = nullptr,
             const char* solver = "pgs") {
  Result result;
  make_solver(solver, {.recorder = recorder})->solve(problem, result, start);
  return result;
}

TEST(DumpSettings, AreReadFromText) {
  const DumpSettings plain = DumpSettings::parse("/tmp/dumps");
  EXPECT_EQ(plain.folder, "/tmp/dumps");
  EXPECT_EQ(plain.when, When::kAll);
  EXPECT_TRUE(plain.write_folder);
  EXPECT_FALSE(plain.write_hdf5);
  const DumpSettings all = DumpSettings::parse("a:b:unsolved,both,max=3");
  EXPECT_EQ(all.folder, "a:b");
  EXPECT_EQ(all.when, When::kUnsolved);
  EXPECT_TRUE(all.write_folder);
  EXPECT_TRUE(all.write_hdf5);
  EXPECT_EQ(all.max_count, 3);
  EXPECT_FALSE(DumpSettings::parse("a:hdf5").write_folder);
  for (const char* wrong : {"", ":all", "a:b", "a:max=0", "a:max=", "a:max=9999999999", "a:ALL"}) {
    EXPECT_THROW((void)DumpSettings::parse(wrong), std::invalid_argument) << wrong;
  }
}

TEST(DumpRecorder, WritesEverySolveInOrderWithItsStartAndResult) {
  const TemporaryFolder folder;
  DumpRecorder recorder({.folder = folder.path() / "dump"});
  const Problem problem = small_problem();
  const Result cold = solve(problem, &recorder);
  EXPECT_EQ(cold.detail, "");
  const Result warm = solve(problem, &recorder, &cold.z);
  solve(infeasible_problem(), &recorder, nullptr, "lemke");
  EXPECT_EQ(recorder.written(), 3);
  EXPECT_EQ(summary(recorder), "dump: 3 solves written to " + (folder.path() / "dump").string());

  const auto problems = list_problems(folder.path() / "dump");
  ASSERT_EQ(problems.size(), 3U);
  const RecordedSolve first = read_recorded_solve(problems[0]);
  EXPECT_EQ(first.solver, "pgs");
  EXPECT_EQ(first.status, "solved");
  EXPECT_EQ(first.settings.tolerance, 1e-8);
  EXPECT_EQ(first.settings.time_limit, std::numeric_limits<double>::infinity());
  EXPECT_EQ(first.work, cold.statistics.iterations);
  EXPECT_EQ(first.warm_start.size(), 0);
  EXPECT_EQ(to_dense(first.problem.M), to_dense(problem.M));
  EXPECT_EQ(first.problem.q, problem.q);
  EXPECT_EQ(read_numbers(problems[0] / "z.txt", 2), cold.z);
  const RecordedSolve second = read_recorded_solve(problems[1]);
  EXPECT_EQ(second.warm_start, cold.z);
  EXPECT_EQ(second.work, warm.statistics.iterations);
  EXPECT_EQ(read_recorded_solve(problems[2]).status, "infeasible");
}

TEST(DumpRecorder, AReplayRepeatsTheSolveToTheBit) {
  const TemporaryFolder folder;
  DumpRecorder recorder({.folder = folder.path()});
  const Vector start = Eigen::Vector2d(0.1, 0.7);
  const Result original = solve(small_problem(), &recorder, &start);
  const RecordedSolve recorded = read_recorded_solve(folder.path() / "000001");
  Result again;
  make_solver(recorded.solver, recorded.settings)
      ->solve(recorded.problem, again, &recorded.warm_start);
  EXPECT_EQ(again.z, original.z);
  EXPECT_EQ(again.statistics.iterations, original.statistics.iterations);
}

TEST(DumpRecorder, CanKeepToUnsolvedOnes) {
  const TemporaryFolder folder;
  DumpRecorder recorder({.folder = folder.path(), .when = When::kUnsolved});
  solve(small_problem(), &recorder);
  EXPECT_EQ(recorder.written(), 0);
  solve(infeasible_problem(), &recorder, nullptr, "lemke");
  EXPECT_EQ(recorder.written(), 1);
}

TEST(DumpRecorder, StopsAtItsCountAndGoesOnFromTheLargestNumber) {
  const TemporaryFolder folder;
  DumpRecorder recorder({.folder = folder.path(), .max_count = 2});
  for (int k = 0; k < 5; ++k) {
    solve(small_problem(), &recorder);
  }
  EXPECT_EQ(recorder.written(), 2);
  EXPECT_EQ(recorder.left_out(), 3);
  EXPECT_EQ(entries_in(folder.path()), 2);
  DumpRecorder second({.folder = folder.path()});
  solve(small_problem(), &second);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "000003"));
}

TEST(DumpRecorder, FailureToWriteIsSaidAndBreaksNothing) {
  const TemporaryFolder folder;
  DumpRecorder recorder({.folder = folder.path() / "dump"});
  std::filesystem::remove_all(folder.path() / "dump");
  folder.write("dump", "a file in the way");
  const Result result = solve(small_problem(), &recorder);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_NE(result.detail.find("dump: "), std::string::npos) << result.detail;
  EXPECT_NE(result.detail.find("not written"), std::string::npos) << result.detail;
  EXPECT_EQ(recorder.failed(), 1);
  EXPECT_EQ(entries_in(folder.path()), 1);
}

TEST(DumpRecorder, InvalidProblemsAndStartsThatAreNotFiniteAreWritten) {
  const TemporaryFolder folder;
  DumpRecorder recorder({.folder = folder.path()});
  Problem problem = small_problem();
  const Vector start = Vector::Constant(2, std::numeric_limits<double>::quiet_NaN());
  solve(problem, &recorder, &start);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "000001" / "warm_start.txt"));
  problem.q[0] = start[0];
  solve(problem, &recorder);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "000002" / "record.json"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "000002" / "z.txt"));
}

class Throwing : public SolveRecorder {
 public:
  std::string record(const SolveRecord&) override { throw std::runtime_error("no"); }
};

TEST(SolveRecorder, WhatItThrowsEndsInTheDetail) {
  Throwing recorder;
  const Result result = solve(small_problem(), &recorder);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_EQ(result.detail, "not recorded: no");
}

TEST(DumpRecorder, EnvironmentVariableIsRead) {
  const TemporaryFolder folder;
  ::unsetenv(kDumpVariable);
  EXPECT_EQ(dump_recorder_from_environment(), nullptr);
  ::setenv(kDumpVariable, (folder.path() / "x").c_str(), 1);
  EXPECT_NE(dump_recorder_from_environment(), nullptr);
  ::setenv(kDumpVariable, "/dev/null/x", 1);
  EXPECT_THROW((void)dump_recorder_from_environment(), std::runtime_error);
  ::setenv(kDumpVariable, "x:sometimes", 1);
  EXPECT_THROW((void)dump_recorder_from_environment(), std::invalid_argument);
  ::unsetenv(kDumpVariable);
}

TEST(RecordedSolve, AMalformedRecordIsNamed) {
  const TemporaryFolder folder;
  DumpRecorder recorder({.folder = folder.path()});
  solve(small_problem(), &recorder);
  const auto problem = folder.path() / "000001";
  for (const char* wrong : {"", "{", "{}", "[1]", R"({"solver": 3})"}) {
    folder.write("000001/record.json", wrong);
    EXPECT_THROW((void)read_recorded_solve(problem), InputError) << wrong;
  }
  std::filesystem::remove(problem / "record.json");
  EXPECT_EQ(read_recorded_solve(problem).solver, "");
}

TEST(RecordedSolve, AFolderWithoutProblemsIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW((void)list_problems(folder.path()), InputError);
  EXPECT_THROW((void)list_problems(folder.path() / "absent"), InputError);
}

}  // namespace
}  // namespace signorini::lcp
