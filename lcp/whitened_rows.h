#pragma once

#include <signorini/lcp/factored_matrix.h>
#include <signorini/lcp/types.h>

#include <array>
#include <span>
#include <vector>

namespace signorini::lcp {

/// A factored matrix in the coordinates in which mass and row length are one:
///
///     A = J W J^T + c = S (G G^T + C) S,   W = F F^T,   S_i = sqrt(A_ii),
///     G = S^-1 J F Q,   C = S^-2 c,        so that (G G^T + C)_ii = 1,
///
/// and the body-space matrix H(D) = I + G^T D G, block sparse, one block a pair of bodies that
/// share a row; its pattern does not depend on D. Redundant rows of G do not disturb H. Rows of A
/// that are zero have S_i = 1 and G_i = 0.
///
/// Q has orthonormal columns: for each body a basis of the space its rows can move it in. A body
/// that only touches through its centre (a sphere), or only with parallel normals (a box on a box),
/// has 3 columns and not 6; a body without rows has none. Q Q^T acts as the identity on every row
/// to 1e-11 of the length of the row, which changes G G^T by 1e-22: far below its rounding.
///
/// Rows can be put in groups (the rows of one contact). A group has one S, that of its longest row,
/// so that a friction cone stays a cone; D may then have a dense block for each group.
class WhitenedRows {
 public:
  /// A body in a group of rows.
  struct Entry {
    int body;
    int dimension;
    int offset;  ///< of the body in u
    int column;  ///< of its first number in a row of the group
  };

  /// Takes over rows and mass, every row a group of its own. Cost: O(entries of J) and, for the
  /// pattern, the pairs of blocks. Reuses memory.
  void set(const FactoredMatrix& A);
  /// The same with groups. @param group_start the first row of every group, then the number of
  /// rows: increasing, from 0 to A.rows()
  void set(const FactoredMatrix& A, std::span<const int> group_start);

  [[nodiscard]] Index rows() const { return scale_.size(); }
  /// Columns of G.
  [[nodiscard]] Index degrees_of_freedom() const { return degrees_of_freedom_; }
  [[nodiscard]] const Vector& scale() const { return scale_; }            ///< S
  [[nodiscard]] const Vector& compliance() const { return compliance_; }  ///< C

  /// u = G^T x.
  void transpose_times(const Vector& x, Vector& u) const;
  /// y = G u.
  void times(const Vector& u, Vector& y) const;
  /// Calls visit(entries, values, width) for every group: its bodies (a span of Entry) and its rows
  /// of G, one after the other, `width` numbers each.
  template <typename Visit>
  void visit_groups(Visit visit) const {
    for (int g = 0; g < groups(); ++g) {
      visit(entries_of(g), values_.data() + groups_[g].values, groups_[g].width);
    }
  }
  /// The bodies of group g.
  [[nodiscard]] std::span<const Entry> entries_of(int g) const {
    return std::span(entries_).subspan(groups_[g].entry, groups_[g + 1].entry - groups_[g].entry);
  }
  /// The first row of group g.
  [[nodiscard]] const double* values_of(int g) const { return values_.data() + groups_[g].values; }
  /// The lower triangle of I + G^T D G for a diagonal D; the pattern is the same at every call.
  /// @param d the diagonal of D, >= 0
  const SparseMatrix& body_space_matrix(const Vector& d);
  /// The same for a D with one symmetric block a group.
  /// @param blocks the blocks of D one after the other, each b x b, column-major, for a group of b
  /// rows
  const SparseMatrix& body_space_matrix(std::span<const double> blocks);

 private:
  struct Group {
    int row;     // the first
    int entry;   // the first
    int values;  // where the numbers of the first row start; rows follow each other
    int width;   // numbers a row
  };
  /// Groups that follow each other with the same bodies.
  struct Bundle {
    int group;   // the first
    int groups;  // how many
    int row;     // the first
    int rows;    // how many
    int values;  // where the numbers of the first row start; all rows follow each other
    int width;   // numbers a row
    int parts;   // where a row is one or two parts of `size` numbers, and the compiler unrolls that
    int size;    // else 0
    std::array<int, 2> offset;  // of the parts in u
  };
  void take_over(const FactoredMatrix& A, std::span<const int> group_start);
  void whiten(const FactoredMatrix& A);
  void find_roots(const BlockMass& mass);
  void scale_rows(const FactoredMatrix& A);
  void compress(const BlockMass& mass);
  void extend_basis(int body, int dimension, const double* row);
  void set_pattern(int bodies);
  void find_bundles();
  template <typename AddBundle>
  const SparseMatrix& assemble(AddBundle add_bundle);
  void add_products(const Bundle& bundle, const double* left, const double* right, const double* d,
                    double* out, const int* pair) const;

  [[nodiscard]] int groups() const { return static_cast<int>(groups_.size()) - 1; }
  [[nodiscard]] int group_rows(int g) const { return groups_[g + 1].row - groups_[g].row; }

  Index degrees_of_freedom_ = 0;
  std::vector<Group> groups_;  // and one behind the last
  std::vector<Entry> entries_;
  std::vector<double> values_;
  std::vector<Bundle> bundles_;
  std::vector<double> ones_;  // as many as a bundle has rows
  Vector scale_;
  Vector compliance_;
  std::vector<int> each_row_;  // group_start of groups of one row

  // bodies
  std::vector<double> roots_;       // F of every body, d x d, column-major
  std::vector<int> root_start_;     // of a body
  std::vector<double> basis_;       // columns of Q of every body, where F stands in roots_
  std::vector<int> rank_;           // columns of Q
  std::vector<int> body_offset_;    // in u
  std::vector<int> entry_of_body_;  // in the group at hand, or -1
  std::vector<double> work_;

  // For every pair of entries (e1, e2) of every group, body of e1 >= body of e2, in the order of
  // the loops of assemble(): the number of the pair of bodies.
  std::vector<int> pair_of_entries_;
  std::vector<int> pair_column_, pair_row_;  // bodies of a pair of entries, while sorting
  std::vector<int> column_bucket_, sorted_;
  std::vector<int> pair_of_row_;  // of the body column at hand
  std::vector<int> rows_of_column_;
  // For every pair of bodies and every column of its second body: where row 0 of the first body
  // would stand among the values of the column.
  std::vector<int> column_starts_;
  std::vector<int> first_column_start_;  // of a pair
  SparseMatrix lower_;
  std::vector<int> outer_, inner_;
  std::vector<int> diagonal_position_;
};

}  // namespace signorini::lcp
