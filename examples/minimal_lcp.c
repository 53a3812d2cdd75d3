/* The smallest use from C: find z with 0 <= z, w = M z + q >= 0, z.w = 0. */
#include <signorini/c/signorini.h>
#include <stdio.h>

int main(void) {
  const double M[] = {2.0, 1.0, 1.0, 2.0};
  const double q[] = {-5.0, -6.0};
  signorini_problem* problem = NULL;
  signorini_solver* solver = NULL;
  signorini_result* result = NULL;
  int failed = signorini_problem_create(&problem) ||
               signorini_problem_set_dense(problem, 2, SIGNORINI_ROW_MAJOR, M, q) ||
               signorini_solver_create("lemke", &solver) || signorini_result_create(&result) ||
               signorini_solver_solve(solver, problem, NULL, result);
  if (failed) {
    fprintf(stderr, "%s\n", signorini_last_error());
  } else {
    const double* z = signorini_result_z(result);
    printf("%s: z = %.5f %.5f\n", signorini_status_text(signorini_result_status(result)), z[0], z[1]);
    failed = !signorini_is_solved(signorini_result_status(result));
  }
  signorini_result_destroy(result);
  signorini_solver_destroy(solver);
  signorini_problem_destroy(problem);
  return failed;
}
