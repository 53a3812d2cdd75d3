#include <signorini/lcp/number_text.h>
#include <signorini/lcp/problem.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[noreturn]] void fail(const std::string& what) {
  throw std::invalid_argument("Problem: " + what);
}

std::string indexed(const char* name, Index i, double value) {
  return std::string(name) + "[" + std::to_string(i) + "] is " + number_text(value);
}

std::string bad_matrix_value(const Matrix& M) {
  for (Index j = 0; j < M.cols(); ++j) {
    for (Index i = 0; i < M.rows(); ++i) {
      if (!std::isfinite(M(i, j))) {
        return "M(" + std::to_string(i) + ", " + std::to_string(j) + ") is " + number_text(M(i, j));
      }
    }
  }
  return {};
}

std::string bad_matrix_value(const SparseMatrix& M) {
  for (Index j = 0; j < M.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(M, j); it; ++it) {
      if (!std::isfinite(it.value())) {
        return "M(" + std::to_string(it.row()) + ", " + std::to_string(j) + ") is " +
               number_text(it.value());
      }
    }
  }
  return {};
}

std::string bad_matrix_value(const FactoredMatrix& M) {  // W is checked when its blocks are added
  for (int i = 0; i < M.rows(); ++i) {
    for (const FactoredMatrix::Entry& entry : M.entries(i)) {
      for (int k = 0; k < M.mass.dimension(entry.block); ++k) {
        if (!std::isfinite(M.values(entry)[k])) {
          return "J: row " + std::to_string(i) + ", block " + std::to_string(entry.block) +
                 ", value " + std::to_string(k) + " is " + number_text(M.values(entry)[k]);
        }
      }
    }
  }
  return {};
}

std::string bad_bound(const Problem& problem) {
  for (Index i = 0; i < problem.size(); ++i) {
    const double lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    const double upper = problem.upper.size() > 0 ? problem.upper[i] : kInfinity;
    if (std::isnan(lower) || lower == kInfinity) {
      return indexed("lower", i, lower);
    }
    if (std::isnan(upper) || upper == -kInfinity) {
      return indexed("upper", i, upper);
    }
    if (lower > upper) {
      return indexed("lower", i, lower) + ", above " + indexed("upper", i, upper);
    }
  }
  for (const CoupledLimit& limit : problem.limits) {
    if (!(limit.coefficient >= 0.0) || !std::isfinite(limit.coefficient)) {
      return indexed("limit coefficient of row", limit.row, limit.coefficient);
    }
  }
  for (const FrictionCone& cone : problem.cones) {
    if (!(cone.coefficient >= 0.0) || !std::isfinite(cone.coefficient)) {
      return indexed("friction coefficient of the cone at row", cone.normal_row, cone.coefficient);
    }
  }
  return {};
}

std::string cone_at(const FrictionCone& cone) {
  return "cones: at row " + std::to_string(cone.normal_row);
}

/// Cones lie within the problem, ascend, and share no row with one another.
void check_cones(const Problem& problem) {
  Index free_from = 0;
  for (const FrictionCone& cone : problem.cones) {
    if (cone.dimension != 2 && cone.dimension != 3) {
      fail(cone_at(cone) + ": dimension must be 2 or 3, got " + std::to_string(cone.dimension));
    }
    if (cone.normal_row < free_from) {
      fail(cone_at(cone) + ": cones must ascend and share no row; the one before ends at row " +
           std::to_string(free_from - 1));
    }
    free_from = Index{cone.normal_row} + cone.dimension;
    if (free_from > problem.size()) {
      fail(cone_at(cone) + ": " + std::to_string(cone.dimension) +
           " rows do not fit a problem of " + std::to_string(problem.size()) + " rows");
    }
  }
}

/// The rows of coupled limits lie outside of the cones (checked and ascending).
void check_limits_beside_cones(const Problem& problem) {
  for (const CoupledLimit& limit : problem.limits) {
    for (const int row : {limit.row, limit.normal_row}) {
      const auto after =
          std::ranges::upper_bound(problem.cones, row, {}, &FrictionCone::normal_row);
      if (after != problem.cones.begin() &&
          row < std::prev(after)->normal_row + std::prev(after)->dimension) {
        fail("limits: row " + std::to_string(row) + " belongs to a cone");
      }
    }
  }
}

}  // namespace

std::string_view to_string(FrictionLaw law) {
  return law == FrictionLaw::kCoulomb ? "Coulomb" : "associated";
}

bool Problem::is_unilateral() const {
  return limits.empty() && (lower.size() == 0 || (lower.array() == 0.0).all()) &&
         (upper.size() == 0 || (upper.array() == kInfinity).all());
}

void check_shapes(const Problem& problem) {
  const Index n = problem.size();
  std::visit(
      [n](const auto& M) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(M)>, FactoredMatrix>) {
          if (M.rows() != M.cols()) {
            fail("M: must be square, got " + std::to_string(M.rows()) + " x " +
                 std::to_string(M.cols()));
          }
        }
        if (M.rows() != n) {
          fail("q: " + std::to_string(n) + " numbers for a matrix M of " +
               std::to_string(M.rows()) + " rows");
        }
      },
      problem.M);
  if (problem.lower.size() != 0 && problem.lower.size() != n) {
    fail("lower: " + std::to_string(problem.lower.size()) + " numbers, expected 0 or " +
         std::to_string(n));
  }
  if (problem.upper.size() != 0 && problem.upper.size() != n) {
    fail("upper: " + std::to_string(problem.upper.size()) + " numbers, expected 0 or " +
         std::to_string(n));
  }
  for (const CoupledLimit& limit : problem.limits) {
    if (limit.row < 0 || limit.row >= n || limit.normal_row < 0 || limit.normal_row >= n ||
        limit.row == limit.normal_row) {
      fail("limits: row " + std::to_string(limit.row) + " with normal row " +
           std::to_string(limit.normal_row) + " in a problem of " + std::to_string(n) + " rows");
    }
  }
  check_cones(problem);
  check_limits_beside_cones(problem);
}

std::string find_bad_value(const Problem& problem) {
  for (Index i = 0; i < problem.size(); ++i) {
    if (!std::isfinite(problem.q[i])) {
      return indexed("q", i, problem.q[i]);
    }
  }
  std::string bad = std::visit([](const auto& M) { return bad_matrix_value(M); }, problem.M);
  return bad.empty() ? bad_bound(problem) : bad;
}

Index rows(const MatrixForm& M) {
  return std::visit([](const auto& form) -> Index { return form.rows(); }, M);
}

template <typename Scalar>
void multiply(const MatrixForm& M, const Scalar* z, Scalar* w) {
  if (const auto* factored = std::get_if<FactoredMatrix>(&M)) {
    factored->multiply(z, w);
    return;
  }
  std::fill(w, w + rows(M), Scalar(0));
  if (const auto* dense = std::get_if<Matrix>(&M)) {
    for (Index j = 0; j < dense->cols(); ++j) {
      if (z[j] == Scalar(0)) {
        continue;
      }
      for (Index i = 0; i < dense->rows(); ++i) {
        w[i] += (*dense)(i, j) * z[j];
      }
    }
    return;
  }
  const auto& sparse = std::get<SparseMatrix>(M);
  for (Index j = 0; j < sparse.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(sparse, j); it; ++it) {
      w[it.row()] += it.value() * z[j];
    }
  }
}

void transpose_multiply(const MatrixForm& M, const VectorRef& y, std::vector<long double>& out) {
  out.assign(rows(M), 0.0L);
  if (const auto* factored = std::get_if<FactoredMatrix>(&M)) {  // symmetric
    const std::vector<long double> wide(y.data(), y.data() + y.size());
    factored->multiply(wide.data(), out.data());
    return;
  }
  if (const auto* dense = std::get_if<Matrix>(&M)) {
    for (Index j = 0; j < dense->cols(); ++j) {
      for (Index i = 0; i < dense->rows(); ++i) {
        out[j] += static_cast<long double>((*dense)(i, j)) * y[i];
      }
    }
    return;
  }
  const auto& sparse = std::get<SparseMatrix>(M);
  for (Index j = 0; j < sparse.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(sparse, j); it; ++it) {
      out[j] += static_cast<long double>(it.value()) * y[it.row()];
    }
  }
}

void diagonal(const MatrixForm& M, Vector& d) {
  if (const auto* factored = std::get_if<FactoredMatrix>(&M)) {
    factored->diagonal(d);
  } else if (const auto* dense = std::get_if<Matrix>(&M)) {
    d = dense->diagonal();
  } else {
    d = std::get<SparseMatrix>(M).diagonal();
  }
}

Matrix to_dense(const MatrixForm& M) {
  if (const auto* dense = std::get_if<Matrix>(&M)) {
    return *dense;
  }
  if (const auto* factored = std::get_if<FactoredMatrix>(&M)) {
    return Matrix(factored->form());
  }
  return Matrix(std::get<SparseMatrix>(M));
}

template void multiply(const MatrixForm&, const double*, double*);
template void multiply(const MatrixForm&, const long double*, long double*);

}  // namespace signorini::lcp
