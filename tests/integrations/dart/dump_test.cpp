// What DART asks is written by a recorder and solved again from the files.
#include <signorini/integrations/dart/boxed_lcp_solver.h>
#include <signorini/lcp/io/dump_recorder.h>
#include <signorini/lcp/io/problem_folder.h>

#include "tests/integrations/dart/worlds.h"
#include "tests/lcp/temporary_folder.h"

#include <gtest/gtest.h>
#include <memory>

namespace signorini::dartsim {
namespace {

TEST(DartDump, EveryProblemOfAWorldIsAFolderThatSolvesToTheSameImpulses) {
  const lcp::TemporaryFolder folder;
  lcp::DumpRecorder recorder({.folder = folder.path() / "dump", .max_count = 5});
  lcp::Vector last;
  {
    const auto solver =
        std::make_shared<BoxedLcpSolver>(lcp::SolverSettings{.recorder = &recorder});
    const auto world = world_with_floor(solver, 0.5);
    const auto box = cube("box", 0.5, 1.0, 0.5);
    place(*box, Eigen::Vector3d(0.0, 0.0, 0.2499));
    world->addSkeleton(box);
    while (recorder.written() < 5 && world->getSimFrames() < 100) {
      world->step();
      last = solver->last_result().z;
    }
  }
  ASSERT_EQ(recorder.written(), 5);
  EXPECT_EQ(recorder.failed(), 0);
  const lcp::Problem problem = lcp::read_problem(folder.path() / "dump" / "000005");
  EXPECT_GE(problem.limits.size(), 8u);  // four contacts, two tangents each
  lcp::Result result;
  lcp::make_solver("auto")->solve(problem, result);
  EXPECT_TRUE(lcp::is_solved(result.status));
  EXPECT_EQ(result.z, last);
}

}  // namespace
}  // namespace signorini::dartsim
