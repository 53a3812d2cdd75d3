#include <signorini/lcp/lemke.h>

#include "byte_reader.h"
#include "lcp_bytes.h"

#include <algorithm>
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

/// max |z - clamp(z - w)| / (1 + |q|), computed apart from the certificate, in long double.
long double natural_residual(const lcp::Problem& problem, const lcp::Vector& z) {
  const auto& M = std::get<lcp::Matrix>(problem.M);
  long double worst = 0.0L;
  for (lcp::Index i = 0; i < z.size(); ++i) {
    long double w = problem.q[i];
    for (lcp::Index j = 0; j < z.size(); ++j) {
      w += static_cast<long double>(M(i, j)) * z[j];
    }
    long double lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    long double upper = problem.upper.size() > 0 ? problem.upper[i] : kInfinity;
    for (const lcp::CoupledLimit& limit : problem.limits) {
      if (limit.row == i) {
        upper = limit.coefficient * std::max(0.0L, static_cast<long double>(z[limit.normal_row]));
        lower = -upper;
      }
    }
    const long double stays = std::clamp(z[i] - w, lower, upper);
    worst = std::max(worst, std::abs(z[i] - stays));
  }
  const double q = z.size() == 0 ? 0.0 : problem.q.lpNorm<Eigen::Infinity>();
  return worst / (1.0L + q);
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
  require(result.z.allFinite(), "z is finite");
  const long double residual = natural_residual(problem, result.z);
  if (result.status == lcp::Status::kSolved) {
    require(residual <= 1.001e-8L + 1e-3L * result.certificate.natural_floor,
            "a solved problem has a small residual");
  }
  if (result.status == lcp::Status::kInfeasible || result.status == lcp::Status::kNoSolutionBelow) {
    require(result.ray.size() == problem.size(), "a proof comes with its ray");
    require(!(residual == 0.0L && result.status == lcp::Status::kInfeasible),
            "what has a solution is not infeasible");
  }
}

}  // namespace signorini::testing
