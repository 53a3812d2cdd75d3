#include <signorini/lcp/exact_sum.h>
#include <signorini/lcp/ray.h>
#include <signorini/lcp/solver.h>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#ifdef SIGNORINI_HAS_GMP
#include <gmpxx.h>
#endif

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Vector vector(std::initializer_list<double> values) {
  return Eigen::Map<const Vector>(values.begin(), static_cast<Index>(values.size()));
}

/// A ball between two opposite walls, touching both: M = [1 -1; -1 1], q < 0.
Problem opposite_walls(double q0, double q1) {
  return {.M = Matrix{{1.0, -1.0}, {-1.0, 1.0}},
          .q = vector({q0, q1}),
          .lower = {},
          .upper = {},
          .limits = {}};
}

Problem dense(const Matrix& M, const Vector& q) {
  return {.M = M, .q = q, .lower = {}, .upper = {}, .limits = {}};
}

/// The same two walls as J W J^T + compliance, the ball's mass 3 kept as a factor or inverted.
Problem factored_walls(bool is_factor, double second_normal, double compliance) {
  FactoredMatrix A;
  const Matrix mass = 3.0 * Matrix::Identity(3, 3);
  const int ball =
      is_factor ? A.mass.add_mass(mass) : A.mass.add_inverse(Matrix::Identity(3, 3) / 3.0);
  A.add_row(compliance);
  A.add_entry(ball, vector({0.6, 0.8, 0.1}));
  A.add_row(compliance);
  A.add_entry(ball, vector({-0.6, second_normal, -0.1}));
  return {.M = A, .q = vector({-0.3, -0.1}), .lower = {}, .upper = {}, .limits = {}};
}

TEST(ExactSum, CancelsWhereLongDoubleDoesNot) {
  ExactSum sum;
  sum.add_product(1e300, 1e300);
  sum.add_product(1e-300, -1e-300);
  sum.add_product(-1e300, 1e300);
  EXPECT_EQ(sum.sign(), -1);
  sum.add_product(1e-300, 1e-300);
  EXPECT_EQ(sum.sign(), 0);
  EXPECT_EQ(sum.enclosure().lower, 0.0L);
  EXPECT_EQ(sum.enclosure().upper, 0.0L);
}

TEST(ExactSum, HoldsTheLargestAndTheSmallestProducts) {
  const double most = std::numeric_limits<double>::max();
  const double least = std::numeric_limits<double>::denorm_min();
  ExactSum sum;
  for (int i = 0; i < 1000; ++i) {
    sum.add_product(most, most);
  }
  sum.add_product(-least, least);
  for (int i = 0; i < 1000; ++i) {
    sum.add_product(-most, most);
  }
  EXPECT_EQ(sum.sign(), -1);
  EXPECT_EQ(sum.enclosure().lower, -std::ldexp(1.0L, -2148));
  EXPECT_EQ(sum.enclosure().upper, -std::ldexp(1.0L, -2148));
}

TEST(ExactSum, EnclosureIsTightAndExactWhereItCanBe) {
  ExactSum sum;
  sum.add_product(3.0, 0.25);
  sum.add_product(-7.0, 2.0);
  EXPECT_EQ(sum.enclosure().lower, -13.25L);
  EXPECT_EQ(sum.enclosure().upper, -13.25L);
  sum.add_product(0x1p-200, 1.0);
  EXPECT_LT(sum.enclosure().lower, -13.25L + 0x1p-200L);
  EXPECT_GT(sum.enclosure().upper, -13.25L);
  EXPECT_LE(sum.enclosure().upper - sum.enclosure().lower, 16 * 0x1p-64L * 3);
}

#ifdef SIGNORINI_HAS_GMP
TEST(ExactSum, AgreesWithRationalsOnRandomDoublesOfAllScales) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  for (const int spread : {1, 60, 500}) {
    std::uniform_int_distribution<int> exponent(-spread, spread);
    for (int trial = 0; trial < 300; ++trial) {
      ExactSum sum;
      mpq_class truth = 0;
      double first_a = 0.0;
      double first_b = 0.0;
      for (int k = 0; k < 12; ++k) {
        double a = std::ldexp(mantissa(random), exponent(random));
        double b = std::ldexp(mantissa(random), exponent(random));
        if (k == 0) {
          first_a = a;
          first_b = b;
        }
        if (k == 11) {  // cancels the first product
          a = -first_a;
          b = first_b;
        }
        sum.add_product(a, b);
        truth += mpq_class(a) * mpq_class(b);
      }
      ASSERT_EQ(sum.sign(), sgn(truth)) << "spread " << spread << ", trial " << trial;
      const auto rational = [](long double x) {  // exact: the head and the tail of 64 bits
        int e = 0;
        const long double fraction = std::frexp(x, &e);
        const auto head = static_cast<double>(fraction);
        mpq_class value = mpq_class(head) + mpq_class(static_cast<double>(fraction - head));
        if (e >= 0) {
          mpq_mul_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<unsigned long>(e));
        } else {
          mpq_div_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<unsigned long>(-e));
        }
        return value;
      };
      const Interval enclosure = sum.enclosure();
      ASSERT_LE(rational(enclosure.lower), truth);
      ASSERT_GE(rational(enclosure.upper), truth);
      // A long double of 64 bits: three of its units are below 2^-61 of the value.
      ASSERT_LE(enclosure.upper - enclosure.lower, 0x1p-61L * std::abs(enclosure.lower));
    }
  }
}
#endif

TEST(Interval, HoldsAThirdAndStaysExactWhereDoublesAre) {
  const Interval third = Interval(1.0L) / 3.0L;
  EXPECT_LT(third.lower, third.upper);
  EXPECT_LE(3.0 * third.lower, 1.0L);
  EXPECT_GE(3.0 * third.upper, 1.0L);
  const Interval half = Interval(3.0L) / 2.0L;
  EXPECT_EQ(half.lower, 1.5L);
  EXPECT_EQ(half.upper, 1.5L);
  const Interval flipped = -2.0 * third;
  EXPECT_LT(flipped.lower, flipped.upper);
  EXPECT_LT(flipped.upper, 0.0L);
}

TEST(Interval, OverflowNeverGivesAFiniteWrongBound) {
  const long double most = std::numeric_limits<long double>::max();
  Interval sum(most);
  sum += Interval(most);
  EXPECT_LE(sum.lower, most);
  EXPECT_EQ(sum.upper, std::numeric_limits<long double>::infinity());
  const Interval tiny = 0x1p-1000 * Interval(std::numeric_limits<long double>::denorm_min());
  EXPECT_LE(tiny.lower, 0.0L);
  EXPECT_GT(tiny.upper, 0.0L);
}

TEST(Ray, OppositeWallsAreInfeasible) {
  const RayVerdict verdict = judge_ray(opposite_walls(-1.0, -2.0), vector({1.0, 1.0}));
  EXPECT_EQ(verdict.status, Status::kInfeasible);
  EXPECT_EQ(verdict.bound, kInfinity);
}

TEST(Ray, EveryMultipleProvesTheSame) {
  for (const double scale : {1e-300, 1e-150, 1.0, 1e150, 1e300}) {
    const Vector y = vector({scale, scale});
    EXPECT_EQ(judge_ray(opposite_walls(-1.0, -2.0), y).status, Status::kInfeasible) << scale;
    EXPECT_EQ(judge_ray(opposite_walls(1e-150, -2e-150), y).status, Status::kInfeasible) << scale;
  }
}

TEST(Ray, NeedsQDotYBelowZeroExactly) {
  const Vector y = vector({1.0, 1.0});
  EXPECT_EQ(judge_ray(opposite_walls(1.0, -1.0), y).status, Status::kRayUnproven);
  // -1e-300 is lost in any floating sum with 1 - 1.
  EXPECT_EQ(
      judge_ray(dense(Matrix::Zero(3, 3), vector({1.0, -1e-300, -1.0})), vector({1.0, 1.0, 1.0}))
          .status,
      Status::kInfeasible);
  EXPECT_EQ(
      judge_ray(dense(Matrix::Zero(3, 3), vector({1.0, 1e-300, -1.0})), vector({1.0, 1.0, 1.0}))
          .status,
      Status::kRayUnproven);
}

TEST(Ray, OneUnitInTheLastPlaceTurnsInfeasibleIntoABound) {
  Problem problem = opposite_walls(-1.0, -2.0);
  std::get<Matrix>(problem.M)(1, 0) = -1.0 + 0x1p-53;  // (M^T y)_0 = 2^-53
  const RayVerdict verdict = judge_ray(problem, vector({1.0, 1.0}));
  EXPECT_EQ(verdict.status, Status::kNoSolutionBelow);
  EXPECT_EQ(verdict.bound, 3.0 * 0x1p53);
  std::get<Matrix>(problem.M)(1, 0) = -1.0 - 0x1p-52;
  EXPECT_EQ(judge_ray(problem, vector({1.0, 1.0})).status, Status::kInfeasible);
}

TEST(Ray, UsesTheTransposeOfANonsymmetricMatrix) {
  const Matrix M{{0.0, 1.0}, {0.0, 0.0}};  // w_1 = q_1 = -1 for every z; w_0 = z_1 - 1
  EXPECT_EQ(judge_ray(dense(M, vector({-1.0, -1.0})), vector({0.0, 1.0})).status,
            Status::kInfeasible);
  const RayVerdict bound = judge_ray(dense(M, vector({-3.0, 5.0})), vector({1.0, 0.0}));
  EXPECT_EQ(bound.status, Status::kNoSolutionBelow);
  EXPECT_EQ(bound.bound, 3.0);
}

TEST(Ray, SparseIsJudgedAsDense) {
  for (const double last : {-1.0, -1.0 + 0x1p-53}) {
    Problem problem = opposite_walls(-1.0, -2.0);
    std::get<Matrix>(problem.M)(1, 0) = last;
    const RayVerdict expected = judge_ray(problem, vector({1.0, 1.0}));
    problem.M = SparseMatrix(std::get<Matrix>(problem.M).sparseView());
    const RayVerdict verdict = judge_ray(problem, vector({1.0, 1.0}));
    EXPECT_EQ(verdict.status, expected.status);
    EXPECT_EQ(verdict.bound, expected.bound);
  }
}

TEST(Ray, FactoredFormIsProvenThroughJTransposeY) {
  for (const bool is_factor : {false, true}) {
    EXPECT_EQ(judge_ray(factored_walls(is_factor, -0.8, 0.0), vector({2.0, 2.0})).status,
              Status::kInfeasible);
  }
}

TEST(Ray, FactoredFormWithNormalsThatDoNotQuiteOpposeHasABound) {
  for (const bool is_factor : {false, true}) {
    const double normal = std::nextafter(-0.8, -1.0);
    const RayVerdict verdict =
        judge_ray(factored_walls(is_factor, normal, 0.0), vector({1.0, 1.0}));
    EXPECT_EQ(verdict.status, Status::kNoSolutionBelow);
    // J^T y = (0, -g, 0) with the gap g between the doubles 0.8 and normal, M^T y = (-0.8 g,
    // |normal| g) / 3 to a few roundings of the inverse mass (1/3) or of its factor (sqrt 3).
    const double gap = -normal - 0.8;
    const double exact = 0.4 / (-normal * gap / 3.0);
    EXPECT_NEAR(verdict.bound / exact, 1.0, 1e-14);
  }
}

TEST(Ray, ComplianceMakesOppositeWallsFeasible) {
  for (const bool is_factor : {false, true}) {
    const RayVerdict verdict = judge_ray(factored_walls(is_factor, -0.8, 0.25), vector({1.0, 1.0}));
    EXPECT_EQ(verdict.status, Status::kNoSolutionBelow);
    // -q.y / c = 0.4 / 0.25, q.y in doubles of -0.3 and -0.1.
    EXPECT_NEAR(verdict.bound, 1.6, 4 * 0x1p-52);
  }
}

TEST(Ray, BoundIsRoundedDown) {
  // Z = 1/3: the largest double not above it, or one of the few below.
  const RayVerdict verdict = judge_ray(dense(Matrix{{3.0}}, vector({-1.0})), vector({1.0}));
  EXPECT_EQ(verdict.status, Status::kNoSolutionBelow);
  EXPECT_LT(std::fma(verdict.bound, 3.0, -1.0), 0.0);
  EXPECT_GT(verdict.bound, 1.0 / 3.0 - 3 * 0x1p-54);
}

TEST(Ray, BoundBeyondDoubleIsTheLargestDouble) {
  const RayVerdict verdict = judge_ray(dense(Matrix{{1e-300}}, vector({-1e300})), vector({1.0}));
  EXPECT_EQ(verdict.status, Status::kNoSolutionBelow);
  EXPECT_EQ(verdict.bound, std::numeric_limits<double>::max());
}

TEST(Ray, BoundBelowDoubleProvesNothing) {
  EXPECT_EQ(judge_ray(dense(Matrix{{1e300}}, vector({-1e-300})), vector({1.0})).status,
            Status::kRayUnproven);
}

TEST(Ray, ExtremeScalesOfTheFactoredFormNeverGiveAWrongProof) {
  for (const double scale : {1e-150, 1e-90, 1e90, 1e150}) {
    FactoredMatrix A;
    A.mass.add_inverse(Matrix{{scale}});
    A.add_row();
    A.add_entry(0, vector({scale}));
    const Problem problem{.M = A, .q = vector({-1.0}), .lower = {}, .upper = {}, .limits = {}};
    const RayVerdict verdict = judge_ray(problem, vector({1.0}));
    EXPECT_NE(verdict.status, Status::kInfeasible) << scale;  // z = 1 / scale^3 solves it
    EXPECT_LE(verdict.bound, std::pow(static_cast<long double>(scale), -3.0L) * (1 + 1e-15L));
  }
}

TEST(Ray, ZeroNegativeAndNonFiniteRaysAreUnproven) {
  const Problem problem = opposite_walls(-1.0, -2.0);
  for (const Vector& y : {vector({0.0, 0.0}), vector({1.0, -1e-300}), vector({kNaN, 1.0}),
                          vector({1.0, kInfinity}), vector({-kInfinity, 1.0})}) {
    EXPECT_EQ(judge_ray(problem, y).status, Status::kRayUnproven);
    EXPECT_EQ(judge_ray(problem, y).bound, 0.0);
  }
}

TEST(Ray, NonFiniteDataAreUnproven) {
  const Vector y = vector({1.0, 1.0});
  EXPECT_EQ(judge_ray(opposite_walls(kNaN, -2.0), y).status, Status::kRayUnproven);
  EXPECT_EQ(judge_ray(opposite_walls(-kInfinity, -2.0), y).status, Status::kRayUnproven);
  Problem problem = opposite_walls(-1.0, -2.0);
  std::get<Matrix>(problem.M)(0, 1) = kNaN;
  EXPECT_EQ(judge_ray(problem, y).status, Status::kRayUnproven);
}

TEST(Ray, ProblemsWithBoundsOrFreeRowsAreUnproven) {
  Problem problem = opposite_walls(-1.0, -2.0);
  problem.lower = vector({-kInfinity, 0.0});
  EXPECT_EQ(judge_ray(problem, vector({1.0, 1.0})).status, Status::kRayUnproven);
}

TEST(Ray, NoRowsProveNothing) {
  EXPECT_EQ(judge_ray(dense(Matrix(0, 0), Vector(0)), Vector(0)).status, Status::kRayUnproven);
}

#ifdef SIGNORINI_HAS_GMP
/// -q.y / max (M^T y)_+ in rationals; 0: infeasible or unproven.
struct RationalVerdict {
  Status status;
  mpq_class bound;
};

RationalVerdict judge_in_rationals(const Matrix& M, const Vector& q, const Vector& y) {
  mpq_class q_dot_y = 0;
  mpq_class most = 0;
  for (Index j = 0; j < q.size(); ++j) {
    q_dot_y += mpq_class(q[j]) * mpq_class(y[j]);
    mpq_class column = 0;
    for (Index i = 0; i < q.size(); ++i) {
      column += mpq_class(M(i, j)) * mpq_class(y[i]);
    }
    most = std::max(most, column);
  }
  if (q_dot_y >= 0) {
    return {Status::kRayUnproven, 0};
  }
  if (most == 0) {
    return {Status::kInfeasible, 0};
  }
  return {Status::kNoSolutionBelow, -q_dot_y / most};
}

TEST(Ray, AgreesWithRationalsOnRandomProblems) {
  std::mt19937_64 random(11);
  std::uniform_int_distribution<int> small(-2, 2);
  std::uniform_int_distribution<int> exponent(-150, 150);
  std::uniform_real_distribution<double> real(-1.0, 1.0);
  int verdicts[3] = {0, 0, 0};
  for (int trial = 0; trial < 3000; ++trial) {
    const Index n = 1 + static_cast<Index>(random() % 5);
    const bool is_scaled = trial % 2 == 1;
    const auto draw = [&] {
      return is_scaled ? std::ldexp(real(random), exponent(random)) : double(small(random));
    };
    Matrix M(n, n);
    Vector q(n);
    Vector y(n);
    for (Index i = 0; i < n; ++i) {
      q[i] = draw();
      y[i] = std::abs(draw());
      for (Index j = 0; j < n; ++j) {
        M(i, j) = draw() - (trial % 4 < 2 ? 0.0 : std::abs(draw()));
      }
    }
    const RationalVerdict truth = judge_in_rationals(M, q, y);
    const RayVerdict verdict = judge_ray(dense(M, q), y);
    ASSERT_EQ(to_string(verdict.status), to_string(truth.status)) << "trial " << trial;
    if (truth.status == Status::kNoSolutionBelow) {
      ASSERT_LE(mpq_class(verdict.bound), truth.bound);
      ASSERT_GE(mpq_class(verdict.bound), truth.bound * mpq_class(1.0 - 0x1p-51));
    }
    verdicts[truth.status == Status::kInfeasible    ? 0
             : truth.status == Status::kRayUnproven ? 1
                                                    : 2] += 1;
  }
  for (const int count : verdicts) {
    EXPECT_GT(count, 100);
  }
}
#endif

/// Whatever solver ended on a ray: what it says is what the ray proves in exact arithmetic.
TEST(Ray, EverySolverThatEndsOnOneSaysWhatItProves) {
  const Matrix walls{{1.0, -1.0}, {-1.0, 1.0}};
  // cos and sin of two normals that are opposite but for rounding
  const double c = 0.6;
  const double s = 0.8;
  const Vector up{{c, s}};
  const Vector down{{-c, -std::nextafter(s, 1.0)}};
  Matrix rounded(2, 2);
  rounded << up.dot(up), up.dot(down), up.dot(down), down.dot(down);
  for (const char* name : {"lemke", "structured-lemke", "dantzig", "block-pivoting", "auto",
#ifdef SIGNORINI_HAS_GMP
                           "exact"
#endif
       }) {
    int proofs = 0;
    for (const Matrix& M : {walls, Matrix(0x1p300 * walls), rounded}) {
      for (const bool sparse : {false, true}) {
        Problem problem;
        problem.M = sparse ? MatrixForm(SparseMatrix(M.sparseView())) : MatrixForm(M);
        problem.q = Vector::Constant(2, -1.0);
        Result result;
        make_solver(name)->solve(problem, result);
        if (result.ray.size() == 0) {
          continue;
        }
        const RayVerdict verdict = judge_ray(problem, result.ray);
        EXPECT_EQ(result.status, verdict.status) << name << ": " << result.detail;
        EXPECT_EQ(result.ray_bound, verdict.bound) << name;
        proofs += verdict.status == Status::kInfeasible ? 1 : 0;
      }
    }
    EXPECT_GE(proofs, 4) << name << ": the walls are proven infeasible";
  }
}

}  // namespace
}  // namespace signorini::lcp
