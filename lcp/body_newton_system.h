#pragma once

#include <signorini/lcp/alart_curnier_function.h>
#include <signorini/lcp/dense_kernels.h>
#include <signorini/lcp/refined_lu.h>
#include <signorini/lcp/whitened_rows.h>

#include <utility>
#include <vector>

namespace signorini::lcp {

/// The Newton step of F(x, u) = 0, u = (G G^T + C + alpha I) x + b, in body space: with
/// K = A + B (C + alpha) + E, block diagonal over the groups but for the couplings E of rows at
/// limits that follow a normal row (A = 1, B = 0 there), and D = K^-1 B,
///
///     (I + G^T D G) y = -G^T K^-1 F,     dx = -K^-1 (F + B G y).
///
/// The matrix has a row a degree of freedom of the bodies, however many contacts there are, one
/// pattern for all steps, and is factored by RefinedLu, since D is not symmetric where contacts
/// slide. alpha > 0 keeps K invertible; the numbers of dx lose digits as alpha goes to 0.
class BodyNewtonSystem {
 public:
  /// Keeps rows and function, whose groups must be the same.
  void set(const WhitenedRows& rows, const AlartCurnierFunction& function);

  /// Keeps B and the couplings until the last solve(). @return false if a matrix is singular;
  /// solve() must then not be called.
  [[nodiscard]] bool factor(const std::vector<AlartCurnierFunction::Block>& A,
                            const std::vector<AlartCurnierFunction::Block>& B,
                            const std::vector<AlartCurnierFunction::Coupling>& couplings,
                            double alpha);
  /// @return false if the step is not finite; dx is then of no use.
  [[nodiscard]] bool solve(const Vector& F, Vector& dx);

  /// What the factors hold.
  [[nodiscard]] std::int64_t factor_bytes() const { return lu_.bytes(); }

 private:
  void find_pairs();
  [[nodiscard]] int find_start(int column, int row) const;
  void set_pattern();
  [[nodiscard]] RefinedLu::View matrix() const;
  [[nodiscard]] bool invert_blocks(const std::vector<AlartCurnierFunction::Block>& A,
                                   const std::vector<AlartCurnierFunction::Block>& B, double alpha);
  void assemble(const std::vector<AlartCurnierFunction::Block>& B);
  void add_product(const double* left, const double* right, int d, int width, int rows, int columns,
                   double* block, int ld) const;
  void add_couplings(const std::vector<AlartCurnierFunction::Block>& B);
  void apply_inverse(const Vector& in, Vector& out) const;
  void apply(const std::vector<AlartCurnierFunction::Block>& blocks, const Vector& in,
             Vector& out) const;

  const WhitenedRows* rows_ = nullptr;
  const AlartCurnierFunction* function_ = nullptr;
  const std::vector<AlartCurnierFunction::Block>* B_ = nullptr;
  const std::vector<AlartCurnierFunction::Coupling>* couplings_ = nullptr;
  std::vector<AlartCurnierFunction::Block> inverse_;  // K^-1
  struct Body {
    int dimension;
    int offset;  // in u
  };
  std::vector<Body> bodies_;
  // Two bodies that share a group, that of the columns first; sorted, and where the rows of the
  // second start in the columns of the first.
  std::vector<std::pair<int, int>> pairs_;
  std::vector<int> pair_start_;
  std::vector<int> outer_, inner_;  // the pattern of H
  std::vector<double> values_;
  std::vector<int> row_offset_;  // of a pair of entries of a group: where the first body's rows
                                 // start in the columns of the second
  std::vector<int> diagonal_;    // position of the diagonal in every column
  std::vector<double> product_;  // D G of a group
  Vector h_, y_, gy_;
  DenseKernels kernels_ = dense_kernels().front();
  RefinedLu lu_;
};

}  // namespace signorini::lcp
