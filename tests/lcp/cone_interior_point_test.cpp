#include <signorini/lcp/cone_interior_point.h>
#include <signorini/lcp/second_order_cone.h>

#include "allocation_count.h"
#include "bench/contact_families.h"
#include "definition_residual.h"
#include "family_with_friction.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kLaws = {FrictionLaw::kCoulomb, FrictionLaw::kAssociated};

Result solve(const Problem& problem, const ConeInteriorPointSettings& settings = {},
             const Vector* warm_start = nullptr) {
  Result result;
  ConeInteriorPoint(settings).solve(problem, result, warm_start);
  return result;
}

Problem one_contact(const Matrix& M, const Vector& q, double mu, FrictionLaw law) {
  Problem problem;
  problem.M = M;
  problem.q = q;
  problem.cones = {{.normal_row = 0, .dimension = static_cast<int>(q.size()), .coefficient = mu}};
  problem.friction_law = law;
  return problem;
}

/// A random contact problem M = G G^T + c, singular where c = 0 and the rows outnumber freedom.
Problem random_contacts(unsigned seed, int contacts, int dimension, int freedom, double c) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const int n = contacts * dimension;
  Matrix G(n, freedom);
  for (double& value : G.reshaped()) value = normal(random);
  Vector v(freedom);
  for (double& value : v) value = normal(random);
  Problem problem;
  problem.M = Matrix(G * G.transpose() + c * Matrix::Identity(n, n));
  problem.q = G * v;  // the motion of free bodies: feasible whatever the contacts
  for (int k = 0; k < contacts; ++k) {
    problem.cones.push_back({dimension * k, dimension, 0.1 * (k % 10)});
  }
  return problem;
}

void expect_solution(const Result& result, const Vector& z) {
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_LE((result.z - z).norm(), 1e-7) << result.z.transpose();
}

TEST(SecondOrderCone, NesterovAndToddMakeTwoPointsOne) {
  using namespace second_order_cone;
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  const auto inside = [&] {
    Vector3 x(0, normal(random), normal(random));
    x[0] = x.norm() + std::exp(normal(random));
    return x;
  };
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3 x = inside();
    const Vector3 v = inside();
    NesterovTodd W;
    W.set(x, v);
    EXPECT_LE((W.times(v) - W.inverse_times(x)).norm(), 1e-12 * x.norm() * v.norm());
    EXPECT_LE((W.square() * v - x).norm(), 1e-11 * x.norm());
    const Vector3 p(normal(random), normal(random), normal(random));
    EXPECT_LE((product(x, quotient(x, p)) - p).norm(), 1e-10 * p.norm());
    if (const double step = longest_step(x, p); step < kInfinity) {
      EXPECT_NEAR(determinant(x + step * p) / (x + step * p).squaredNorm(), 0.0, 1e-12);
    } else {
      EXPECT_GE(p[0], std::hypot(p[1], p[2]));
    }
  }
}

TEST(ConeInteriorPoint, SeparatesAndSticksAlikeByBothLaws) {
  const Matrix M{{2, 0, 0}, {0, 4, 1}, {0, 1, 2}};
  const Vector pressing{{-4, 1, 1}};
  for (const FrictionLaw law : kLaws) {
    expect_solution(solve(one_contact(M, Vector{{4, 3, 4}}, 0.5, law)), Vector::Zero(3));
    expect_solution(solve(one_contact(M, pressing, 1.0, law)), -M.inverse() * pressing);
  }
}

// By Coulomb's law w_N = 0 and z_T = -mu z_N w_T / |w_T|; by the associated law z is the point of K
// nearest to -q / 2.
TEST(ConeInteriorPoint, SlidesByTheLawOfTheProblem) {
  const Matrix M = 2.0 * Matrix::Identity(3, 3);
  const Vector q{{-4, 3, 4}};
  expect_solution(solve(one_contact(M, q, 0.5, FrictionLaw::kCoulomb)), Vector{{2, -0.6, -0.8}});
  expect_solution(solve(one_contact(M, q, 0.5, FrictionLaw::kAssociated)),
                  Vector{{2.6, -0.78, -1.04}});
  const Matrix plane = 2.0 * Matrix::Identity(2, 2);
  expect_solution(solve(one_contact(plane, Vector{{-4, 5}}, 0.5, FrictionLaw::kCoulomb)),
                  Vector{{2, -1}});
  expect_solution(solve(one_contact(plane, Vector{{-4, 5}}, 0.5, FrictionLaw::kAssociated)),
                  Vector{{2.6, -1.3}});
}

// It slides off faster than it separates: by the associated law that takes a force, by Coulomb's
// none.
TEST(ConeInteriorPoint, OnlyCoulombsLawLetsASlidingContactSeparateFreely) {
  const Matrix M = Matrix::Identity(3, 3);
  const Vector q{{1, 3, 4}};
  expect_solution(solve(one_contact(M, q, 0.5, FrictionLaw::kCoulomb)), Vector::Zero(3));
  expect_solution(solve(one_contact(M, q, 0.5, FrictionLaw::kAssociated)),
                  Vector{{1.2, -0.36, -0.48}});
}

TEST(ConeInteriorPoint, TakesFrictionOfZeroAndHugeFriction) {
  const Matrix M = 2.0 * Matrix::Identity(3, 3);
  const Vector q{{-4, 3, 4}};
  for (const FrictionLaw law : kLaws) {
    expect_solution(solve(one_contact(M, q, 0.0, law)), Vector{{2, 0, 0}});
    expect_solution(solve(one_contact(M, -q, 0.0, law)), Vector::Zero(3));
    for (const double mu : {1e3, 1e6}) {
      expect_solution(solve(one_contact(M, q, mu, law)), Vector{{2, -1.5, -2}});
    }
  }
}

TEST(ConeInteriorPoint, CertifiesRedundantContactsByTheAssociatedLaw) {
  ConeInteriorPoint solver;
  Result result;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const int contacts = 1 + static_cast<int>(seed) % 12;
    const int dimension = 2 + static_cast<int>(seed) % 2;
    for (const double c : {0.0, 0.1}) {
      Problem problem = random_contacts(seed, contacts, dimension, 6 + contacts / 2, c);
      problem.friction_law = FrictionLaw::kAssociated;
      solver.solve(problem, result);
      EXPECT_TRUE(is_solved(result.status))
          << "seed " << seed << " c " << c << ": " << to_string(result.status) << ' '
          << result.certificate.unit_free_residual;
    }
  }
}

// One contact, written down three times: the forces are not unique, their sum is.
TEST(ConeInteriorPoint, AddsUpTheForcesOfEqualContacts) {
  Problem problem;
  Matrix G(9, 3);
  G << Matrix::Identity(3, 3), Matrix::Identity(3, 3), Matrix::Identity(3, 3);
  problem.M = Matrix(2.0 * G * G.transpose());
  problem.q = G * Vector{{-4, 3, 4}};
  problem.cones = {{0, 3, 0.5}, {3, 3, 0.5}, {6, 3, 0.5}};
  for (const FrictionLaw law : kLaws) {
    problem.friction_law = law;
    const Result result = solve(problem);
    EXPECT_EQ(result.status, Status::kSolved);
    const Vector expected =
        law == FrictionLaw::kCoulomb ? Vector{{2, -0.6, -0.8}} : Vector{{2.6, -0.78, -1.04}};
    EXPECT_LE((G.transpose() * result.z - expected).norm(), 1e-7);
  }
}

TEST(ConeInteriorPoint, CertifiesAHundredContactsOfBodiesByTheAssociatedLaw) {
  for (const bench::FamilySpec& spec : {bench::FamilySpec{.family = "tower4", .size = 25},
                                        bench::FamilySpec{.family = "pyramid2d", .size = 5},
                                        bench::FamilySpec{.family = "spheres", .size = 100}}) {
    const Problem problem = family_with_friction(spec, 0.5, FrictionLaw::kAssociated);
    const Result result = solve(problem);
    EXPECT_GE(problem.cones.size(), 100U) << spec.family;
    EXPECT_TRUE(is_solved(result.status)) << spec.family << ": " << to_string(result.status);
    EXPECT_LE(result.statistics.factorizations, 100) << spec.family;
  }
}

TEST(ConeInteriorPoint, TakesBoundsAndFreeRowsBesideCones) {
  Problem problem = random_contacts(5, 3, 3, 9, 0.1);
  problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 0.6}};
  // A cone, a free row, LCP, box, upper bound alone, fixed, box that is far away.
  problem.lower = Vector{{0, 0, 0, -kInfinity, 0, -0.1, -kInfinity, 0.25, -1e6}};
  problem.upper = Vector{{0, 0, 0, kInfinity, kInfinity, 0.1, 0.5, 0.25, 1e6}};
  for (const FrictionLaw law : kLaws) {
    problem.friction_law = law;
    const Result result = solve(problem);
    EXPECT_EQ(result.status, Status::kSolved);
    EXPECT_LE(definition_residual(problem, result.z), 1e-8);
    EXPECT_NEAR(result.w[3], 0.0, 1e-7);
    EXPECT_DOUBLE_EQ(result.z[7], 0.25);
  }
}

TEST(ConeInteriorPoint, SolvesProblemsWithoutCones) {
  Problem bounded = random_contacts(6, 4, 1, 4, 0.5);
  bounded.cones.clear();
  EXPECT_EQ(solve(bounded).status, Status::kSolved);

  Problem free = bounded;
  free.lower = Vector::Constant(4, -kInfinity);
  const Result result = solve(free);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_LE((result.z + to_dense(free.M).inverse() * free.q).norm(), 1e-7);
}

TEST(ConeInteriorPoint, TakesNoRowsAndOneRow) {
  Problem none;
  none.M = Matrix(0, 0);
  none.q = Vector(0);
  EXPECT_EQ(solve(none).status, Status::kSolved);

  Problem one;
  one.M = Matrix{{4}};
  one.q = Vector{{-2}};
  expect_solution(solve(one), Vector{{0.5}});
  one.q = Vector{{2}};
  expect_solution(solve(one), Vector{{0}});
  one.q = Vector{{0}};
  expect_solution(solve(one), Vector{{0}});
}

TEST(ConeInteriorPoint, TakesEveryFormOfMAlike) {
  Problem problem =
      family_with_friction({.family = "spheres", .size = 20}, 0.5, FrictionLaw::kAssociated);
  const Result factored = solve(problem);
  problem.M = to_dense(problem.M);
  const Result dense = solve(problem);
  problem.M = SparseMatrix(std::get<Matrix>(problem.M).sparseView());
  const Result sparse = solve(problem);
  for (const Result* result : {&factored, &dense, &sparse}) {
    EXPECT_TRUE(is_solved(result->status));
    EXPECT_LE((result->w - factored.w).norm(), 1e-6 * (1.0 + factored.w.norm()));
  }
  EXPECT_EQ(sparse.z, dense.z);
}

// Two opposite walls that approach each other: the two normal velocities add up to -2 whatever z.
TEST(ConeInteriorPoint, DoesNotCallAnInfeasibleProblemSolved) {
  Problem walls;
  Matrix G(6, 3);
  G << Matrix::Identity(3, 3), -Matrix::Identity(3, 3);
  walls.M = Matrix(G * G.transpose());
  walls.q = Vector{{-1, 0.5, 0, -1, -0.5, 0}};
  walls.cones = {{0, 3, 0.5}, {3, 3, 0.5}};
  for (const FrictionLaw law : kLaws) {
    walls.friction_law = law;
    const Result result = solve(walls);
    EXPECT_FALSE(is_solved(result.status));
    EXPECT_NE(result.status, Status::kInfeasible);  // nothing is proven here
    EXPECT_TRUE(result.z.allFinite());
    EXPECT_GT(result.certificate.natural_residual, 0.1);
  }
}

TEST(ConeInteriorPoint, StopsAtItsLimits) {
  Problem problem = random_contacts(8, 30, 3, 20, 0.0);
  problem.friction_law = FrictionLaw::kAssociated;
  ConeInteriorPointSettings settings;
  settings.max_iterations = 2;
  const Result few = solve(problem, settings);
  EXPECT_EQ(few.status, Status::kIterationLimit);
  EXPECT_EQ(few.statistics.iterations, 2);
  EXPECT_EQ(few.statistics.factorizations, 2);
  EXPECT_TRUE(few.z.allFinite());
  settings.max_iterations = -1;
  settings.time_limit = 1e-9;
  EXPECT_EQ(solve(problem, settings).status, Status::kTimeLimit);
}

TEST(ConeInteriorPoint, NeedsNothingToSeeThatAWarmStartIsTheAnswer) {
  Problem problem = random_contacts(3, 10, 3, 12, 0.0);
  problem.friction_law = FrictionLaw::kAssociated;
  const Result cold = solve(problem);
  ASSERT_EQ(cold.status, Status::kSolved);
  const Result warm = solve(problem, {}, &cold.z);
  EXPECT_EQ(warm.statistics.factorizations, 0);
  EXPECT_EQ(warm.z, cold.z);
}

TEST(ConeInteriorPoint, GivesTheSameBitsAgain) {
  const Problem problem = random_contacts(9, 20, 3, 24, 0.0);
  ConeInteriorPoint solver;
  Result result;
  solver.solve(problem, result);
  const Vector first = result.z;
  solver.solve(family_with_friction({.family = "tower4", .size = 2}, 0.5, FrictionLaw::kCoulomb),
               result);
  solver.solve(problem, result);
  EXPECT_EQ(result.z, first);
}

TEST(ConeInteriorPoint, EndsOnNaNAsInvalidInput) {
  Problem problem = random_contacts(1, 2, 3, 6, 0.0);
  problem.q[4] = std::nan("");
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kInvalidInput);
  EXPECT_NE(result.detail.find("q[4]"), std::string::npos) << result.detail;
}

TEST(ConeInteriorPoint, RefusesCoupledLimitsAndNamesTheRow) {
  Problem problem = random_contacts(1, 2, 3, 6, 0.1);
  problem.cones.pop_back();
  problem.limits = {{.row = 5, .normal_row = 4, .coefficient = 0.3}};
  const std::string why = ConeInteriorPoint().refuses(problem);
  EXPECT_NE(why.find("coupled limits; row 5"), std::string::npos) << why;
  EXPECT_THROW(solve(problem), std::invalid_argument);
}

std::string refused(const std::function<void(ConeInteriorPointSettings&)>& change) {
  ConeInteriorPointSettings settings;
  change(settings);
  try {
    const ConeInteriorPoint solver(settings);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(ConeInteriorPoint, RefusesSettingsOutOfRange) {
  EXPECT_EQ(refused([](auto& s) { s.polish_steps = -1; }),
            "settings: polish_steps: must be >= 0, got -1");
  EXPECT_EQ(refused([](auto& s) { s.step_fraction = 1.0; }),
            "settings: step_fraction: must be in (0, 1), got 1");
  EXPECT_NE(refused([](auto& s) { s.step_fraction = std::nan(""); }), "");
  EXPECT_NE(refused([](auto& s) { s.tolerance = 0.0; }), "");
}

/// At 1e-15 the path ends short of the tolerance, and the polish follows.
TEST(ConeInteriorPoint, AllocatesNothingTheSecondTimeButInTheBackEnd) {
  const Problem given = random_contacts(3, 12, 3, 16, 0.1);
  const Problem sparse = random_contacts(3, 60, 3, 80, 0.1);
  const Problem bodies = family_with_friction({"tower4", 64}, 0.5, FrictionLaw::kCoulomb);
  for (const Problem* problem : {&given, &sparse, &bodies}) {
    ConeInteriorPoint solver({{.tolerance = 1e-15}, 20});
    Result result;
    solver.solve(*problem, result);
    ASSERT_GT(result.statistics.factorizations, result.statistics.iterations + 1) << "no polish";
    const AllocationCount allocations;
    solver.solve(*problem, result);
    EXPECT_EQ(allocations.count(), 0);
    EXPECT_EQ(allocations.back_end_count() > 0, problem == &sparse);
    EXPECT_EQ(result.statistics.factor_bytes > 0, problem != &given);
  }
}

}  // namespace
}  // namespace signorini::lcp
