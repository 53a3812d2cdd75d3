#include <signorini/lcp/solver.h>

#include "bench/claim_judge.h"
#include "bench/fuzz_problems.h"
#include "bench/fuzz_study.h"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <unistd.h>
#include <utility>

namespace signorini::bench {
namespace {

using lcp::Index;
using lcp::Matrix;
using lcp::Problem;
using lcp::Result;
using lcp::Status;
using lcp::Vector;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTolerance = 1e-8;

Problem problem_of(const Matrix& M, const Vector& q) {
  Problem problem;
  problem.M = M;
  problem.q = q;
  return problem;
}

Result claim(const Problem& problem, const Vector& z, Status status = Status::kSolved) {
  Result result;
  result.status = status;
  result.z = z;
  result.certificate = lcp::certify(problem, z, &result.w);
  return result;
}

std::string wrong(const Problem& problem, const Vector& z, Status status = Status::kSolved) {
  return judge_claim(problem, claim(problem, z, status), kTolerance).wrong;
}

TEST(ClaimJudge, AcceptsTrueSolutionsByIntervalsAndRefusesFalseOnes) {
  const Problem problem = problem_of(Matrix{{2.0, 1.0}, {1.0, 2.0}}, Eigen::Vector2d(-3.0, -3.0));
  const Verdict verdict =
      judge_claim(problem, claim(problem, Eigen::Vector2d(1.0 + 1e-9, 1.0)), kTolerance);
  EXPECT_EQ(verdict.wrong, "");
  EXPECT_FALSE(verdict.by_rationals);
  EXPECT_NE(wrong(problem, Eigen::Vector2d(1.0 + 1e-7, 1.0)), "");
  EXPECT_NE(wrong(problem, Eigen::Vector2d(0.0, 0.0)), "");
  EXPECT_EQ(wrong(problem, Eigen::Vector2d(0.0, 0.0), Status::kStalled), "");
}

TEST(ClaimJudge, GoesToRationalsWhereRoundingHidesTheAnswer) {
  // w = 2^70 (z_0 - z_1) - 1 cancels beyond long double: only rationals see that w_0 = 2^17.
  const Problem problem =
      problem_of(Matrix{{0x1p70, -0x1p70}, {-0x1p70, 0x1p70}}, Eigen::Vector2d(-1.0, 1.0));
  const Verdict verdict =
      judge_claim(problem, claim(problem, Eigen::Vector2d(1.0 + 0x1p-52, 1.0)), kTolerance);
  EXPECT_NE(verdict.wrong, "");
  EXPECT_TRUE(verdict.by_rationals);
}

TEST(ClaimJudge, LetsNothingPassWhereQIsZero) {
  // w_0 = 2^-40, which a sum in long double loses.
  Matrix M = Matrix::Zero(3, 3);
  M.row(0) = Eigen::RowVector3d(1e20, 0x1p-40, -1e20);
  EXPECT_NE(wrong(problem_of(M, Vector::Zero(3)), Vector::Ones(3)), "");
  M(0, 1) = 0.0;
  EXPECT_EQ(wrong(problem_of(M, Vector::Zero(3)), Vector::Ones(3)), "");
}

TEST(ClaimJudge, KnowsBoundsFreeRowsAndCoupledLimits) {
  Problem boxed = problem_of(Matrix{{1.0}}, Vector::Constant(1, -3.0));
  boxed.upper = Vector::Constant(1, 2.0);
  EXPECT_EQ(wrong(boxed, Vector::Constant(1, 2.0)), "");
  EXPECT_NE(wrong(boxed, Vector::Constant(1, 3.0)), "");
  Problem free = problem_of(Matrix{{1.0}}, Vector::Constant(1, 3.0));
  free.lower = Vector::Constant(1, -kInfinity);
  EXPECT_EQ(wrong(free, Vector::Constant(1, -3.0)), "");
  EXPECT_NE(wrong(free, Vector::Constant(1, 0.0)), "");
  Problem coupled = problem_of(Matrix{{1.0, 0.0}, {0.0, 1.0}}, Eigen::Vector2d(-2.0, -5.0));
  coupled.limits = {{1, 0, 0.5}};
  EXPECT_EQ(wrong(coupled, Eigen::Vector2d(2.0, 1.0)), "");
  EXPECT_NE(wrong(coupled, Eigen::Vector2d(2.0, 1.5)), "");
}

TEST(ClaimJudge, KnowsBothFrictionLaws) {
  // A unit mass pressed down with 1 and pushed sideways with (3, 4): it slides, mu = 0.5.
  Problem sliding = problem_of(Matrix(Matrix::Identity(3, 3)), Eigen::Vector3d(-1.0, -3.0, -4.0));
  sliding.cones = {{0, 3, 0.5}};
  const Vector coulomb = Eigen::Vector3d(1.0, 0.3, 0.4);  // w_T = (-2.7, -3.6), w_N = 0
  EXPECT_EQ(wrong(sliding, coulomb), "");
  sliding.friction_law = lcp::FrictionLaw::kAssociated;
  EXPECT_NE(wrong(sliding, coulomb), "");
  // The projection of -q on the cone: along (1, 0.5 t) with (1 + 0.5 * 5) / 1.25.
  const Vector associated = Eigen::Vector3d(2.8, 0.84, 1.12);
  EXPECT_EQ(wrong(sliding, associated), "");
  sliding.friction_law = lcp::FrictionLaw::kCoulomb;
  EXPECT_NE(wrong(sliding, associated), "");
}

TEST(ClaimJudge, SeesTheNormalPartUnderAnyFriction) {
  // Closes with 1 while it slides with 1e-9, and holds with 1 while it opens with 1.
  for (const auto& [z, w] :
       {std::pair(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-1, 1e-9, 0)),
        std::pair(Eigen::Vector3d(1e-9, -1, 0), Eigen::Vector3d(1, 1e-9, 0))}) {
    Problem problem = problem_of(Matrix(Matrix::Identity(3, 3)), w - z);
    problem.cones = {{0, 3, 1e9}};
    EXPECT_FALSE(surely_within(problem, z, kTolerance));
    EXPECT_NE(wrong(problem, z), "");
    const ExactResiduals r = exact_residuals(problem, z);
    const lcp::Certificate c = lcp::certify(problem, z);
    // The certificate's have mu times what long double may lose of a slip.
    constexpr double kLost = 1e9 * 0x1p-59;
    EXPECT_NEAR(r.unit_free.get_d(), c.unit_free_residual, kLost);
    EXPECT_NEAR(r.natural.get_d(), c.natural_residual, kLost);
    EXPECT_GT(r.unit_free, 0.4);
  }
}

TEST(ClaimJudge, RefusesMalformedResultsAndProofsOfOtherProblems) {
  Problem problem = problem_of(Matrix{{1.0}}, Vector::Constant(1, -1.0));
  EXPECT_NE(wrong(problem, Vector::Constant(1, 1.0), Status::kInvalidInput), "");
  EXPECT_NE(wrong(problem, Vector::Constant(1, kInfinity), Status::kStalled), "");
  EXPECT_NE(wrong(problem, Vector::Constant(1, 1.0), Status::kNotRun), "");
  Result proof = claim(problem, Vector::Constant(1, 0.0), Status::kNoSolutionBelow);
  proof.ray = Vector::Constant(1, 1.0);
  proof.ray_bound = 1.0;
  EXPECT_EQ(judge_claim(problem, proof, kTolerance).wrong, "");
  proof.ray_bound = 1.0 + 0x1p-52;
  EXPECT_NE(judge_claim(problem, proof, kTolerance).wrong, "");
  problem.upper = Vector::Constant(1, 2.0);
  proof.ray_bound = 1.0;
  EXPECT_NE(judge_claim(problem, proof, kTolerance).wrong, "");
  problem.q[0] = kInfinity;
  EXPECT_NE(wrong(problem, Vector::Constant(1, 0.0), Status::kStalled), "");
}

TEST(FuzzProblems, AreOfEveryKindAndDependOnSeedAndIndexAlone) {
  std::set<std::size_t> forms;
  std::set<std::string> words;
  int small = 0;
  for (int index = 0; index < 3000; ++index) {
    const FuzzProblem drawn = draw_fuzz_problem(3, index);
    lcp::check_shapes(drawn.problem);
    EXPECT_GE(drawn.problem.size(), 1);
    EXPECT_LE(drawn.problem.size(), 30);
    small += drawn.problem.size() <= 8 ? 1 : 0;
    forms.insert(drawn.problem.M.index());
    std::istringstream recipe(drawn.recipe);
    for (std::string word; std::getline(recipe, word, ',');) {
      words.insert(word);
    }
  }
  EXPECT_GT(small, 1500);
  EXPECT_EQ(forms.size(), 3U);
  for (const char* word :
       {" units scaled", " rows scaled", " row repeated", " zero rows", " perturbed", " sparse",
        " q = 0", " q solvable", " not finite", " bounds", " crossed bounds", " free rows",
        " coupled limits", " cones", "near zero", "random factored", "psd-infeasible"}) {
    EXPECT_TRUE(words.contains(word)) << word;
  }
  const FuzzProblem once = draw_fuzz_problem(5, std::int64_t{1} << 40);
  const FuzzProblem again = draw_fuzz_problem(5, std::int64_t{1} << 40);
  EXPECT_EQ(once.recipe, again.recipe);
  EXPECT_EQ(once.problem.q, again.problem.q);
}

/// A solver with a vice.
class Bad : public lcp::Solver {
 public:
  enum class Vice : unsigned char { kNone, kHang, kCrash, kThrow, kNan };
  Bad(const lcp::SolverSettings& settings, Vice vice) : settings_(settings), vice_(vice) {}
  [[nodiscard]] std::string_view name() const override { return "bad"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override {
    return problem.size() > 8 ? "too large" : "";
  }

 protected:
  [[nodiscard]] const lcp::SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector*, const lcp::Deadline&,
                 Result& result) override {
    result.z = Vector::Zero(problem.size());
    if (problem.size() == 3) {
      switch (vice_) {
        case Vice::kHang: ::pause(); break;
        case Vice::kCrash: std::abort();
        case Vice::kThrow: throw std::runtime_error("thrown");
        case Vice::kNan: result.z.setConstant(std::numeric_limits<double>::quiet_NaN()); break;
        case Vice::kNone: break;
      }
    }
    return Status::kStalled;
  }

 private:
  lcp::SolverSettings settings_;
  Vice vice_;
};

FuzzRow run_bad(Bad::Vice vice, int problems, std::string* text = nullptr) {
  std::ostringstream out;
  const FuzzCounts counts =
      run_fuzz_study({.problems = problems, .seed = 2, .hang_seconds = 0.3}, out,
                     {{"bad", [vice](const lcp::SolverSettings& settings) {
                         return std::make_unique<Bad>(settings, vice);
                       }}});
  if (text != nullptr) {
    *text = out.str();
  }
  return counts.rows.at(0);
}

TEST(FuzzStudy, CountsHangsAndCrashesOnceAndLosesNothing) {
  constexpr int kProblems = 40;
  int of_three_rows = 0;
  for (int index = 0; index < kProblems; ++index) {
    const Problem problem = draw_fuzz_problem(2, index).problem;
    of_three_rows += problem.size() == 3 && lcp::find_bad_value(problem).empty() ? 1 : 0;
  }
  ASSERT_GT(of_three_rows, 0);
  const FuzzRow good = run_bad(Bad::Vice::kNone, kProblems);
  EXPECT_EQ(good.wrong(), 0);
  EXPECT_EQ(good.judged + good.refused, kProblems);
  std::string text;
  const FuzzRow crashing = run_bad(Bad::Vice::kCrash, kProblems, &text);
  EXPECT_EQ(crashing.crashes, of_three_rows);
  EXPECT_EQ(crashing.judged + crashing.refused + crashing.crashes, kProblems);
  EXPECT_NE(text.find("--seed 2 --solver bad --first "), std::string::npos) << text;
  EXPECT_EQ(run_bad(Bad::Vice::kThrow, kProblems).crashes, of_three_rows);
  const FuzzRow hanging = run_bad(Bad::Vice::kHang, kProblems);
  EXPECT_EQ(hanging.hangs, of_three_rows);
  EXPECT_EQ(hanging.judged + hanging.refused + hanging.hangs, kProblems);
  EXPECT_EQ(run_bad(Bad::Vice::kNan, kProblems).wrong(), 0) << "solve() makes it z = 0";
}

TEST(FuzzStudy, RangesAddUp) {
  std::ostringstream out;
  const auto run = [&out](std::int64_t first, std::int64_t problems) {
    return run_fuzz_study(
               {.first = first, .problems = problems, .solver = "lemke", .in_children = false}, out)
        .rows.at(0);
  };
  const FuzzRow whole = run(0, 200);
  const FuzzRow head = run(0, 77);
  const FuzzRow tail = run(77, 123);
  EXPECT_EQ(whole.judged, head.judged + tail.judged);
  EXPECT_EQ(whole.solved, head.solved + tail.solved);
  EXPECT_EQ(whole.by_rationals, head.by_rationals + tail.by_rationals);
}

TEST(FuzzStudy, RefusesBadOptions) {
  std::ostringstream out;
  EXPECT_THROW(run_fuzz_study({.first = -1}, out), std::invalid_argument);
  EXPECT_THROW(run_fuzz_study({.problems = -1}, out), std::invalid_argument);
  EXPECT_THROW(run_fuzz_study({.solver = "gauss"}, out), std::invalid_argument);
  EXPECT_THROW(run_fuzz_study({.hang_seconds = 0.0}, out), std::invalid_argument);
}

class NeverALie : public testing::TestWithParam<std::string> {};

TEST_P(NeverALie, FastSample) {
  std::ostringstream out;
  const FuzzCounts counts = run_fuzz_study({.problems = 1000,
                                            .solver = GetParam(),
                                            .max_iterations = 200,
                                            .truth_every = 10,
                                            .warm = true},
                                           out);
  EXPECT_EQ(counts.wrong(), 0) << out.str();
  EXPECT_GT(counts.rows.at(0).judged, 1.8 * static_cast<double>(1000 - counts.rows.at(0).refused))
      << "nearly all are solved a second time";
}

/// What fuzzing found, in the order of finding.
struct Found {
  const char* solver;
  std::int64_t index;  // of seed 1
  const char* recipe;  // without which it is another problem
  const char* what;
};

TEST(FuzzStudy, WhatWasFoundStaysMended) {
  constexpr Found kFound[] = {
      {"dantzig", 78973, "random factored, bounds",
       "a dependent row moved between far bounds without end"},
      {"dantzig", 84379, "random psd, perturbed, units scaled, bounds", "the same"},
      {"dantzig", 99608, "random psd, units scaled, sparse, bounds", "the same, n = 4"},
      {"pgs", 83624, "psd-repeated, bounds", "q = 0 and a w that long double loses, called solved"},
      {"symmetric-pgs", 83624, "psd-repeated, bounds", "the same"},
      {"nncg", 83624, "psd-repeated, bounds", "the same"},
      {"cone-interior-point", 39840, "any-solvable, row repeated, rows scaled, cones",
       "a cone's scale too small by half, from a closed form"},
      {"cone-interior-point", 81171, "random any, rows scaled, sparse, cones",
       "the same, by forty powers of ten"},
      {"alart-curnier", 81171, "random any, rows scaled, sparse, cones", "the same"},
      {"alart-curnier", 2018224, "random factored, cones",
       "a floor of mu |w_T| larger than that of the boundary"},
      {"cone-interior-point", 3069053, "mass-ratio, rows scaled, cones",
       "mu = 1e12 times a slip that long double loses beside it"},
      {"sticking", 830811, "random factored, cones",
       "mu = 1e12 times what long double loses of a slip"},
      {"cone-interior-point", 619561, "near zero, rows scaled, cones",
       "a floor that the judge's doubles made infinite: a crash"},
      {"cone-interior-point", 43407, "random any, cones with still tangents",
       "mu = 0 and tangents that nothing moves, below the cone"},
  };
  for (const Found& found : kFound) {
    std::ostringstream out;
    const FuzzCounts counts =
        run_fuzz_study({.first = found.index, .problems = 1, .solver = found.solver}, out);
    EXPECT_EQ(draw_fuzz_problem(1, found.index).recipe, found.recipe) << found.what;
    EXPECT_EQ(counts.wrong(), 0) << found.what << "\n" << out.str();
    EXPECT_EQ(counts.rows.at(0).judged, 1);
  }
}

std::vector<std::string> names() {
  return {lcp::solver_names().begin(), lcp::solver_names().end()};
}

INSTANTIATE_TEST_SUITE_P(Fuzz, NeverALie, testing::ValuesIn(names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace signorini::bench
