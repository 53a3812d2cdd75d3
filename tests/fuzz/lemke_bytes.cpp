#ifdef SIGNORINI_HAS_GMP
#include <signorini/lcp/exact_solution.h>
#endif
#include <signorini/lcp/lemke.h>

#include "byte_reader.h"
#include "lcp_bytes.h"
#include "plain_problem.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace signorini::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

lcp::Problem read_problem(ByteReader& bytes) {
  const int n = bytes.below(9);
  lcp::Problem problem;
  lcp::Matrix M(n, n);
  const bool symmetric = bytes.below(2) == 1;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      M(i, j) = symmetric && i < j ? M(j, i) : bytes.number();
    }
  }
  problem.q.resize(n);
  for (int i = 0; i < n; ++i) {
    problem.q[i] = bytes.number();
  }
  problem.M = M;
  if (bytes.below(3) == 1) {
    problem.lower = lcp::Vector::Zero(n);
    problem.upper = lcp::Vector::Constant(n, kInfinity);
    for (int i = 0; i < n; ++i) {
      switch (bytes.below(4)) {
        case 0: problem.lower[i] = -kInfinity; break;
        case 1: problem.upper[i] = bytes.number(); break;
        default: break;
      }
    }
  }
  if (n >= 2 && bytes.below(3) == 1) {
    problem.limits.push_back({bytes.below(n), bytes.below(n), bytes.number()});
  }
  return problem;
}

/// The problem apart from the library, dense.
PlainProblem plain(const lcp::Problem& problem) {
  const auto& M = std::get<lcp::Matrix>(problem.M);
  PlainProblem stated(static_cast<int>(problem.size()));
  for (int i = 0; i < stated.n; ++i) {
    for (int j = 0; j < stated.n; ++j) {
      stated.M[i * stated.n + j] = M(i, j);
      stated.size[i * stated.n + j] = std::abs(M(i, j));
    }
    stated.q[i] = problem.q[i];
    stated.q_size[i] = std::abs(problem.q[i]);
    if (problem.has_bounds()) {
      stated.lower[i] = problem.lower[i];
      stated.upper[i] = problem.upper[i];
    }
  }
  for (const lcp::CoupledLimit& limit : problem.limits) {
    stated.limits.push_back({limit.row, limit.normal_row, limit.coefficient});
  }
  return stated;
}

/// What is said to have no solution has none in rational numbers, as far as some pivots find.
void judge_infeasible([[maybe_unused]] const lcp::Problem& problem) {
#ifdef SIGNORINI_HAS_GMP
  require(lcp::solve_exactly(problem, 200).ending != lcp::ExactEnding::kSolution,
          "what has a solution is not infeasible");
#endif
}

}  // namespace

void judge_lemke_bytes(const std::uint8_t* data, std::size_t size) {
  ByteReader bytes(data, size);
  const lcp::Problem problem = read_problem(bytes);
  lcp::Lemke lemke({{.max_iterations = 2000}});
  lcp::Result result;
  try {
    lemke.solve(problem, result);
  } catch (const std::invalid_argument&) {
    return;  // a row that is its own normal row
  }
  require(result.z.size() == problem.size(), "z has a number a row");
  if (result.status == lcp::Status::kInvalidInput) {
    require(!lcp::find_bad_value(problem).empty(), "invalid input names a value");
    return;
  }
  const PlainProblem stated = plain(problem);
  stated.judge(result.z.data(), {.natural_residual = result.certificate.natural_residual,
                                 .unit_free_residual = result.certificate.unit_free_residual,
                                 .is_solved = result.status == lcp::Status::kSolved,
                                 .is_to_rounding = result.status == lcp::Status::kSolvedToRounding,
                                 .tolerance = lcp::SolverSettings{}.tolerance});
  if (result.status == lcp::Status::kInfeasible || result.status == lcp::Status::kNoSolutionBelow) {
    require(result.ray.size() == problem.size(), "a proof comes with its ray");
    stated.judge_ray(result.ray.data(), result.ray_bound);
  }
  if (result.status == lcp::Status::kInfeasible) {
    judge_infeasible(problem);
  }
}

}  // namespace signorini::testing
