#pragma once

#include <signorini/lcp/alart_curnier_function.h>
#include <signorini/lcp/dense_lu.h>
#include <signorini/lcp/refined_lu.h>
#include <signorini/lcp/sparse_lu.h>

#include <vector>

namespace signorini::lcp {

/// The Newton step of F(x, u) = 0, u = (W + alpha I) x + b, for a given W:
///
///     (A + B (W + alpha I)) dx = -F.
///
/// Groups with B = 0, where A must be I, are solved by hand; the rest is factored, dense up to
/// kDenseRows rows, sparse above: by RefinedLu where the pattern of W is symmetric and no row is
/// coupled, else by SparseLu.
class NewtonSystem {
 public:
  static constexpr int kDenseRows = 120;

  /// Keeps W. @param function its groups
  void set(const SparseMatrix& W, const AlartCurnierFunction& function);

  /// Keeps B until the last solve(). @return false if the matrix is singular; solve() must then not
  /// be called.
  [[nodiscard]] bool factor(const std::vector<AlartCurnierFunction::Block>& A,
                            const std::vector<AlartCurnierFunction::Block>& B,
                            const std::vector<AlartCurnierFunction::Coupling>& couplings,
                            double alpha);
  /// @return false if the step is not finite; dx is then of no use.
  [[nodiscard]] bool solve(const Vector& F, Vector& dx);

  /// What the sparse factors hold, or held at most since set().
  [[nodiscard]] std::int64_t factor_bytes() const {
    return is_symmetric_ ? refined_lu_.bytes() : sparse_lu_.bytes();
  }

 private:
  void find_active(const std::vector<AlartCurnierFunction::Block>& B,
                   const std::vector<AlartCurnierFunction::Coupling>& couplings);
  void assemble(const std::vector<AlartCurnierFunction::Block>& A,
                const std::vector<AlartCurnierFunction::Block>& B, double alpha);
  [[nodiscard]] bool factor_active();
  void set_right_side(const Vector& F, const Vector& dx);

  const SparseMatrix* W_ = nullptr;
  const AlartCurnierFunction* function_ = nullptr;
  const std::vector<AlartCurnierFunction::Block>* B_ = nullptr;
  std::vector<char> group_is_active_;
  std::vector<int> active_row_;   // of every row, or -1
  std::vector<int> active_rows_;  // ascending
  std::vector<std::vector<std::pair<int, double>>> couplings_of_column_;
  // one column of B (W + alpha I) + A, by group
  std::vector<Eigen::Vector3d> column_;
  std::vector<int> groups_in_column_;
  std::vector<char> is_in_column_;
  // the active system
  std::vector<int> outer_, inner_;
  std::vector<double> values_;
  std::vector<double> right_;
  Vector w_;
  DenseLu dense_lu_;
  bool is_symmetric_ = false;  // the pattern, whichever rows are active
  RefinedLu refined_lu_;
  SparseLu sparse_lu_;
};

}  // namespace signorini::lcp
