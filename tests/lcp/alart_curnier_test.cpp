#include <signorini/lcp/alart_curnier.h>
#include <signorini/lcp/alart_curnier_function.h>
#include <signorini/lcp/friction_cone.h>

#include "allocation_count.h"
#include "definition_residual.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Result solve(const Problem& problem, const AlartCurnierSettings& settings = {},
             const Vector* warm_start = nullptr) {
  Result result;
  AlartCurnier(settings).solve(problem, result, warm_start);
  return result;
}

Problem one_contact(const Matrix& M, const Vector& q, double mu) {
  Problem problem;
  problem.M = M;
  problem.q = q;
  problem.cones = {{.normal_row = 0, .dimension = static_cast<int>(q.size()), .coefficient = mu}};
  return problem;
}

/// A random contact problem A = G G^T + c with more rows than bodies where redundant.
Problem random_contacts(unsigned seed, int contacts, int dimension, int freedom, double c) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const int n = contacts * dimension;
  Matrix G(n, freedom);
  for (double& value : G.reshaped()) value = normal(random);
  Problem problem;
  problem.M = Matrix(G * G.transpose() + c * Matrix::Identity(n, n));
  Vector v(freedom);
  for (double& value : v) value = normal(random);
  problem.q = G * v;  // the motion of free bodies: feasible whatever the contacts
  for (int k = 0; k < contacts; ++k) {
    problem.cones.push_back({dimension * k, dimension, 0.1 * (k % 10)});
  }
  return problem;
}

/// A mixture of everything: a Coulomb cone, a box row, a free row, a coupled row.
Problem mixture() {
  Problem problem = random_contacts(5, 2, 3, 9, 0.1);
  problem.cones.resize(1);
  problem.cones[0].coefficient = 0.6;
  problem.lower = Vector{{0, 0, 0, -kInfinity, 0, -0.1}};
  problem.upper = Vector{{0, 0, 0, kInfinity, kInfinity, 0.1}};
  return problem;
}

TEST(AlartCurnierFunction, DerivativeIsThatOfDifferences) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const FrictionLaw law : {FrictionLaw::kCoulomb, FrictionLaw::kAssociated}) {
    for (int trial = 0; trial < 200; ++trial) {
      Problem problem = mixture();
      problem.friction_law = law;
      problem.limits = {{.row = 5, .normal_row = 4, .coefficient = 0.3}};
      const int n = 6;
      AlartCurnierFunction function;
      function.set(problem, Vector::Ones(n), 1.0);
      Vector x(n);
      Vector u(n);
      Vector dx(n);
      Vector du(n);
      for (int i = 0; i < n; ++i) {
        x[i] = normal(random);
        u[i] = normal(random);
        dx[i] = normal(random);
        du[i] = normal(random);
      }
      const double rho = std::exp(normal(random));
      std::vector<AlartCurnierFunction::Block> A;
      std::vector<AlartCurnierFunction::Block> B;
      std::vector<AlartCurnierFunction::Coupling> couplings;
      function.differentiate(x, u, rho, A, B, couplings);
      Vector expected = Vector::Zero(n);
      for (std::size_t g = 0; g < function.groups().size(); ++g) {
        const auto& group = function.groups()[g];
        for (int i = 0; i < group.dimension; ++i) {
          for (int j = 0; j < group.dimension; ++j) {
            expected[group.first + i] +=
                A[g](i, j) * dx[group.first + j] + B[g](i, j) * du[group.first + j];
          }
        }
      }
      for (const auto& coupling : couplings) {
        expected[coupling.row] += coupling.value * dx[coupling.column];
      }
      const double h = 1e-7;
      Vector ahead(n);
      Vector behind(n);
      function.evaluate(x + h * dx, u + h * du, rho, ahead);
      function.evaluate(x - h * dx, u - h * du, rho, behind);
      const Vector slope = (ahead - behind) / (2 * h);
      // A kink within h of the point (probability about 1e-6 a trial) would show here.
      EXPECT_LE((slope - expected).cwiseAbs().maxCoeff(), 1e-5 * (1 + expected.norm()))
          << "trial " << trial;
    }
  }
}

TEST(AlartCurnier, SeparatesSticksAndSlides) {
  const Matrix M = 2.0 * Matrix::Identity(3, 3);
  const Result separates = solve(one_contact(M, Vector{{1, 5, 5}}, 0.5));
  EXPECT_EQ(separates.status, Status::kSolved);
  EXPECT_EQ(separates.z, Vector::Zero(3));

  const Result sticks = solve(one_contact(M, Vector{{-4, 1, 1}}, 1.0));
  EXPECT_EQ(sticks.status, Status::kSolved);
  EXPECT_LE((sticks.z - Vector{{2, -0.5, -0.5}}).norm(), 1e-8);

  const Result slides = solve(one_contact(M, Vector{{-4, 3, 4}}, 0.5));
  EXPECT_EQ(slides.status, Status::kSolved);
  EXPECT_LE((slides.z - Vector{{2, -0.6, -0.8}}).norm(), 1e-7);
  EXPECT_LE(slides.certificate.cone_violation, 1e-8);
}

TEST(AlartCurnier, SlidesInThePlaneAndByTheAssociatedLaw) {
  Problem problem = one_contact(2.0 * Matrix::Identity(3, 3), Vector{{-4, 3, 4}}, 0.5);
  problem.friction_law = FrictionLaw::kAssociated;
  const Result associated = solve(problem);
  EXPECT_EQ(associated.status, Status::kSolved);
  EXPECT_LE((associated.z - Vector{{2.6, -0.78, -1.04}}).norm(), 1e-7);

  const Result plane = solve(one_contact(Matrix{{2, 0}, {0, 2}}, Vector{{-4, 5}}, 0.5));
  EXPECT_LE((plane.z - Vector{{2, -1}}).norm(), 1e-8);
}

TEST(AlartCurnier, CertifiesRandomAndRedundantContacts) {
  AlartCurnier solver;
  Result result;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const int contacts = 1 + static_cast<int>(seed) % 12;
    const int dimension = 2 + static_cast<int>(seed) % 2;
    for (const double c : {0.0, 0.1}) {
      Problem problem = random_contacts(seed, contacts, dimension, 6 + contacts / 2, c);
      for (const FrictionLaw law : {FrictionLaw::kCoulomb, FrictionLaw::kAssociated}) {
        problem.friction_law = law;
        solver.solve(problem, result);
        EXPECT_EQ(result.status, Status::kSolved)
            << "seed " << seed << " c " << c << ' ' << to_string(law) << ": "
            << to_string(result.status) << ' ' << result.certificate.unit_free_residual;
      }
    }
  }
}

TEST(AlartCurnier, TakesBoundsFreeRowsAndCoupledLimitsBesideCones) {
  Problem problem = mixture();
  const Result bounded = solve(problem);
  EXPECT_EQ(bounded.status, Status::kSolved);
  EXPECT_LE(definition_residual(problem, bounded.z), 1e-8);
  EXPECT_GE(definition_residual(problem, bounded.z + Vector::Constant(6, 1e-3)), 1e-5);
  problem.limits = {{.row = 5, .normal_row = 4, .coefficient = 0.3}};
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_LE(definition_residual(problem, result.z), 1e-8);
  EXPECT_LE(std::abs(result.z[5]), 0.3 * result.z[4] + 1e-8);
  EXPECT_NEAR(result.w[3], 0.0, 1e-7);
}

TEST(AlartCurnier, TakesTheSparseAndTheDenseFormAlike) {
  Problem problem = random_contacts(3, 50, 3, 60, 0.0);
  const Result dense = solve(problem);
  problem.M = SparseMatrix(std::get<Matrix>(problem.M).sparseView());
  const Result sparse = solve(problem);
  EXPECT_EQ(dense.status, Status::kSolved);
  EXPECT_EQ(sparse.z, dense.z);
}

// Two bodies, one of which no row moves; a row that moves nothing; general block sizes; compliance.
TEST(AlartCurnier, SolvesAFactoredProblemAsItDoesTheFormedOne) {
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 40; ++trial) {
    FactoredMatrix A;
    const std::array<int, 4> sizes{6, 1, 6, 3};
    for (const int size : sizes) {
      Matrix root(size, size);
      for (double& value : root.reshaped()) value = normal(random);
      A.mass.add_inverse(Matrix(root * root.transpose() + Matrix::Identity(size, size)));
    }
    const int contacts = 1 + trial % 4;
    Problem problem;
    for (int c = 0; c < contacts; ++c) {
      const int other = 1 + (c + trial) % 3;
      problem.cones.push_back({A.rows(), 3, 0.2 * c});
      for (int k = 0; k < 3; ++k) {
        A.add_row(trial % 3 == 0 ? 0.1 : 0.0);
        Vector values(6);
        for (double& value : values) value = normal(random);
        A.add_entry(0, values);
        values.conservativeResize(sizes[other]);
        if (trial % 5 == 0) values.setZero();
        A.add_entry(other, values);
      }
    }
    A.add_row();
    A.add_entry(1, Vector::Zero(1));
    Vector v(A.rows());
    for (double& value : v) value = normal(random);
    problem.q.resize(A.rows());
    A.multiply(v.data(), problem.q.data());
    problem.M = A;
    const Result factored = solve(problem);
    problem.M = A.form();
    const Result formed = solve(problem);
    EXPECT_EQ(factored.status, Status::kSolved) << trial;
    EXPECT_EQ(formed.status, Status::kSolved) << trial;
    EXPECT_LE((factored.w - formed.w).norm(), 1e-5 * (1.0 + formed.w.norm())) << trial;
  }
}

TEST(AlartCurnier, StartsWarmFromItsAnswer) {
  const Problem problem = random_contacts(3, 20, 3, 24, 0.0);
  const Result cold = solve(problem);
  ASSERT_EQ(cold.status, Status::kSolved);
  EXPECT_EQ(solve(problem, {}, &cold.z).statistics.factorizations, 0);
}

TEST(AlartCurnier, AStartThatStrainsAgainstItselfIsGivenUpForZero) {
  // Eight rough contacts of nine degrees of freedom hold any forces against each other; beside a
  // million of them the residual is rounding. Gone on from it took 4000 factorisations, to 2e-8.
  for (const unsigned seed : {3U, 4U}) {
    Problem problem = random_contacts(seed, 8, 3, 9, 0.0);
    for (FrictionCone& cone : problem.cones) cone.coefficient = 1e3;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 1e6);
    Vector start(problem.size());
    for (double& value : start) value = normal(random);
    AlartCurnierSettings settings;
    settings.tolerance = 1e-10;
    const Result result = solve(problem, settings, &start);
    EXPECT_EQ(result.status, Status::kSolved);
    EXPECT_LT(result.statistics.factorizations, 2000);
    EXPECT_EQ(result.z, solve(problem, settings).z);
  }
}

TEST(AlartCurnier, GivesTheSameBitsAgain) {
  const Problem problem = random_contacts(9, 20, 3, 24, 0.0);
  AlartCurnier solver;
  Result result;
  solver.solve(problem, result);
  const Vector first = result.z;
  solver.solve(random_contacts(4, 7, 2, 5, 0.1), result);
  solver.solve(problem, result);
  EXPECT_EQ(result.z, first);
}

// Two opposite walls that approach each other: w = -1 whatever z.
TEST(AlartCurnier, DoesNotCallAnInfeasibleProblemSolved) {
  Problem problem;
  problem.M = Matrix{{1, -1}, {-1, 1}};
  problem.q = Vector{{-1, -1}};
  const Result result = solve(problem);
  EXPECT_FALSE(is_solved(result.status));
  EXPECT_TRUE(result.z.allFinite());
}

TEST(AlartCurnier, StopsAtItsLimits) {
  const Problem problem = random_contacts(8, 30, 3, 20, 0.0);
  AlartCurnierSettings settings;
  settings.max_iterations = 2;
  const Result few = solve(problem, settings);
  EXPECT_EQ(few.status, Status::kIterationLimit);
  EXPECT_LE(few.statistics.factorizations, 2);
  EXPECT_LT(few.certificate.unit_free_residual, 1.0);
  settings.max_iterations = -1;
  settings.time_limit = 1e-9;
  EXPECT_EQ(solve(problem, settings).status, Status::kTimeLimit);
}

TEST(AlartCurnier, TakesNoRowsAndRefusesNaN) {
  Problem problem;
  problem.M = Matrix(0, 0);
  problem.q = Vector(0);
  EXPECT_EQ(solve(problem).status, Status::kSolved);
  problem = random_contacts(1, 2, 3, 6, 0.0);
  problem.q[4] = std::nan("");
  EXPECT_EQ(solve(problem).status, Status::kInvalidInput);
}

TEST(AlartCurnier, RefusesSettingsOutOfRange) {
  AlartCurnierSettings settings;
  settings.proximal = 0.0;
  EXPECT_THROW(AlartCurnier{settings}, std::invalid_argument);
  settings = {};
  settings.inner_steps = 0;
  EXPECT_THROW(AlartCurnier{settings}, std::invalid_argument);
}

/// Contacts in space of one body of six freedoms with the next, and a common ground.
Problem chain(unsigned seed, int bodies, int contacts_each) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  FactoredMatrix A;
  for (int b = 0; b < bodies; ++b) A.mass.add_inverse(Matrix::Identity(6, 6));
  Problem problem;
  Vector v(6 * bodies);
  for (double& value : v) value = normal(random);
  std::vector<double> q;
  for (int c = 0; c < bodies * contacts_each; ++c) {
    problem.cones.push_back({A.rows(), 3, 0.3});
    for (int k = 0; k < 3; ++k) {
      A.add_row();
      q.push_back(0.0);
      for (int b = c % bodies; b <= std::min(c % bodies + 1, bodies - 1); ++b) {
        Vector values(6);
        for (double& value : values) value = normal(random);
        A.add_entry(b, values);
        q.back() += values.dot(v.segment(6 * b, 6));
      }
    }
  }
  problem.q = Eigen::Map<const Vector>(q.data(), static_cast<Index>(q.size()));
  problem.M = A;
  return problem;
}

TEST(AlartCurnier, TakesCoupledLimitsInBodySpaceAsItDoesFormed) {
  for (const int bodies : {4, 12}) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(std::to_string(bodies) + " bodies, seed " + std::to_string(seed));
      Problem problem = chain(seed, bodies, 1);
      const int n = static_cast<int>(problem.size());
      problem.cones.clear();
      for (int i = 0; i + 2 < n; i += 3) {
        problem.limits.push_back({i + 1, i, 0.3});
        problem.limits.push_back({i + 2, (i + n / 2) % n / 3 * 3, 0.2});  // of bodies far off
      }
      const Result factored = solve(problem);
      problem.M = std::get<FactoredMatrix>(problem.M).form();
      const Result formed = solve(problem);
      EXPECT_EQ(factored.status, Status::kSolved);
      EXPECT_EQ(formed.status, Status::kSolved);
      EXPECT_EQ(factored.statistics.factorizations, formed.statistics.factorizations);
      EXPECT_LE((factored.w - formed.w).norm(), 1e-6 * (1.0 + formed.w.norm()));
    }
  }
}

TEST(AlartCurnier, TakesLimitsThatFollowACoupledRow) {
  Problem problem = chain(3, 4, 1);
  problem.cones.clear();
  for (int i = 0; i + 2 < problem.size(); i += 3) {
    problem.limits.push_back({i + 1, i, 0.3});
    problem.limits.push_back({i + 2, i + 1, 0.5});
  }
  EXPECT_EQ(solve(problem).status, Status::kSolved);
}

/// Solves twice. @return the numbers that the back-end holds, in bytes.
/// @param back_end_allocates whenever it holds any
std::int64_t expect_no_allocation_the_second_time(const Problem& problem,
                                                  bool back_end_allocates = true) {
  AlartCurnier solver;
  Result result;
  solver.solve(problem, result);
  EXPECT_EQ(result.status, Status::kSolved);
  const AllocationCount allocations;
  solver.solve(problem, result);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(allocations.back_end_count() > 0,
            back_end_allocates && result.statistics.factor_bytes > 0);
  return result.statistics.factor_bytes;
}

TEST(AlartCurnier, AllocatesNothingTheSecondTimeButInTheBackEnd) {
  Problem small = random_contacts(3, 12, 3, 16, 0.1);
  EXPECT_EQ(expect_no_allocation_the_second_time(small), 0) << "dense, given dense";
  small.M = SparseMatrix(std::get<Matrix>(small.M).sparseView());
  EXPECT_EQ(expect_no_allocation_the_second_time(small), 0) << "dense, given sparse";
  const Problem large = random_contacts(3, 120, 3, 150, 0.1);
  EXPECT_GT(expect_no_allocation_the_second_time(large), 0) << "sparse";
  Problem bodies = chain(4, 12, 3);
  EXPECT_GT(expect_no_allocation_the_second_time(bodies, false), 0) << "body space";
  const int n = static_cast<int>(bodies.size());
  bodies.cones.clear();
  for (int i = 0; i + 2 < n; i += 3) bodies.limits.push_back({i + 1, i, 0.3});
  EXPECT_GT(expect_no_allocation_the_second_time(bodies, false), 0) << "with coupled limits";
}

}  // namespace
}  // namespace signorini::lcp
