#include <signorini/integrations/dart/boxed_lcp_solver.h>

#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <memory>

int main() {
  auto solver = std::make_shared<signorini::dartsim::BoxedLcpSolver>();
  dart::constraint::BoxedLcpConstraintSolver inside(solver);
  double A = 2.0, x = 0.0, b = 1.0, lo = 0.0, hi = 9.0;
  int normal_row = -1;
  return solver->solve(1, &A, &x, &b, 0, &lo, &hi, &normal_row) && x == 0.5 &&
                 inside.getBoxedLcpSolver() == solver
             ? 0
             : 1;
}
