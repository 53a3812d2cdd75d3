#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/types.h>

#include <vector>

namespace signorini::lcp {

/// Writes a problem with bounds and coupled limits as one whose rows are all 0 <= z_i ⊥ w_i >= 0 or
/// free (w_i = 0), so that complementary pivoting can take it. Row by row, with y the new variable
/// of the row and w as in the caller's problem:
///
///     lower finite                y = z - lower                 (y >= 0)
///     only upper finite           y = upper - z,  w turned round
///     both finite                 y = z - lower; new row v >= 0 ⊥ s = upper - lower - y >= 0,
///                                 w becomes w + v               (v >= 0 carries w < 0)
///     |z| <= mu z_n (coupled)     y = z + mu z_n; new row v >= 0 ⊥ s = 2 mu z_n - y >= 0,
///                                 w becomes w + v
///
/// The new rows of a box keep a positive semidefinite M so (they add a skew part); those of a
/// coupled limit make M nonsymmetric, as a friction pyramid does.
class LcpAugmentation {
 public:
  /// True if every row is 0 <= z_i ⊥ w_i >= 0 or free: there is nothing to write anew.
  [[nodiscard]] static bool is_plain(const Problem& problem);

  /// Builds augmented(). M is formed. @param problem without cones
  void build(const Problem& problem);

  [[nodiscard]] const Problem& augmented() const { return augmented_; }
  /// The caller's z of a solution of augmented().
  void recover(const Vector& y, Vector& z) const;
  /// A start for augmented() from one for the caller's problem; multipliers from its w.
  void carry(const Problem& problem, const Vector& z, Vector& y) const;

 private:
  void assemble(const Problem& problem, const std::vector<char>& is_free);

  Index n_ = 0;
  Problem augmented_;
  SparseMatrix map_;  // z = offset + map y
  Vector sign_;       // of w
  Vector offset_;
  Vector range_;  // upper - lower of a box, else infinite
  struct Added {
    int row;         // of the caller's problem
    int normal_row;  // -1: a box
    double slope;    // 2 mu
  };
  std::vector<Added> added_;
};

}  // namespace signorini::lcp
