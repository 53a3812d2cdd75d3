#include "tools/job_list.h"

#include "tests/tools/four_ranks.h"
#include "tools/job_files.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace signorini::tools {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

class JobList : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  struct Outcome {
    int exit_code = -1;
    std::string output;
    std::string results;
  };
  /// The program on 24 jobs, started by `how`.
  [[nodiscard]] Outcome run(const std::string& how, int processes,
                            const std::string& settings = "s") const {
    const std::string command = how + " " + arguments(processes, settings) + " 2>&1";
    Outcome outcome;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    std::array<char, 4096> bytes = {};
    while (const std::size_t got = std::fread(bytes.data(), 1, bytes.size(), pipe)) {
      outcome.output.append(bytes.data(), got);
    }
    const int status = ::pclose(pipe);
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.results = read(folder_ / "results");
    return outcome;
  }
  [[nodiscard]] std::string arguments(int processes, const std::string& settings) const {
    return std::string(SIGNORINI_JOB_LIST_PROGRAM) + " 24 " + std::to_string(processes) + " " +
           kept().string() + " " + settings + " " + (folder_ / "log").string() + " " +
           (folder_ / "results").string();
  }
  [[nodiscard]] fs::path kept() const { return folder_ / "jobs"; }
  [[nodiscard]] std::size_t count_kept() const {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(kept())) {
      count += entry.path().extension() == ".job" ? 1 : 0;
    }
    return count;
  }

  /// Starts the program, sends it a signal once some jobs are finished, waits for its end.
  void run_and_kill(const std::string& how, int processes, int signal) const {
    const pid_t child = ::fork();
    if (child == 0) {
      ::setpgid(0, 0);
      const std::string command = "exec " + how + " " + arguments(processes, "s") + " >/dev/null";
      ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      ::_exit(127);
    }
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!fs::exists(kept()) || count_kept() < 5) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "no five jobs in a minute";
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (signal == SIGKILL) ::kill(-child, SIGKILL);  // of mpirun: its ranks
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      ("jobs_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(JobList, ResultsDoNotDependOnTheNumberOfProcesses) {
  const Outcome one = run("", 1);
  EXPECT_EQ(one.exit_code, 0) << one.output;
  EXPECT_EQ(lines(one.results), 24U);
  EXPECT_EQ(one.output.find("SHARED"), std::string::npos) << one.output;
  fs::remove_all(kept());
  const Outcome four = run("", 4);
  EXPECT_EQ(four.exit_code, 0) << four.output;
  EXPECT_EQ(four.results, one.results);
  EXPECT_NE(four.output.find("up to 4 jobs ran at once: their TIMES ARE OF A SHARED MACHINE"),
            std::string::npos)
      << four.output;
}

TEST_F(JobList, WhatWasFinishedIsTakenOverUnderTheSameSettingsAlone) {
  const Outcome first = run("", 2);
  EXPECT_EQ(count_kept(), 24U);
  const Outcome again = run("", 1);
  EXPECT_NE(again.output.find("taken over: 24"), std::string::npos) << again.output;
  EXPECT_NE(again.output.find("SHARED MACHINE"), std::string::npos) << "as they were measured";
  EXPECT_EQ(again.results, first.results);
  EXPECT_EQ(lines(read(folder_ / "log")), 24U);
  const Outcome other = run("", 2, "t");
  EXPECT_NE(other.output.find("taken over: 0"), std::string::npos) << other.output;
  EXPECT_EQ(lines(read(folder_ / "log")), 48U);
}

TEST_F(JobList, AKilledRunGoesOnWhereItWas) {
  run_and_kill("", 2, SIGKILL);
  const std::size_t finished = count_kept();
  EXPECT_GE(finished, 5U);
  EXPECT_LT(finished, 24U);
  const Outcome rest = run("", 2);
  EXPECT_EQ(rest.exit_code, 0);
  EXPECT_NE(rest.output.find("taken over: " + std::to_string(finished)), std::string::npos)
      << rest.output;
  // Each once, but for the two that were being done, or had just been, when it was killed.
  EXPECT_LE(lines(read(folder_ / "log")), 26U);
  fs::remove_all(kept());
  EXPECT_EQ(run("", 1).results, rest.results);
}

TEST_F(JobList, AnInterruptedRunHasWhatIsFinished) {
  run_and_kill("", 2, SIGINT);
  const std::string results = read(folder_ / "results");
  EXPECT_EQ(lines(results), 24U);
  EXPECT_NE(results.find("done "), std::string::npos);
  EXPECT_NE(results.find("not \n"), std::string::npos);
}

TEST_F(JobList, ACrashIsThatJobsAlone) {
  const Outcome outcome = run("", 3, "crash");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.results.find("not signal 9 (Killed)\n"), std::string::npos);
  EXPECT_EQ(lines(read(folder_ / "log")), 23U);
  EXPECT_EQ(count_kept(), 23U);
}

TEST_F(JobList, ADamagedFileIsNoResult) {
  const Outcome first = run("", 2);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kept())) files.push_back(entry.path());
  ASSERT_GE(files.size(), 4U);
  fs::resize_file(files[0], fs::file_size(files[0]) - 1);
  std::ofstream(files[1]) << "no result";
  fs::copy_file(files[3], files[2], fs::copy_options::overwrite_existing);  // another job's
  const Outcome again = run("", 1);
  EXPECT_NE(again.output.find("taken over: 21"), std::string::npos) << again.output;
  EXPECT_EQ(again.results, first.results);
}

TEST_F(JobList, BadListsAreRefused) {
  const auto nothing = [] { return std::string(); };
  EXPECT_THROW((void)run_job_list({{"a", nothing}}, {.processes = 0}), std::invalid_argument);
  EXPECT_THROW((void)run_job_list({{"a", nothing}, {"a", nothing}}, {}), std::invalid_argument);
  std::ofstream(folder_ / "file") << "x";
  EXPECT_THROW((void)run_job_list({{"a", nothing}}, {.folder = folder_ / "file" / "jobs"}),
               std::runtime_error);
  EXPECT_TRUE(run_job_list({}, {}).jobs.empty());
}

TEST_F(JobList, AnExceptionIsTheReason) {
  const std::vector<Job> jobs = {{"bad", []() -> std::string { throw std::runtime_error("why"); }},
                                 {"good", [] { return std::string("g"); }}};
  const JobListResult result = run_job_list(jobs, {.folder = kept()});
  EXPECT_FALSE(result.jobs[0].is_done);
  EXPECT_EQ(result.first_failure(jobs), "bad: why");
  EXPECT_EQ(result.jobs[1].bytes, "g");
  forget_finished_jobs(jobs, kept());
  EXPECT_FALSE(fs::exists(kept()));
}

#ifdef SIGNORINI_MPIRUN
TEST_F(JobList, FourRanksGiveWhatOneProcessGives) {
  const Outcome serial = run("", 1);
  fs::remove_all(kept());
  const Outcome ranks = run(kFourRanks, 1);
  EXPECT_EQ(ranks.exit_code, 0) << ranks.output;
  EXPECT_NE(ranks.output.find("ranks: 4\n"), std::string::npos) << ranks.output;
  EXPECT_EQ(ranks.output.find("ranks: "), ranks.output.rfind("ranks: ")) << "one leader";
  EXPECT_EQ(ranks.results, serial.results);
  EXPECT_EQ(lines(read(folder_ / "log")), 48U);
}

TEST_F(JobList, KilledRanksGoOnWhereTheyWere) {
  const std::string how = kFourRanks.substr(kFourRanks.find(SIGNORINI_MPIRUN));
  ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  run_and_kill(how, 1, SIGKILL);
  const std::size_t finished = count_kept();
  EXPECT_GE(finished, 5U);
  const Outcome rest = run(kFourRanks, 1);
  EXPECT_EQ(rest.exit_code, 0) << rest.output;
  // Those that were being written when it was killed may have come after the count.
  const std::size_t at = rest.output.find("taken over: ");
  ASSERT_NE(at, std::string::npos) << rest.output;
  EXPECT_GE(std::stoul(rest.output.substr(at + 12)), finished);
  fs::remove_all(kept());
  EXPECT_EQ(run("", 1).results, rest.results);
}

TEST_F(JobList, RanksRefuseAsManyProcessesMore) {
  const Outcome outcome = run(kFourRanks, 2);
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_NE(outcome.output.find("under MPI the ranks do the jobs; must be 1, got 2"),
            std::string::npos)
      << outcome.output;
}
#endif

}  // namespace
}  // namespace signorini::tools
