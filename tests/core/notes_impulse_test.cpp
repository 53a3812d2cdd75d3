#include <signorini/core/response/notes_impulse.h>
#include <signorini/lcp/solver.h>

#include "response_scenes.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <limits>

namespace signorini {
namespace {

using scenes::Scene;

NormalRows rows_of(const Scene& scene) {
  NormalRows rows;
  assemble_normals(scene.bodies, scene.state, scene.contacts, rows);
  return rows;
}

lcp::Vector target_of(const NormalRows& rows, const ContactSet& contacts) {
  lcp::Vector t = rows.d_dot;
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    t[i] *= t[i] < 0.0 ? -contacts[i].material.restitution : 1.0;
  }
  return t;
}

TEST(NotesProblem, IsMonotoneAndHasNoSquareOfA) {
  std::mt19937_64 random(8);
  const Scene scene = scenes::random_scene(random, 4, 10);
  const NotesProblem notes = notes_problem(rows_of(scene), scene.contacts, 0.0, false);
  const lcp::Matrix M = lcp::to_dense(notes.problem.M);
  const Eigen::Index bounded = notes.upper.array().isFinite().count();
  EXPECT_EQ(M.rows(), 3 * 10 + bounded + 1);
  lcp::Matrix symmetric = M + M.transpose();
  symmetric.diagonal().segment(10, 10).array() -= 2.0;  // 2 I on y
  EXPECT_LE(symmetric.cwiseAbs().maxCoeff(), 0.0);
}

TEST(NotesProblem, ItsSolutionIsTheClosestAdmissiblePoint) {
  // No admissible f gives an A f + d'- closer to t: tried along 200 random directions that keep f
  // and d'+ within their bounds.
  std::mt19937_64 random(9);
  const auto solver = lcp::make_solver("lemke", {.tolerance = 1e-12});
  int solved = 0;
  int steps_tried = 0;
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    const Scene scene = scenes::random_scene(random, 4, 6);
    const NormalRows rows = rows_of(scene);
    const NotesProblem notes = notes_problem(rows, scene.contacts, 0.0, false);
    lcp::Result result;
    solver->solve(notes.problem, result);
    if (!lcp::is_solved(result.status)) {
      continue;
    }
    ++solved;
    const lcp::Vector f = notes_impulses(notes, result.z);
    EXPECT_LE(notes_violation(notes, rows, f), 1e-11 * rows.d_dot.cwiseAbs().maxCoeff());
    const lcp::Vector t = target_of(rows, scene.contacts);
    const double best = (gap_velocities_after(rows, f) - t).squaredNorm();
    std::normal_distribution<double> normal;
    for (int k = 0; k < 200; ++k) {
      lcp::Vector other = f;
      for (double& x : other) {
        x = std::max(0.0, x + 0.01 * normal(random));
      }
      if (notes_violation(notes, rows, other) <= 0.0) {
        ++steps_tried;
        EXPECT_GE((gap_velocities_after(rows, other) - t).squaredNorm(), best * (1 - 1e-9) - 1e-12);
      }
    }
  }
  EXPECT_GT(solved, 10);
  EXPECT_GT(steps_tried, 200);
}

TEST(NotesProblem, RedundantContactsChangeNothing) {
  std::mt19937_64 random(10);
  const auto solver = lcp::make_solver("lemke", {.tolerance = 1e-12});
  Scene scene = scenes::box_on_ground(1.3, Vec3(1, 0.6, 0.4), 0.3, Vec3(0.1, 0.2, -1.0), 0.5);
  scene.state[0].L = Vec3(0.02, -0.01, 0.03);
  const NormalRows rows = rows_of(scene);
  const NotesProblem notes = notes_problem(rows, scene.contacts, 0.0, false);
  lcp::Result four;
  solver->solve(notes.problem, four);
  ASSERT_TRUE(lcp::is_solved(four.status));
  const lcp::Vector after = gap_velocities_after(rows, notes_impulses(notes, four.z));

  // The targets of the four corners are affine like the corners, so d'+ = t.
  EXPECT_LE((after - target_of(rows, scene.contacts)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(NotesProblem, ASlowContactBesideAFastOneMayHaveToOpenFasterThanItApproached) {
  // A point mass on two walls at 1 degree: the one is hit at full speed, the other barely. The
  // impulse of the first opens the second faster than |d'-|, whatever the second does.
  Scene scene;
  const int mass = scene.add(scenes::ball(), Vec3::Zero(), {Vec3(0, -1, 0), Vec3::Zero()});
  const int ground = scene.add(scenes::fixed_body(), Vec3::Zero());
  const int belt = scene.add(scenes::kinematic_body(), Vec3::Zero());
  set_velocity(scene.bodies[belt], {Vec3(0, -0.999, 0), Vec3::Zero()}, scene.state[belt]);
  scene.touch(mass, ground, Vec3::Zero(), Vec3(0, 1, 0), 0.5);
  scene.touch(mass, belt, Vec3::Zero(), Vec3(0, 1, 0), 0.5);
  const NotesProblem notes = notes_problem(rows_of(scene), scene.contacts, 0.0, false);
  lcp::Result result;
  lcp::make_solver("lemke", {.tolerance = 1e-12})->solve(notes.problem, result);
  EXPECT_TRUE(result.status == lcp::Status::kInfeasible ||
              result.status == lcp::Status::kNoSolutionBelow)
      << lcp::to_string(result.status);
  EXPECT_GT(result.ray_bound, 1e6);
}

TEST(NotesViolation, SeesEveryKind) {
  const Scene scene = scenes::wedge(1.0, 1.0);
  const NormalRows rows = rows_of(scene);
  const NotesProblem notes = notes_problem(rows, scene.contacts, 0.0, false);
  const Eigen::Matrix2d A = Eigen::MatrixXd(rows.A.form());
  const lcp::Vector stop = A.inverse() * -rows.d_dot;
  EXPECT_LE(notes_violation(notes, rows, stop), 1e-15);
  EXPECT_LE(notes_violation(notes, rows, 2.0 * stop), 1e-15);
  const double least = rows.d_dot.cwiseAbs().minCoeff();
  EXPECT_GT(notes_violation(notes, rows, 2.01 * stop), 0.009 * least);     // above the bound
  EXPECT_GT(notes_violation(notes, rows, 0.99 * stop), 0.009 * least);     // approaching
  EXPECT_GT(notes_violation(notes, rows, lcp::Vector(-1.0 * stop)), 0.1);  // pulling
}

}  // namespace
}  // namespace signorini
