#include "bench/peer_task.h"

#include <stdexcept>

namespace signorini::bench {
namespace {

std::vector<double> numbers(const lcp::Vector& vector) {
  return {vector.data(), vector.data() + vector.size()};
}

lcp::Vector vector_of(const std::vector<double>& numbers) {
  return Eigen::Map<const lcp::Vector>(numbers.data(), static_cast<lcp::Index>(numbers.size()));
}

}  // namespace

PeerTask peer_task(const lcp::Problem& problem, const PeerSettings& settings,
                   const RunLimits& limits) {
  if (!problem.cones.empty()) {
    throw std::invalid_argument("peer task: no program takes friction cones");
  }
  const lcp::Matrix M = lcp::to_dense(problem.M);
  return {.M = {M.data(), M.data() + M.size()},
          .q = numbers(problem.q),
          .lower = numbers(problem.lower),
          .upper = numbers(problem.upper),
          .coupled = problem.limits,
          .settings = settings,
          .limits = limits};
}

lcp::Problem problem_of(const PeerTask& task) {
  const std::size_t n = task.q.size();
  const auto is_whole = [&](const std::vector<double>& bound) {
    return bound.empty() || bound.size() == n;
  };
  if (task.M.size() != n * n || !is_whole(task.lower) || !is_whole(task.upper)) {
    throw std::invalid_argument("peer task: M, q and the bounds have different sizes");
  }
  const auto rows = static_cast<lcp::Index>(n);
  lcp::Problem problem;
  problem.M = lcp::Matrix(Eigen::Map<const lcp::Matrix>(task.M.data(), rows, rows));
  problem.q = vector_of(task.q);
  problem.lower = vector_of(task.lower);
  problem.upper = vector_of(task.upper);
  problem.limits = task.coupled;
  return problem;
}

}  // namespace signorini::bench
