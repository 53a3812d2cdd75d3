#include "bench/complementary_cones.h"
#include "bench/exactness_families.h"
#include "bench/exactness_study.h"
#include "bench/rational_judge.h"

#include <Eigen/LU>
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <sstream>

namespace signorini::bench {
namespace {

using lcp::Index;
using lcp::Matrix;
using lcp::Problem;
using lcp::Result;
using lcp::Status;
using lcp::Vector;

constexpr double kTolerance = 1e-8;

Vector vector(std::initializer_list<double> values) {
  return Eigen::Map<const Vector>(values.begin(), static_cast<Index>(values.size()));
}

Problem dense(const Matrix& M, const Vector& q) {
  return {.M = M, .q = q, .lower = {}, .upper = {}, .limits = {}};
}

/// What is wrong with the claim of a status about a problem.
std::string wrong(const Problem& problem, const Result& result) {
  const lcp::ExactProblem exact = lcp::to_rational(problem);
  return find_wrong_claim(exact, result, kTolerance, find_truth(problem, exact));
}

Result solved(const Vector& z, Status status = Status::kSolved) {
  Result result;
  result.status = status;
  result.z = z;
  return result;
}

Result ray(const Vector& y, Status status, double bound = 0.0) {
  Result result;
  result.status = status;
  result.ray = y;
  result.ray_bound = bound;
  return result;
}

TEST(RationalJudge, AcceptsATrueSolutionAndRefusesAFalseOne) {
  const Problem problem = dense(Matrix{{2.0, 1.0}, {1.0, 2.0}}, vector({-3.0, -3.0}));
  EXPECT_EQ(wrong(problem, solved(vector({1.0, 1.0}))), "");
  EXPECT_EQ(wrong(problem, solved(vector({1.0 + 1e-9, 1.0}))), "");
  EXPECT_NE(wrong(problem, solved(vector({1.0 + 1e-7, 1.0}))), "");
  EXPECT_NE(wrong(problem, solved(vector({0.0, 0.0}))), "");
}

TEST(RationalJudge, JudgesBothResiduals) {
  // min(z, w) is small in the caller's units where M_ii z is not, and the other way round.
  EXPECT_NE(wrong(dense(Matrix{{1.0}}, vector({1e-9})), solved(vector({1e-9}))), "");
  EXPECT_NE(wrong(dense(Matrix{{1e-12}}, vector({1e3})), solved(vector({1.0}))), "");
}

TEST(RationalJudge, SolvedToRoundingMayMissTheToleranceByFourFloors) {
  const double huge = 0x1p40;
  const Problem problem = dense(Matrix{{huge}}, vector({-1.0}));
  const double z = 1.0 / huge;
  const Vector off = vector({z * (1 + 0x1p-20)});
  EXPECT_NE(wrong(problem, solved(off)), "");
  EXPECT_NE(wrong(problem, solved(off, Status::kSolvedToRounding)), "");
  // Floors are eps (|M||z| + |q|) / |q|: with large cancelling terms they exceed the tolerance.
  const Problem cancelling = dense(Matrix{{huge, -huge}, {-huge, huge}}, vector({-1.0, 1.0}));
  const auto at = [](double error) { return vector({1.0 + 0x1p-40 + error, 1.0}); };
  const double floor = 0x1p-52 * (2 * huge + 2.0);  // of w, with |q| = 1
  EXPECT_EQ(wrong(cancelling, solved(at(0.0))), "");
  EXPECT_NE(wrong(cancelling, solved(at(3 * floor / huge))), "");
  EXPECT_EQ(wrong(cancelling, solved(at(3 * floor / huge), Status::kSolvedToRounding)), "");
  EXPECT_NE(wrong(cancelling, solved(at(5 * floor / huge), Status::kSolvedToRounding)), "");
}

TEST(RationalJudge, RefusesARayThatProvesNothing) {
  const Problem walls = dense(Matrix{{1.0, -1.0}, {-1.0, 1.0}}, vector({-1.0, -1.0}));
  EXPECT_EQ(wrong(walls, ray(vector({1.0, 1.0}), Status::kInfeasible)), "");
  EXPECT_NE(wrong(walls, ray(vector({1.0, 1.0 + 0x1p-52}), Status::kInfeasible)), "");
  EXPECT_NE(wrong(walls, ray(vector({1.0, -1.0}), Status::kInfeasible)), "");
  EXPECT_NE(wrong(walls, ray(Vector(), Status::kInfeasible)), "");
  const Problem feasible = dense(Matrix{{1.0, -1.0}, {-1.0, 1.0}}, vector({-1.0, 1.0}));
  EXPECT_NE(wrong(feasible, ray(vector({1.0, 1.0}), Status::kInfeasible)), "");
}

TEST(RationalJudge, RefusesABoundAboveTheRays) {
  const Problem problem = dense(Matrix{{0.5}}, vector({-3.0}));  // z = 6
  const Vector y = vector({1.0});
  EXPECT_EQ(wrong(problem, ray(y, Status::kNoSolutionBelow, 6.0)), "");
  EXPECT_NE(wrong(problem, ray(y, Status::kNoSolutionBelow, 6.0 + 0x1p-50)), "");
}

TEST(RationalJudge, FindsTheTruthWhereLemkeEndsOnARay) {
  int by_enumeration = 0;
  for (int index = 0; index < 2000; ++index) {
    const auto [family, problem] = draw_exactness_problem(3, index);
    if (family->name != "any-solvable" || problem.size() > 6) {
      continue;
    }
    const Truth truth = find_truth(problem, lcp::to_rational(problem));
    ASSERT_EQ(truth.existence, Existence::kSolution) << "problem " << index;
    by_enumeration += truth.is_by_enumeration ? 1 : 0;
  }
  EXPECT_GT(by_enumeration, 0);
}

TEST(ExactnessFamilies, ProblemsAreLcpsOfOneToTwelveRowsInEveryForm) {
  std::set<std::size_t> forms;
  std::set<Index> sizes;
  for (int index = 0; index < 1000; ++index) {
    const Problem problem = draw_exactness_problem(1, index).problem;
    lcp::check_shapes(problem);
    ASSERT_EQ(lcp::find_bad_value(problem), "");
    ASSERT_TRUE(problem.is_lcp());
    forms.insert(problem.M.index());
    sizes.insert(problem.size());
  }
  EXPECT_EQ(forms.size(), 3u);
  EXPECT_EQ(sizes.size(), 12u);
  EXPECT_EQ(*sizes.begin(), 1);
  EXPECT_EQ(*sizes.rbegin(), 12);
}

TEST(ExactnessFamilies, DataAreExact) {
  // What the doubles say is a multiple of a power of two with few bits, so nothing was rounded when
  // the products were formed: 2^24 times every number is an integer below 2^53.
  for (int index = 0; index < 1000; ++index) {
    const lcp::ExactProblem exact = lcp::to_rational(draw_exactness_problem(1, index).problem);
    for (const std::vector<mpq_class>* numbers : {&exact.M, &exact.q}) {
      for (const mpq_class& number : *numbers) {
        const mpq_class scaled = number * 0x1p24;
        ASSERT_EQ(scaled.get_den(), 1) << "problem " << index;
        ASSERT_LT(abs(scaled), mpq_class(0x1p53));
      }
    }
  }
}

TEST(ExactnessFamilies, PMatricesHavePositivePrincipalMinors) {
  int checked = 0;
  for (int index = 0; index < 1000; ++index) {
    const auto [family, problem] = draw_exactness_problem(1, index);
    const Index n = problem.size();
    if (family->name.substr(0, 2) != "p-" || n > 6) {
      continue;
    }
    const Matrix M = lcp::to_dense(problem.M);
    for (int subset = 1; subset < (1 << n); ++subset) {
      std::vector<Index> rows;
      for (Index i = 0; i < n; ++i) {
        if ((subset >> i) % 2 == 1) {
          rows.push_back(i);
        }
      }
      // An integer determinant, small enough for rounding to stay far below 1/2.
      ASSERT_GT(Matrix(M(rows, rows)).determinant(), 0.5) << "problem " << index;
    }
    ++checked;
  }
  EXPECT_GT(checked, 30);
}

TEST(ExactnessFamilies, AProblemDependsOnSeedAndIndexAlone) {
  const auto first = draw_exactness_problem(7, 41);
  static_cast<void>(draw_exactness_problem(7, 40));
  const auto again = draw_exactness_problem(7, 41);
  EXPECT_EQ(first.family, again.family);
  EXPECT_EQ(lcp::to_dense(first.problem.M), lcp::to_dense(again.problem.M));
  EXPECT_EQ(first.problem.q, again.problem.q);
  const auto families = static_cast<int>(exactness_families().size());
  bool differs = false;
  for (int k = 1; k <= 5; ++k) {
    const auto other = draw_exactness_problem(7, 41 + k * families);
    differs = differs || other.problem.q.size() != first.problem.q.size() ||
              other.problem.q != first.problem.q;
  }
  EXPECT_TRUE(differs);
}

TEST(ExactnessStudy, FastSampleHasNoWrongClaimAndBreaksNoPromise) {
  std::ostringstream out;
  const ExactnessCounts counts = run_exactness_study({.problems = 2000, .seed = 2}, out);
  EXPECT_EQ(counts.problems, 2000);
  EXPECT_EQ(counts.wrong_solved, 0) << out.str();
  EXPECT_EQ(counts.wrong_infeasible, 0) << out.str();
  EXPECT_EQ(counts.wrong_bound, 0) << out.str();
  EXPECT_EQ(counts.undecided_promises, 0) << out.str();
  EXPECT_EQ(counts.broken_promises, 0) << out.str();
  EXPECT_TRUE(counts.complaints.empty());

  std::map<std::string, int> of_lemke;
  int unproven = 0;
  for (const ExactnessRow& row : counts.rows) {
    EXPECT_EQ(row.count, row.with_solution + row.without_solution + row.undecided);
    if (row.solver == "lemke") {
      of_lemke[row.family] += row.count;
      unproven += row.status == Status::kRayUnproven ? row.count : 0;
    }
  }
  EXPECT_EQ(of_lemke.size(), exactness_families().size());
  for (const auto& [family, count] : of_lemke) {
    EXPECT_EQ(count, 2000 / static_cast<int>(exactness_families().size())) << family;
  }
  EXPECT_EQ(unproven, counts.ray_unproven);
  EXPECT_NE(out.str().find("psd-repeated"), std::string::npos);

  const std::string csv = counts.to_csv();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + static_cast<long>(counts.rows.size()));
}

TEST(ExactnessStudy, NoProblemsGiveAnEmptyTable) {
  std::ostringstream out;
  const ExactnessCounts counts = run_exactness_study({.problems = 0}, out);
  EXPECT_EQ(counts.problems, 0);
  EXPECT_TRUE(counts.rows.empty());
}

TEST(ExactnessStudy, RefusesANegativeCount) {
  std::ostringstream out;
  EXPECT_THROW(run_exactness_study({.problems = -1}, out), std::invalid_argument);
}

}  // namespace
}  // namespace signorini::bench
