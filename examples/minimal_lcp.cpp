// The smallest use: find z with 0 <= z, w = M z + q >= 0, z.w = 0.
#include <signorini/lcp/solver.h>

#include <iostream>

int main() {
  signorini::lcp::Problem problem;
  problem.M = signorini::lcp::Matrix{{2.0, 1.0}, {1.0, 2.0}};
  problem.q = signorini::lcp::Vector{{-5.0, -6.0}};

  signorini::lcp::Result result;
  signorini::lcp::make_solver("lemke")->solve(problem, result);

  std::cout << to_string(result.status) << ": z = " << result.z.transpose() << ", residual "
            << result.certificate.unit_free_residual << "\n";
  return is_solved(result.status) ? 0 : 1;
}
