#include <signorini/lcp/enclosed_product.h>
#include <signorini/lcp/exact_sum.h>

namespace signorini::lcp {
namespace {

Interval enclose_row(const Matrix& M, Index i, const VectorRef& x) {
  ExactSum sum;
  for (Index j = 0; j < M.cols(); ++j) {
    sum.add_product(M(i, j), x[j]);
  }
  return sum.enclosure();
}

Interval enclose_column(const Matrix& M, Index j, const VectorRef& x) {
  ExactSum sum;
  for (Index i = 0; i < M.rows(); ++i) {
    sum.add_product(M(i, j), x[i]);
  }
  return sum.enclosure();
}

/// The product of x with what M stores together: columns, or rows where M is row-major.
template <typename Sparse>
void enclose_outer(const Sparse& M, const VectorRef& x, std::vector<Interval>& product) {
  product.clear();
  for (Index j = 0; j < M.outerSize(); ++j) {
    ExactSum sum;
    for (typename Sparse::InnerIterator it(M, j); it; ++it) {
      sum.add_product(it.value(), x[it.index()]);
    }
    product.push_back(sum.enclosure());
  }
}

/// p = J^T x, every sum exact, then enclosed.
std::vector<Interval> enclose_impulse(const FactoredMatrix& A, const VectorRef& x) {
  std::vector<ExactSum> sums(A.degrees_of_freedom());
  for (int i = 0; i < A.rows(); ++i) {
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      for (int k = 0; k < A.mass.dimension(entry.block); ++k) {
        sums[A.mass.offset(entry.block) + k].add_product(A.values(entry)[k], x[i]);
      }
    }
  }
  std::vector<Interval> p(sums.size());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    p[k] = sums[k].enclosure();
  }
  return p;
}

void enclose(const FactoredMatrix& A, const VectorRef& x, std::vector<Interval>& product) {
  const std::vector<Interval> p = enclose_impulse(A, x);
  std::vector<Interval> v(p.size());
  for (int b = 0; b < A.mass.block_count(); ++b) {
    A.mass.apply_inverse(b, p.data() + A.mass.offset(b), v.data() + A.mass.offset(b));
  }
  product.clear();
  for (int i = 0; i < A.rows(); ++i) {
    Interval sum = A.compliance(i) * Interval(x[i]);
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      for (int k = 0; k < A.mass.dimension(entry.block); ++k) {
        sum += A.values(entry)[k] * v[A.mass.offset(entry.block) + k];
      }
    }
    product.push_back(sum);
  }
}

}  // namespace

void enclose_product(const MatrixForm& M, const VectorRef& x, std::vector<Interval>& product) {
  if (const auto* dense = std::get_if<Matrix>(&M)) {
    product.clear();
    for (Index i = 0; i < dense->rows(); ++i) {
      product.push_back(enclose_row(*dense, i, x));
    }
  } else if (const auto* sparse = std::get_if<SparseMatrix>(&M)) {
    enclose_outer(Eigen::SparseMatrix<double, Eigen::RowMajor>(*sparse), x, product);
  } else {
    enclose(std::get<FactoredMatrix>(M), x, product);
  }
}

void enclose_transposed_product(const MatrixForm& M, const VectorRef& x,
                                std::vector<Interval>& product) {
  if (const auto* dense = std::get_if<Matrix>(&M)) {
    product.clear();
    for (Index j = 0; j < dense->cols(); ++j) {
      product.push_back(enclose_column(*dense, j, x));
    }
  } else if (const auto* sparse = std::get_if<SparseMatrix>(&M)) {
    enclose_outer(*sparse, x, product);
  } else {
    enclose(std::get<FactoredMatrix>(M), x, product);
  }
}

}  // namespace signorini::lcp
