#include "bench/peer.h"

#include <limits>

namespace signorini::bench {
namespace {

/// True if M is symmetric to rounding: a product J W J^T formed in doubles is.
bool is_symmetric(const lcp::MatrixForm& form) {
  if (std::holds_alternative<lcp::FactoredMatrix>(form)) {
    return true;
  }
  const lcp::Matrix M = lcp::to_dense(form);
  return (M - M.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * M.cwiseAbs().maxCoeff();
}

}  // namespace

lcp::Problem regularised(const lcp::Problem& problem) {
  lcp::Problem other = problem;
  lcp::Matrix M = lcp::to_dense(problem.M);
  M.diagonal() *= kRegularisation;
  other.M = std::move(M);
  return other;
}

std::string refuses_all_but_lcp(const lcp::Problem& problem) {
  return problem.is_lcp() ? "" : "takes an LCP alone";
}

std::string refuses_cones(const lcp::Problem& problem) {
  return problem.cones.empty() ? "" : "takes no friction cones";
}

std::string refuses_all_but_boxes(const lcp::Problem& problem) {
  if (!problem.cones.empty()) {
    return refuses_cones(problem);
  }
  const RowBounds bounds = row_bounds(problem);
  for (lcp::Index i = 0; i < problem.size(); ++i) {
    if (bounds.lower[i] > 0.0 || bounds.upper[i] < 0.0) {
      return "takes bounds with 0 between them";
    }
  }
  lcp::Vector diagonal;
  lcp::diagonal(problem.M, diagonal);
  return (diagonal.array() > 0.0).all() ? "" : "divides by the diagonal, which has a zero";
}

std::string refuses_all_but_symmetric_boxes(const lcp::Problem& problem) {
  std::string reason = refuses_all_but_boxes(problem);
  if (!reason.empty()) {
    return reason;
  }
  return is_symmetric(problem.M) ? "" : "takes a symmetric matrix";
}

RowBounds row_bounds(const lcp::Problem& problem) {
  const lcp::Index n = problem.size();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  RowBounds bounds{lcp::Vector::Zero(n), lcp::Vector::Constant(n, kInfinity),
                   std::vector<int>(static_cast<std::size_t>(n), -1)};
  if (problem.lower.size() > 0) {
    bounds.lower = problem.lower;
  }
  if (problem.upper.size() > 0) {
    bounds.upper = problem.upper;
  }
  for (const lcp::CoupledLimit& limit : problem.limits) {
    bounds.lower[limit.row] = -limit.coefficient;
    bounds.upper[limit.row] = limit.coefficient;
    bounds.normal_row[limit.row] = limit.normal_row;
  }
  return bounds;
}

}  // namespace signorini::bench
