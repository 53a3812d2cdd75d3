#include "stated_problem.h"

#include <cmath>
#include <vector>

namespace signorini::testing {
namespace {

PlainProblem without_matrix(int n, const double* q) {
  PlainProblem stated(n);
  for (int i = 0; i < n; ++i) {
    stated.q[i] = q[i];
    stated.q_size[i] = std::abs(stated.q[i]);
  }
  return stated;
}

void state_entry(int i, int j, long double value, PlainProblem& stated) {
  stated.M[i * stated.n + j] = value;
  stated.size[i * stated.n + j] = std::abs(value);
}

/// An inverse mass and, where it had to be computed, what that multiplies rounding by.
struct InverseMass {
  std::vector<long double> W;
  long double lost = 1.0L;
};

InverseMass inverse_mass(int d, signorini_mass_kind kind, const double* block) {
  InverseMass inverse{.W = {block, block + d * d}};
  if (kind == SIGNORINI_INVERSE_MASS) {
    if (d == 2) {
      inverse.W[2] = inverse.W[1];  // the lower triangle is used
    }
    return inverse;
  }
  if (d == 1) {
    inverse.W[0] = 1.0L / inverse.W[0];
    return inverse;
  }
  const long double a = block[0];
  const long double b = block[1];
  const long double c = block[3];
  const long double determinant = a * c - b * b;
  inverse.W = {c / determinant, -b / determinant, -b / determinant, a / determinant};
  inverse.lost = 1.0L + a * c / std::abs(determinant);
  return inverse;
}

}  // namespace

PlainProblem stated_dense(int n, signorini_order order, const double* M, const double* q) {
  PlainProblem stated = without_matrix(n, q);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      state_entry(i, j, M[order == SIGNORINI_ROW_MAJOR ? i * n + j : j * n + i], stated);
    }
  }
  return stated;
}

PlainProblem stated_sparse(int n, signorini_order order, const std::int32_t* start,
                           const std::int32_t* index, const double* value, const double* q) {
  PlainProblem stated = without_matrix(n, q);
  for (int outer = 0; outer < n; ++outer) {
    for (int k = start[outer]; k < start[outer + 1]; ++k) {
      const bool by_rows = order == SIGNORINI_ROW_MAJOR;
      state_entry(by_rows ? outer : index[k], by_rows ? index[k] : outer, value[k], stated);
    }
  }
  return stated;
}

PlainProblem stated_factored(int n, const std::int32_t* start, const std::int32_t* index,
                             const double* value, std::span<const std::int32_t> block_size,
                             signorini_mass_kind kind, const double* block_value,
                             const double* compliance, const double* q) {
  PlainProblem stated = without_matrix(n, q);
  int columns = 0;
  for (const std::int32_t d : block_size) {
    columns += d;
  }
  std::vector<long double> J(static_cast<std::size_t>(n) * columns);
  for (int i = 0; i < n; ++i) {
    for (int k = start[i]; k < start[i + 1]; ++k) {
      J[i * columns + index[k]] = value[k];
    }
  }
  int first = 0;
  for (const std::int32_t d : block_size) {
    const InverseMass inverse = inverse_mass(d, kind, block_value);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        for (int k = 0; k < d * d; ++k) {
          const long double term =
              J[i * columns + first + k % d] * inverse.W[k] * J[j * columns + first + k / d];
          stated.M[i * n + j] += term;
          stated.size[i * n + j] += inverse.lost * std::abs(term);
        }
      }
    }
    first += d;
    block_value += d * d;
  }
  for (int i = 0; compliance != nullptr && i < n; ++i) {
    stated.M[i * n + i] += compliance[i];
    stated.size[i * n + i] += compliance[i];
  }
  return stated;
}

}  // namespace signorini::testing
