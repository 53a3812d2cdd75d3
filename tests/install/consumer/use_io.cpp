#include <signorini/lcp/io/dump_recorder.h>
#include <signorini/lcp/io/problem_folder.h>
#include <signorini/lcp/solver.h>

#include <filesystem>

int main() {
  std::filesystem::remove_all("dump");
  signorini::lcp::DumpRecorder recorder({.folder = "dump"});
  signorini::lcp::Problem problem;
  problem.M = signorini::lcp::Matrix{{2.0, 1.0}, {1.0, 2.0}};
  problem.q = signorini::lcp::Vector{{-5.0, -6.0}};
  signorini::lcp::Result result;
  signorini::lcp::make_solver("lemke", {.recorder = &recorder})->solve(problem, result);
  return signorini::lcp::read_problem("dump/000001").q == problem.q ? 0 : 1;
}
