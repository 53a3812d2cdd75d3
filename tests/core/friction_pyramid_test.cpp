#include <signorini/core/response/assembly.h>
#include <signorini/core/response/friction_pyramid.h>
#include <signorini/lcp/certificate.h>

#include "plane_contacts.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <stdexcept>

namespace signorini {
namespace {

using testing_tools::at;
using testing_tools::box_body;
using testing_tools::fixed_body;

double uniform(std::mt19937_64& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

Vec3 random_vector(std::mt19937_64& rng) {
  return {uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1)};
}

Contact random_contact(std::mt19937_64& rng, int a, int b, double friction) {
  Contact contact;
  contact.body_a = a;
  contact.body_b = b;
  contact.normal = random_vector(rng).normalized();
  contact.gap = uniform(rng, -0.1, 0.1);
  contact.point_b = random_vector(rng);
  contact.point_a = contact.point_b + contact.gap * contact.normal;
  contact.material.friction = friction;
  return contact;
}

// A fixed body, two free boxes, and contacts with and without friction between all of them.
struct Scene {
  Bodies bodies{fixed_body(), box_body(1.0, Vec3(0.5, 0.6, 0.7)),
                box_body(30.0, Vec3(0.9, 0.4, 1))};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 1)), at(Vec3(1, 0, 1))};
  ContactSet contacts;
  lcp::Vector allowance;

  explicit Scene(unsigned seed) {
    std::mt19937_64 rng(seed);
    for (int k : {1, 2}) {
      state[k].q = Quat(Eigen::AngleAxisd(uniform(rng, 0, 3), random_vector(rng).normalized()));
      set_velocity(bodies[k], {random_vector(rng), random_vector(rng)}, state[k]);
    }
    contacts = {random_contact(rng, 1, 0, 0.5), random_contact(rng, 2, 1, 0.0),
                random_contact(rng, 0, 2, 0.9), random_contact(rng, 1, 2, 0.2)};
    allowance = lcp::Vector::Zero(4);
    allowance << 0.0, 0.1, -0.2, 0.3;
  }
};

Vec3 relative_velocity(const Scene& scene, const State& state, const Contact& contact) {
  const Vec3 point = friction_point(contact);
  const int a = contact.body_a;
  const int b = contact.body_b;
  return velocity(scene.bodies[a], state[a]).at(point - state[a].x) -
         velocity(scene.bodies[b], state[b]).at(point - state[b].x);
}

TEST(FrictionPyramid, TheFrameIsAlignedWithTheSlip) {
  const Vec3 normal = Vec3(1, 2, 3).normalized();
  const Vec3 slip(0.3, -0.1, 0.2);
  const TangentFrame frame = tangent_frame(normal, slip);
  const Vec3 tangential = slip - slip.dot(normal) * normal;
  EXPECT_LT((frame.t1 - tangential.normalized()).norm(), 1e-15);
  EXPECT_LT((frame.t2 - normal.cross(frame.t1)).norm(), 1e-15);
}

TEST(FrictionPyramid, TheFrameIsAcrossTheNormalHoweverFastAnImpactIs) {
  const Vec3 normal = Vec3(1, 2, 3).normalized();
  const Vec3 aside = normal.unitOrthogonal();
  for (const double fast : {1.0, 1e3, 1e6}) {
    const TangentFrame frame = tangent_frame(normal, -fast * normal + 2.0 * kAligningSlip * aside);
    EXPECT_NEAR(frame.t1.dot(normal), 0.0, 1e-15) << fast;
    EXPECT_NEAR(frame.t2.dot(normal), 0.0, 1e-15) << fast;
  }
}

TEST(FrictionPyramid, WithoutSlipTheFrameDependsOnTheNormalAlone) {
  const Vec3 normal = Vec3(1, 2, 3).normalized();
  const TangentFrame still = tangent_frame(normal, Vec3::Zero());
  EXPECT_EQ(still.t1, tangent_frame(normal, 0.5 * kAligningSlip * Vec3(1, 0, 0)).t1);
  EXPECT_EQ(still.t1, tangent_frame(normal, 5.0 * normal).t1);
  EXPECT_NEAR(still.t1.dot(normal), 0.0, 1e-15);
  EXPECT_NEAR(still.t1.norm(), 1.0, 1e-15);
}

TEST(FrictionPyramid, WIsTheVelocityThatTheImpulsesReallyGive) {
  for (const int sides : {4, 6, 8}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE("sides " + std::to_string(sides) + ", seed " + std::to_string(seed));
      const Scene scene(seed);
      PyramidProblem pyramid;
      assemble_pyramid(scene.bodies, scene.state, scene.contacts, scene.allowance, sides, pyramid);
      ASSERT_EQ(pyramid.frictional, (std::vector<int>{0, 2, 3}));
      const int n = 4;
      const int m = 3;
      ASSERT_EQ(pyramid.problem.size(), n + (sides + 1) * m);
      std::mt19937_64 rng(seed + 1000);
      lcp::Vector z(pyramid.problem.size());
      for (double& value : z) value = uniform(rng, 0, 1);
      const lcp::Matrix M = lcp::to_dense(pyramid.problem.M);
      const lcp::Vector w = M * z + pyramid.problem.q;

      const std::vector<Vec3> impulses = contact_impulses(pyramid, scene.contacts, z);
      State after = scene.state;
      apply_contact_impulses(scene.bodies, scene.contacts, impulses, after);
      for (int i = 0; i < n; ++i) {
        EXPECT_NEAR(w[i], gap_velocity(scene.bodies, after, scene.contacts[i]) + scene.allowance[i],
                    1e-11);
      }
      for (int c = 0; c < m; ++c) {
        const int i = pyramid.frictional[c];
        const Vec3 u = relative_velocity(scene, after, scene.contacts[i]);
        const double scale = M(i, i);
        double total = 0.0;
        for (int j = 0; j < sides; ++j) {
          const double angle = 2.0 * std::numbers::pi * j / sides;
          const Vec3 direction =
              std::cos(angle) * pyramid.frames[c].t1 + std::sin(angle) * pyramid.frames[c].t2;
          const double lambda = z[n + sides * m + c];
          EXPECT_NEAR(w[n + sides * c + j], direction.dot(u) + lambda, 1e-11);
          total += z[n + sides * c + j];
        }
        EXPECT_NEAR(w[n + sides * m + c],
                    scale * (scene.contacts[i].material.friction * z[i] - total), 1e-11);
      }
    }
  }
}

TEST(FrictionPyramid, MIsCopositiveUpToTheScaleOfTheConeRows) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Scene scene(seed);
    PyramidProblem pyramid;
    assemble_pyramid(scene.bodies, scene.state, scene.contacts, scene.allowance, 8, pyramid);
    lcp::Matrix M = lcp::to_dense(pyramid.problem.M);
    for (int c = 0; c < 3; ++c) {
      const int i = pyramid.frictional[c];
      M.row(4 + 8 * 3 + c) /= M(i, i);
    }
    std::mt19937_64 rng(seed);
    for (int trial = 0; trial < 50; ++trial) {
      lcp::Vector z(M.rows());
      for (double& value : z) value = std::max(0.0, uniform(rng, -1, 1));
      EXPECT_GE(z.dot(M * z), -1e-12) << "seed " << seed;
    }
  }
}

TEST(FrictionPyramid, TheCertificateDoesNotDependOnTheMasses) {
  // The same motion with masses (and impulses) a million times larger or smaller: w is the same.
  const auto problem_with = [](double factor) {
    Scene scene(5);
    for (int k : {1, 2}) {
      scene.bodies[k].mass *= factor;
      scene.bodies[k].inertia *= factor;
      scene.state[k].p *= factor;
      scene.state[k].L *= factor;
    }
    PyramidProblem pyramid;
    assemble_pyramid(scene.bodies, scene.state, scene.contacts, scene.allowance, 8, pyramid);
    return pyramid.problem;
  };
  const lcp::Problem plain = problem_with(1.0);
  std::mt19937_64 rng(5);
  lcp::Vector z(plain.size());
  for (double& value : z) value = uniform(rng, 0, 1);
  const double residual = lcp::certify(plain, z).unit_free_residual;
  for (const double factor : {1e-6, 1e6}) {
    lcp::Vector scaled = z;
    scaled.head(4 + 8 * 3) *= factor;
    EXPECT_NEAR(lcp::certify(problem_with(factor), scaled).unit_free_residual, residual,
                1e-9 * residual);
  }
}

TEST(FrictionPyramid, WithoutFrictionTheMatrixStaysFactored) {
  Scene scene(3);
  for (Contact& contact : scene.contacts) contact.material.friction = 0.0;
  PyramidProblem pyramid;
  assemble_pyramid(scene.bodies, scene.state, scene.contacts, scene.allowance, 8, pyramid);
  EXPECT_TRUE(std::holds_alternative<lcp::FactoredMatrix>(pyramid.problem.M));
  EXPECT_EQ(pyramid.problem.size(), 4);
  EXPECT_TRUE(pyramid.frictional.empty());
}

TEST(FrictionPyramid, FrictionHasNoMomentOnThePair) {
  const Scene scene(11);
  ContactSet pair{scene.contacts[3]};  // between the two free bodies, with a gap
  pair[0].gap = 0.3;
  pair[0].point_a = pair[0].point_b + 0.3 * pair[0].normal;
  State after = scene.state;
  apply_contact_impulses(scene.bodies, pair, {Vec3(1, 2, 3)}, after);
  Vec3 momentum = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  for (int k : {1, 2}) {
    momentum += after[k].p - scene.state[k].p;
    moment += after[k].L - scene.state[k].L + after[k].x.cross(after[k].p - scene.state[k].p);
  }
  EXPECT_LT(momentum.norm(), 1e-13);
  EXPECT_LT(moment.norm(), 1e-13);
  EXPECT_EQ(after[0].p, Vec3::Zero());
}

TEST(FrictionPyramid, RefusesWrongArgumentsAndLeavesTheOutputAlone) {
  const Scene scene(1);
  PyramidProblem pyramid;
  pyramid.sides = 123;
  const auto assemble = [&](const ContactSet& contacts, const lcp::Vector& allowance, int sides) {
    assemble_pyramid(scene.bodies, scene.state, contacts, allowance, sides, pyramid);
  };
  EXPECT_THROW(assemble(scene.contacts, scene.allowance, 5), std::invalid_argument);
  EXPECT_THROW(assemble(scene.contacts, scene.allowance, 2), std::invalid_argument);
  EXPECT_THROW(assemble(scene.contacts, scene.allowance.head(3), 8), std::invalid_argument);
  ContactSet immovable = scene.contacts;
  immovable[0].body_a = immovable[0].body_b = 0;
  EXPECT_THROW(assemble(immovable, scene.allowance, 8), std::invalid_argument);
  EXPECT_EQ(pyramid.sides, 123);
}

}  // namespace
}  // namespace signorini
