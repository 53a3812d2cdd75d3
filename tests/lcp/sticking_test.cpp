#include <signorini/lcp/alart_curnier.h>
#include <signorini/lcp/sticking.h>

#include "allocation_count.h"
#include "bench/contact_families.h"

#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

Result solve(const Problem& problem, const StickingSettings& settings = {},
             const Vector* warm_start = nullptr) {
  Result result;
  Sticking(settings).solve(problem, result, warm_start);
  return result;
}

/// One body of mass 1/2 at one point: M = 2 I.
Problem one_contact(const Vector& q, double mu) {
  FactoredMatrix A;
  A.mass.add_inverse(2.0 * Matrix::Identity(3, 3));
  for (int k = 0; k < 3; ++k) {
    A.add_row();
    A.add_entry(0, Vector(Vector::Unit(3, k)));
  }
  Problem problem;
  problem.M = A;
  problem.q = q;
  problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = mu}};
  return problem;
}

/// A family of bench/contact_families.h at rest, with friction cones.
Problem resting(const bench::FamilySpec& spec, double mu, const Eigen::Vector3d& gravity) {
  const bench::FamilyScene scene = bench::make_family_scene(spec);
  FactoredMatrix A = scene.inverse_mass();
  Problem problem;
  for (const auto& touch : scene.touches) {
    problem.cones.push_back({A.rows(), 3, mu});
    const Eigen::Vector3d t1 = touch.normal.unitOrthogonal();
    for (const Eigen::Vector3d& direction : {touch.normal, t1, touch.normal.cross(t1).eval()}) {
      scene.add_row(touch, direction, A);
    }
  }
  problem.q.setZero(A.rows());
  for (int i = 0; i < A.rows(); ++i) {
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      problem.q[i] += Eigen::Map<const Eigen::Vector3d>(A.values(entry)).dot(gravity) / 60.0;
    }
  }
  problem.M = A;
  return problem;
}

const Eigen::Vector3d kDown(0.0, 0.0, -9.81);

TEST(Sticking, OneContactSeparatesSticksOrSlides) {
  EXPECT_EQ(solve(one_contact(Vector{{1, 5, 5}}, 0.5)).z, Vector::Zero(3));
  const Result stick = solve(one_contact(Vector{{-2, 0.5, 0}}, 0.5));
  EXPECT_EQ(stick.status, Status::kSolved);
  EXPECT_LT((stick.z - Vector{{1, -0.25, 0}}).norm(), 1e-14);
  const Result slide = solve(one_contact(Vector{{-2, 6, 8}}, 0.5));
  EXPECT_EQ(slide.status, Status::kSolved);
  EXPECT_LT((slide.z - Vector{{1, -0.3, -0.4}}).norm(), 1e-14);
}

TEST(Sticking, StacksAtRestAreSolvedFromTheirNeighbours) {
  for (const auto& spec : {bench::FamilySpec{.family = "tower4", .size = 30, .at_rest = true},
                           {.family = "pyramid2d", .size = 8, .at_rest = true}}) {
    SCOPED_TRACE(std::string(spec.family));
    const Problem problem = resting(spec, 0.5, kDown);
    Result start;
    AlartCurnier().solve(problem, start);
    ASSERT_EQ(start.status, Status::kSolved);
    // The same pile with gravity a little turned: everything still sticks.
    const Problem turned = resting(spec, 0.5, kDown + Eigen::Vector3d(0.02, -0.01, 0.0));
    const Result result = solve(turned, {}, &start.z);
    EXPECT_EQ(result.status, Status::kSolved) << result.certificate.unit_free_residual;
    EXPECT_LE(result.statistics.factorizations, 10);
    EXPECT_LT(result.w.cwiseAbs().maxCoeff(), 1e-9);
    // Its solution again costs nothing.
    const Result again = solve(turned, {}, &result.z);
    EXPECT_EQ(again.status, Status::kSolved);
    EXPECT_EQ(again.statistics.factorizations, 0);
    EXPECT_EQ(again.z, result.z);
  }
}

TEST(Sticking, ATowerPushedBeyondFrictionSlidesAsAlartCurnierSays) {
  const bench::FamilySpec spec{.family = "tower4", .size = 2, .at_rest = true};
  const Problem problem = resting(spec, 0.2, kDown + Eigen::Vector3d(3.0, 1.0, 0.0));
  Result other;
  AlartCurnier({{.tolerance = 1e-12}}).solve(problem, other);
  ASSERT_TRUE(is_solved(other.status));
  const Result result = solve(problem, {}, &other.z);
  EXPECT_TRUE(is_solved(result.status));
  EXPECT_LT((result.w - other.w).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT(result.w.cwiseAbs().maxCoeff(), 1e-3);  // it does slide
}

TEST(Sticking, ASlipThatIsRoundingDoesNotTurnFriction) {
  // Unit mass / 2 on two contacts at one place that strain against each other, both at the edge of
  // their cones, gravity off by 1e-9.
  FactoredMatrix A;
  A.mass.add_inverse(2.0 * Matrix::Identity(3, 3));
  for (int row = 0; row < 6; ++row) {
    A.add_row();
    A.add_entry(0, Vector(Vector::Unit(3, row % 3)));
  }
  Problem problem;
  problem.M = A;
  problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 0.5},
                   {.normal_row = 3, .dimension = 3, .coefficient = 0.5}};
  const Vector start{{0.5, 0.25, 0.0, 0.5, -0.25, 0.0}};
  for (const double slip : {1e-13, 1e-12}) {
    problem.q = Vector{{-2.0 - 1e-9, -0.1 * slip, -slip, -2.0 - 1e-9, -0.1 * slip, -slip}};
    const Result result = solve(problem, {}, &start);
    EXPECT_EQ(result.status, Status::kSolved);
    EXPECT_EQ(result.statistics.factorizations, 1);
    EXPECT_LT(result.w.cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LT((result.z - start).cwiseAbs().maxCoeff(), 1e-8) << result.z.transpose();
  }
}

TEST(Sticking, ASolvedStartIsKeptWhereItsSetIsMuchWorse) {
  // A bar on two supports that the push lifts off the second: with both closed it must pull.
  FactoredMatrix A;
  A.mass.add_inverse(Matrix{{1.0, 0.0}, {0.0, 0.1}});  // M = [1.1 0.9; 0.9 1.1]
  for (const double arm : {-1.0, 1.0}) {
    A.add_row();
    A.add_entry(0, Vector{{1.0, arm}});
  }
  Problem problem;
  problem.M = A;
  problem.q = Vector{{-1.1, -0.7}};  // z = (1, 0), w = (0, 0.2)
  const Vector start{{1.0, 0.01}};
  StickingSettings settings;
  settings.tolerance = 0.05;
  const Result kept = solve(problem, settings, &start);
  EXPECT_EQ(kept.status, Status::kSolved);
  EXPECT_EQ(kept.z, start);
  EXPECT_EQ(kept.statistics.factorizations, 1);
  settings.tolerance = 1e-8;  // a start that is not solved gets the sets it takes
  const Result solved = solve(problem, settings, &start);
  EXPECT_EQ(solved.status, Status::kSolved);
  EXPECT_LT((solved.z - Vector{{1.0, 0.0}}).norm(), 1e-14);
  EXPECT_EQ(solved.statistics.factorizations, 2);
}

TEST(Sticking, FreeRowsAndRowsWithoutFriction) {
  // Three unit masses in a row along x: a contact pushes the first, a free row ties it to the
  // second, an LCP row holds the second against the third.
  FactoredMatrix A;
  for (int k = 0; k < 3; ++k) A.mass.add_inverse(Matrix::Identity(3, 3));
  const Vector x = Vector::Unit(3, 0);
  for (int k = 0; k < 3; ++k) {
    A.add_row();
    A.add_entry(0, Vector(Vector::Unit(3, k)));
  }
  A.add_row();
  A.add_entry(0, x);
  A.add_entry(1, Vector(-x));
  A.add_row();
  A.add_entry(1, Vector(-x));
  A.add_entry(2, x);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Problem problem;
  problem.M = A;
  problem.q = Vector{{-3.0, 0.1, 0.0, 0.0, 3.0}};
  problem.lower = Vector{{0.0, 0.0, 0.0, -kInfinity, 0.0}};
  problem.upper = Vector::Constant(5, kInfinity);
  problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 0.5}};
  const Result result = solve(problem);
  EXPECT_EQ(result.status, Status::kSolved);
  EXPECT_LT(std::abs(result.w[3]), 1e-14);
  EXPECT_LT(std::abs(result.w[0]), 1e-14);
  EXPECT_GT(std::abs(result.z[3]), 1.0);
}

/// Point masses on each other, four contacts between any two, at rest under gravity.
Problem column(const std::vector<double>& masses) {
  FactoredMatrix A;
  Problem problem;
  for (const double mass : masses) {
    A.mass.add_inverse(1.0 / mass * Matrix::Identity(3, 3));
  }
  for (int body = 0; body < static_cast<int>(masses.size()); ++body) {
    for (int contact = 0; contact < 4; ++contact) {
      problem.cones.push_back({A.rows(), 3, 0.5});
      for (int k = 0; k < 3; ++k) {
        A.add_row();
        A.add_entry(body, Vector(Vector::Unit(3, k)));
        if (body > 0) {
          A.add_entry(body - 1, Vector(-Vector::Unit(3, k)));
        }
      }
    }
  }
  problem.q.setZero(A.rows());
  for (int contact = 0; contact < 4; ++contact) {
    problem.q[3 * contact] = -9.81 / 60.0;
  }
  problem.M = A;
  return problem;
}

// Beside 1e9 kg a double's product M z knows the light body's velocity to 1e-7 m/s; what is asked
// for is that of the heavy one, whose forces must be its weight to more digits than that.
TEST(Sticking, AHeavyBodyOnLightOnesRestsToItsOwnDigits) {
  std::vector<double> masses(60, 1.0);
  masses.back() = 1e9;
  const Problem problem = column(masses);
  Vector start = Vector::Zero(problem.size());
  for (std::size_t c = 0; c < problem.cones.size(); ++c) {
    start[problem.cones[c].normal_row] = 1e9 * 9.81 / 60.0 * (c % 4 == 0 ? 0.4 : 0.2);
  }
  const Result result = solve(problem, {{.tolerance = 1e-13}}, &start);
  EXPECT_EQ(result.status, Status::kSolvedToRounding);
  double carried = 0.0;
  for (int contact = 236; contact < 240; ++contact) {
    carried += result.z[problem.cones[contact].normal_row];
  }
  EXPECT_NEAR(carried / (1e9 * 9.81 / 60.0), 1.0, 1e-9);  // without: 3e-8
  EXPECT_EQ(result.statistics.factorizations, 2);         // the set's, and one for the last digits
}

TEST(Sticking, LimitsEndWithTheirStatusAndTheBestIterate) {
  const Problem problem = resting({.family = "tower4", .size = 30, .at_rest = true}, 0.5, kDown);
  const Result few = solve(problem, {{.max_iterations = 1}});
  EXPECT_EQ(few.status, Status::kIterationLimit);
  EXPECT_EQ(few.statistics.factorizations, 1);
  const Result none = solve(problem, {{.max_iterations = 0}});
  EXPECT_EQ(none.status, Status::kIterationLimit);
  EXPECT_EQ(none.z, Vector::Zero(problem.size()));
  EXPECT_EQ(solve(problem, {{.time_limit = 1e-12}}).status, Status::kTimeLimit);
}

TEST(Sticking, RefusesWhatItCannotTake) {
  Problem problem = one_contact(Vector{{-1, 0, 0}}, 0.5);
  problem.lower = Vector::Constant(3, -1.0);
  EXPECT_EQ(Sticking().refuses(problem), "");  // bounds of a cone's rows do not count
  problem.cones.clear();
  EXPECT_NE(Sticking().refuses(problem).find("row 0"), std::string::npos);
  problem.lower.resize(0);
  problem.limits = {{1, 0, 0.5}};
  EXPECT_NE(Sticking().refuses(problem).find("row 1"), std::string::npos);
  problem.limits.clear();
  problem.M = Matrix(Matrix::Identity(3, 3));
  EXPECT_NE(Sticking().refuses(problem).find("factored"), std::string::npos);
  problem = one_contact(Vector{{-1, std::nan(""), 0}}, 0.5);
  EXPECT_EQ(solve(problem).status, Status::kInvalidInput);
}

TEST(Sticking, AllocatesNothingTheSecondTime) {
  const Problem problem = resting({.family = "pyramid2d", .size = 5, .at_rest = true}, 0.5, kDown);
  Result start;
  AlartCurnier().solve(problem, start);
  const Problem turned = resting({.family = "pyramid2d", .size = 5, .at_rest = true}, 0.5,
                                 kDown + Eigen::Vector3d(0.02, -0.01, 0.0));
  Sticking solver;
  Result result;
  solver.solve(turned, result, &start.z);
  const AllocationCount allocations;
  solver.solve(turned, result, &start.z);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_GT(result.statistics.factorizations, 0);
}

}  // namespace
}  // namespace signorini::lcp
