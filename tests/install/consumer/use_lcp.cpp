#include <signorini/lcp/solver.h>

int main() {
  signorini::lcp::Problem problem;
  problem.M = signorini::lcp::Matrix{{2.0, 1.0}, {1.0, 2.0}};
  problem.q = signorini::lcp::Vector{{-5.0, -6.0}};
  signorini::lcp::Result result;
  signorini::lcp::make_solver("lemke")->solve(problem, result);
  return result.status == signorini::lcp::Status::kSolved ? 0 : 1;
}
