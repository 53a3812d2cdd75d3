#include "bench/row_scaling_study.h"

#include <signorini/lcp/interior_point.h>
#include <signorini/lcp/whitened_rows.h>

#include "bench/contact_families.h"
#include "bench/factorization_floor.h"
#include "bench/thread_time.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <ostream>
#include <random>

namespace signorini::bench {
namespace {

constexpr double kChange = 0.01;  // of the velocities, for the warm start
constexpr double kNoise = 0.1;    // m/s: the spread of a family's velocities

/// The size that gives a family about so many rows, from the counts of contact_families.h.
int size_for(std::string_view family, int rows) {
  const double n = rows;
  double size = n;  // spheres
  if (family == "tower4") size = n / 4.0;
  if (family == "tower8") size = n / 8.0;
  if (family == "pyramid2d") size = std::sqrt(n / 4.0);
  if (family == "wall") size = std::sqrt(n / 11.5);
  if (family == "pyramid3d") size = std::cbrt(n * 3.0 / 16.0);
  return std::max(1, static_cast<int>(std::lround(size)));
}

/// q of bodies whose velocities differ by 1 % of their spread.
lcp::Problem changed(const lcp::Problem& problem) {
  const auto& A = std::get<lcp::FactoredMatrix>(problem.M);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, kChange * kNoise);
  const lcp::Vector dv =
      lcp::Vector::NullaryExpr(A.degrees_of_freedom(), [&] { return normal(random); });
  const lcp::Vector none = lcp::Vector::Zero(A.rows());
  lcp::Vector dq(A.rows());
  A.times(dv.data(), none.data(), dq.data());
  lcp::Problem other = problem;
  other.q += dq;
  return other;
}

BackEndTime measure(std::string_view name, const lcp::SparseMatrix& H, int repetitions) {
  BackEndTime time{.name = name};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  time.analyse_seconds = time.factor_seconds = time.solve_seconds = kInfinity;
  for (int k = 0; k < repetitions; ++k) {
    const auto cholesky = lcp::make_sparse_cholesky(name);
    lcp::Vector x = lcp::Vector::Ones(H.rows());
    const double start = thread_seconds();
    cholesky->analyse(H);
    const double analysed = thread_seconds();
    if (!cholesky->factor(H)) {
      return time;
    }
    const double factored = thread_seconds();
    cholesky->solve(x);
    time.analyse_seconds = std::min(time.analyse_seconds, analysed - start);
    time.factor_seconds = std::min(time.factor_seconds, factored - analysed);
    time.solve_seconds = std::min(time.solve_seconds, thread_seconds() - factored);
    time.counts = cholesky->counts();
  }
  return time;
}

RowScalingRow run_one(std::string_view family, int rows, int repetitions) {
  const lcp::Problem problem = make_family({.family = family, .size = size_for(family, rows)});
  const auto& A = std::get<lcp::FactoredMatrix>(problem.M);
  RowScalingRow row{.family = family, .rows = static_cast<int>(problem.size())};
  row.seconds = row.warm_seconds = std::numeric_limits<double>::infinity();
  const lcp::Problem other = changed(problem);
  lcp::Result cold;
  lcp::Result warm;
  for (int k = 0; k < repetitions; ++k) {
    lcp::InteriorPoint solver;  // nothing is kept from one repetition to the next
    const double start = thread_seconds();
    solver.solve(problem, cold);
    const double solved = thread_seconds();
    solver.solve(other, warm, &cold.z);
    row.seconds = std::min(row.seconds, solved - start);
    row.warm_seconds = std::min(row.warm_seconds, thread_seconds() - solved);
  }
  row.status = cold.status;
  row.warm_status = warm.status;
  row.factorizations = cold.statistics.factorizations;
  row.warm_factorizations = warm.statistics.factorizations;
  row.unit_free_residual = cold.certificate.unit_free_residual;
  row.floor_seconds =
      measure_factorization_floor(A, cold.z, reference_back_end(), repetitions).seconds;
  lcp::WhitenedRows whitened;
  whitened.set(A);
  const lcp::Vector d = (cold.z.array() > 0.0).cast<double>() * 1e6;
  const lcp::SparseMatrix& H = whitened.body_space_matrix(d);
  for (const std::string_view name : lcp::sparse_cholesky_names()) {
    row.back_ends.push_back(measure(name, H, repetitions));
  }
  return row;
}

void print(const RowScalingRow& row, std::ostream& log) {
  log << fmt::format("{:<10} {:>6}  {:<18} {:>9.3f} {:>3}  {:>9.3f} {:>3}  {:>9.3f} {:>6.1f} ",
                     row.family, row.rows, lcp::to_string(row.status), 1e3 * row.seconds,
                     row.factorizations, 1e3 * row.warm_seconds, row.warm_factorizations,
                     1e3 * row.floor_seconds, row.seconds / row.floor_seconds);
  for (const BackEndTime& time : row.back_ends) {
    log << fmt::format("  {} {:.3f}", time.name, 1e3 * time.factor_seconds);
  }
  log << '\n' << std::flush;
}

}  // namespace

std::vector<RowGrowth> RowScalingReport::growth() const {
  std::vector<RowGrowth> all;
  for (const std::string_view family : family_names()) {
    const RowScalingRow* first = nullptr;
    const RowScalingRow* last = nullptr;
    for (const RowScalingRow& row : rows) {
      if (row.family == family) {
        first = first == nullptr ? &row : first;
        last = &row;
      }
    }
    if (first == nullptr || last->rows == first->rows) {
      continue;
    }
    const double decades = std::log(static_cast<double>(last->rows) / first->rows);
    all.push_back({family, std::log(last->seconds / first->seconds) / decades,
                   std::log(last->floor_seconds / first->floor_seconds) / decades});
  }
  return all;
}

bool RowScalingReport::passed() const {
  return std::ranges::all_of(rows, [](const RowScalingRow& row) {
    return lcp::is_solved(row.status) && lcp::is_solved(row.warm_status);
  });
}

std::string RowScalingReport::to_csv() const {
  std::string csv =
      "family,rows,status,unit_free_residual,seconds,factorizations,warm_status,warm_seconds,"
      "warm_factorizations,floor_seconds,times_floor,back_end,analyse_seconds,factor_seconds,"
      "solve_seconds,factor_entries,factor_flops,bytes\n";
  for (const RowScalingRow& row : rows) {
    for (const BackEndTime& time : row.back_ends) {
      csv += fmt::format(
          "{},{},{},{:.3g},{:.6g},{},{},{:.6g},{},{:.6g},{:.4g},{},{:.6g},{:.6g},"
          "{:.6g},{:.6g},{:.6g},{}\n",
          row.family, row.rows, lcp::to_string(row.status), row.unit_free_residual, row.seconds,
          row.factorizations, lcp::to_string(row.warm_status), row.warm_seconds,
          row.warm_factorizations, row.floor_seconds, row.seconds / row.floor_seconds, time.name,
          time.analyse_seconds, time.factor_seconds, time.solve_seconds, time.counts.entries,
          time.counts.flops, time.counts.bytes);
    }
  }
  return csv;
}

RowScalingReport run_row_scaling_study(const RowScalingOptions& options, std::ostream& log) {
  RowScalingReport report;
  log << "CPU times in ms, the least of " << options.repetitions
      << "; fac: factorisations; floor: one analysis, factorisation and solve of the active rows "
         "by "
      << reference_back_end() << ".\n"
      << "family       rows  status                  cold fac       warm fac      floor  ratio   "
         "one "
         "factor of H\n";
  for (const std::string_view family : family_names()) {
    for (double rows = 1000.0; rows <= 1.001 * options.max_rows; rows *= std::sqrt(10.0)) {
      report.rows.push_back(
          run_one(family, static_cast<int>(std::lround(rows)), options.repetitions));
      print(report.rows.back(), log);
    }
    if (options.max_rows > 10000 && options.max_rows < 100000) {  // and the end, off the ladder
      report.rows.push_back(run_one(family, options.max_rows, options.repetitions));
      print(report.rows.back(), log);
    }
  }
  for (const RowGrowth& growth : report.growth()) {
    log << fmt::format("{:<10} time ~ rows^{:.2f}, floor ~ rows^{:.2f}{}\n", growth.family,
                       growth.solver, growth.floor,
                       growth.solver <= growth.floor + 0.1 ? "" : "  (faster than the floor)");
  }
  return report;
}

}  // namespace signorini::bench
