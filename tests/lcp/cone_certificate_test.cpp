#include <signorini/lcp/certificate.h>
#include <signorini/lcp/friction_cone.h>

#include "stated_lcp.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace signorini::lcp {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kTolerance = 1e-8;

Problem one_contact(double mu, FrictionLaw law) {
  Problem problem = lcp(2.0 * Matrix::Identity(3, 3), vector({-4, 3, 4}));
  problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = mu}};
  problem.friction_law = law;
  return problem;
}

// Slides: z_N = 2, |z_T| = 1 against w_T = (3, 4) - 2 (.6, .8).
TEST(ConeCertificate, OfACoulombContactThatSlidesIsZeroOnlyAgainstItsVelocity) {
  const Problem problem = one_contact(0.5, FrictionLaw::kCoulomb);
  const Certificate c = certify(problem, vector({2, -0.6, -0.8}));
  EXPECT_LE(c.unit_free_residual, kEpsilon);
  EXPECT_LE(c.natural_residual, kEpsilon);
  EXPECT_EQ(c.min_z, 2.0);
  EXPECT_EQ(c.min_w, 0.0);
  EXPECT_LE(c.complementarity, 4 * kEpsilon);
  EXPECT_LE(c.cone_violation, kEpsilon);
  EXPECT_EQ(c.worst_row, 0);
  // along the velocity: moved_T = (.6, .8) - (3 + 1.2, 4 + 1.6) / 2 points the other way
  EXPECT_GT(certify(problem, vector({2, 0.6, 0.8})).unit_free_residual, 0.5);
  EXPECT_GT(certify(problem, vector({2, 0, 0})).unit_free_residual, 0.1);
}

TEST(ConeCertificate, OfAContactThatSticksIsZeroInsideItsCone) {
  const Problem problem = one_contact(2.0, FrictionLaw::kCoulomb);
  EXPECT_EQ(certify(problem, vector({2, -1.5, -2})).unit_free_residual, 0.0);
  // w = (0, 1, 0), w~ = (2, 1, 0), z - w~ / 2 = (1, -1.5, -2), P of it (1.2, -1.44, -1.92)
  EXPECT_DOUBLE_EQ(certify(problem, vector({2, -1, -2})).unit_free_residual,
                   2.0 * std::sqrt(0.8 * 0.8 + 0.44 * 0.44 + 0.08 * 0.08) / 4.0);
}

// The convex model lifts a sliding contact: w_N = mu |w_T|, which Coulomb's law refuses.
TEST(ConeCertificate, OfTheAssociatedLawLiftsASlidingContact) {
  // w = (-4 + 2 a, 5 - a): w_N = (5 - a) / 2 at a = 13 / 5
  const double a = 2.6;
  const Vector z = vector({a, -0.5 * a * 0.6, -0.5 * a * 0.8});
  EXPECT_LE(certify(one_contact(0.5, FrictionLaw::kAssociated), z).unit_free_residual, kEpsilon);
  EXPECT_GT(certify(one_contact(0.5, FrictionLaw::kCoulomb), z).unit_free_residual, 0.1);
  EXPECT_GT(certify(one_contact(0.5, FrictionLaw::kAssociated), vector({2, -0.6, -0.8}))
                .unit_free_residual,
            0.1);
}

// 2 x 2: M_cc = [[3, 1], [1, 3]] has the largest eigenvalue 4; at z = 0, w = q.
TEST(ConeCertificate, MeasuresAConeByTheLargestEigenvalueOfItsBlock) {
  Problem problem = lcp(Matrix{{3, 1}, {1, 3}}, vector({-8, 0}));
  problem.cones = {{.normal_row = 0, .dimension = 2, .coefficient = 0.5}};
  EXPECT_DOUBLE_EQ(certify(problem, vector({0, 0})).unit_free_residual, 1.0);
  EXPECT_DOUBLE_EQ(certify(problem, vector({0, 0})).natural_residual, 8.0 / 9.0);
  // outside the cone by |z_T| = 1: w = (-7 + 10, 3), 4 |(0, 1) - P((0, 1) - (3 + 1.5, 3) / 4)|
  problem.q[0] = 2.0;
  const double x0 = -4.5 / 4.0;
  const double x1 = 1.0 - 0.75;
  ASSERT_LT(x0 + 0.5 * x1, 0.0);  // P = 0
  EXPECT_DOUBLE_EQ(certify(problem, vector({0, 1})).unit_free_residual, 4.0 / 2.0);
}

// P_K sees these as 1e-9: they are outside K* or inside K by that much, in the Euclidean norm.
TEST(ConeCertificate, SeesTheNormalPartOfACoulombContactUnderAnyFriction) {
  const Matrix M = Matrix::Identity(3, 3);
  const auto residual = [&M](const Vector& z, const Vector& w) {
    Problem problem = lcp(M, w - z);
    problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 1e9}};
    const Certificate c = certify(problem, z);
    EXPECT_GE(c.natural_residual, 0.5 * c.unit_free_residual);
    return c.unit_free_residual;
  };
  EXPECT_DOUBLE_EQ(residual(vector({0, 0, 0}), vector({-1, 1e-9, 0})), 1.0) << "it closes";
  EXPECT_GT(residual(vector({1e-9, -1, 0}), vector({1, 1e-9, 0})), 0.5) << "it holds, and opens";
  EXPECT_GT(residual(vector({1, 0, 0}), vector({-0.1, 1e-10, 0})), 0.05) << "pushes and closes";
  EXPECT_EQ(residual(vector({0, 0, 0}), vector({1, 1, 0})), 0.0);
  EXPECT_EQ(residual(vector({1, 5, 5}), vector({0, 0, 0})), 0.0);
  EXPECT_LE(residual(vector({1e-9, -1, 0}), vector({0, 1, 0})), 1e-8) << "slides";
}

// K is a half line: without tangential parts a point below it is on the line through it.
TEST(ConeCertificate, OfAContactWithoutFrictionIsThatOfItsNormal) {
  for (const FrictionLaw law : {FrictionLaw::kCoulomb, FrictionLaw::kAssociated}) {
    for (const double slip : {0.0, 0.5}) {
      for (const auto& [z, w] : {std::pair(-1.0, 0.0),
                                 {0.0, 1.0},
                                 {-1.0, 1.0},
                                 {0.0, -1.0},
                                 {1.0, 0.0},
                                 {1.0, 1.0},
                                 {0.0, 0.0}}) {
        Problem problem = lcp(Matrix::Identity(3, 3), vector({w - z, slip, 0}));
        problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 0.0}};
        problem.friction_law = law;
        const Certificate c = certify(problem, vector({z, 0, 0}));
        const double residual = std::abs(std::min(z, w));
        EXPECT_DOUBLE_EQ(c.natural_residual, residual / (1.0 + problem.q.cwiseAbs().maxCoeff()))
            << z << " " << w << " " << slip;
        Certifier certifier;
        EXPECT_EQ(judge(certifier.certify_quickly(problem, vector({z, 0, 0}), kTolerance),
                        kTolerance, Status::kStalled),
                  residual > 0.0 ? Status::kStalled : Status::kSolved);
      }
    }
  }
}

// z and w within the residual of a pair that obeys Coulomb's law: certificate.h's construction.
TEST(ConeCertificate, OfACoulombContactBoundsTheDistanceToItsLaw) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> power(-12.0, 12.0);
  std::uniform_int_distribution<int> branch(0, 2);
  int close = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const double mu = std::pow(10.0, power(random));
    const double noise = std::pow(10.0, power(random) - 12.0);
    Eigen::Vector3d z = Eigen::Vector3d::Zero();
    Eigen::Vector3d w(0.0, normal(random), normal(random));
    switch (branch(random)) {
      case 0: w[0] = std::abs(normal(random)); break;  // apart
      case 1:                                          // slides
        z[0] = std::abs(normal(random)) * std::min(1.0, 1.0 / mu);
        z.tail<2>() = -mu * z[0] * w.tail<2>().normalized();
        break;
      default:  // sticks
        z = Eigen::Vector3d(1.0 + 1.0 / mu, 0.5, 0.5);
        w.setZero();
    }
    for (int k = 0; k < 3; ++k) {
      z[k] += noise * normal(random);
      w[k] += noise * normal(random);
    }
    Problem problem = lcp(Matrix::Identity(3, 3), w - z);
    problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = mu}};
    w = z + problem.q;
    const Certificate c = certify(problem, z);
    const double t = c.unit_free_residual * problem.q.cwiseAbs().maxCoeff();
    Eigen::Vector3d p = z - w;
    p[0] -= mu * w.tail<2>().norm();
    project_on_cone(mu, 3, p.data(), p.data());
    const double rounding = 1e-14 * (1.0 + mu * w.tail<2>().norm() + z.norm() + w.norm());
    const bool touches = std::abs(w[0]) <= t + rounding;
    const Eigen::Vector3d near_z = touches ? p : Eigen::Vector3d(Eigen::Vector3d::Zero());
    Eigen::Vector3d near_w = w;
    if (touches) {
      near_w << 0.0, (w - (z - p)).tail<2>();
    }
    EXPECT_LE((near_z - z).norm(), t + rounding) << mu << " " << z << " " << w;
    EXPECT_LE(std::abs(near_w[0] - w[0]), t + rounding);
    EXPECT_LE((near_w - w).tail<2>().norm(), t + rounding);
    EXPECT_GE(near_w[0], 0.0);
    EXPECT_LE(near_z.tail<2>().norm(), mu * near_z[0] * (1.0 + 1e-12));
    EXPECT_LE(std::abs(near_z[0] * near_w[0]), 0.0);
    EXPECT_LE(near_z.dot(near_w) + mu * near_z[0] * near_w.tail<2>().norm(),
              (near_z.norm() + mu * near_z[0]) * rounding)
        << "against its velocity";
    close += t < 1e-3 ? 1 : 0;
  }
  EXPECT_GT(close, 5000);
}

TEST(ConeCertificate, OfConesIsTheSameForEveryFormOfM) {
  FactoredMatrix A;
  A.mass.add_inverse(Matrix{{2, 0.5}, {0.5, 1}});
  A.mass.add_inverse(Matrix::Identity(1, 1));
  for (const auto& [a, b, c] :
       {std::tuple{1.0, 2.0, 0.5}, {0.0, 1.0, -1.0}, {1.0, 0.0, 2.0}, {-1.0, 1.0, 1.0}}) {
    A.add_row(0.25);
    A.add_entry(0, vector({a, b}));
    A.add_entry(1, vector({c}));
  }
  Problem problem;
  problem.M = A;
  problem.q = vector({-1, 2, -3, 0.5});
  problem.cones = {{.normal_row = 1, .dimension = 3, .coefficient = 0.7}};
  const Vector z = vector({0.3, 1.0, -0.2, 0.4});
  const Certificate factored = certify(problem, z);
  problem.M = A.form();
  const Certificate sparse = certify(problem, z);
  problem.M = Matrix(A.form());
  const Certificate dense = certify(problem, z);
  EXPECT_EQ(sparse.unit_free_residual, dense.unit_free_residual);
  EXPECT_EQ(sparse.rounding_floor, dense.rounding_floor);
  EXPECT_NEAR(factored.unit_free_residual, dense.unit_free_residual, 1e-15);
  EXPECT_NEAR(factored.natural_residual, dense.natural_residual, 1e-15);
  EXPECT_NEAR(factored.rounding_floor, dense.rounding_floor, 1e-28);
  EXPECT_NEAR(factored.backward_error, dense.backward_error, 1e-15);
}

// D_c = 7e8 is the tangents'; w_N / D_c vanishes beside z_N, and must not vanish from the residual.
TEST(ConeCertificate, LosesNoNormalVelocityBesideALargeImpulse) {
  Problem problem = lcp(Vector{{1e-5, 7e8, 1e4}}.asDiagonal().toDenseMatrix(), vector({-2, 0, 0}));
  problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 1e-10}};
  const Certificate c = certify(problem, vector({2e5 - 4e-3, 0, 0}));  // w_N = -4e-8
  EXPECT_NEAR(c.unit_free_residual, 2e-8, 1e-12);
}

TEST(ConeCertificate, RoundingALargeForceFarInsideItsConeCostsNothing) {
  // 1e18 kg that stick: the force has steps of 32 N s, the velocity those of 1e-17 m/s.
  Problem problem;
  problem.M = Matrix(1e-18 * Matrix::Identity(3, 3));
  problem.q = Vector{{-0.16, 0.02, 0.0}};
  problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 0.5}};
  const Vector z = -1e18 * problem.q;
  EXPECT_EQ(judge(certify(problem, z), 1e-12, Status::kStalled), Status::kSolved);
  Certifier certifier;
  EXPECT_EQ(judge(certifier.certify_quickly(problem, z, 1e-12), 1e-12, Status::kStalled),
            Status::kSolved);
  problem.q[1] = 0.08;  // at the boundary rounding decides
  EXPECT_NE(judge(certify(problem, Vector(-1e18 * problem.q)), 1e-12, Status::kStalled),
            Status::kSolved);
}

// w~ = w_N + mu |w_T|: rounding w_T costs mu times as much, also of a force far inside the cone.
TEST(ConeCertificate, KnowsWhatAHugeMuMakesOfRounding) {
  Problem problem;
  problem.M = Matrix(Matrix::Identity(3, 3));
  problem.cones = {{.normal_row = 0, .dimension = 3, .coefficient = 1e3}};
  const Vector z{{0.16, 0.02, 0.0}};
  problem.q = -z;
  problem.q[1] += 4e-18;
  const Certificate c = certify(problem, z);
  EXPECT_GT(c.unit_free_residual, 1e-14);
  EXPECT_EQ(judge(c, 1e-15, Status::kStalled), Status::kSolvedToRounding);
  problem.q[0] -= 1e-9;  // the normal part is as it was
  EXPECT_EQ(judge(certify(problem, z), 1e-15, Status::kStalled), Status::kStalled);
}

}  // namespace
}  // namespace signorini::lcp
