// Every lcp folder of ../shared/data with n <= 600, and the generated factored ones with n <= 1024.

#include <signorini/lcp/io/problem_folder.h>
#include <signorini/lcp/solver.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kMaxFrictionRows = 120;
constexpr int kMaxRows = 120;  // sanitizers slow this down by ten and more
constexpr int kMaxGeneratedRows = 120;
#else
constexpr int kMaxFrictionRows = 5000;
constexpr int kMaxRows = 600;
constexpr int kMaxGeneratedRows = 1024;
#endif
constexpr int kMaxExactRows = 60;
constexpr double kTolerance = 1e-8;

struct Folder {
  std::string name;
  fs::path path;
  int size;
};

void PrintTo(const Folder& folder, std::ostream* stream) {
  *stream << folder.name << ", n = " << folder.size;
}

/// The value of a key of problem.txt, "" if absent: enough to choose the folders by.
std::string value_of(const fs::path& folder, const std::string& key) {
  std::ifstream stream(folder / "problem.txt");
  std::string name;
  std::string value;
  while (stream >> name >> value) {
    if (name == key) {
      return value;
    }
  }
  return "";
}

std::vector<Folder> folders(const char* part, int max_rows, const char* kind = "lcp") {
  std::vector<Folder> found;
  const fs::path root = fs::path(SIGNORINI_SHARED_DIR) / "data" / part;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(root, absent)) {
    if (value_of(entry.path(), "kind") != kind) {
      continue;
    }
    const int size = std::stoi(value_of(entry.path(), "size"));
    if (size <= max_rows) {
      found.push_back({entry.path().filename().string(), entry.path(), size});
    }
  }
  std::ranges::sort(found, {}, [](const Folder& f) { return std::pair(f.size, f.name); });
  return found;
}

std::vector<Folder> all_folders(int max_rows, int max_generated_rows) {
  std::vector<Folder> found = folders("contact-problems", max_rows);
  const std::vector<Folder> generated = folders("generated", max_generated_rows);
  found.insert(found.end(), generated.begin(), generated.end());
  return found;
}

std::string test_name(const testing::TestParamInfo<Folder>& tested) {
  std::string name = tested.param.name;
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

Result solve(const char* solver, const Problem& problem, const SolverSettings& settings = {}) {
  Result result;
  make_solver(solver, settings)->solve(problem, result);
  return result;
}

void expect_certified(const Result& result) {
  EXPECT_TRUE(is_solved(result.status))
      << result.solver << ": " << to_string(result.status) << " (" << result.detail << ")";
  const Certificate& c = result.certificate;
  EXPECT_LE(c.natural_residual, std::max(kTolerance, 4.0 * c.natural_floor));
  EXPECT_LE(c.unit_free_residual, std::max(kTolerance, 4.0 * c.rounding_floor));
}

TEST(RealProblems, TheCollectionIsThere) {
  if (!fs::exists(fs::path(SIGNORINI_SHARED_DIR) / "data")) {
    GTEST_SKIP() << "../shared is absent";
  }
  EXPECT_EQ(folders("contact-problems", 600).size(), 38U);
  EXPECT_EQ(folders("contact-problems", 600, "mlcp").size(), 8U);
  EXPECT_EQ(folders("generated", 1024).size(), 10U);
  EXPECT_EQ(folders("contact-problems", 5000).size(), 40U);
  EXPECT_EQ(folders("contact-problems", 5000, "fc2d").size(), 7U);
  EXPECT_EQ(folders("contact-problems", 5000, "fc3d").size(), 25U);
}

/// Every problem of the collection: LCPs, mixed ones, and Coulomb friction in the plane and in
/// space.
std::vector<Folder> every_folder() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  constexpr int kRows = 120;
#else
  constexpr int kRows = 5000;
#endif
  std::vector<Folder> found = all_folders(kRows, kRows);
  for (const char* kind : {"mlcp", "fc2d", "fc3d"}) {
    const std::vector<Folder> more = folders("contact-problems", kRows, kind);
    found.insert(found.end(), more.begin(), more.end());
  }
  return found;
}

class AutoSolves : public testing::TestWithParam<Folder> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AutoSolves);

TEST_P(AutoSolves, Certified) {
  expect_certified(solve("auto", read_problem(GetParam().path)));
}

INSTANTIATE_TEST_SUITE_P(RealProblems, AutoSolves, testing::ValuesIn(every_folder()), test_name);

/// The same contacts on ice, with half their friction and with three times as much.
class AutoSolvesWithOtherFriction : public testing::TestWithParam<Folder> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AutoSolvesWithOtherFriction);

TEST_P(AutoSolvesWithOtherFriction, Certified) {
  const Problem given = read_problem(GetParam().path);
  for (const double factor : {0.0, 0.5, 3.0}) {
    Problem problem = given;
    for (FrictionCone& cone : problem.cones) {
      cone.coefficient *= factor;
    }
    SCOPED_TRACE(factor);
    expect_certified(solve("auto", problem));
  }
}

std::vector<Folder> friction_folders() {
  std::vector<Folder> found = folders("contact-problems", kMaxFrictionRows, "fc2d");
  const std::vector<Folder> in_space = folders("contact-problems", kMaxFrictionRows, "fc3d");
  found.insert(found.end(), in_space.begin(), in_space.end());
  return found;
}

INSTANTIATE_TEST_SUITE_P(RealProblems, AutoSolvesWithOtherFriction,
                         testing::ValuesIn(friction_folders()), test_name);

class LemkeSolves : public testing::TestWithParam<Folder> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(LemkeSolves);

TEST_P(LemkeSolves, Certified) {
  expect_certified(solve("lemke", read_problem(GetParam().path)));
}

INSTANTIATE_TEST_SUITE_P(RealProblems, LemkeSolves,
                         testing::ValuesIn(all_folders(kMaxRows, kMaxGeneratedRows)), test_name);

/// Electrical circuits: free rows, nonsymmetric M with zeros on its diagonal.
INSTANTIATE_TEST_SUITE_P(RealMixedProblems, LemkeSolves,
                         testing::ValuesIn(folders("contact-problems", kMaxRows, "mlcp")),
                         test_name);

/// A solver that does not solve a problem, by the problem's name, and why. Whoever solves it after
/// all is told to take it off the list.
using Reasons = std::map<std::string, std::string>;

bool is_known_failure(const Reasons& reasons, const Folder& folder, const Result& result) {
  const auto reason = reasons.find(folder.name);
  if (reason == reasons.end()) {
    return false;
  }
  EXPECT_FALSE(is_solved(result.status)) << folder.name << " is solved now: take it off the list";
  return true;
}

#ifdef SIGNORINI_HAS_GMP
class ExactSolves : public testing::TestWithParam<Folder> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ExactSolves);

TEST_P(ExactSolves, Certified) {
  expect_certified(solve("exact", read_problem(GetParam().path)));
}

INSTANTIATE_TEST_SUITE_P(RealProblems, ExactSolves,
                         testing::ValuesIn(folders("contact-problems", kMaxExactRows)), test_name);
#endif

const char* const kZeroDiagonal =
    "M is not semidefinite and has M_ii = 0 with w_i < 0: there is no Gauss-Seidel step";
const char* const kTooManySweeps = "10,000 sweeps are too few: M is badly conditioned";
const char* const kMassRatio =
    "10,000 sweeps are far too few: mass ratio 1e3 to 1e6, where the exact solvers belong";

const Reasons kPgsFailures = {
    {"lcp_Pang_isolated_sol", kZeroDiagonal},
    {"lcp_CPS_3", kZeroDiagonal},
    {"lcp_CPS_4", kZeroDiagonal},
    {"Capsules-i101-404-normal", kTooManySweeps},
    {"Capsules-i125-1213-normal", kTooManySweeps},
    {"RockPile_tob1-normal", kTooManySweeps},
    {"tower4-1000", "10,000 sweeps are too few for a tower of 250 boxes"},
    {"spheres-1000-R1e6", kMassRatio},
    {"tower4-1000-R1e6", kMassRatio},
    {"tower8-1000-R1e3", kMassRatio},
    {"pyramid2d-1024-R1e6", kMassRatio},
};

/// How far the w of two certified solutions can be apart. With dz = z_1 - z_2, dw = M dz and
///
///     dz.dw = z_1.w_1 + z_2.w_2 - z_1.w_2 - z_2.w_1 <= gap,
///
/// the gap being computed here from the two. Let M = S + K, symmetric and skew, and mu >= 0 such
/// that S + mu I is semidefinite (mu > 0 where the source printed too few digits). Then
/// dz.(S + mu I) dz <= gap + mu |dz|^2, and |P x|^2 <= lambda_max(P) x.P x for semidefinite P give
///
///     |dw| <= sqrt((lambda_max(S) + mu)(gap + mu |dz|^2)) + mu |dz| + |K dz|.
double largest_distance(const Matrix& M, const Result& a, const Result& b) {
  const Matrix S = 0.5 * (M + M.transpose());
  const Vector dz = a.z - b.z;
  const Vector eigenvalues =
      Eigen::SelfAdjointEigenSolver<Matrix>(S, Eigen::EigenvaluesOnly).eigenvalues();
  // The eigenvalues are off by up to n eps |S|.
  const double most = eigenvalues.maxCoeff();
  const double mu =
      std::max(0.0, -eigenvalues.minCoeff()) + 4e-16 * static_cast<double>(M.rows()) * most;
  const double gap = a.z.dot(a.w) + b.z.dot(b.w) - a.z.dot(b.w) - b.z.dot(a.w);
  const double negative = std::max(0.0, -a.w.minCoeff()) * b.z.cwiseAbs().sum() +
                          std::max(0.0, -b.w.minCoeff()) * a.z.cwiseAbs().sum() +
                          std::abs(a.z.dot(a.w)) + std::abs(b.z.dot(b.w));
  EXPECT_LE(gap, negative * (1.0 + 1e-12)) << "not two solutions of one problem";
  return std::sqrt((most + mu) * (negative + mu * dz.squaredNorm())) + mu * dz.norm() +
         ((M - S) * dz).norm();
}

/// Certified, and up to n = 600 the same w = M z + q as Lemke; z may differ by the null space of M.
void expect_the_w_of_lemke(const char* solver, const Reasons& failures, const Folder& folder) {
  const Problem problem = read_problem(folder.path);
  if (const std::string why = make_solver(solver)->refuses(problem); !why.empty()) {
    GTEST_SKIP() << why;
  }
  const Result result = solve(solver, problem);
  if (is_known_failure(failures, folder, result)) {
    GTEST_SKIP() << to_string(result.status) << ": " << failures.at(folder.name);
  }
  expect_certified(result);
  if (folder.size <= 600) {
    const Result lemke = solve("lemke", problem);
    const double distance = (result.w - lemke.w).norm();
    EXPECT_LE(distance, largest_distance(to_dense(problem.M), result, lemke));
    // The bound is a square root of the residual at best; what is seen is far below it.
    EXPECT_LE(distance, 1e-4 * (1.0 + problem.q.norm()));
  }
}

const Reasons kInteriorPointFailures = {
    {"lcp_Pang_isolated_sol", "M is neither semidefinite nor a P matrix: the path leads away"},
};

/// Every lcp and mlcp folder: bounds, free rows, nonsymmetric M.
std::vector<Folder> interior_point_folders() {
  std::vector<Folder> found = all_folders(kMaxRows == 600 ? 5000 : kMaxRows, kMaxGeneratedRows);
  const std::vector<Folder> mixed = folders("contact-problems", 600, "mlcp");
  found.insert(found.end(), mixed.begin(), mixed.end());
  return found;
}

class InteriorPointSolves : public testing::TestWithParam<Folder> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(InteriorPointSolves);

TEST_P(InteriorPointSolves, Certified) {
  const Result result = solve("interior-point", read_problem(GetParam().path));
  if (is_known_failure(kInteriorPointFailures, GetParam(), result)) {
    GTEST_SKIP() << to_string(result.status) << ": " << kInteriorPointFailures.at(GetParam().name);
  }
  expect_certified(result);
  EXPECT_LE(result.statistics.factorizations, 80);
}

INSTANTIATE_TEST_SUITE_P(RealProblems, InteriorPointSolves,
                         testing::ValuesIn(interior_point_folders()), test_name);

class PgsSolves : public testing::TestWithParam<Folder> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(PgsSolves);

TEST_P(PgsSolves, CertifiedAndWithTheWOfLemke) {
  expect_the_w_of_lemke("pgs", kPgsFailures, GetParam());
}

INSTANTIATE_TEST_SUITE_P(RealProblems, PgsSolves,
                         testing::ValuesIn(all_folders(kMaxRows, kMaxGeneratedRows)), test_name);

const Reasons kIndefiniteTriangle = {
    {"RockPile_tob1-normal",
     "M is symmetric to 3e-3 only, and the triangle that is pivoted on is indefinite"},
};

class DantzigSolves : public testing::TestWithParam<Folder> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(DantzigSolves);

TEST_P(DantzigSolves, CertifiedAndWithTheWOfLemke) {
  expect_the_w_of_lemke("dantzig", kIndefiniteTriangle, GetParam());
}

INSTANTIATE_TEST_SUITE_P(RealProblems, DantzigSolves,
                         testing::ValuesIn(all_folders(kMaxRows, kMaxGeneratedRows)), test_name);

class BlockPivotingSolves : public testing::TestWithParam<Folder> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(BlockPivotingSolves);

TEST_P(BlockPivotingSolves, CertifiedAndWithTheWOfLemke) {
  expect_the_w_of_lemke("block-pivoting", {}, GetParam());
}

INSTANTIATE_TEST_SUITE_P(RealProblems, BlockPivotingSolves,
                         testing::ValuesIn(all_folders(kMaxRows, kMaxGeneratedRows)), test_name);

class StructuredLemkeSolves : public testing::TestWithParam<Folder> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(StructuredLemkeSolves);

TEST_P(StructuredLemkeSolves, CertifiedAndWithTheWOfLemke) {
  expect_the_w_of_lemke("structured-lemke", kIndefiniteTriangle, GetParam());
}

INSTANTIATE_TEST_SUITE_P(RealProblems, StructuredLemkeSolves,
                         testing::ValuesIn(all_folders(kMaxRows, kMaxGeneratedRows)), test_name);

}  // namespace
}  // namespace signorini::lcp
