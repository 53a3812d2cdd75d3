#include <signorini/c/signorini.h>

int main(void) {
  const double M[] = {2.0, 1.0, 1.0, 2.0};
  const double q[] = {-5.0, -6.0};
  signorini_problem* problem = NULL;
  signorini_solver* solver = NULL;
  signorini_result* result = NULL;
  int solved = 0;
  if (!signorini_problem_create(&problem) &&
      !signorini_problem_set_dense(problem, 2, SIGNORINI_ROW_MAJOR, M, q) &&
      !signorini_solver_create("auto", &solver) && !signorini_result_create(&result) &&
      !signorini_solver_solve(solver, problem, NULL, result)) {
    solved = signorini_is_solved(signorini_result_status(result));
  }
  signorini_result_destroy(result);
  signorini_solver_destroy(solver);
  signorini_problem_destroy(problem);
  return solved ? 0 : 1;
}
