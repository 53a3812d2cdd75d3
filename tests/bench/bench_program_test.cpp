#include "tests/tools/four_ranks.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <string>
#include <sys/wait.h>

namespace {

/// The exit code of signorini-bench; what it prints is dropped.
int run(const std::string& arguments, const std::string& before = "") {
  const int status = std::system(
      (before + " " + std::string(SIGNORINI_BENCH) + " " + arguments + " >/dev/null 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class BenchProgram : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      ("bench_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(BenchProgram, HelpAndVersionExitZero) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_EQ(run("--version"), 0);
  EXPECT_EQ(run("exactness --help"), 0);
}

TEST_F(BenchProgram, BadUsageExits64) {
  EXPECT_EQ(run(""), 64);
  EXPECT_EQ(run("nonsense"), 64);
  EXPECT_EQ(run("exactness --problems -1"), 64);
  EXPECT_EQ(run("exactness --problems many"), 64);
  EXPECT_EQ(run("impacts --problems 3"), 64);
}

TEST_F(BenchProgram, ImpactsWritesItsCsv) {
  EXPECT_EQ(run("impacts --impacts 20 --out '" + folder_.string() + "'"), 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "impacts.csv"));
}

TEST_F(BenchProgram, PeersWritesTableProfileAndCsv) {
  EXPECT_EQ(run("peers --families spheres,murty --sizes 8 --solvers lemke,pgs --out '" +
                folder_.string() + "'"),
            0);
  for (const char* file : {"peers.csv", "peers.md", "peers-profile.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / file)) << file;
  }
  EXPECT_EQ(run("peers --list"), 0);
  EXPECT_EQ(run("peers --time-limit 0"), 64);
  EXPECT_EQ(run("peers --families castle"), 70);
  EXPECT_EQ(run("peers /no/such/folder"), 70);
}

/// The lines of a .csv without the columns that hold times.
std::string without_times(const std::filesystem::path& file) {
  std::ifstream csv(file);
  std::string text;
  std::set<int> times;
  for (std::string line; std::getline(csv, line);) {
    std::istringstream cells(line);
    std::string cell;
    for (int column = 0; std::getline(cells, cell, ','); ++column) {
      if (cell == "seconds") times.insert(column);
      if (times.count(column) == 0) text += cell + ",";
    }
    text += "\n";
  }
  return text;
}

/// Few problems for few solvers.
const std::string kSmallTrade =
    "tradeoff --no-scenes --families tower4,murty --forms lcp --sizes 16 --ratios 1 --dial "
    "1e-4,1e-8 "
    "--solvers auto,lemke,pgs ";

TEST_F(BenchProgram, TradeoffWritesItsPagesAndLeavesNoJobs) {
  EXPECT_EQ(run(kSmallTrade + "--out '" + folder_.string() + "'"), 0);
  for (const char* file : {"tradeoff.csv", "scores.csv", "tradeoff.md", "recommendations.md",
                           "pareto.svg", "profiles.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / file)) << file;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "jobs"));
  EXPECT_EQ(run("tradeoff --jobs 0"), 64);
}

TEST_F(BenchProgram, TradeoffIsTheSameForAnyNumberOfProcessesAndRanks) {
  const auto csv = [&](const std::string& name, const std::string& jobs,
                       const std::string& before) {
    EXPECT_EQ(run(kSmallTrade + jobs + " --out '" + (folder_ / name).string() + "'", before), 0);
    return without_times(folder_ / name / "tradeoff.csv");
  };
  const std::string serial = csv("serial", "", "");
  EXPECT_NE(serial.find(",lemke,"), std::string::npos);
  EXPECT_EQ(csv("processes", "--jobs 3", ""), serial);
#ifdef SIGNORINI_MPIRUN
  EXPECT_EQ(csv("ranks", "", signorini::kFourRanks), serial);
#endif
}

#ifdef SIGNORINI_HAS_SCALING
TEST_F(BenchProgram, ScalingComparesWithABaselineAndFailsOnAWorseCountAlone) {
  const std::string small =
      "scaling --bodies 10 --scenes stacks --steps 1 --threads 1 --bullet-iterations 0 ";
  EXPECT_EQ(run(small + "--out '" + folder_.string() + "'"), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "jobs"));
  const std::filesystem::path stored = folder_ / "scaling.csv";
  std::ifstream in(stored);
  std::stringstream csv;
  csv << in.rdbuf();
  const auto against = [&](const std::string& from, const std::string& to) {
    std::string text = csv.str();
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << text;
    std::ofstream(folder_ / "changed.csv") << text.replace(at, from.size(), to);
    return run(small + "--baseline '" + (folder_ / "changed.csv").string() + "'");
  };
  EXPECT_EQ(against(",,40,120,", ",,40,120,"), 0);  // a tower of ten: 40 contacts
  EXPECT_EQ(against(",,40,120,", ",,39,120,"), 1);
  EXPECT_EQ(against(",,40,120,", ",,41,120,"), 0);
  EXPECT_EQ(against(",,40,120,", ",,many,120,"), 65);
  EXPECT_EQ(against("scene,", "place,"), 65);
  EXPECT_EQ(run(small + "--baseline '" + (folder_ / "absent.csv").string() + "'"), 65);
  EXPECT_EQ(run(small + "--accuracy game --baseline '" + stored.string() + "'"), 65);
  EXPECT_EQ(run("scaling --bodies 5"), 64);
}
#endif

TEST_F(BenchProgram, BulletSetsWritesItsCsvOrSaysThatThereIsNoBullet) {
  const int code = run("bullet-sets --sets stack10 --repeats 1 --out '" + folder_.string() + "'");
#ifdef SIGNORINI_HAS_BULLET
  EXPECT_EQ(code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "bullet-sets.csv"));
#else
  EXPECT_NE(code, 0);
#endif
}

#ifdef SIGNORINI_HAS_BULLET_DROP_IN
TEST_F(BenchProgram, DropInWritesItsCsv) {
  EXPECT_EQ(run("drop-in --scenes stack --seconds 0.1 --out '" + folder_.string() + "'"), 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "drop-in.csv"));
  EXPECT_EQ(run("drop-in --scenes castle"), 64);
}
#endif

TEST_F(BenchProgram, DumpsAStudyAndReplaysItAsASequence) {
  const std::string dump = (folder_ / "dump").string();
  ::setenv("SIGNORINI_DUMP", (dump + ":max=5").c_str(), 1);
  EXPECT_EQ(run("impacts --impacts 3"), 0);
  ::unsetenv("SIGNORINI_DUMP");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "dump" / "000005" / "record.json"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "dump" / "000006"));
  const int code =
      run("sequence '" + dump + "' --solver recorded --out '" + folder_.string() + "'");
  EXPECT_TRUE(code == 0 || code == 2) << code;  // 2: an impact of the five has no answer
  EXPECT_TRUE(std::filesystem::exists(folder_ / "sequence.csv"));
  EXPECT_EQ(run("sequence '" + (folder_ / "absent").string() + "'"), 65);
  EXPECT_EQ(run("sequence"), 64);
}

#ifdef SIGNORINI_HAS_GMP
TEST_F(BenchProgram, ExactnessWritesItsCsvAndNothingElse) {
  EXPECT_EQ(run("exactness --problems 40 --seed 5 --out '" + folder_.string() + "'"), 0);
  std::ifstream csv(folder_ / "exactness.csv");
  std::string header;
  ASSERT_TRUE(std::getline(csv, header));
  EXPECT_EQ(header.rfind("family,solver,status,count,", 0), 0u) << header;
  const auto files = std::filesystem::directory_iterator(folder_);
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST_F(BenchProgram, AFolderThatCannotBeMadeEndsBeforeTheStudy) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "file") << "in the way";
  EXPECT_EQ(run("exactness --problems 1000000 --out '" + (folder_ / "file" / "out").string() + "'"),
            70);
}
#else
TEST_F(BenchProgram, ExactnessSaysThatItNeedsGmp) {
  EXPECT_EQ(run("exactness --problems 1"), 70);
}
#endif

}  // namespace
