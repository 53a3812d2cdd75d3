#include <signorini/lcp/certificate.h>

#include "allocation_count.h"
#include "stated_lcp.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace signorini::lcp {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTolerance = 1e-8;

Problem two_by_two() {
  return lcp(Matrix{{2, 1}, {1, 2}}, vector({-3, -3}));
}

Status verdict(const Problem& problem, const Vector& z) {
  return judge(certify(problem, z), kTolerance, Status::kStalled);
}

// w = (1, -1) at z = (2, 0), D = 2: r = min(2 * 2, 1) and min(0, -1).
TEST(Certificate, HasTheValuesOfTheHandComputedExample) {
  Vector w;
  const Certificate c = certify(two_by_two(), vector({2, 0}), &w);
  EXPECT_EQ(w, vector({1, -1}));
  EXPECT_DOUBLE_EQ(c.natural_residual, 1.0 / 4.0);
  EXPECT_DOUBLE_EQ(c.unit_free_residual, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(c.rounding_floor, kEpsilon * 7.0 / 3.0);
  EXPECT_DOUBLE_EQ(c.natural_floor, kEpsilon * 7.0 / 4.0);
  EXPECT_DOUBLE_EQ(c.backward_error, 1.0 / 5.0);  // row 1; row 0 has 1 / (4 + 7)
  EXPECT_EQ(c.min_z, 0.0);
  EXPECT_EQ(c.min_w, -1.0);
  EXPECT_EQ(c.complementarity, 2.0);
}

TEST(Certificate, OfTheSolutionIsZero) {
  const Certificate c = certify(two_by_two(), vector({1, 1}));
  EXPECT_EQ(c.natural_residual, 0.0);
  EXPECT_EQ(c.unit_free_residual, 0.0);
  EXPECT_EQ(c.backward_error, 0.0);
}

TEST(Certificate, NamesTheWorstRow) {
  const Problem problem = lcp(Matrix::Identity(3, 3), vector({-1, -5, -2}));
  EXPECT_EQ(certify(problem, vector({1, 5, 0})).worst_row, 2);
}

TEST(Certificate, SeesANegativeZAndALargeComplementaryPair) {
  const Problem problem = lcp(Matrix::Identity(1, 1), vector({4}));
  EXPECT_DOUBLE_EQ(certify(problem, vector({-1})).unit_free_residual, 0.25);
  EXPECT_DOUBLE_EQ(certify(problem, vector({2})).unit_free_residual, 0.5);  // min(2, 6) / 4
}

TEST(Certificate, UsesOneWhereTheDiagonalIsNotPositive) {
  const Problem problem = lcp(Matrix{{0, 1}, {1, -3}}, vector({-1, 1}));
  // w = (-1, 1) + (0, 1) at z = (1, 0)
  EXPECT_DOUBLE_EQ(certify(problem, vector({1, 0})).unit_free_residual, 1.0);
}

TEST(Certificate, MeasuresABoxRowFromItsBounds) {
  Problem problem = lcp(Matrix{{2}}, vector({-10}));
  problem.lower = vector({-1});
  problem.upper = vector({1});
  EXPECT_EQ(certify(problem, vector({1})).unit_free_residual, 0.0);
  const Certificate inside = certify(problem, vector({0}));
  EXPECT_DOUBLE_EQ(inside.unit_free_residual, 0.2);  // 2 |0 - clamp(5)| / 10
  EXPECT_DOUBLE_EQ(inside.natural_residual, 1.0 / 11.0);
  EXPECT_DOUBLE_EQ(certify(problem, vector({3})).unit_free_residual, 0.4);
  EXPECT_TRUE(std::isnan(inside.min_z));
}

TEST(Certificate, MeasuresAFreeRowByW) {
  Problem problem = lcp(Matrix{{2}}, vector({3}));
  problem.lower = vector({-kInfinity});
  const Certificate c = certify(problem, vector({0}));
  EXPECT_DOUBLE_EQ(c.natural_residual, 0.75);
  EXPECT_DOUBLE_EQ(c.unit_free_residual, 1.0);
  EXPECT_EQ(certify(problem, vector({-1.5})).unit_free_residual, 0.0);
}

TEST(Certificate, CouplesAFrictionRowToTheNormalOfTheGivenZ) {
  Problem problem = lcp(Matrix::Identity(2, 2), vector({-2, -5}));
  problem.limits = {{.row = 1, .normal_row = 0, .coefficient = 0.5}};
  EXPECT_EQ(certify(problem, vector({2, 1})).unit_free_residual, 0.0);
  EXPECT_DOUBLE_EQ(certify(problem, vector({2, 2})).unit_free_residual, 0.2);
  // A negative normal force carries no friction: both rows are wrong, z_n by 1 + 2.
  EXPECT_DOUBLE_EQ(certify(problem, vector({-1, 0})).unit_free_residual, 0.6);
}

// mu z_N with more bits than long double, rounded to a z_T that is outside by 2^10, or inside by
// 2^9: w does not vanish beside either.
TEST(Certificate, HoldsWhatRoundingTakesFromACoupledLimit) {
  const double size = 0x1p113;
  const auto certificates = [&](double mu, double normal, double tangential, double w) {
    Problem problem;
    FactoredMatrix A;
    for (const double z : {normal, tangential}) {
      const int block = A.mass.add_inverse(Matrix{{1.0 / size}});
      A.add_row();
      A.add_entry(block, vector({1.0}));
      problem.q.conservativeResize(A.rows());
      problem.q[A.rows() - 1] = -z;  // w = 0
    }
    problem.q[1] += w;
    problem.M = A;
    problem.limits = {{.row = 1, .normal_row = 0, .coefficient = mu}};
    const Vector z = size * vector({normal, tangential});
    return std::pair{certify(problem, z), Certifier().certify_quickly(problem, z, 1e-8)};
  };
  const double ulp = 0x1p-52;
  const auto [outside, outside_quickly] = certificates(1.0 + 2.0 * ulp, 1.0 - ulp, 1.0 + ulp, 0.0);
  EXPECT_GT(outside.natural_residual, 100.0);
  EXPECT_GT(outside_quickly.natural_residual, 100.0);
  const auto [inside, inside_quickly] = certificates(1.0 + ulp, 1.0 + ulp, -(1.0 + 2.0 * ulp), 2.0);
  EXPECT_GT(inside.natural_residual, 0.1);
  EXPECT_GT(inside_quickly.natural_residual, 0.1);
}

TEST(Certificate, OfAnIslandIsThatOfTheIslandAlone) {
  Matrix M = Matrix::Zero(3, 3);
  M.topLeftCorner(2, 2) = Matrix{{2, 1}, {1, 2}};
  M(2, 2) = 5.0;
  const Problem problem = lcp(M, vector({-3, -3, 1e6}));
  Islands islands;
  islands.find(problem);
  Certifier certifier;
  std::vector<Certificate> each;
  certifier.certify_islands(problem, vector({2, 0, 0}), islands, each);
  ASSERT_EQ(each.size(), 2u);
  const Certificate alone = certify(two_by_two(), vector({2, 0}));
  EXPECT_EQ(each[0].unit_free_residual, alone.unit_free_residual);
  EXPECT_EQ(each[0].natural_residual, alone.natural_residual);
  EXPECT_EQ(each[0].rounding_floor, alone.rounding_floor);
  EXPECT_EQ(each[0].worst_row, alone.worst_row);
  EXPECT_EQ(each[1].unit_free_residual, 0.0);
  EXPECT_EQ(each[1].worst_row, 2);
  // the whole problem's residual hides the small island behind the large q
  EXPECT_LT(certify(problem, vector({2, 0, 0})).unit_free_residual, 1e-5);
}

TEST(Certificate, AllocatesNothingTheSecondTime) {
  Problem factored;
  FactoredMatrix A;
  A.mass.add_inverse(Matrix::Identity(6, 6));
  A.mass.add_mass(Matrix::Identity(6, 6));
  for (int i = 0; i < 6; ++i) {
    A.add_row();
    A.add_entry(0, Vector::Constant(6, 1.0 + i));
    A.add_entry(1, Vector::Unit(6, i));
  }
  factored.M = A;
  factored.q = Vector::Ones(6);
  factored.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 0.5},
                    {.normal_row = 4, .dimension = 2, .coefficient = 0.5}};
  Problem dense = factored;
  dense.M = Matrix(A.form());
  Problem sparse = factored;
  sparse.M = A.form();
  const Vector z = Vector::Ones(6);
  Vector w;
  for (const Problem* problem : {&factored, &dense, &sparse}) {
    Certifier certifier;
    Islands islands;
    std::vector<Certificate> each;
    const Certificate first = certifier.certify(*problem, z, &w);
    islands.find(*problem);
    certifier.certify_islands(*problem, z, islands, each);
    const AllocationCount allocations;
    const Certificate second = certifier.certify(*problem, z, &w);
    islands.find(*problem);
    certifier.certify_islands(*problem, z, islands, each);
    EXPECT_EQ(allocations.count(), 0);
    EXPECT_EQ(second.unit_free_residual, first.unit_free_residual);
  }
}

TEST(Certificate, OfZeroQIsZeroForZeroAndInfiniteForAnythingWrong) {
  const Problem problem = lcp(Matrix::Identity(2, 2), vector({0, 0}));
  EXPECT_EQ(certify(problem, vector({0, 0})).unit_free_residual, 0.0);
  EXPECT_EQ(certify(problem, vector({1e-30, 0})).unit_free_residual, kInfinity);
}

/// The residual of a problem with q = 0.
double homogeneous(const MatrixForm& M, const Vector& z) {
  Problem problem;
  problem.M = M;
  problem.q = Vector::Zero(z.size());
  return certify(problem, z).unit_free_residual;
}

TEST(Certificate, OfZeroQIsDecidedWithoutRounding) {
  const Matrix walls{{1.5, -1.5}, {-1.5, 1.5}};
  EXPECT_EQ(homogeneous(walls, vector({0.1, 0.1})), 0.0);
  EXPECT_EQ(homogeneous(walls, vector({0.1, 0.1 + 0x1p-56})), kInfinity);
  // w_0 = (1e20 + 2^-40) - 1e20 is 0 in long double.
  Matrix hidden = Matrix::Zero(3, 3);
  hidden.row(0) = Eigen::RowVector3d(1e20, 0x1p-40, -1e20);
  EXPECT_EQ(homogeneous(hidden, vector({1, 1, 1})), kInfinity);
  EXPECT_EQ(homogeneous(SparseMatrix(hidden.sparseView()), vector({1, 1, 1})), kInfinity);
  hidden(0, 1) = 0.0;
  EXPECT_EQ(homogeneous(hidden, vector({1, 1, 1})), 0.0);
  EXPECT_EQ(homogeneous(SparseMatrix(hidden.sparseView()), vector({1, 1, 1})), 0.0);
  FactoredMatrix factored;
  factored.mass.add_mass(Matrix{{3.0, 1.0}, {1.0, 7.0}});
  for (const double side : {1.0, -1.0}) {
    factored.add_row();
    factored.add_entry(0, vector({0.3 * side, 0.7 * side}));
  }
  EXPECT_EQ(homogeneous(factored, vector({5, 5})), 0.0);
  EXPECT_EQ(homogeneous(factored, vector({5, 5 + 0x1p-50})), kInfinity);
}

TEST(Certificate, OfZeroQKnowsBoundsAndLimits) {
  Problem problem = lcp(Matrix{{2.0, 0.0}, {0.0, 0.0}}, vector({0, 0}));
  const auto residual = [&problem](double a, double b) {
    return certify(problem, vector({a, b})).unit_free_residual;
  };
  problem.lower = vector({1, -kInfinity});
  EXPECT_EQ(residual(1.0, 3.0), 0.0) << "w = (2, 0)";
  EXPECT_EQ(residual(1.0 + kEpsilon, 3.0), kInfinity);
  problem.lower = vector({-4, 0});
  problem.upper = vector({-0.5, 1});
  EXPECT_EQ(residual(-0.5, 0.25), 0.0) << "w = (-1, 0)";
  EXPECT_EQ(residual(-1.0, 0.25), kInfinity);
  EXPECT_EQ(residual(-0.5, 1.0 + kEpsilon), kInfinity) << "out of its bounds";
  problem = lcp(Matrix{{0.0, 0.0}, {0.0, 1.0}}, vector({0, 0}));
  problem.limits = {{.row = 1, .normal_row = 0, .coefficient = 0.5}};
  EXPECT_EQ(residual(3.0, 0.0), 0.0);
  EXPECT_EQ(residual(3.0, 1.5), kInfinity) << "w_1 > 0 at the upper limit";
  EXPECT_EQ(residual(3.0, -1.5), kInfinity) << "w_1 < 0 at the lower limit";
  problem.M = Matrix{{0.0, 0.0}, {0.0, -1.0}};
  EXPECT_EQ(residual(3.0, 1.5), 0.0) << "w_1 < 0 at the upper limit";
  problem.limits[0].coefficient = 0.1;
  EXPECT_EQ(residual(3.0, 0.1 * 3.0), kInfinity) << "0.1 * 3 is rounded";
}

TEST(Certificate, OfZeroQKnowsCones) {
  Problem problem = lcp(Matrix::Zero(3, 3), Vector::Zero(3));
  problem.cones = {{0, 3, 0.5}};
  const auto residual = [&problem](const Vector& z) {
    return certify(problem, z).unit_free_residual;
  };
  EXPECT_EQ(residual(vector({2, 0.5, 0.5})), 0.0);
  EXPECT_EQ(residual(vector({2, 0.0, 1.5})), kInfinity);
  EXPECT_EQ(residual(vector({2, 0.0, 1.0})), kInfinity) << "its boundary is left open";
  // A separate row pushes the contact, whose impulse is 0: apart, together, sideways.
  problem = lcp(Matrix::Zero(4, 4), Vector::Zero(4));
  problem.cones = {{0, 3, 0.5}};
  problem.M = Matrix{{1, 0, 0, 1}, {0, 1, 0, 4}, {0, 0, 1, 0}, {0, 0, 0, 0}};
  EXPECT_EQ(residual(vector({0, 0, 0, 1})), 0.0) << "Coulomb: apart, however it slides";
  problem.friction_law = FrictionLaw::kAssociated;
  EXPECT_EQ(residual(vector({0, 0, 0, 1})), kInfinity) << "w_N < mu |w_T|";
  std::get<Matrix>(problem.M)(1, 3) = 1.0;
  EXPECT_EQ(residual(vector({0, 0, 0, 1})), 0.0);
  std::get<Matrix>(problem.M)(0, 3) = -1.0;
  EXPECT_EQ(residual(vector({0, 0, 0, 1})), kInfinity) << "together";
}

TEST(Certificate, OfNoRowsIsSolved) {
  const Certificate c = certify(lcp(Matrix(0, 0), Vector(0)), Vector(0));
  EXPECT_EQ(judge(c, kTolerance, Status::kStalled), Status::kSolved);
  EXPECT_EQ(c.worst_row, -1);
}

TEST(Certificate, RefusesWhatIsNotFinite) {
  for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
    Vector w;
    const Certificate c = certify(two_by_two(), vector({1, bad}), &w);
    EXPECT_EQ(c.natural_residual, kInfinity);
    EXPECT_EQ(c.unit_free_residual, kInfinity);
    EXPECT_TRUE(w.array().isNaN().all());
    EXPECT_EQ(judge(c, 0.5, Status::kStalled), Status::kStalled);
  }
  EXPECT_EQ(verdict(two_by_two(), vector({1})), Status::kStalled);
}

// (M, q, z) in other units of z and w: factors that are powers of two change no digit.
TEST(Certificate, UnitFreeNumbersDoNotDependOnTheUnits) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    Matrix G(4, 3);
    Vector q(4);
    Vector z(4);
    for (double& value : G.reshaped()) value = normal(random);
    for (double& value : q) value = normal(random);
    for (double& value : z) value = std::abs(normal(random));
    const Matrix M = G * G.transpose();
    const Certificate c = certify(lcp(M, q), z);
    for (const auto& [z_unit, w_unit] : {std::pair{-300, 150}, {200, -250}, {480, 480}}) {
      const Certificate scaled =
          certify(lcp(M * std::ldexp(1.0, w_unit - z_unit), q * std::ldexp(1.0, w_unit)),
                  z * std::ldexp(1.0, z_unit));
      EXPECT_EQ(scaled.unit_free_residual, c.unit_free_residual);
      EXPECT_EQ(scaled.rounding_floor, c.rounding_floor);
      EXPECT_EQ(scaled.backward_error, c.backward_error);
    }
  }
}

TEST(Certificate, NeitherLiesNorRefusesFrom1e150Downto1e150) {
  for (const double m : {1e-150, 1.0, 1e150}) {
    for (const double s : {1e-150, 1.0, 1e150}) {
      const Problem problem = lcp(Matrix{{m}}, vector({-s}));
      const Certificate exact = certify(problem, vector({s / m}));
      EXPECT_LE(exact.unit_free_residual, kEpsilon) << m << ' ' << s;
      EXPECT_TRUE(std::isfinite(exact.rounding_floor));
      const Certificate wrong = certify(problem, vector({0.5 * (s / m)}));
      EXPECT_DOUBLE_EQ(wrong.unit_free_residual, 0.5) << m << ' ' << s;
    }
  }
}

/// Sums of |M||z| that doubles cannot hold, or hold with fewer digits, count like those they can.
TEST(Certificate, SumsBeyondTheRangeOfDoublesCountToo) {
  const auto same_as_unscaled = [](const Problem& problem, const Vector& z, double m, double by) {
    Problem scaled = problem;
    scaled.M = Matrix(m * std::get<Matrix>(problem.M));
    scaled.q = m * (by * problem.q);
    const Certificate unscaled = certify(problem, z);
    const Certificate c = certify(scaled, by * z);
    EXPECT_GT(unscaled.rounding_floor, 0.0);
    EXPECT_DOUBLE_EQ(c.rounding_floor, unscaled.rounding_floor);
    EXPECT_DOUBLE_EQ(c.unit_free_residual, unscaled.unit_free_residual);
    EXPECT_DOUBLE_EQ(c.backward_error, unscaled.backward_error);
  };
  const Vector inexact = vector({1.0 + 1e-9, 1.0});
  same_as_unscaled(two_by_two(), inexact, 0x1p-520, 0x1p-520);  // 2^-1040
  same_as_unscaled(two_by_two(), inexact, 0x1p-300, 0x1p-200);  // in range
  const double small = 0x1p-120;
  same_as_unscaled(lcp(Matrix{{1, -1}, {-1, 1}}, vector({-small, -small})), inexact, 0x1p600,
                   0x1p500);  // |M||z| is 2^1101
}

TEST(Certificate, WrongAnswersAreNeverJudgedSolved) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const Index n = 1 + trial % 8;
    Matrix M(n, n);
    for (double& value : M.reshaped()) value = uniform(random);
    M.diagonal().array() += static_cast<double>(n) + 1.0;  // strictly diagonally dominant: P
    Vector z(n);
    Vector w(n);
    for (Index i = 0; i < n; ++i) {
      const double size = 0.1 + std::abs(uniform(random));
      z[i] = i % 2 == 0 ? size : 0.0;
      w[i] = i % 2 == 0 ? 0.0 : size;
    }
    const Problem problem = lcp(M, w - M * z);
    ASSERT_EQ(verdict(problem, z), Status::kSolved);
    // Diagonal dominance by 1 and |q| < 40: an error of 1e-5 in z leaves a residual above 1e-7.
    z[trial % n] += 1e-5;
    EXPECT_EQ(verdict(problem, z), Status::kStalled) << "trial " << trial;
  }
}

// q.y = -2 with y = (1, 1), M y = 0: there is no solution, yet |M||z| grows without end.
TEST(Judge, NoRoundingFloorMakesAnInfeasibleProblemSolved) {
  const Problem problem = lcp(Matrix{{1, -1}, {-1, 1}}, vector({-1, -1}));
  for (double t = 1.0; t < 1e300; t *= 1e3) {
    EXPECT_EQ(verdict(problem, vector({t, t})), Status::kStalled) << t;
  }
}

// A force balance of 1e10 kg under 1 N: rounding z costs more than 1e-8 of q.
TEST(Judge, CallsWhatRoundingAloneSpoilsSolvedToRounding) {
  const double third = 1.0 / 3.0;
  const Problem problem = lcp(Matrix{{3e10, -3e10}, {-3e10, 3e10 + 1}}, vector({-1, third}));
  const double z1 = 2.0 / 3.0;
  const double z0 = z1 + third * 1e-10;
  const Certificate c = certify(problem, vector({z0, z1}));
  ASSERT_GT(c.unit_free_residual, kTolerance);
  ASSERT_LE(c.unit_free_residual, 4.0 * c.rounding_floor);
  EXPECT_EQ(judge(c, kTolerance, Status::kStalled), Status::kSolvedToRounding);
  EXPECT_EQ(judge(c, 1e-3, Status::kStalled), Status::kSolved);
}

TEST(Judge, NeedsBothResiduals) {
  Certificate c;
  c.natural_floor = c.rounding_floor = 0.0;
  c.natural_residual = c.unit_free_residual = kTolerance;
  EXPECT_EQ(judge(c, kTolerance, Status::kStalled), Status::kSolved);
  c.natural_residual = 2.0 * kTolerance;
  EXPECT_EQ(judge(c, kTolerance, Status::kStalled), Status::kStalled);
  c.natural_floor = kTolerance;
  EXPECT_EQ(judge(c, kTolerance, Status::kStalled), Status::kSolvedToRounding);
  c.unit_free_residual = 4.1 * kTolerance;
  c.rounding_floor = kTolerance;
  EXPECT_EQ(judge(c, kTolerance, Status::kStalled), Status::kStalled);
  c.natural_residual = std::nan("");
  EXPECT_EQ(judge(c, kTolerance, Status::kTimeLimit), Status::kTimeLimit);
}

TEST(Judge, HasACeilingForTheFloor) {
  Certificate c;
  c.natural_residual = c.unit_free_residual = 1.1e-5;
  c.natural_floor = c.rounding_floor = 1e-4;
  EXPECT_EQ(judge(c, kTolerance, Status::kStalled), Status::kStalled);
  c.natural_residual = c.unit_free_residual = 0.9e-5;
  EXPECT_EQ(judge(c, kTolerance, Status::kStalled), Status::kSolvedToRounding);
}

/// Two bodies, one cone between them and one on the ground, an LCP row.
Problem two_bodies(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  FactoredMatrix A;
  A.mass.add_inverse(Matrix::Identity(6, 6));
  A.mass.add_inverse(0.1 * Matrix::Identity(6, 6));
  const auto add = [&](bool first, bool second) {
    A.add_row();
    for (int body = 0; body < 2; ++body) {
      if (body == 0 ? first : second) {
        Vector values(6);
        for (double& value : values) value = normal(random);
        A.add_entry(body, values);
      }
    }
  };
  for (int k = 0; k < 3; ++k) add(true, true);
  for (int k = 0; k < 3; ++k) add(false, true);
  add(true, false);
  Problem problem;
  problem.M = A;
  problem.cones = {{0, 3, 0.5}, {3, 3, 0.8}};
  return problem;
}

TEST(QuickCertificate, GivesTheSameVerdictAndNoSmallerNumbersAlsoOfIterates) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Certifier certifier;
  int quick_ones = 0;
  for (int k = 0; k < 200; ++k) {
    SCOPED_TRACE(k);
    Problem problem = two_bodies(random);
    Vector z{{1.0, 0.2, -0.1, 2.0, 0.5, 0.5, 0.7}};
    if (k % 3 == 1) z.segment(3, 3).setZero();
    Vector w(7);
    multiply(problem.M, z.data(), w.data());
    // From exact to hopeless: w = 0 but for an error of 10^-12 .. 1.
    const double error = std::pow(10.0, -12.0 + k % 13);
    problem.q = -w;
    for (double& q : problem.q) q += error * normal(random);
    if (k % 3 == 1) problem.q[3] += 1.0;  // separates
    Vector w_quick, w_full;
    const Certificate quick = certifier.certify_quickly(problem, z, kTolerance, &w_quick);
    const Certificate full = certify(problem, z, &w_full);
    EXPECT_EQ(judge(quick, kTolerance, Status::kStalled),
              judge(full, kTolerance, Status::kStalled));
    EXPECT_EQ(w_quick, w_full);
    EXPECT_GE(quick.unit_free_residual, full.unit_free_residual * (1.0 - 1e-12));
    EXPECT_GE(quick.natural_residual, full.natural_residual * (1.0 - 1e-12));
    EXPECT_GE(quick.rounding_floor, full.rounding_floor * (1.0 - 1e-12));
    EXPECT_EQ(quick.min_z, full.min_z);
    EXPECT_EQ(quick.min_w, full.min_w);
    EXPECT_NEAR(quick.complementarity, full.complementarity, 1e-14 * full.complementarity + 1e-18);
    EXPECT_EQ(quick.cone_violation, full.cone_violation);
    quick_ones += std::isnan(quick.backward_error) ? 1 : 0;
    certifier.start_iterates(problem);
    const Certificate iterate = certifier.certify_iterate(problem, z, kTolerance);
    EXPECT_EQ(judge(iterate, kTolerance, Status::kStalled),
              judge(full, kTolerance, Status::kStalled));
    EXPECT_TRUE(std::isnan(iterate.backward_error));  // a bound, solved or not
    EXPECT_GE(iterate.rounding_floor, full.rounding_floor * (1.0 - 1e-12));
    if (full.unit_free_residual > kTolerance) {
      EXPECT_NEAR(iterate.unit_free_residual / full.unit_free_residual, 1.0, 1e-12);
    }
    if (full.natural_residual > kTolerance) {
      EXPECT_NEAR(iterate.natural_residual / full.natural_residual, 1.0, 1e-12);
    }
  }
  EXPECT_GT(quick_ones, 20);
  EXPECT_LT(quick_ones, 180);
  // q = 0, a z that is not finite, a given M: as certify().
  Problem problem = two_bodies(random);
  problem.q.setZero(7);
  EXPECT_EQ(certifier.certify_quickly(problem, Vector::Zero(7), kTolerance).unit_free_residual,
            0.0);
  problem.q.setOnes();
  EXPECT_EQ(certifier.certify_quickly(problem, Vector::Constant(7, std::nan("")), kTolerance)
                .unit_free_residual,
            kInfinity);
  certifier.start_iterates(problem);
  EXPECT_EQ(certifier.certify_iterate(problem, Vector::Constant(7, std::nan("")), kTolerance)
                .unit_free_residual,
            kInfinity);
  // Where the floors alone make it solved: certify() itself.
  problem = two_bodies(random);
  const Vector z{{1.0, 0.2, -0.1, 2.0, 0.5, 0.5, 0.7}};
  Vector w(7);
  multiply(problem.M, z.data(), w.data());
  problem.q = -w;
  certifier.start_iterates(problem);
  EXPECT_FALSE(std::isnan(certifier.certify_iterate(problem, z, 1e-17).backward_error));
}

// mu |w_T| = -w_N: w~ is 0 while the contact closes with 0.1.
TEST(QuickCertificate, SeesAContactThatClosesBehindAHugeMu) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix::Identity(3, 3));
  for (int k = 0; k < 3; ++k) {
    A.add_row();
    A.add_entry(0, Vector::Unit(3, k));
  }
  Problem problem;
  problem.M = A;
  problem.cones = {{0, 3, 1e12}};
  problem.q = Vector{{-1.1, 1e-13, 0.0}};
  const Certificate quick = Certifier().certify_quickly(problem, Vector::Unit(3, 0), kTolerance);
  EXPECT_GT(quick.unit_free_residual, 0.05);
  EXPECT_EQ(judge(quick, kTolerance, Status::kStalled), Status::kStalled);
}

// A floor of 1e-4 is double's; computed in long double, the residual may be 1e-7 too small.
TEST(Judge, TrustsNoResidualBeyondWhatItsOwnRoundingLeaves) {
  Certificate c;
  c.natural_residual = c.unit_free_residual = 0.0;
  c.natural_floor = c.rounding_floor = 1e-4;
  EXPECT_EQ(judge(c, kTolerance, Status::kStalled), Status::kSolvedToRounding);
  EXPECT_EQ(judge(c, 2e-7, Status::kStalled), Status::kSolved);
  c.natural_floor = c.rounding_floor = kInfinity;
  EXPECT_EQ(judge(c, kTolerance, Status::kStalled), Status::kStalled);
}

}  // namespace
}  // namespace signorini::lcp
