#pragma once

#include <signorini/lcp/types.h>

#include <algorithm>
#include <type_traits>
#include <vector>

namespace signorini::lcp {

/// The inverse mass W = blockdiag(W_0, W_1, ...) of a factored matrix A = J W J^T: one symmetric
/// positive definite block a body, of any size (6 for a free rigid body; the number of degrees of
/// freedom of an articulated one). A block is given either as W_k itself or as the mass M_k, which
/// is then kept as its Cholesky factor and applied by two triangular solves.
///
/// Immovable and driven bodies have no block: their velocity belongs in q.
class BlockMass {
 public:
  /// Adds a block by its inverse mass W_k (d x d). Positive definiteness is the caller's promise.
  /// @return the block's number. @throws std::invalid_argument unless W_k is square, finite,
  /// symmetric to 1e-12 of its largest entry (the lower triangle is used) and its diagonal is >= 0.
  int add_inverse(const MatrixRef& inverse_mass);

  /// Adds a block by its mass M_k (d x d). @return the block's number.
  /// @throws std::invalid_argument unless M_k is square, finite, symmetric to 1e-12 and positive
  /// definite.
  int add_mass(const MatrixRef& mass);

  /// Adds a block by the Cholesky factor L of its mass, M_k = L L^T: what add_mass() keeps, so that
  /// a block can be copied to the bit. @return the block's number. @throws std::invalid_argument
  /// unless L is square, finite, lower triangular and its diagonal is > 0.
  int add_factor(const MatrixRef& factor);

  void clear();
  void reserve(int blocks, int dimension_each);

  [[nodiscard]] int block_count() const { return static_cast<int>(blocks_.size()); }
  [[nodiscard]] int dimension(int block) const { return blocks_[block].dimension; }
  /// The first degree of freedom of the block in the stacked velocity vector.
  [[nodiscard]] int offset(int block) const { return blocks_[block].offset; }
  /// True where stored(block) is the factor L of M_k = L L^T, false where it is W_k.
  [[nodiscard]] bool is_factor(int block) const { return blocks_[block].is_factor; }
  /// The d x d numbers that the block is kept as.
  [[nodiscard]] Eigen::Map<const Matrix> stored(int block) const {
    const Block& b = blocks_[block];
    return {values_.data() + b.values, b.dimension, b.dimension};
  }
  /// The length of the stacked velocity vector.
  [[nodiscard]] int degrees_of_freedom() const { return degrees_of_freedom_; }

  /// y = W_k x for one block; x and y hold dimension(block) numbers and must not overlap.
  /// Scalar is double, long double or any type with their arithmetic against double (Interval; a
  /// rational, with which this is W_k exactly: the matrix given, or L^-T L^-1 of the factor kept).
  template <typename Scalar>
  void apply_inverse(int block, const Scalar* x, Scalar* y) const;

  /// F with W_k = F F^T: the Cholesky factor of a W_k that was given (lower), L^-T of a mass that
  /// was given (upper).
  /// @param F dimension(block)^2 numbers, column-major, written whole
  /// @return false, and F unfinished, where a W_k that was given is not positive definite.
  [[nodiscard]] bool inverse_root(int block, double* F) const;

 private:
  struct Block {
    int offset;
    int dimension;
    int values;      // where the block's d x d numbers start, column-major
    bool is_factor;  // the numbers are L of M_k = L L^T, not W_k
  };
  int add(const MatrixRef& values, bool is_factor);

  std::vector<Block> blocks_;
  std::vector<double> values_;
  int degrees_of_freedom_ = 0;
};

template <typename Scalar>
void BlockMass::apply_inverse(int block, const Scalar* x, Scalar* y) const {
  const auto [offset, d, start, is_factor] = blocks_[block];
  const double* v = values_.data() + start;
  if (!is_factor) {
    constexpr int kRigidBody = 6;
    const auto multiply = [v, x, y](int size) {  // unrolled where the size is known
      if constexpr (std::is_same_v<Scalar, double>) {
        std::fill_n(y, size, 0.0);
        for (int j = 0; j < size; ++j) {
          for (int i = 0; i < size; ++i) {
            y[i] += v[j * size + i] * x[j];
          }
        }
      } else {  // others are dear to store
        for (int i = 0; i < size; ++i) {
          Scalar sum = 0;
          for (int j = 0; j < size; ++j) {
            sum += v[j * size + i] * x[j];
          }
          y[i] = sum;
        }
      }
    };
    d == kRigidBody ? multiply(kRigidBody) : multiply(d);
    return;
  }
  for (int i = 0; i < d; ++i) {  // L y = x
    Scalar sum = x[i];
    for (int j = 0; j < i; ++j) {
      sum -= v[j * d + i] * y[j];
    }
    y[i] = sum / v[i * d + i];
  }
  for (int i = d - 1; i >= 0; --i) {  // L^T y = y
    Scalar sum = y[i];
    for (int j = i + 1; j < d; ++j) {
      sum -= v[i * d + j] * y[j];
    }
    y[i] = sum / v[i * d + i];
  }
}

}  // namespace signorini::lcp
