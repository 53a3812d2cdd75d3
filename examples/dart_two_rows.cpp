// A contact that pushes at an angle, as DART forms it: two rows, friction bound by the normal
// impulse, which friction itself raises. In closed form x_t = -x_n / 2 and
// 5 x_n - 2 x_n / 2 = 1: x = (0.25, -0.125).
#include <signorini/integrations/dart/boxed_lcp_solver.h>

#include <cstdio>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <limits>

namespace {

void solve(const char* name, dart::constraint::BoxedLcpSolver& solver) {
  double A[] = {5.0, 2.0, 0.0, 0.0,  // rows are padded to four numbers
                2.0, 3.0, 0.0, 0.0};
  double b[] = {1.0, -1.5};
  double low[] = {0.0, -0.5};  // of the second row: -mu and mu, times x_0
  double high[] = {std::numeric_limits<double>::infinity(), 0.5};
  int normal_row[] = {-1, 0};
  double x[] = {0.0, 0.0};
  const bool solved = solver.solve(2, A, x, b, 0, low, high, normal_row, true);
  std::printf("%s: %s, x = (%.3f, %.3f)\n", name, solved ? "solved" : "not solved", x[0], x[1]);
}

}  // namespace

int main() {
  dart::constraint::DantzigBoxedLcpSolver dantzig;
  signorini::dartsim::BoxedLcpSolver ours;
  solve("DART's Dantzig", dantzig);
  solve("Signorini", ours);
}
