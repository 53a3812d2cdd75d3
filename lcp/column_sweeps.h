#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/sweeps.h>

#include <span>
#include <vector>

namespace signorini::lcp {

/// Sweeps over a given M, dense or sparse: M z is kept, and a step adds a column of M to it, so
/// that a row whose z_i does not change costs O(1). With float, z and M z are rounded, M is not.
template <typename T>
class ColumnSweeps final : public Sweeps<T> {
 public:
  /// Keeps pointers to M, which must not be factored, and to rows, until the next call.
  /// @param rows q, bounds and coupling of every row; receives scale and inverse
  /// @param relaxation omega in (0, 2)
  void set(const MatrixForm& M, std::span<SweepRow> rows, double relaxation);

  void start(const Vector& z) override;
  void forward() override;
  void backward() override;
  void read(Vector& z) const override;
  void refresh(Vector& w) override;
  [[nodiscard]] std::span<T> state() override { return state_; }
  [[nodiscard]] double squared_length(std::span<const T> difference) const override;

 private:
  void step(Index i);
  void move(Index i, T change);
  [[nodiscard]] T* kept() { return state_.data() + rows_.size(); }

  const Matrix* dense_ = nullptr;
  const SparseMatrix* sparse_ = nullptr;
  std::span<const SweepRow> rows_;
  double relaxation_ = 1.0;
  std::vector<T> state_;  // z, then M z
};

extern template class ColumnSweeps<double>;
extern template class ColumnSweeps<float>;

}  // namespace signorini::lcp
