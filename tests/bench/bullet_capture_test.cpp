#include "bench/bullet_capture.h"

#include <signorini/lcp/certificate.h>
#include <signorini/lcp/solver.h>

#include "bench/bullet_sets.h"

#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace signorini::bench {
namespace {

using lcp::Vector;

struct Assembled {
  BulletContacts contacts;
  NormalRows rows;
  lcp::Problem problem;
};

Assembled assemble(const BulletGroup& group) {
  Assembled all;
  all.contacts.read(group);
  assemble_normals(all.contacts.bodies, all.contacts.free_state, all.contacts.contacts, all.rows);
  all.problem.q = all.rows.d_dot + all.contacts.allowance;
  all.problem.M = all.rows.A;
  return all;
}

class EverySet : public testing::TestWithParam<std::string> {};

TEST_P(EverySet, HasTheContactsThatItSays) {
  int groups = 0;
  BulletScene(GetParam()).visit([&](const BulletGroup& group) {
    ++groups;
    const Assembled all = assemble(group);
    validate(all.contacts.contacts, static_cast<int>(all.contacts.bodies.size()));
    const auto n = static_cast<int>(all.contacts.points.size());
    const int expected = GetParam() == "stack10"     ? 40
                         : GetParam() == "stack30"   ? 120
                         : GetParam() == "pyramid10" ? 400
                                                     : 180;
    EXPECT_NEAR(n, expected, GetParam() == "spheres125" ? 20 : 0);
  });
  EXPECT_EQ(groups, 1);
}

TEST_P(EverySet, OurRowsAreTheOnesThatBulletSolves) {
  // What Bullet's impulses do to the velocities is what A does, and the target velocity is what
  // the sequential impulses drive to zero.
  BulletScene(GetParam()).visit([](const BulletGroup& group) {
    const BulletState start(group);
    const Assembled all = assemble(group);
    forget_impulses(group);
    btSequentialImpulseConstraintSolver solver;
    group.solve(solver, *group.info);
    const Vector f = written_impulses(all.contacts);
    EXPECT_GT(f.maxCoeff(), 0.0);
    Vector w(f.size());
    lcp::multiply(all.problem.M, f.data(), w.data());
    w += all.problem.q;
    const double scale = w.lpNorm<Eigen::Infinity>() + f.lpNorm<Eigen::Infinity>();
    EXPECT_LE((w - targets_now(group, all.contacts)).lpNorm<Eigen::Infinity>(), 1e-13 * scale);
    start.restore(group);
  });
}

TEST_P(EverySet, MoreSweepsOfBulletsCloserToOurAnswer) {
  BulletScene(GetParam()).visit([](const BulletGroup& group) {
    const BulletState start(group);
    const Assembled all = assemble(group);
    const auto residual_after = [&](int iterations) {
      start.restore(group);
      forget_impulses(group);
      btContactSolverInfo info = *group.info;
      info.m_numIterations = iterations;
      btSequentialImpulseConstraintSolver solver;
      group.solve(solver, info);
      return lcp::certify(all.problem, written_impulses(all.contacts)).natural_residual;
    };
    EXPECT_LT(residual_after(1000), residual_after(1));
  });
}

TEST_P(EverySet, AStateIsRestoredToTheBit) {
  BulletScene(GetParam()).visit([](const BulletGroup& group) {
    const BulletState start(group);
    forget_impulses(group);
    btNNCGConstraintSolver solver;
    group.solve(solver, *group.info);
    EXPECT_FALSE(BulletState(group) == start);
    start.restore(group);
    EXPECT_TRUE(BulletState(group) == start);
    for (int i = 0; i < group.body_count; ++i) {
      EXPECT_EQ(group.bodies[i]->getCompanionId(), -1);
    }
  });
}

TEST_P(EverySet, TheSameStartGivesTheSameBits) {
  BulletScene(GetParam()).visit([](const BulletGroup& group) {
    const BulletState start(group);
    const auto solve = [&] {
      start.restore(group);
      forget_impulses(group);
      btSequentialImpulseConstraintSolver solver;
      group.solve(solver, *group.info);
      return BulletState(group);
    };
    const BulletState first = solve();
    EXPECT_TRUE(solve() == first);
  });
}

TEST_P(EverySet, AVisitChangesNothing) {
  // The step after a visit that did a lot is the step without one.
  const auto step = [&](bool visits) {
    BulletState after;
    BulletScene scene(GetParam());
    scene.visit([&](const BulletGroup& group) {
      if (visits) {
        btContactSolverInfo info = *group.info;
        info.m_numIterations = 3;
        btSequentialImpulseConstraintSolver solver;
        group.solve(solver, info);
      }
    });
    scene.visit([&](const BulletGroup& group) { after = BulletState(group); });
    return after;
  };
  EXPECT_TRUE(step(true) == step(false));
}

TEST_P(EverySet, OurSolutionIsWrittenWhereBulletWritesIts) {
  BulletScene(GetParam()).visit([](const BulletGroup& group) {
    const Assembled all = assemble(group);
    lcp::Result result;
    lcp::make_solver("interior-point", {.tolerance = 1e-11})->solve(all.problem, result);
    ASSERT_TRUE(lcp::is_solved(result.status)) << result.detail;
    write_solution(group, all.contacts, result.z);
    EXPECT_EQ(written_impulses(all.contacts), result.z);
    EXPECT_GE(targets_now(group, all.contacts).minCoeff(), -1e-10);
  });
}

TEST_P(EverySet, WithFrictionOurRowsAreTheOnesThatBulletSolves) {
  BulletScene(GetParam(), 0.4).visit([](const BulletGroup& group) {
    const BulletState start(group);
    BulletContacts contacts;
    contacts.read(group);
    BulletCones cones;
    assemble_cones(contacts, cones);
    lcp::check_shapes(cones.problem);
    for (const int mode : {0, int{SOLVER_USE_2_FRICTION_DIRECTIONS}}) {
      start.restore(group);
      forget_impulses(group);
      btContactSolverInfo info = *group.info;
      info.m_solverMode |= mode;
      btSequentialImpulseConstraintSolver solver;
      group.solve(solver, info);
      const Vector z = written_impulses(contacts, cones);
      Vector w(z.size());
      lcp::multiply(cones.problem.M, z.data(), w.data());
      w += cones.problem.q;
      const Vector normals = w(Eigen::seq(0, Eigen::last, 3));
      const double scale = w.lpNorm<Eigen::Infinity>() + z.lpNorm<Eigen::Infinity>();
      EXPECT_LE((normals - targets_now(group, contacts)).lpNorm<Eigen::Infinity>(), 1e-12 * scale);
    }
    start.restore(group);
  });
}

TEST_P(EverySet, WithFrictionOurSolutionIsWrittenWhereBulletWritesIts) {
  BulletScene(GetParam(), 0.4).visit([](const BulletGroup& group) {
    BulletContacts contacts;
    contacts.read(group);
    BulletCones cones;
    assemble_cones(contacts, cones);
    const auto n = static_cast<lcp::Index>(contacts.points.size());
    const Vector z = Vector::LinSpaced(3 * n, 0.1, 1.0);  // any impulses
    write_solution(group, contacts, cones, z);
    EXPECT_LE((written_impulses(contacts, cones) - z).lpNorm<Eigen::Infinity>(), 1e-14);
    Vector w(z.size());
    lcp::multiply(cones.problem.M, z.data(), w.data());
    w += cones.problem.q;
    const Vector normals = w(Eigen::seq(0, Eigen::last, 3));
    EXPECT_LE((normals - targets_now(group, contacts)).lpNorm<Eigen::Infinity>(),
              1e-12 * w.lpNorm<Eigen::Infinity>());
  });
}

INSTANTIATE_TEST_SUITE_P(Bullet, EverySet, testing::ValuesIn(BulletScene::names()),
                         [](const auto& named) { return named.param; });

/// Two spheres and the ground by hand: one in the air above it, one in it.
class TwoSpheres {
 public:
  TwoSpheres() {
    world_.setGravity(btVector3(0.0, 0.0, -9.81));
    add(ground_, 0.0, btVector3(0.0, 0.0, -10.0));
    add(sphere_, 2.0, btVector3(0.0, 0.0, 0.51));
    add(sphere_, 2.0, btVector3(3.0, 0.0, 0.48));
  }
  ~TwoSpheres() {
    for (const auto& body : bodies_) {
      world_.removeRigidBody(body.get());
    }
  }
  btRigidBody& body(int i) { return *bodies_[i]; }
  btContactSolverInfo& info() { return world_.getSolverInfo(); }
  void step(const CapturingSolver::Visitor& visitor) {
    solver_.set_visitor(visitor);
    world_.stepSimulation(0.01, 0);
  }

 private:
  void add(btCollisionShape& shape, double mass, const btVector3& centre) {
    btVector3 inertia(0.0, 0.0, 0.0);
    if (mass > 0.0) shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform.setOrigin(centre);
    info.m_restitution = 1.0;
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(bodies_.back().get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  CapturingSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btBoxShape ground_{btVector3(10.0, 10.0, 10.0)};
  btSphereShape sphere_{0.5};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

TEST(BulletContacts, AllowanceIsGapOverDtAboveAndErpOfItBelow) {
  TwoSpheres scene;
  scene.info().m_minimumSolverBatchSize = 1000;  // both in one group
  int seen = 0;
  scene.step([&](const BulletGroup& group) {
    BulletContacts contacts;
    contacts.read(group);
    for (std::size_t i = 0; i < contacts.points.size(); ++i) {
      const double gap = contacts.contacts[i].gap;
      const double erp = gap > 0.0 ? 1.0 : group.info->m_erp2;
      EXPECT_NEAR(contacts.allowance[static_cast<lcp::Index>(i)], erp * gap / 0.01, 1e-12);
      EXPECT_NEAR(std::abs(contacts.contacts[i].normal.z()), 1.0, 1e-12);
      ++seen;
    }
    // Free velocities hold the step's gravity.
    for (std::size_t k = 0; k < contacts.bodies.size(); ++k) {
      if (contacts.bodies[k].is_dynamic()) {
        EXPECT_NEAR(contacts.free_state[k].p.z(), -2.0 * 9.81 * 0.01, 1e-12);
      }
    }
  });
  EXPECT_EQ(seen, 2);
}

TEST(BulletContacts, SplitImpulsesTakeTheOverlapOutOfTheVelocity) {
  TwoSpheres scene;
  scene.info().m_splitImpulsePenetrationThreshold = 0.0;
  scene.step([&](const BulletGroup& group) {
    BulletContacts contacts;
    contacts.read(group);
    for (std::size_t i = 0; i < contacts.points.size(); ++i) {
      if (contacts.contacts[i].gap < 0.0) {
        EXPECT_EQ(contacts.allowance[static_cast<lcp::Index>(i)], 0.0);
      }
    }
  });
}

TEST(BulletContacts, ABounceIsAskedForAboveTheThreshold) {
  TwoSpheres scene;
  scene.body(2).setLinearVelocity(btVector3(0.0, 0.0, -1.0));
  int bounces = 0;
  scene.step([&](const BulletGroup& group) {
    const BulletState start(group);
    const Assembled all = assemble(group);
    for (std::size_t i = 0; i < all.contacts.points.size(); ++i) {
      const double gap = all.contacts.contacts[i].gap;
      if (gap < 0.0) {
        const double push = group.info->m_erp2 * gap / 0.01;
        EXPECT_NEAR(all.contacts.allowance[static_cast<lcp::Index>(i)], push - 1.0, 1e-12);
        ++bounces;
      }
    }
    forget_impulses(group);
    btSequentialImpulseConstraintSolver solver;
    group.solve(solver, *group.info);
    const Vector targets = targets_now(group, all.contacts);
    for (std::size_t i = 0; i < all.contacts.points.size(); ++i) {
      if (all.contacts.contacts[i].gap < 0.0) {
        EXPECT_NEAR(targets[static_cast<lcp::Index>(i)], 0.0, 1e-12);
      }
    }
    start.restore(group);
  });
  EXPECT_EQ(bounces, 1);
}

TEST(BulletContacts, JointsAndSoftContactsAreRefused) {
  TwoSpheres scene;
  scene.step([&](const BulletGroup& group) {
    BulletContacts contacts;
    BulletGroup jointed = group;
    jointed.joint_count = 1;
    EXPECT_THROW(contacts.read(jointed), std::invalid_argument);
    btContactSolverInfo soft = *group.info;
    soft.m_globalCfm = 0.1;
    BulletGroup softened = group;
    softened.info = &soft;
    if (group.manifold_count > 0) {
      EXPECT_THROW(contacts.read(softened), std::invalid_argument);
    }
    contacts.read(group);  // still usable
  });
}

TEST(BulletScene, UnknownNamesAreRefused) {
  EXPECT_THROW(BulletScene("castle"), std::invalid_argument);
}

TEST(BulletSets, TheTableHasARowASolverAndJudgesThem) {
  const auto runs =
      run_bullet_sets({.sets = {"stack10"}, .repeats = 1, .limits = {.seconds = 5.0}}, nullptr);
  ASSERT_GE(runs.size(), 8u);
  const auto find = [&](const std::string& solver) {
    const auto found = std::find_if(runs.begin(), runs.end(),
                                    [&](const BulletSetRun& run) { return run.solver == solver; });
    return found == runs.end() ? BulletSetRun{} : *found;
  };
  EXPECT_EQ(find("Bullet SI10").n, 40);
  EXPECT_GT(find("Bullet SI10").residual, find("Bullet SI1000").residual);
  EXPECT_LE(find("lemke").residual, 1e-10);
  EXPECT_EQ(find("lemke").outcome, "solved");
  const std::string csv = bullet_sets_csv(runs);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + static_cast<long>(runs.size()));
  EXPECT_NE(bullet_sets_text(runs).find("Bullet NNCG200"), std::string::npos);
}

}  // namespace
}  // namespace signorini::bench
