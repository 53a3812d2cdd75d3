#include <signorini/lcp/column_sweeps.h>

#include <algorithm>
#include <variant>

namespace signorini::lcp {

template <typename T>
void ColumnSweeps<T>::set(const MatrixForm& M, std::span<SweepRow> rows, double relaxation) {
  dense_ = std::get_if<Matrix>(&M);
  sparse_ = std::get_if<SparseMatrix>(&M);
  rows_ = rows;
  relaxation_ = relaxation;
  state_.assign(2 * rows.size(), T(0));
  for (Index i = 0; i < static_cast<Index>(rows.size()); ++i) {
    set_diagonal(rows[i], dense_ != nullptr ? (*dense_)(i, i) : sparse_->coeff(i, i));
  }
}

template <typename T>
void ColumnSweeps<T>::start(const Vector& z) {
  std::transform(z.begin(), z.end(), state_.begin(),
                 [](double z_i) { return static_cast<T>(z_i); });
}

template <typename T>
void ColumnSweeps<T>::read(Vector& z) const {
  std::copy_n(state_.begin(), z.size(), z.begin());
}

template <typename T>
void ColumnSweeps<T>::refresh(Vector& w) {
  std::fill(state_.begin() + static_cast<std::ptrdiff_t>(rows_.size()), state_.end(), T(0));
  for (Index i = 0; i < w.size(); ++i) {
    move(i, state_[i]);
  }
  for (Index i = 0; i < w.size(); ++i) {
    w[i] = rows_[i].q + static_cast<double>(kept()[i]);
  }
}

template <typename T>
void ColumnSweeps<T>::move(Index i, T change) {
  T* kept = this->kept();
  if (dense_ != nullptr) {
    const double* column = dense_->col(i).data();
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      kept[k] += static_cast<T>(column[k]) * change;
    }
    return;
  }
  for (SparseMatrix::InnerIterator it(*sparse_, i); it; ++it) {
    kept[it.row()] += static_cast<T>(it.value()) * change;
  }
}

template <typename T>
void ColumnSweeps<T>::step(Index i) {
  const SweepRow& row = rows_[i];
  T& z = state_[i];
  T lower = static_cast<T>(row.lower);
  T upper = static_cast<T>(row.upper);
  if (row.normal_row >= 0) {
    upper = static_cast<T>(row.coefficient) * std::max(state_[row.normal_row], T(0));
    lower = -upper;
  }
  const T w = static_cast<T>(row.q) + kept()[i];
  const T moved = row.inverse > 0.0
                      ? std::clamp(z - static_cast<T>(relaxation_ * row.inverse) * w, lower, upper)
                      : pushed_to_bound(z, w, lower, upper);
  const T change = moved - z;
  if (change != T(0)) {
    z = moved;
    move(i, change);
  }
}

template <typename T>
void ColumnSweeps<T>::forward() {
  for (Index i = 0; i < static_cast<Index>(rows_.size()); ++i) {
    step(i);
  }
}

template <typename T>
void ColumnSweeps<T>::backward() {
  for (Index i = static_cast<Index>(rows_.size()) - 1; i >= 0; --i) {
    step(i);
  }
}

template <typename T>
double ColumnSweeps<T>::squared_length(std::span<const T> difference) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto d = static_cast<double>(difference[i]);
    sum += rows_[i].scale * d * d;
  }
  return sum;
}

template class ColumnSweeps<double>;
template class ColumnSweeps<float>;

}  // namespace signorini::lcp
