#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/result.h>

#include <span>
#include <string>

namespace signorini::lcp {

/// One line that says what a problem is: "n = 64, factored, 16 blocks, 96 degrees of freedom".
[[nodiscard]] std::string problem_text(const Problem& problem);

/// A result for people, some seven lines: status, both residuals with their floors, what a ray
/// proves, cost; where islands were certified a table of them, the worst first, at most 20.
/// @param tolerance the one that was asked for
[[nodiscard]] std::string result_text(const Result& result, double tolerance);

/// Several results as a table, one line each.
[[nodiscard]] std::string results_table(std::span<const Result> results);

}  // namespace signorini::lcp
