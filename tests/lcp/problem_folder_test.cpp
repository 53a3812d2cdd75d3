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

/// Three rows: one bounded, one coupled to it, one free.
void write_general(const TemporaryFolder& folder) {
  folder.write("problem.txt", "kind general\nsize 3\n");
  folder.write("W.mtx",
               "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 2\n2 2 1\n3 3 4\n");
  folder.write("q.mtx", "%%MatrixMarket matrix array real general\n3 1\n-1\n-2\n3\n");
  folder.write("lower.mtx", "%%MatrixMarket matrix array real general\n3 1\n-0.5\n0\n-inf\n");
  folder.write("upper.mtx", "%%MatrixMarket matrix array real general\n3 1\n7\ninf\n+inf\n");
  folder.write("limits.txt", "2 1 0.5\n");
}

/// One row on two blocks of a mass, the first by its inverse, the second by its factor.
void write_stored(const TemporaryFolder& folder) {
  folder.write("problem.txt", "kind lcp\nform factored\nsize 1\n");
  folder.write("blocks.txt", "1 inverse\n2 factor\n");
  folder.write("Minv.mtx", "%%MatrixMarket matrix coordinate real symmetric\n3 3 1\n1 1 0.5\n");
  folder.write("L.mtx",
               "%%MatrixMarket matrix coordinate real general\n3 3 3\n2 2 2\n3 2 1\n3 3 4\n");
  folder.write("H.mtx", "%%MatrixMarket matrix coordinate real general\n3 1 2\n1 1 1\n3 1 8\n");
  folder.write("q.mtx", "%%MatrixMarket matrix array real general\n1 1\n-1\n");
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

TEST(ProblemFolder, FrictionKindsAreReadAsCones) {
  const TemporaryFolder folder;
  write_given(folder);
  folder.write("problem.txt", "kind fc2d\nsize 2\ncontacts 1\ndimension 2\n");
  folder.write("mu.mtx", "%%MatrixMarket matrix array real general\n1 1\n0.3\n");
  const ProblemFolder read = read_problem_folder(folder.path());
  EXPECT_EQ(read.dimension, 2);
  ASSERT_EQ(read.problem.cones.size(), 1U);
  EXPECT_EQ(read.problem.cones[0].normal_row, 0);
  EXPECT_EQ(read.problem.cones[0].dimension, 2);
  EXPECT_EQ(read.problem.cones[0].coefficient, 0.3);
  EXPECT_EQ(read.problem.friction_law, FrictionLaw::kCoulomb);
  EXPECT_NO_THROW(check_shapes(read.problem));
  folder.write("problem.txt",
               "kind fc2d\nsize 2\ncontacts 1\ndimension 2\nfriction_law associated\n");
  EXPECT_EQ(read_problem(folder.path()).friction_law, FrictionLaw::kAssociated);
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
                  "problem.txt:2: kind: expected lcp, mlcp, fc2d, fc3d or general, found 'qp'"},
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
        BadFolder{"UnknownLaw", write_given, "problem.txt", "kind lcp\nsize 2\nfriction_law dry\n",
                  "problem.txt:3: friction_law: expected coulomb or associated, found 'dry'"},
        BadFolder{"UnknownStorage", write_given, "problem.txt", "kind lcp\nsize 2\nstorage band\n",
                  "problem.txt:3: storage: expected dense or sparse, found 'band'"},
        BadFolder{"BoundsInAnLcp", write_given, "lower.mtx", kColumn + "2 1\n0\n0\n",
                  "lower.mtx: expected none for kind lcp, only for general"},
        BadFolder{"ConesInAnLcp", write_given, "cones.txt", "1 2 0.5\n",
                  "cones.txt: expected none for kind lcp, only for general"},
        BadFolder{"ComplianceInTheGivenForm", write_given, "compliance.mtx",
                  kColumn + "2 1\n0\n1\n",
                  "compliance.mtx: expected none in the given form, whose W.mtx has it on its "
                  "diagonal"},
        BadFolder{"NegativeCompliance", write_factored, "compliance.mtx",
                  kColumn + "3 1\n0\n-1\n0\n",
                  "compliance.mtx: row 2: expected a compliance >= 0, found -1"},
        BadFolder{"BoundsTooShort", write_general, "upper.mtx", kColumn + "1 1\n1\n",
                  "upper.mtx: expected 3 x 1 (problem.txt: size 3), found 1 x 1"},
        BadFolder{"BoundIsNan", write_general, "upper.mtx", kColumn + "3 1\n1\nnan\n1\n",
                  "upper.mtx:4: value: expected a finite number in the range of double, found "
                  "'nan'"},
        BadFolder{"LimitRowOutOfRange", write_general, "limits.txt", "4 1 0.5\n",
                  "limits.txt:1: row: expected an integer from 1 to 3, found '4'"},
        BadFolder{"LimitNegative", write_general, "limits.txt", "2 1 -0.5\n",
                  "limits.txt:1: friction coefficient: expected a number >= 0, found -0.5"},
        BadFolder{
            "LimitWithTooManyWords", write_general, "limits.txt", "2 1 0.5 7\n",
            "limits.txt:1: expected the end of the line after the friction coefficient, found "
            "'7'"},
        BadFolder{"ConeOfDimensionFour", write_general, "cones.txt", "1 4 0.5\n",
                  "cones.txt:1: dimension: expected an integer from 2 to 3, found '4'"},
        BadFolder{"BlockOfUnknownKind", write_stored, "blocks.txt", "1 inverse\n2 cholesky\n",
                  "blocks.txt:2: expected inverse or factor, found 'cholesky'"},
        BadFolder{"BlocksAgainstMatrix", write_stored, "blocks.txt", "1 inverse\n1 factor\n",
                  "Minv.mtx: expected 2 x 2 (the sum of blocks.txt is 2), found 3 x 3"},
        BadFolder{"BlockInTheWrongFile", write_stored, "Minv.mtx",
                  kCoordinates + "3 3 2\n1 1 1\n2 2 1\n",
                  "Minv.mtx:4: row 2 belongs to a block that blocks.txt gives by its factor"},
        BadFolder{"FactorNotTriangular", write_stored, "L.mtx",
                  kCoordinates + "3 3 3\n2 2 1\n3 3 1\n2 3 1\n",
                  "L.mtx: block of rows 2 to 3: BlockMass: factor: must be square, finite, lower "
                  "triangular and > 0 on its diagonal"},
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
            "mu.mtx: contact 1: expected a friction coefficient >= 0, found -0.25");
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

TEST(ProblemFolder, GeneralProblemHasBoundsLimitsAndCones) {
  const TemporaryFolder folder;
  write_general(folder);
  const Problem problem = read_problem(folder.path());
  EXPECT_EQ(problem.lower, Vector(Eigen::Vector3d(-0.5, 0.0, -kInfinity)));
  EXPECT_EQ(problem.upper, Vector(Eigen::Vector3d(7.0, kInfinity, kInfinity)));
  ASSERT_EQ(problem.limits.size(), 1U);
  EXPECT_EQ(problem.limits[0].row, 1);
  EXPECT_EQ(problem.limits[0].normal_row, 0);
  EXPECT_EQ(problem.limits[0].coefficient, 0.5);
  folder.write("limits.txt", "");
  folder.write("cones.txt", "2 2 0.25\n");
  const Problem cones = read_problem(folder.path());
  ASSERT_EQ(cones.cones.size(), 1U);
  EXPECT_EQ(cones.cones[0].normal_row, 1);
  folder.write("cones.txt", "2 3 0.25\n");
  EXPECT_NE(error_of(folder).find("3 rows do not fit a problem of 3 rows"), std::string::npos)
      << error_of(folder);
}

TEST(ProblemFolder, StoredBlocksAreReadToTheBit) {
  const TemporaryFolder folder;
  write_stored(folder);
  const Problem problem = read_problem(folder.path());
  const auto& A = std::get<FactoredMatrix>(problem.M);
  ASSERT_EQ(A.mass.block_count(), 2);
  EXPECT_FALSE(A.mass.is_factor(0));
  EXPECT_TRUE(A.mass.is_factor(1));
  // L L^T = [4 2; 2 17], whose inverse has 4 / 64 at the end: A = 0.5 + 64 * 4 / 64.
  EXPECT_EQ(to_dense(problem.M)(0, 0), 4.5);
}

/// Problems that use everything a folder can say.
struct RoundTrip {
  const char* name;
  Problem (*make)();
  const char* kind;
};

void PrintTo(const RoundTrip& tested, std::ostream* stream) {
  *stream << tested.name;
}

double draw(std::mt19937_64& random) {
  return std::normal_distribution<double>()(random);
}

Problem random_dense(int n) {
  std::mt19937_64 random(11);
  Problem problem;
  problem.M = Matrix(Matrix::NullaryExpr(n, n, [&] { return draw(random); }));
  problem.q = Vector::NullaryExpr(n, [&] { return draw(random); });
  return problem;
}

Problem random_mixed() {
  Problem problem = random_dense(7);
  problem.lower = Vector::Zero(7);
  problem.lower.head(2).setConstant(-kInfinity);
  return problem;
}

Problem random_bounded() {
  Problem problem = random_dense(7);
  problem.lower = Vector::Constant(7, -0.1);
  problem.upper = Vector::Constant(7, kInfinity);
  problem.upper[3] = 1.0 / 3.0;
  problem.limits = {{5, 6, 0.7}, {4, 6, 0.0}};
  return problem;
}

Problem random_cones() {
  Problem problem = random_dense(6);
  problem.cones = {{0, 3, 0.1}, {3, 3, 0.0}};
  problem.friction_law = FrictionLaw::kAssociated;
  return problem;
}

Problem random_mixed_cones() {
  Problem problem = random_dense(7);
  problem.cones = {{1, 3, 0.1}, {4, 2, 0.3}};
  problem.lower = Vector::Zero(7);
  problem.lower[0] = -kInfinity;
  return problem;
}

Problem random_factored() {
  std::mt19937_64 random(5);
  FactoredMatrix A;
  const Matrix G = Matrix::NullaryExpr(6, 6, [&] { return draw(random); });
  A.mass.add_mass(G * G.transpose() + Matrix::Identity(6, 6));
  A.mass.add_inverse(Matrix(Vector::LinSpaced(3, 0.1, 0.7).asDiagonal()));
  A.mass.add_inverse(Matrix::Zero(1, 1));
  Problem problem;
  problem.q = Vector::NullaryExpr(4, [&] { return draw(random); });
  for (int i = 0; i < 4; ++i) {
    A.add_row(i == 2 ? 1e-3 : 0.0);
    A.add_entry(0, Vector::NullaryExpr(6, [&] { return draw(random); }));
    if (i % 2 == 0) {
      A.add_entry(1, Vector::NullaryExpr(3, [&] { return draw(random); }));
    }
  }
  problem.M = std::move(A);
  return problem;
}

Problem empty() {
  return random_dense(0);
}

class RoundTrips : public testing::TestWithParam<RoundTrip> {};

TEST_P(RoundTrips, ToTheBitInTheSameForm) {
  const Problem original = GetParam().make();
  const TemporaryFolder folder;
  write_problem_folder(original, folder.path() / "copy", {{"note.txt", "beside"}});
  EXPECT_EQ(entries_in(folder.path()), 1) << "a partial folder was left";
  EXPECT_EQ(read_text(folder.path() / "copy" / "note.txt"), "beside");
  const ProblemFolder read = read_problem_folder(folder.path() / "copy");
  EXPECT_EQ(read.kind, GetParam().kind);
  const Problem& problem = read.problem;
  EXPECT_EQ(problem.M.index(), original.M.index());
  EXPECT_EQ(to_dense(problem.M), to_dense(original.M));
  EXPECT_EQ(problem.q, original.q);
  EXPECT_EQ(problem.friction_law, original.friction_law);
  if (read.kind == std::string("general")) {
    EXPECT_EQ(problem.lower, original.lower);
    EXPECT_EQ(problem.upper, original.upper);
  }
  ASSERT_EQ(problem.limits.size(), original.limits.size());
  for (std::size_t k = 0; k < problem.limits.size(); ++k) {
    EXPECT_EQ(problem.limits[k].row, original.limits[k].row);
    EXPECT_EQ(problem.limits[k].normal_row, original.limits[k].normal_row);
    EXPECT_EQ(problem.limits[k].coefficient, original.limits[k].coefficient);
  }
  ASSERT_EQ(problem.cones.size(), original.cones.size());
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    EXPECT_EQ(problem.cones[k].normal_row, original.cones[k].normal_row);
    EXPECT_EQ(problem.cones[k].dimension, original.cones[k].dimension);
    EXPECT_EQ(problem.cones[k].coefficient, original.cones[k].coefficient);
  }
}

INSTANTIATE_TEST_SUITE_P(ProblemFolder, RoundTrips,
                         testing::Values(RoundTrip{"Dense", [] { return random_dense(5); }, "lcp"},
                                         RoundTrip{"Empty", empty, "lcp"},
                                         RoundTrip{"Sparse",
                                                   [] {
                                                     Problem problem = random_dense(5);
                                                     problem.M = SparseMatrix(
                                                         std::get<Matrix>(problem.M).sparseView());
                                                     return problem;
                                                   },
                                                   "lcp"},
                                         RoundTrip{"Mixed", random_mixed, "mlcp"},
                                         RoundTrip{"Bounded", random_bounded, "general"},
                                         RoundTrip{"Cones", random_cones, "fc3d"},
                                         RoundTrip{"MixedCones", random_mixed_cones, "general"},
                                         RoundTrip{"Factored", random_factored, "lcp"}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(ProblemFolder, BlocksAndComplianceRoundTrip) {
  const TemporaryFolder folder;
  const Problem original = random_factored();
  write_problem_folder(original, folder.path() / "copy");
  const Problem problem = read_problem(folder.path() / "copy");
  const auto& A = std::get<FactoredMatrix>(problem.M);
  const auto& B = std::get<FactoredMatrix>(original.M);
  ASSERT_EQ(A.mass.block_count(), B.mass.block_count());
  for (int b = 0; b < A.mass.block_count(); ++b) {
    EXPECT_EQ(A.mass.is_factor(b), B.mass.is_factor(b));
    EXPECT_EQ(Matrix(A.mass.stored(b)), Matrix(B.mass.stored(b)));
  }
  for (int i = 0; i < A.rows(); ++i) {
    EXPECT_EQ(A.compliance(i), B.compliance(i));
    EXPECT_EQ(A.entries(i).size(), B.entries(i).size());
  }
}

TEST(ProblemFolder, FactoredFormOfACollectionIsCopiedToTheBit) {
  const TemporaryFolder folder;
  write_factored(folder);
  const ProblemFolder original = read_problem_folder(folder.path());
  write_problem_folder(original.problem, folder.path() / "copy");
  const ProblemFolder read = read_problem_folder(folder.path() / "copy");
  EXPECT_EQ(read.problem.q, original.problem.q);
  EXPECT_EQ(read_text(folder.path() / "copy" / "H.mtx"), read_text(folder.path() / "H.mtx"));
  EXPECT_EQ(to_dense(read.problem.M), to_dense(original.problem.M));
}

TEST(ProblemFolder, WhatIsNotFiniteIsWrittenAndNotReadBack) {
  const TemporaryFolder folder;
  Problem problem = random_dense(2);
  problem.q[1] = std::numeric_limits<double>::quiet_NaN();
  write_problem_folder(problem, folder.path() / "copy");
  EXPECT_NE(read_text(folder.path() / "copy" / "q.mtx").find("nan"), std::string::npos);
  EXPECT_THROW((void)read_problem(folder.path() / "copy"), InputError);
}

TEST(ProblemFolder, WritesNothingWhenItCannotWriteAll) {
  const TemporaryFolder folder;
  write_given(folder);
  const Problem original = read_problem(folder.path());
  EXPECT_THROW(write_problem_folder(original, folder.path()), std::runtime_error);
  EXPECT_THROW(write_problem_folder(original, folder.path() / "no" / "such"), std::runtime_error);
  Problem wrong = original;
  wrong.limits.push_back({7, 0, 1.0});
  EXPECT_THROW(write_problem_folder(wrong, folder.path() / "copy"), std::invalid_argument);
  EXPECT_EQ(entries_in(folder.path()), 3);
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
  const auto json = nlohmann::json::parse(result_json(result, 1e-8));
  EXPECT_EQ(json["status"], "infeasible");
  EXPECT_EQ(json["solved"], false);
  EXPECT_EQ(json["solver"], "lemke");
  EXPECT_EQ(json["pivots"], 7);
  EXPECT_TRUE(json["iterations"].is_null());
  EXPECT_EQ(json["ray_bound"], "inf");
  EXPECT_EQ(json["certificate"]["natural_residual"], 0.1);
  EXPECT_TRUE(json["certificate"]["min_z"].is_null());
  EXPECT_FALSE(json.contains("attempts"));
  EXPECT_FALSE(json.contains("friction_law"));
  result.attempts.emplace_back().solver = "pgs";
  const auto with_attempts = nlohmann::json::parse(result_json(result, 1e-8, "Coulomb"));
  EXPECT_EQ(with_attempts["attempts"][0]["solver"], "pgs");
  EXPECT_TRUE(with_attempts["attempts"][0]["pivots"].is_null());
  EXPECT_EQ(with_attempts["friction_law"], "Coulomb");
}

}  // namespace
}  // namespace signorini::lcp
