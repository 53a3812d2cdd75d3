#include <signorini/lcp/exact_lemke.h>
#include <signorini/lcp/exact_solution.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace signorini::lcp {
namespace {

/// Writes the nearest doubles; beyond the largest double, that one. @return whether all fit.
bool round_to_doubles(const std::vector<mpq_class>& exact, Vector& rounded) {
  constexpr double kMost = std::numeric_limits<double>::max();
  bool all_fit = true;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double value = to_nearest_double(exact[i]);
    all_fit = all_fit && value <= kMost;
    rounded[static_cast<Index>(i)] = std::min(value, kMost);
  }
  return all_fit;
}

std::string describe_ray(const ExactSolution& solution, bool is_exact) {
  std::string text = solution.ray_proves_infeasible
                         ? "in rational arithmetic the ray proves that no solution exists"
                         : "in rational arithmetic the ray proves nothing about this matrix";
  if (!is_exact) {
    text += "; no multiple of it has double entries, the ray given is rounded";
  }
  return text;
}

std::string describe_restarts(const ExactSolution& solution) {
  return solution.restarts == 0 ? std::string()
                                : "; " + std::to_string(solution.restarts) +
                                      " restarts from another complementary basis";
}

}  // namespace

void ExactLemkeSettings::validate() const {
  SolverSettings::validate();
  if (restarts < 0) {
    throw std::invalid_argument("ExactLemke settings: restarts: must be >= 0, got " +
                                std::to_string(restarts));
  }
}

ExactLemke::ExactLemke(const ExactLemkeSettings& settings) : settings_(settings) {
  settings_.validate();
}

std::string ExactLemke::refuses(const Problem& problem) const {
  return problem.is_lcp() ? ""
                          : "takes an LCP: every lower bound 0, no upper bound, no friction limit";
}

Status ExactLemke::iterate(const Problem& problem, const Vector* /*warm_start*/,
                           const Deadline& deadline, Result& result) {
  const ExactSolution solution =
      solve_exactly(problem, settings_.max_iterations, deadline, settings_.restarts);
  result.statistics.pivots = solution.pivots;
  const bool all_fit = round_to_doubles(solution.z, result.z);
  switch (solution.ending) {
    case ExactEnding::kPivotLimit: return Status::kIterationLimit;
    case ExactEnding::kTimeLimit: return Status::kTimeLimit;
    case ExactEnding::kRay: {
      const bool is_exact = scale_ray(solution.ray, result.ray);
      result.detail = describe_ray(solution, is_exact) + describe_restarts(solution);
      return Status::kRayUnproven;
    }
    case ExactEnding::kSolution: break;
  }
  result.detail = (all_fit ? "exact solution, rounded to double"
                           : "an exact solution exists, but is beyond the largest double") +
                  describe_restarts(solution);
  return Status::kNumericalBreakdown;
}

}  // namespace signorini::lcp
