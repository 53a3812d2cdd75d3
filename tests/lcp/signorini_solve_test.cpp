// Runs the program itself: SIGNORINI_SOLVE is its path.

#include <signorini/lcp/io/problem_folder.h>
#include <signorini/lcp/solver.h>

#include "tests/lcp/temporary_folder.h"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/wait.h>

namespace signorini::lcp {
namespace {

struct Outcome {
  int exit_code;
  std::string out;
  std::string err;
};

/// Runs `signorini-solve ARGUMENTS` through the shell. Arguments hold no quotes or blanks.
Outcome run(const std::string& arguments) {
  const TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string();
  const std::string err = (folder.path() / "err").string();
  const std::string command =
      std::string(SIGNORINI_SOLVE) + " " + arguments + " >" + out + " 2>" + err + " </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// True if the table, which ends where its columns are explained, has a row of the solver.
bool has_a_row_of(const std::string& out, std::string_view solver) {
  const std::string table = out.substr(0, out.find("\nwork:"));
  std::string cell = "  ";
  cell += solver;
  return contains(table, cell + "  ") || contains(table, cell + ": ");
}

/// [2 1; 1 4] z + (-1, -2): z = (2, 3) / 7.
class SignoriniSolve : public testing::Test {
 protected:
  SignoriniSolve() {
    write("problem.txt", "kind lcp\nsize 2\n");
    write("W.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 2\n2 1 1\n2 2 4\n");
    write("q.mtx", "%%MatrixMarket matrix array real general\n2 1\n-1\n-2\n");
  }
  void write(const char* name, const std::string& text) { folder_.write(name, text); }
  [[nodiscard]] std::string path() const { return folder_.path().string(); }
  /// 0 z = w - 1 has no solution: the ray proves it.
  void make_infeasible() {
    write("W.mtx", "%%MatrixMarket matrix coordinate real general\n2 2 1\n1 1 1\n");
  }
  /// The same with a free first row and q_0 = 3: z = (-2, 1).
  void make_mixed() {
    write("problem.txt", "kind mlcp\nsize 2\nfree 1\n");
    write("q.mtx", "%%MatrixMarket matrix array real general\n2 1\n3\n-2\n");
  }

  TemporaryFolder folder_;
};

TEST_F(SignoriniSolve, SolvesWithExitCodeZeroAndNamesTheSolverThatRan) {
  const Outcome result = run(path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "solver      ")) << result.out;
  EXPECT_TRUE(contains(result.out, "tried       ")) << result.out;
  EXPECT_TRUE(contains(result.out, "status      solved")) << result.out;
  EXPECT_TRUE(contains(result.out, "natural")) << result.out;
  EXPECT_TRUE(contains(result.out, "unit-free")) << result.out;
  EXPECT_TRUE(contains(result.out, "rounding floor")) << result.out;
  EXPECT_EQ(result.err, "");
}

TEST_F(SignoriniSolve, EverySolverAnswersByItsNameOrSaysWhyItRefuses) {
  const Problem problem = read_problem(path());
  for (const std::string_view name : solver_names()) {
    std::string arguments = path() + " --json --solver ";
    arguments += name;
    arguments += name.ends_with("-float") ? " --tolerance 1e-4" : "";  // the digits of float
    const Outcome result = run(arguments);
    if (const std::string why = make_solver(name)->refuses(problem); !why.empty()) {
      EXPECT_EQ(result.exit_code, 64);
      EXPECT_TRUE(contains(result.err, why)) << result.err;
      continue;
    }
    ASSERT_EQ(result.exit_code, 0) << name << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["solver"].get<std::string>().substr(0, name.size()), name);
    EXPECT_EQ(json["status"], "solved");
  }
}

TEST_F(SignoriniSolve, JsonHasThePromisedKeys) {
  const Outcome result = run(path() + " --solver lemke --json");
  const auto json = nlohmann::json::parse(result.out);
  for (const char* key : {"status", "solver", "detail", "iterations", "pivots", "factorizations",
                          "factor_bytes", "solve_seconds", "certificate", "ray_bound"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_LE(json["certificate"]["natural_residual"], 1e-8);
  EXPECT_LE(json["certificate"]["unit_free_residual"], 1e-8);
  EXPECT_GE(json["pivots"], 1);
  EXPECT_TRUE(json["iterations"].is_number() || json["iterations"].is_null());
}

TEST_F(SignoriniSolve, IslandsAreCertifiedOnRequestInTextAndJson) {
  const Outcome without = run(path() + " --json");
  EXPECT_FALSE(nlohmann::json::parse(without.out).contains("islands"));
  // Rows 1 and 3 are one island, row 2 another; z = (1, 0, 1).
  write("problem.txt", "kind lcp\nsize 3\n");
  write("W.mtx",
        "%%MatrixMarket matrix coordinate real symmetric\n3 3 4\n1 1 2\n3 1 1\n2 2 4\n3 3 2\n");
  write("q.mtx", "%%MatrixMarket matrix array real general\n3 1\n-3\n1e6\n-3\n");
  const Outcome result = run(path() + " --solver lemke --islands --json");
  const auto islands = nlohmann::json::parse(result.out)["islands"];
  ASSERT_EQ(islands.size(), 2U);
  EXPECT_EQ(islands[0]["rows"], (std::vector<int>{0, 2}));
  EXPECT_EQ(islands[1]["rows"], (std::vector<int>{1}));
  EXPECT_TRUE(islands[0]["solved"]);
  EXPECT_LE(islands[0]["certificate"]["unit_free_residual"], 1e-8);
  // From a starved solve: the whole is solved to 3e-6, the island by itself is not at all.
  const Outcome starved =
      run(path() + " --solver lemke --max-iterations 0 --tolerance 1e-5 --islands");
  EXPECT_EQ(starved.exit_code, 0) << starved.out;
  EXPECT_TRUE(contains(starved.out, "islands     2, 1 of them solved by themselves"))
      << starved.out;
  EXPECT_TRUE(contains(starved.out, "not solved")) << starved.out;
  const Outcome all = run(path() + " --solver all --islands --json");
  EXPECT_EQ(nlohmann::json::parse(all.out)["results"][0]["islands"].size(), 2U);
}

TEST_F(SignoriniSolve, OutputHasOneNumberALineWith17Digits) {
  const Outcome result = run(path() + " --solver exact --output " + path() + "/z.txt");
  if (result.exit_code == 64) {
    GTEST_SKIP() << "built without GMP: " << result.err;
  }
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read_text(folder_.path() / "z.txt"), "0.2857142857142857\n0.42857142857142855\n");
  EXPECT_EQ(entries_in(folder_.path()), 4) << "something else was left";
}

TEST_F(SignoriniSolve, StarvedSolveExitsWithTwoAndSaysWhatItWrote) {
  const Outcome result =
      run(path() + " --solver pgs --max-iterations 1 --output " + path() + "/z.txt");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.out, "iteration limit")) << result.out;
  EXPECT_TRUE(contains(result.err, "NOT a solution")) << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "z.txt"));
}

TEST_F(SignoriniSolve, InfeasibleExitsWithTwoAndPrintsTheProof) {
  make_infeasible();
  const Outcome result = run(path());
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_TRUE(contains(result.out, "status      infeasible")) << result.out;
  EXPECT_TRUE(contains(result.out, "Z = inf")) << result.out;
  const auto json = nlohmann::json::parse(run(path() + " --json").out);
  EXPECT_EQ(json["status"], "infeasible");
  EXPECT_EQ(json["ray_bound"], "inf");
}

/// Opposite walls whose normals are rounded: the ray (1, 1) has M^T y = (2^-53, 0), q.y = -2.
/// (There is a solution, of the size of that bound.)
TEST_F(SignoriniSolve, NoSolutionBelowPrintsZ) {
  write("W.mtx",
        "%%MatrixMarket matrix coordinate real general\n2 2 4\n1 1 1\n1 2 -1\n"
        "2 1 -0.99999999999999989\n2 2 1\n");
  write("q.mtx", "%%MatrixMarket matrix array real general\n2 1\n-1\n-1\n");
  const Outcome result = run(path() + " --solver lemke");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.out, "status      no solution below Z")) << result.out;
  EXPECT_TRUE(contains(result.out, "|z|_1 >= Z = 1.80144e+16")) << result.out;
}

TEST_F(SignoriniSolve, MixedProblemIsSolvedAndTheAttemptsAreListed) {
  make_mixed();
  const Outcome result = run(path());
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_TRUE(contains(result.out, "1 free row")) << result.out;
  EXPECT_TRUE(contains(result.out, "tried       ")) << result.out;
}

TEST_F(SignoriniSolve, AllPrintsATableOfEverySolver) {
  const Outcome result = run(path() + " --solver all");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "\nverdict     ")) << result.out;
  for (const std::string_view name : solver_names()) {
    const bool refused = !make_solver(name)->refuses(read_problem(path())).empty();
    EXPECT_NE(has_a_row_of(result.out, name), refused) << name << "\n" << result.out;
  }
  const auto json = nlohmann::json::parse(run(path() + " --solver all --json").out);
  EXPECT_EQ(json["results"].size() + json["left_out"].size(), solver_names().size());
}

TEST_F(SignoriniSolve, AllExitsWithTwoWhenNobodySolved) {
  make_infeasible();
  EXPECT_EQ(run(path() + " --solver all").exit_code, 2);
}

TEST_F(SignoriniSolve, BadUsageExitsWith64AndNamesTheOption) {
  const auto bad = [](const std::string& arguments, const std::string& part) {
    const Outcome result = run(arguments);
    EXPECT_EQ(result.exit_code, 64) << arguments;
    EXPECT_TRUE(contains(result.err, part)) << arguments << ": " << result.err;
  };
  bad("", "PROBLEM");
  bad(path() + " extra", "extra");
  bad(path() + " --no-such-option", "--no-such-option");
  bad(path() + " --tolerance abc", "--tolerance");
  bad(path() + " --tolerance 0", "tolerance: must be");
  bad(path() + " --tolerance nan", "tolerance: must be");
  bad(path() + " --max-iterations -2", "max_iterations: must be >= 0");
  bad(path() + " --time-limit 0", "time_limit: must be > 0");
  bad(path() + " --output " + path() + "/no/z.txt", "--output: " + path() + "/no is not a folder");
  bad(path() + " --output " + path(), "not a regular file");
}

TEST_F(SignoriniSolve, UnknownSolverExitsWith64AndListsTheKnownOnes) {
  const Outcome result = run(path() + " --solver gauss");
  EXPECT_EQ(result.exit_code, 64);
  EXPECT_TRUE(contains(result.err, "no solver is called 'gauss'; known: auto, ")) << result.err;
  for (const std::string_view name : solver_names()) {
    EXPECT_TRUE(contains(result.err, std::string(name))) << result.err;
  }
}

TEST_F(SignoriniSolve, SolverThatCannotTakeTheProblemExitsWith64) {
  make_mixed();
  const Outcome result = run(path() + " --solver apgd");  // its M is given whole
  EXPECT_EQ(result.exit_code, 64);
  EXPECT_TRUE(contains(result.err, "--solver apgd: ")) << result.err;
}

TEST_F(SignoriniSolve, MissingFilesExitWith65AndAreNamed) {
  const Outcome folder = run(path() + "/absent");
  EXPECT_EQ(folder.exit_code, 65);
  EXPECT_TRUE(contains(folder.err, "absent: expected a problem folder")) << folder.err;
  for (const char* name : {"q.mtx", "W.mtx", "problem.txt"}) {
    const std::string text = read_text(folder_.path() / name);
    std::filesystem::remove(folder_.path() / name);
    const Outcome result = run(path());
    EXPECT_EQ(result.exit_code, 65);
    EXPECT_TRUE(contains(result.err, std::string(name) + ": no such file")) << result.err;
    folder_.write(name, text);
  }
}

TEST_F(SignoriniSolve, BadInputExitsWith65NamingFileLineAndExpectation) {
  const auto bad = [this](const std::string& matrix, const std::string& part) {
    write("W.mtx", "%%MatrixMarket matrix coordinate real general\n" + matrix);
    const Outcome result = run(path() + " --json --output " + path() + "/z.txt");
    EXPECT_EQ(result.exit_code, 65) << part;
    EXPECT_TRUE(contains(result.err, path() + "/W.mtx" + part)) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(entries_in(folder_.path()), 3) << "an output was left";
  };
  bad("2 2 3\n1 1 1\n", ":3: the size line declares 3 entries, the file ends after 1");
  bad("2 2 1\n1 1 nan\n", ":3: value: expected a finite number");
  bad("2 3 1\n1 1 1\n", ": expected a square matrix, found 2 x 3");
  bad("2 2 1\n1 5 1\n", ":3: column index: expected an integer from 1 to 2, found '5'");
  bad("3 3 1\n1 1 1\n", ": expected 2 x 2 (problem.txt: size 2), found 3 x 3");
  bad("1000000000 1000000000 1\n1 1 1\n", ": expected 2 x 2");
}

TEST_F(SignoriniSolve, FrictionLawIsChosenAndReported) {
  write("problem.txt", "kind fc2d\nsize 2\n");
  write("mu.mtx", "%%MatrixMarket matrix array real general\n1 1\n0.5\n");
  // Whether a solver takes cones or not: the program says what the problem is, and fails by name.
  const Outcome coulomb = run(path());
  EXPECT_TRUE(contains(coulomb.out, "1 friction cone (Coulomb law)")) << coulomb.out << coulomb.err;
  const Outcome associated = run(path() + " --friction-law associated");
  EXPECT_TRUE(contains(associated.out, "(associated law)")) << associated.out << associated.err;
  EXPECT_EQ(run(path() + " --friction-law dry").exit_code, 64);
}

TEST_F(SignoriniSolve, DumpedProblemIsReplayedWithItsRecord) {
  const std::string dump = path() + "/dump";
  const Outcome first = run(path() + " --solver pgs --dump " + dump + ":all");
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(contains(first.err, "dump: 1 solves written to " + dump)) << first.err;
  const Outcome again = run(dump + "/000001 --solver lemke");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_TRUE(contains(again.out, "recorded    pgs: solved")) << again.out;
  EXPECT_FALSE(contains(again.out, "warm start")) << again.out;
}

TEST_F(SignoriniSolve, WarmStartIsTakenFromAFileAndRecorded) {
  write("z0.txt", "0.2857142857142857\n0.42857142857142855\n");
  const std::string dump = path() + "/dump";
  const Outcome first =
      run(path() + " --solver pgs --warm-start " + path() + "/z0.txt --dump " + dump);
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(contains(first.out, "warm start  " + path() + "/z0.txt")) << first.out;
  EXPECT_EQ(read_text(folder_.path() / "dump" / "000001" / "warm_start.txt"),
            read_text(folder_.path() / "z0.txt"));
  const Outcome warm = run(dump + "/000001 --solver pgs");
  EXPECT_TRUE(contains(warm.out, "warm start  recorded with the problem")) << warm.out;
  EXPECT_FALSE(contains(run(dump + "/000001 --cold").out, "warm start"));
  EXPECT_EQ(run(path() + " --cold --warm-start z0.txt").exit_code, 64);
  write("z0.txt", "1\n");
  const Outcome wrong = run(path() + " --warm-start " + path() + "/z0.txt");
  EXPECT_EQ(wrong.exit_code, 65);
  EXPECT_TRUE(contains(wrong.err, "expected 2 numbers, one a line, found 1")) << wrong.err;
}

TEST_F(SignoriniSolve, EnvironmentVariableDumps) {
  const std::string dump = path() + "/dump";
  ::setenv("SIGNORINI_DUMP", (dump + ":unsolved").c_str(), 1);
  const Outcome solved = run(path());
  make_infeasible();
  const Outcome unsolved = run(path() + " --solver lemke");
  ::setenv("SIGNORINI_DUMP", (dump + ":often").c_str(), 1);
  const Outcome wrong = run(path());
  ::unsetenv("SIGNORINI_DUMP");
  EXPECT_TRUE(contains(solved.err, "dump: 0 solves written")) << solved.err;
  EXPECT_TRUE(contains(unsolved.err, "dump: 1 solves written")) << unsolved.err;
  EXPECT_EQ(wrong.exit_code, 64);
  EXPECT_TRUE(contains(wrong.err, "SIGNORINI_DUMP: expected one of all, ")) << wrong.err;
}

#ifdef SIGNORINI_HAS_HDF5
TEST_F(SignoriniSolve, FclibFileIsSolvedAndAMalformedOneExitsWith65) {
  const std::string dump = path() + "/dump";
  EXPECT_EQ(run(path() + " --solver lemke --dump " + dump + ":hdf5").exit_code, 0);
  const Outcome result = run(dump + "/000001.hdf5");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "n = 2, sparse, 4 entries")) << result.out;
  write("broken.hdf5", "not HDF5");
  const Outcome broken = run(path() + "/broken.hdf5");
  EXPECT_EQ(broken.exit_code, 65);
  EXPECT_TRUE(contains(broken.err, "broken.hdf5: expected a whole HDF5 file")) << broken.err;
  EXPECT_EQ(run(path() + "/absent.hdf5").exit_code, 65);
}
#endif

TEST_F(SignoriniSolve, FactoredProblemIsSolved) {
  std::filesystem::remove(folder_.path() / "W.mtx");
  write("problem.txt", "kind lcp\nform factored\nsize 2\nbodies 1\n");
  write("M.mtx",
        "%%MatrixMarket matrix coordinate real symmetric\n6 6 6\n1 1 1\n2 2 1\n3 3 1\n4 4 1\n5 5 "
        "1\n6 6 1\n");
  write("H.mtx", "%%MatrixMarket matrix coordinate real general\n6 2 2\n3 1 1\n3 2 1\n");
  write("f.mtx", "%%MatrixMarket matrix array real general\n6 1\n0\n0\n-1\n0\n0\n0\n");
  write("w.mtx", "%%MatrixMarket matrix array real general\n2 1\n0\n0\n");
  const Outcome result = run(path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "n = 2, factored, 1 blocks, 6 degrees of freedom"))
      << result.out;
}

TEST_F(SignoriniSolve, TimeLimitExitsWithTwoOrZeroAndNeverHangs) {
  const Outcome result = run(path() + " --solver pgs --time-limit 1e-9");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.out, "time limit")) << result.out;
}

TEST(SignoriniSolveHelp, HelpAndVersionExitWithZero) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* word : {"--solver", "--tolerance", "--max-iterations", "--time-limit",
                           "--output", "--json", "--version", "lemke", "Exit code"}) {
    EXPECT_TRUE(contains(help.out, word)) << word;
  }
  const Outcome version = run("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out.substr(0, 16), "signorini-solve ");
}

TEST_F(SignoriniSolve, FullStandardOutputIsNoSuccess) {
  if (!std::filesystem::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full";
  }
  const std::string command = std::string(SIGNORINI_SOLVE) + " " + path() + " >/dev/full 2>&1";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 73);
}

}  // namespace
}  // namespace signorini::lcp
