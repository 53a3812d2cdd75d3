#include <signorini/lcp/io/problem_folder.h>
#include <signorini/lcp/io/result_writer.h>
#include <signorini/lcp/io/whole_file.h>

#include "tests/lcp/temporary_folder.h"

#include <Eigen/LU>
#include <cmath>
#include <csignal>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <sys/resource.h>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::filesystem::path kShared = SIGNORINI_SHARED_DIR;

/// A 2-row LCP in the given form.
void write_given(const TemporaryFolder& folder) {
  folder.write("problem.txt", "kind lcp\nsize 2\ncontacts 2\ndimension 1\nfree 0\nsymmetric 1\n");
  folder.write("W.mtx",
               "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 2\n2 1 1\n2 2 4\n");
  folder.write("q.mtx", "%%MatrixMarket matrix array real general\n2 1\n-1\n-2\n");
}

/// Two bodies, three contacts; the first body's mass couples x with its rotation, so its block is
/// full, the second's is diagonal.
void write_factored(const TemporaryFolder& folder) {
  folder.write("problem.txt",
               "kind lcp\nform factored\nsize 3\ncontacts 3\ndimension 1\nfree 0\nbodies 2\n");
  std::string M = "%%MatrixMarket matrix coordinate real symmetric\n12 12 13\n";
  for (int i = 1; i <= 12; ++i) {
    M += std::to_string(i) + " " + std::to_string(i) + " " + std::to_string(i + 1) + "\n";
    if (i == 5) {
      M += "5 1 0.5\n";
    }
  }
  folder.write("M.mtx", M);
  folder.write("H.mtx",
               "%%MatrixMarket matrix coordinate real general\n12 3 6\n3 1 1\n5 1 -0.25\n1 2 -1\n"
               "7 2 1\n9 3 1\n12 3 2\n");
  folder.write(
      "f.mtx",
      "%%MatrixMarket matrix array real general\n12 1\n1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n11\n12\n");
  folder.write("w.mtx", "%%MatrixMarket matrix array real general\n3 1\n0.5\n0\n-3\n");
}

/// The message of the InputError, the folder's name cut off; "" if the folder was read.
std::string error_of(
    const TemporaryFolder& folder, const std::function<void(const std::filesystem::path&)>& read =
                                       [](const auto& path) { (void)read_problem_folder(path); }) {
  try {
    read(folder.path());
  } catch (const InputError& error) {
    const std::string what = error.what();
    const std::string start = folder.path().string() + "/";
    return what.starts_with(start) ? what.substr(start.size()) : what;
  }
  return "";
}

TEST(ProblemFolder, ReadsTheGivenForm) {
  const TemporaryFolder folder;
  write_given(folder);
  const ProblemFolder read = read_problem_folder(folder.path());
  EXPECT_EQ(read.kind, "lcp");
  EXPECT_EQ(read.contacts, 2);
  EXPECT_EQ(read.dimension, 1);
  EXPECT_TRUE(read.problem.is_lcp());
  EXPECT_EQ(to_dense(read.problem.M), (Matrix(2, 2) << 2.0, 1.0, 1.0, 4.0).finished());
  EXPECT_EQ(read.problem.q, Vector(Eigen::Vector2d(-1.0, -2.0)));
}

TEST(ProblemFolder, ReadsTheFactoredFormWithTheBodiesBlocks) {
  const TemporaryFolder folder;
  write_factored(folder);
  const ProblemFolder read = read_problem_folder(folder.path());
  const auto& A = std::get<FactoredMatrix>(read.problem.M);
  ASSERT_EQ(A.mass.block_count(), 2);
  EXPECT_EQ(A.mass.dimension(0), 6);
  EXPECT_EQ(A.mass.dimension(1), 6);
  EXPECT_EQ(A.entries(0).size(), 1U);
  EXPECT_EQ(A.entries(1).size(), 2U);
  EXPECT_EQ(A.entries(2).size(), 1U);

  Matrix M = Matrix(Vector::LinSpaced(12, 2.0, 13.0).asDiagonal());
  M(0, 4) = M(4, 0) = 0.5;
  Matrix H = Matrix::Zero(12, 3);
  H(2, 0) = 1.0, H(4, 0) = -0.25, H(0, 1) = -1.0, H(6, 1) = 1.0, H(8, 2) = 1.0, H(11, 2) = 2.0;
  const Matrix W = H.transpose() * M.inverse() * H;
  const Vector q =
      H.transpose() * M.inverse() * Vector::LinSpaced(12, 1.0, 12.0) + Eigen::Vector3d(0.5, 0, -3);
  // Products of at most 12 numbers of size 1, condition number of M 6.5: well below 100 eps.
  EXPECT_LE((to_dense(read.problem.M) - W).cwiseAbs().maxCoeff(), 2e-14);
  EXPECT_LE((read.problem.q - q).cwiseAbs().maxCoeff(), 2e-14);
}

TEST(ProblemFolder, WithoutBodiesTheBlocksAreTheConnectedPartsOfM) {
  const TemporaryFolder folder;
  write_factored(folder);
  folder.write("problem.txt", "kind lcp\nsize 3\n");
  const ProblemFolder read = read_problem_folder(folder.path());
  const auto& A = std::get<FactoredMatrix>(read.problem.M);
  EXPECT_EQ(A.mass.block_count(), 11);  // rows 1 and 5 are one block, the other ten stand alone
  EXPECT_EQ(A.mass.dimension(0), 2);
  const TemporaryFolder with_bodies;
  write_factored(with_bodies);
  const Problem same = read_problem(with_bodies.path());
  EXPECT_LE((to_dense(read.problem.M) - to_dense(same.M)).cwiseAbs().maxCoeff(), 2e-15);
  EXPECT_EQ(read.problem.q, same.q);
}

TEST(ProblemFolder, DiagonalMassIsInvertedWithOneRounding) {
  const TemporaryFolder folder;
  folder.write("problem.txt", "kind lcp\nform factored\nsize 1\n");
  folder.write("M.mtx", "%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 3\n");
  folder.write("H.mtx", "%%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 1\n");
  folder.write("f.mtx", "%%MatrixMarket matrix array real general\n1 1\n-2\n");
  folder.write("w.mtx", "%%MatrixMarket matrix array real general\n1 1\n0\n");
  const Problem problem = read_problem(folder.path());
  EXPECT_EQ(to_dense(problem.M)(0, 0), 1.0 / 3.0);
  EXPECT_EQ(problem.q[0], -2.0 / 3.0);
}

TEST(ProblemFolder, MixedProblemHasFreeFirstRows) {
  const TemporaryFolder folder;
  write_given(folder);
  folder.write("problem.txt", "kind mlcp\nsize 2\ncontacts 1\ndimension 1\nfree 1\n");
  const ProblemFolder read = read_problem_folder(folder.path());
  EXPECT_EQ(read.free, 1);
  EXPECT_EQ(read.problem.lower, Vector(Eigen::Vector2d(-kInfinity, 0.0)));
  EXPECT_FALSE(read.problem.is_lcp());
  EXPECT_EQ(read_problem(folder.path()).lower, read.problem.lower);
}

TEST(ProblemFolder, FrictionKindsAreReadAndNoProblemOfBoundsIsMadeOfThem) {
  const TemporaryFolder folder;
  write_given(folder);
  folder.write("problem.txt", "kind fc2d\nsize 2\ncontacts 1\ndimension 2\n");
  folder.write("mu.mtx", "%%MatrixMarket matrix array real general\n1 1\n0.3\n");
  const ProblemFolder read = read_problem_folder(folder.path());
  EXPECT_EQ(read.dimension, 2);
  EXPECT_EQ(read.mu, Vector(Vector::Constant(1, 0.3)));
  EXPECT_EQ(error_of(folder, [](const auto& path) { (void)read_problem(path); }),
            "problem.txt: kind: fc2d has friction cones, which no solver here takes yet; expected "
            "lcp or mlcp");
}

struct BadFolder {
  const char* name;
  void (*start)(const TemporaryFolder&);
  const char* file;
  std::string text;  // "-": the file is removed
  std::string message;
};

void PrintTo(const BadFolder& bad, std::ostream* stream) {
  *stream << bad.name;
}

class RefusesFolder : public testing::TestWithParam<BadFolder> {};

TEST_P(RefusesFolder, NamingFileAndKey) {
  const BadFolder& bad = GetParam();
  const TemporaryFolder folder;
  bad.start(folder);
  if (bad.text == "-") {
    std::filesystem::remove(folder.path() / bad.file);
  } else {
    folder.write(bad.file, bad.text);
  }
  std::string expected = bad.message;
  if (const auto at = expected.find("FOLDER/"); at != std::string::npos) {
    expected.replace(at, 7, folder.path().string() + "/");
  }
  EXPECT_EQ(error_of(folder), expected);
}

const std::string kCoordinates = "%%MatrixMarket matrix coordinate real general\n";
const std::string kColumn = "%%MatrixMarket matrix array real general\n";

INSTANTIATE_TEST_SUITE_P(
    ProblemFolder, RefusesFolder,
    testing::Values(
        BadFolder{"NoDescription", write_given, "problem.txt", "-", "problem.txt: no such file"},
        BadFolder{"NoMatrix", write_given, "W.mtx", "-", "W.mtx: no such file"},
        BadFolder{"NoQ", write_given, "q.mtx", "-", "q.mtx: no such file"},
        BadFolder{"NoKind", write_given, "problem.txt", "size 2\n",
                  "problem.txt: kind: expected this key, found none"},
        BadFolder{"NoSize", write_given, "problem.txt", "kind lcp\n",
                  "problem.txt: size: expected this key, found none"},
        BadFolder{"UnknownKind", write_given, "problem.txt", "size 2\nkind qp\n",
                  "problem.txt:2: kind: expected lcp, mlcp, fc2d or fc3d, found 'qp'"},
        BadFolder{"KeyWithoutValue", write_given, "problem.txt", "kind lcp\nsize\n",
                  "problem.txt:2: size: expected a value, found the end of the line"},
        BadFolder{"KeyWithTwoValues", write_given, "problem.txt", "kind lcp\nsize 2 3\n",
                  "problem.txt:2: expected the end of the line after the value of size, found '3'"},
        BadFolder{"KeyTwice", write_given, "problem.txt", "kind lcp\nsize 2\nsize 3\n",
                  "problem.txt:3: size: was given before, in line 2"},
        BadFolder{"SizeNotANumber", write_given, "problem.txt", "kind lcp\nsize two\n",
                  "problem.txt:2: size: expected an integer from 0 to 2147483647, found 'two'"},
        BadFolder{"SizeOverflows", write_given, "problem.txt", "kind lcp\nsize 99999999999\n",
                  "problem.txt:2: size: expected an integer from 0 to 2147483647, found "
                  "'99999999999'"},
        BadFolder{"ContactsAgainstSize", write_given, "problem.txt",
                  "kind lcp\nsize 2\ncontacts 3\n",
                  "problem.txt:2: size: expected contacts * dimension + free = 3 * 1 + 0, found 2"},
        BadFolder{"FreeInAnLcp", write_given, "problem.txt", "kind lcp\nsize 2\nfree 1\n",
                  "problem.txt:3: free: expected at most 0 for kind lcp and size 2, found 1"},
        BadFolder{"MoreFreeThanRows", write_given, "problem.txt", "kind mlcp\nsize 2\nfree 3\n",
                  "problem.txt:3: free: expected at most 2 for kind mlcp and size 2, found 3"},
        BadFolder{"DimensionAgainstKind", write_given, "problem.txt",
                  "kind lcp\nsize 2\ndimension 3\n",
                  "problem.txt:3: dimension: expected 1 for kind lcp, found 3"},
        BadFolder{"SizeAgainstQ", write_given, "problem.txt", "kind lcp\nsize 3\n",
                  "q.mtx: expected 3 x 1 (problem.txt: size 3), found 2 x 1"},
        BadFolder{"MatrixNotSquare", write_given, "W.mtx", kCoordinates + "2 3 1\n1 1 1\n",
                  "W.mtx: expected a square matrix, found 2 x 3"},
        BadFolder{"MatrixTooLarge", write_given, "W.mtx", kCoordinates + "3 3 1\n1 1 1\n",
                  "W.mtx: expected 2 x 2 (problem.txt: size 2), found 3 x 3"},
        BadFolder{"MatrixHuge", write_given, "W.mtx",
                  kCoordinates + "1000000000 1000000000 1\n1 1 1\n",
                  "W.mtx: expected 2 x 2 (problem.txt: size 2), found 1000000000 x 1000000000"},
        BadFolder{"FactoredWithW", write_given, "problem.txt", "kind lcp\nform factored\nsize 2\n",
                  "problem.txt:2: form: factored, but the folder has a W.mtx"},
        BadFolder{"UnknownForm", write_given, "problem.txt", "kind lcp\nform dense\nsize 2\n",
                  "problem.txt:2: form: expected factored, found 'dense'"},
        BadFolder{"FrictionWithoutMu", write_given, "problem.txt", "kind fc2d\nsize 2\n",
                  "mu.mtx: no such file"},
        BadFolder{"NoH", write_factored, "H.mtx", "-", "H.mtx: no such file"},
        BadFolder{"BodiesAgainstM", write_factored, "problem.txt",
                  "kind lcp\nform factored\nsize 3\nbodies 3\n",
                  "problem.txt:4: bodies: expected the 12 rows of M.mtx / 6, found 3"},
        BadFolder{"HTooShort", write_factored, "H.mtx", kCoordinates + "11 3 1\n1 1 1\n",
                  "H.mtx: expected 12 x 3 (f.mtx has 12 rows, problem.txt: size 3), found 11 x 3"},
        BadFolder{"MNotSquare", write_factored, "M.mtx", kCoordinates + "12 11 1\n1 1 1\n",
                  "M.mtx: expected 12 x 12 (f.mtx has 12 rows), found 12 x 11"},
        BadFolder{"ZeroMass", write_factored, "M.mtx", kCoordinates + "12 12 1\n1 1 1\n",
                  "M.mtx: block of rows 1 to 6: BlockMass: mass: must be positive definite"},
        BadFolder{"TooLongW", write_factored, "w.mtx", kColumn + "4 1\n1\n1\n1\n1\n",
                  "w.mtx: expected 3 x 1 (problem.txt: size 3), found 4 x 1"},
        BadFolder{"QOverflows", write_factored, "w.mtx", kColumn + "3 1\n1.7e308\n1e400\n1\n",
                  "w.mtx:4: value: expected a finite number in the range of double, found "
                  "'1e400'"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(ProblemFolder, NegativeFrictionCoefficientIsNamed) {
  const TemporaryFolder folder;
  write_given(folder);
  folder.write("problem.txt", "kind fc2d\nsize 2\n");
  folder.write("mu.mtx", kColumn + "1 1\n-0.25\n");
  EXPECT_EQ(error_of(folder),
            "mu.mtx: contact 1: expected a friction coefficient >= 0, found -0.250000");
}

TEST(ProblemFolder, NegativeOrUnsymmetricMassIsNamed) {
  const TemporaryFolder folder;
  write_factored(folder);
  std::string M = kCoordinates + "12 12 12\n";
  for (int i = 1; i <= 12; ++i) {
    M += std::to_string(i) + " " + std::to_string(i) + (i == 8 ? " -1\n" : " 1\n");
  }
  folder.write("M.mtx", M);
  EXPECT_EQ(error_of(folder),
            "M.mtx: block of rows 7 to 12: BlockMass: mass: must be positive definite");
  M.replace(M.find("12 12 12"), 8, "12 12 13");
  M.replace(M.find("-1"), 2, "1");
  folder.write("M.mtx", M + "2 1 0.5\n");
  EXPECT_EQ(
      error_of(folder).find("M.mtx: block of rows 1 to 6: BlockMass: mass: must be symmetric"), 0U)
      << error_of(folder);
}

TEST(ProblemFolder, OneHugeBlockIsRefusedBeforeItIsStored) {
  const TemporaryFolder folder;
  constexpr int kRows = 100000;
  std::string M = kCoordinates + "100000 100000 199999\n";
  std::string f = kColumn + "100000 1\n";
  for (int i = 1; i <= kRows; ++i) {
    M += std::to_string(i) + " " + std::to_string(i) + " 4\n";
    M += i < kRows ? std::to_string(i + 1) + " " + std::to_string(i) + " 1\n" : "";
    f += "0\n";
  }
  folder.write("problem.txt", "kind lcp\nform factored\nsize 0\n");
  folder.write("M.mtx", M);
  folder.write("H.mtx", kCoordinates + "100000 0 0\n");
  folder.write("f.mtx", f);
  folder.write("w.mtx", kColumn + "0 1\n");
  EXPECT_EQ(error_of(folder),
            "M.mtx: block of rows 1 to 100000: 100000 coupled rows, expected at most 256");
}

TEST(ProblemFolder, NamesWhatIsNotAFolder) {
  const TemporaryFolder folder;
  const auto file = folder.write("a", "x");
  EXPECT_THROW((void)read_problem_folder(file), InputError);
  EXPECT_THROW((void)read_problem_folder(folder.path() / "absent"), InputError);
}

TEST(ProblemFolder, EmptyProblemIsRead) {
  const TemporaryFolder folder;
  folder.write("problem.txt", "kind lcp\nsize 0\n");
  folder.write("W.mtx", kCoordinates + "0 0 0\n");
  folder.write("q.mtx", kColumn + "0 1\n");
  EXPECT_EQ(read_problem(folder.path()).size(), 0);
}

TEST(ProblemFolder, GivenFormRoundTripsToTheBit) {
  const TemporaryFolder folder;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  ProblemFolder original;
  original.kind = "mlcp";
  original.free = 2;
  original.contacts = 5;
  original.problem.M = Matrix(Matrix::NullaryExpr(7, 7, [&] { return normal(random); }));
  original.problem.q = Vector::NullaryExpr(7, [&] { return normal(random); });
  original.problem.lower = Vector::Zero(7);
  original.problem.lower.head(2).setConstant(-kInfinity);
  write_problem_folder(original, folder.path() / "copy");
  const ProblemFolder read = read_problem_folder(folder.path() / "copy");
  EXPECT_EQ(read.kind, "mlcp");
  EXPECT_EQ(to_dense(read.problem.M), to_dense(original.problem.M));
  EXPECT_EQ(read.problem.q, original.problem.q);
  EXPECT_EQ(read.problem.lower, original.problem.lower);
  EXPECT_EQ(entries_in(folder.path()), 1) << "a partial folder was left";
}

TEST(ProblemFolder, FactoredFormRoundTrips) {
  const TemporaryFolder folder;
  write_factored(folder);
  const ProblemFolder original = read_problem_folder(folder.path());
  write_problem_folder(original, folder.path() / "copy");
  const ProblemFolder read = read_problem_folder(folder.path() / "copy");
  EXPECT_EQ(read.bodies, 2);
  EXPECT_EQ(read.problem.q, original.problem.q);
  EXPECT_EQ(read_text(folder.path() / "copy" / "H.mtx"), read_text(folder.path() / "H.mtx"));
  EXPECT_LE((to_dense(read.problem.M) - to_dense(original.problem.M)).cwiseAbs().maxCoeff(), 2e-15);
}

TEST(ProblemFolder, FrictionRoundTrips) {
  const TemporaryFolder folder;
  write_given(folder);
  folder.write("problem.txt", "kind fc2d\nsize 2\n");
  folder.write("mu.mtx", kColumn + "1 1\n0.3\n");
  write_problem_folder(read_problem_folder(folder.path()), folder.path() / "copy");
  EXPECT_EQ(read_problem_folder(folder.path() / "copy").mu[0], 0.3);
}

TEST(ProblemFolder, WritesNothingWhenItCannotWriteAll) {
  const TemporaryFolder folder;
  write_given(folder);
  const ProblemFolder original = read_problem_folder(folder.path());
  EXPECT_THROW(write_problem_folder(original, folder.path()), std::runtime_error);
  EXPECT_THROW(write_problem_folder(original, folder.path() / "no" / "such"), std::runtime_error);
  EXPECT_EQ(entries_in(folder.path()), 3);
}

TEST(ProblemFolder, RefusesToWriteWhatTheFormatCannotSay) {
  const TemporaryFolder folder;
  write_given(folder);
  const ProblemFolder original = read_problem_folder(folder.path());
  const auto refused = [&](const std::function<void(ProblemFolder&)>& change) {
    ProblemFolder changed = original;
    change(changed);
    EXPECT_THROW(write_problem_folder(changed, folder.path() / "copy"), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "copy"));
  };
  refused([](ProblemFolder& p) { p.problem.upper = Vector::Constant(2, 1.0); });
  refused([](ProblemFolder& p) { p.problem.limits.push_back({1, 0, 0.5}); });
  refused([](ProblemFolder& p) { p.free = 1; });
  refused([](ProblemFolder& p) { p.contacts = 3; });
  refused([](ProblemFolder& p) { p.mu = Vector::Ones(2); });
  refused([](ProblemFolder& p) {
    FactoredMatrix A;
    A.add_row(1.0);
    A.add_row();
    p.problem.M = std::move(A);
  });
}

/// The global form of four problems of the collection comes with its W and q: read as factored it
/// must give them. Their M is given with 7 to 10 digits' worth of symmetry, W was made in double:
/// agreement is bounded by eps times the condition number of M's blocks, here below 1e-10.
TEST(ProblemFolder, FactoredReadingAgreesWithTheCollectionsOwnW) {
  const std::filesystem::path collection = kShared / "data" / "contact-problems";
  if (!std::filesystem::exists(collection)) {
    GTEST_SKIP() << "../shared is absent";
  }
  int compared = 0;
  for (const char* name : {"GFC3D_OneContact", "GFC3D_TwoRods1", "GFC3D_Example0"}) {
    const TemporaryFolder folder;
    for (const char* file : {"problem.txt", "M.mtx", "H.mtx", "f.mtx", "w.mtx", "mu.mtx"}) {
      std::filesystem::copy(collection / name / file, folder.path() / file);
    }
    const ProblemFolder factored = read_problem_folder(folder.path());
    const ProblemFolder given = read_problem_folder(collection / name);
    ASSERT_TRUE(std::holds_alternative<FactoredMatrix>(factored.problem.M));
    const Matrix W = to_dense(given.problem.M);
    const double scale = W.cwiseAbs().maxCoeff();
    EXPECT_LE((to_dense(factored.problem.M) - W).cwiseAbs().maxCoeff(), 1e-10 * scale) << name;
    EXPECT_LE((factored.problem.q - given.problem.q).cwiseAbs().maxCoeff(),
              1e-10 * given.problem.q.cwiseAbs().maxCoeff())
        << name;
    ++compared;
  }
  EXPECT_EQ(compared, 3);
}

TEST(ProblemFolder, ReadsEveryFolderOfTheCollection) {
  const std::filesystem::path data = kShared / "data";
  if (!std::filesystem::exists(data)) {
    GTEST_SKIP() << "../shared is absent";
  }
  int count = 0;
  for (const char* part : {"contact-problems", "generated"}) {
    for (const auto& entry : std::filesystem::directory_iterator(data / part)) {
      if (entry.is_directory()) {
        EXPECT_NO_THROW((void)read_problem_folder(entry.path())) << entry.path();
        ++count;
      }
    }
  }
  EXPECT_GE(count, 80);
}

TEST(WholeFile, ReplacesAFileAndLeavesNothingBeside) {
  const TemporaryFolder folder;
  const auto file = folder.write("z.txt", "old");
  write_vector(file, Eigen::Vector3d(0.1, -1e-300, 2.0));
  EXPECT_EQ(read_text(file), "0.10000000000000001\n-1e-300\n2\n");
  EXPECT_EQ(entries_in(folder.path()), 1);
}

TEST(WholeFile, FailsWithoutTouchingAnything) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_whole_file(folder.path() / "no" / "z.txt", "x"), std::runtime_error);
  std::filesystem::create_directory(folder.path() / "z.txt");
  EXPECT_THROW(write_whole_file(folder.path() / "z.txt", "x"), std::runtime_error);
  EXPECT_EQ(entries_in(folder.path()), 1);
}

TEST(WholeFile, FullDiskLeavesTheOldFile) {
  const TemporaryFolder folder;
  const auto file = folder.write("z.txt", "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(write_whole_file(file, std::string(100000, 'x')), std::runtime_error);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(read_text(file), "old");
  EXPECT_EQ(entries_in(folder.path()), 1);
}

TEST(ResultJson, SaysNullWhereThereIsNoNumberAndInfAsText) {
  Result result;
  result.status = Status::kInfeasible;
  result.solver = "lemke";
  result.detail = "a \"quoted\" \xff byte";
  result.statistics.pivots = 7;
  result.ray_bound = kInfinity;
  result.certificate.natural_residual = 0.1;
  const auto json = nlohmann::json::parse(result_json(result));
  EXPECT_EQ(json["status"], "infeasible");
  EXPECT_EQ(json["solved"], false);
  EXPECT_EQ(json["solver"], "lemke");
  EXPECT_EQ(json["pivots"], 7);
  EXPECT_TRUE(json["iterations"].is_null());
  EXPECT_EQ(json["ray_bound"], "inf");
  EXPECT_EQ(json["certificate"]["natural_residual"], 0.1);
  EXPECT_TRUE(json["certificate"]["min_z"].is_null());
  EXPECT_FALSE(json.contains("tried"));
}

}  // namespace
}  // namespace signorini::lcp
