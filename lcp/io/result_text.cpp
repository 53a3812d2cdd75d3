#include <signorini/lcp/io/result_text.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

namespace signorini::lcp {
namespace {

std::string matrix_text(const MatrixForm& M) {
  if (const auto* factored = std::get_if<FactoredMatrix>(&M)) {
    return fmt::format("factored, {} blocks, {} degrees of freedom", factored->mass.block_count(),
                       factored->degrees_of_freedom());
  }
  if (const auto* sparse = std::get_if<SparseMatrix>(&M)) {
    return fmt::format("sparse, {} entries", sparse->nonZeros());
  }
  return "dense";
}

std::string cost_text(const Statistics& statistics) {
  std::string text;
  const auto add = [&text](int count, const char* what) {
    if (count >= 0) {
      text += fmt::format("{} {}, ", count, what);
    }
  };
  add(statistics.pivots, "pivots");
  add(statistics.iterations, "iterations");
  add(statistics.factorizations, "factorizations");
  add(statistics.refinements, "refinements");
  if (statistics.factor_bytes > 0) {
    text += fmt::format("factor {:.3g} kB, ", 1e-3 * static_cast<double>(statistics.factor_bytes));
  }
  return text + fmt::format("{:.3g} s", statistics.solve_seconds);
}

std::string ray_text(const Result& result) {
  switch (result.status) {
    case Status::kInfeasible: return "proves that no z satisfies the bounds: Z = inf";
    case Status::kNoSolutionBelow:
      return fmt::format("every feasible z has |z|_1 >= Z = {:.6g}", result.ray_bound);
    default: return "proves nothing about this matrix";
  }
}

/// The islands, worst first, one line each; no more than kMostIslands.
std::string islands_text(const Result& result, double tolerance) {
  constexpr std::size_t kMostIslands = 20;
  const std::vector<Certificate>& each = result.island_certificates;
  std::vector<int> rows(each.size());
  for (const int island : result.island_of_row) {
    ++rows[island];
  }
  std::vector<std::size_t> order(each.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(),
                           [&](std::size_t k) { return each[k].unit_free_residual; });
  const auto verdict = [tolerance](const Certificate& certificate) {
    return judge(certificate, tolerance, Status::kStalled);
  };
  const auto solved =
      std::ranges::count_if(each, [&](const Certificate& c) { return is_solved(verdict(c)); });
  std::string text =
      fmt::format("islands     {}, {} of them solved by themselves\n", each.size(), solved);
  text += fmt::format("            {:>7}{:>8}{:>11}{:>11}{:>11}{:>7}  verdict\n", "island", "rows",
                      "unit-free", "floor", "natural", "worst");
  for (std::size_t k = 0; k < std::min(order.size(), kMostIslands); ++k) {
    const Certificate& c = each[order[k]];
    text += fmt::format("            {:>7}{:>8}{:>11.1e}{:>11.1e}{:>11.1e}{:>7}  {}\n", order[k],
                        rows[order[k]], c.unit_free_residual, c.rounding_floor, c.natural_residual,
                        c.worst_row, is_solved(verdict(c)) ? to_string(verdict(c)) : "not solved");
  }
  if (order.size() > kMostIslands) {
    text += fmt::format("            and {} with smaller residuals\n", order.size() - kMostIslands);
  }
  return text;
}

std::string count_text(Index count, const std::string& what) {
  return count > 0 ? fmt::format(", {} {}{}", count, what, count > 1 ? "s" : "") : "";
}

/// Rows with bounds other than 0 <= z_i and free ones, cones' rows apart.
struct RowCounts {
  Index free = 0;
  Index bounded = 0;
};

RowCounts count_rows(const Problem& problem) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  RowCounts counts;
  for (Index i = 0; i < problem.size(); ++i) {
    const double lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    const double upper = problem.upper.size() > 0 ? problem.upper[i] : kInfinity;
    const bool is_free = lower == -kInfinity && upper == kInfinity;
    counts.free += is_free ? 1 : 0;
    counts.bounded += !is_free && (lower != 0.0 || upper != kInfinity) ? 1 : 0;
  }
  return counts;
}

/// The counter of the solver's own unit.
int work_of(const Statistics& statistics) {
  return std::max(statistics.pivots, statistics.iterations);
}

}  // namespace

std::string problem_text(const Problem& problem) {
  const RowCounts counts = count_rows(problem);
  std::string text = fmt::format("n = {}, {}", problem.size(), matrix_text(problem.M)) +
                     count_text(counts.free, "free row") +
                     count_text(counts.bounded, "bounded row") +
                     count_text(static_cast<Index>(problem.limits.size()), "coupled limit") +
                     count_text(static_cast<Index>(problem.cones.size()), "friction cone");
  if (!problem.cones.empty()) {
    text += fmt::format(" ({} law)", to_string(problem.friction_law));
  }
  return text;
}

std::string result_text(const Result& result, double tolerance) {
  const Certificate& c = result.certificate;
  std::string text =
      fmt::format("solver      {}\nstatus      {}\n", result.solver, to_string(result.status));
  if (!result.detail.empty()) {
    text += fmt::format("detail      {}\n", result.detail);
  }
  for (const Attempt& attempt : result.attempts) {
    text += fmt::format("tried       {} ({}): {}, unit-free {:.2e}, {:.3g} s\n", attempt.solver,
                        attempt.reason, to_string(attempt.status), attempt.unit_free_residual,
                        attempt.statistics.solve_seconds);
  }
  text += fmt::format("residual    natural {:.2e} (rounding floor {:.1e}), tolerance {:.1e}\n",
                      c.natural_residual, c.natural_floor, tolerance);
  text += fmt::format("            unit-free {:.2e} (rounding floor {:.1e}), worst row {}\n",
                      c.unit_free_residual, c.rounding_floor, c.worst_row);
  text += fmt::format("            backward error {:.2e}\n", c.backward_error);
  text += fmt::format("z, w        min z {:.2e}, min w {:.2e}, |z.w| {:.2e}\n", c.min_z, c.min_w,
                      c.complementarity);
  if (!std::isnan(c.cone_violation)) {
    text += fmt::format("            cone violation {:.2e}\n", c.cone_violation);
  }
  if (!result.island_of_row.empty()) {
    text += islands_text(result, tolerance);
  }
  if (result.ray.size() > 0) {
    text += fmt::format("ray         {}\n", ray_text(result));
  }
  return text + fmt::format("cost        {}\n", cost_text(result.statistics));
}

std::string results_table(std::span<const Result> results) {
  const Result* fastest = nullptr;
  int solved = 0;
  for (const Result& result : results) {
    if (is_solved(result.status)) {
      ++solved;
      const double seconds = result.statistics.solve_seconds;
      fastest =
          fastest == nullptr || seconds < fastest->statistics.solve_seconds ? &result : fastest;
    }
  }
  std::string text = fmt::format("verdict     {} of {} solvers solved it", solved, results.size());
  if (fastest != nullptr) {
    text += fmt::format(", first {} in {:.3g} ms", fastest->solver,
                        1e3 * fastest->statistics.solve_seconds);
  }
  text += fmt::format("\n\n{:<22}{:<26}{:>11}{:>11}{:>9}{:>9}{:>12}\n", "status", "solver",
                      "unit-free", "natural", "work", "factors", "ms");
  for (const Result& result : results) {
    const int factors = result.statistics.factorizations;
    text += fmt::format("{:<22}{:<26}{:>11.1e}{:>11.1e}{:>9}{:>9}{:>12.3f}\n",
                        to_string(result.status), result.solver,
                        result.certificate.unit_free_residual, result.certificate.natural_residual,
                        work_of(result.statistics), factors < 0 ? "-" : std::to_string(factors),
                        1e3 * result.statistics.solve_seconds);
  }
  text += "work: pivots, sweeps or iterations; the times include the certificate\n";
  for (const Result& result : results) {
    if (!result.detail.empty()) {
      text += fmt::format("{}: {}\n", result.solver, result.detail);
    }
  }
  return text;
}

}  // namespace signorini::lcp
