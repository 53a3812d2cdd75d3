#pragma once

#include <signorini/lcp/block_mass.h>
#include <signorini/lcp/types.h>

#include <span>
#include <utility>
#include <vector>

namespace signorini::lcp {

/// A = J W J^T + diag(c), never formed unless asked. J has one row a contact (or a friction
/// direction, a joint axis); a row holds any number of (block, values) entries, one a body it acts
/// on. W is the block-diagonal inverse mass; c >= 0 is a compliance the caller wants, normally 0.
///
/// A is symmetric positive semidefinite, and usually singular: redundant contacts are normal.
class FactoredMatrix {
 public:
  /// One entry of a row: `values()` of the row's matrix at this block, dimension(block) numbers.
  struct Entry {
    int block;
    int values;  ///< where the numbers start, see values(entry)
  };

  BlockMass mass;  ///< W; add the blocks before the rows that use them

  /// Starts the next row. @param compliance c_i >= 0. @return the row's number.
  /// @throws std::invalid_argument if compliance is negative or not finite.
  int add_row(double compliance = 0.0);

  /// Adds an entry to the last row.
  /// @param block a block of `mass`, not yet used in this row
  /// @param values dimension(block) numbers
  /// @throws std::invalid_argument on a wrong block, a repeated block or a wrong length.
  void add_entry(int block, const VectorRef& values);

  /// Forgets rows and blocks, keeps the memory.
  void clear();

  [[nodiscard]] int rows() const { return static_cast<int>(compliance_.size()); }
  [[nodiscard]] int degrees_of_freedom() const { return mass.degrees_of_freedom(); }
  [[nodiscard]] double compliance(int row) const { return compliance_[row]; }
  [[nodiscard]] std::span<const Entry> entries(int row) const {
    return {entries_.data() + row_start_[row],
            static_cast<std::size_t>(row_start_[row + 1] - row_start_[row])};
  }
  [[nodiscard]] const double* values(const Entry& entry) const {
    return values_.data() + entry.values;
  }

  /// p = J^T z (length degrees_of_freedom). Scalar is double or long double, here and below.
  template <typename Scalar>
  void transpose_times(const Scalar* z, Scalar* p) const;
  /// v = W p. p and v must not overlap.
  template <typename Scalar>
  void apply_inverse_mass(const Scalar* p, Scalar* v) const;
  /// w_i = (J v)_i + c_i z_i (length rows).
  template <typename Scalar>
  void times(const Scalar* v, const Scalar* z, Scalar* w) const;

  /// w = A z. Allocates two vectors of degrees_of_freedom numbers.
  template <typename Scalar>
  void multiply(const Scalar* z, Scalar* w) const;

  /// A_ii for every row.
  void diagonal(Vector& d) const;

  /// Memory of visit_lower(); grows to the largest matrix it has seen.
  struct VisitWorkspace {
    std::vector<int> use_start;             // of a block, into uses
    std::vector<std::pair<int, int>> uses;  // (row, where its values start), rows ascending
    std::vector<double> moved;              // W_b J_ib^T
    std::vector<double> product;            // A_ij by j
    std::vector<int> seen;                  // the last i with A_ij in product, by j
    std::vector<int> touched;               // the j that are in product
  };
  /// Calls visit(i, j, A_ij) for the entries of A's lower triangle (j <= i), row by row, j in no
  /// order, the diagonal always; entries that cancel to zero are visited. Nothing is formed. Cost:
  /// half the sum over the blocks of (rows on the block)^2.
  template <typename Visit>
  void visit_lower(VisitWorkspace& workspace, Visit visit) const;

  /// A, formed: symmetric, both triangles stored. Cost: the sum over the blocks of (rows on the
  /// block)^2. Entries that cancel to zero are kept.
  [[nodiscard]] SparseMatrix form() const;

 private:
  void start_visit(VisitWorkspace& workspace) const;
  [[nodiscard]] static double dot(int size, const double* x, const double* y);

  std::vector<int> row_start_{0};
  std::vector<Entry> entries_;
  std::vector<double> values_;
  std::vector<double> compliance_;
};

/// Most blocks are bodies in space.
inline double FactoredMatrix::dot(int size, const double* x, const double* y) {
  if (size == 6) {  // two halves at once
    const double low = x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    return low + (x[3] * y[3] + x[4] * y[4] + x[5] * y[5]);
  }
  double sum = 0.0;
  for (int k = 0; k < size; ++k) {
    sum += x[k] * y[k];
  }
  return sum;
}

template <typename Visit>
void FactoredMatrix::visit_lower(VisitWorkspace& workspace, Visit visit) const {
  start_visit(workspace);
  auto& [use_start, uses, moved, product, seen, touched] = workspace;
  for (int i = 0; i < rows(); ++i) {
    touched.assign(1, i);
    seen[i] = i;
    product[i] = compliance_[i];
    for (const Entry& entry : entries(i)) {
      const int size = mass.dimension(entry.block);
      mass.apply_inverse(entry.block, values(entry), moved.data());
      for (int use = use_start[entry.block]; uses[use].first <= i; ++use) {
        const auto [j, start] = uses[use];
        const double a = dot(size, moved.data(), values_.data() + start);
        if (seen[j] != i) {
          seen[j] = i;
          product[j] = 0.0;
          touched.push_back(j);
        }
        product[j] += a;
        if (j == i) {
          break;
        }
      }
    }
    for (const int j : touched) {
      visit(i, j, product[j]);
    }
  }
}

}  // namespace signorini::lcp
