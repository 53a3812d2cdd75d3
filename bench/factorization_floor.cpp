#include "bench/factorization_floor.h"

#include <signorini/lcp/whitened_rows.h>

#include "bench/thread_time.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini::bench {
namespace {

constexpr double kShift = 1e-10;

/// The lower triangle of A's rows and columns with z > 0.
lcp::SparseMatrix active_lower(const lcp::FactoredMatrix& A, const lcp::Vector& z) {
  const lcp::SparseMatrix formed = A.form();
  std::vector<int> place(formed.rows(), -1);
  int active = 0;
  for (lcp::Index i = 0; i < formed.rows(); ++i) {
    if (z[i] > 0.0) {
      place[i] = active++;
    }
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (lcp::Index j = 0; j < formed.cols(); ++j) {
    for (lcp::SparseMatrix::InnerIterator it(formed, j); it; ++it) {
      if (place[j] >= 0 && place[it.row()] >= place[j]) {
        const double shift = it.row() == j ? 1.0 + kShift : 1.0;
        entries.emplace_back(place[it.row()], place[j], shift * it.value());
      }
    }
  }
  lcp::SparseMatrix lower(active, active);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

}  // namespace

std::string_view reference_back_end() {
  const auto names = lcp::sparse_cholesky_names();
  return std::ranges::find(names, "cholmod") != names.end() ? "cholmod" : "eigen";
}

FactorizationFloor measure_factorization_floor(const lcp::FactoredMatrix& A, const lcp::Vector& z,
                                               std::string_view back_end, int repetitions) {
  const lcp::SparseMatrix lower = active_lower(A, z);
  FactorizationFloor floor;
  floor.rows = static_cast<int>(lower.rows());
  floor.seconds = std::numeric_limits<double>::infinity();
  floor.factor_seconds = floor.seconds;
  for (int k = 0; k < repetitions; ++k) {
    const auto cholesky = lcp::make_sparse_cholesky(back_end);
    lcp::Vector x = lcp::Vector::Ones(lower.rows());
    const double start = thread_seconds();
    cholesky->analyse(lower);
    const double analysed = thread_seconds();
    if (!cholesky->factor(lower)) {
      throw std::runtime_error("the active rows' matrix could not be factored by " +
                               std::string(back_end));
    }
    const double factored = thread_seconds();
    cholesky->solve(x);
    floor.seconds = std::min(floor.seconds, thread_seconds() - start);
    floor.factor_seconds = std::min(floor.factor_seconds, factored - analysed);
    floor.counts = cholesky->counts();
  }
  return floor;
}

double measure_body_space_floor(const lcp::Problem& problem, const lcp::Vector& z) {
  const auto* A = std::get_if<lcp::FactoredMatrix>(&problem.M);
  if (A == nullptr) {
    return 0.0;
  }
  constexpr double kActive = 1e6;
  lcp::Vector d = (z.array() > 0.0).cast<double>() * kActive;
  for (const lcp::FrictionCone& cone : problem.cones) {
    d.segment(cone.normal_row, cone.dimension).setConstant(d[cone.normal_row]);
  }
  lcp::WhitenedRows whitened;
  whitened.set(*A);
  const lcp::SparseMatrix& H = whitened.body_space_matrix(d);
  if (H.rows() == 0) {
    return 0.0;
  }
  const auto cholesky = lcp::make_sparse_cholesky(reference_back_end());
  lcp::Vector x = lcp::Vector::Ones(H.rows());
  const double start = thread_seconds();
  cholesky->analyse(H);
  if (!cholesky->factor(H)) {
    throw std::runtime_error("the body-space matrix could not be factored");
  }
  cholesky->solve(x);
  return thread_seconds() - start;
}

}  // namespace signorini::bench
