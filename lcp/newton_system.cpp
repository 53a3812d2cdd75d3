#include <signorini/lcp/newton_system.h>
#include <signorini/lcp/sparse_form.h>

#include <algorithm>

namespace signorini::lcp {

using Block = AlartCurnierFunction::Block;
using Coupling = AlartCurnierFunction::Coupling;

void NewtonSystem::set(const SparseMatrix& W, const AlartCurnierFunction& function) {
  W_ = &W;
  function_ = &function;
  sparse_lu_.reset_bytes();
  is_symmetric_ = function.limits().empty() && has_symmetric_pattern(W);
  const std::size_t n = static_cast<std::size_t>(W.rows());
  active_row_.resize(n);
  couplings_of_column_.resize(n);
  column_.assign(function.groups().size(), Eigen::Vector3d::Zero());
  is_in_column_.assign(function.groups().size(), 0);
}

void NewtonSystem::find_active(const std::vector<Block>& B,
                               const std::vector<Coupling>& couplings) {
  const auto& groups = function_->groups();
  group_is_active_.assign(groups.size(), 0);
  for (auto& list : couplings_of_column_) {
    list.clear();
  }
  for (const Coupling& coupling : couplings) {
    group_is_active_[function_->group_of(coupling.row)] = 1;
    couplings_of_column_[coupling.column].emplace_back(coupling.row, coupling.value);
  }
  active_rows_.clear();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!B[g].isZero(0.0)) {
      group_is_active_[g] = 1;
    }
    for (int k = 0; k < groups[g].dimension; ++k) {
      const int row = groups[g].first + k;
      active_row_[row] = group_is_active_[g] != 0 ? static_cast<int>(active_rows_.size()) : -1;
      if (group_is_active_[g] != 0) {
        active_rows_.push_back(row);
      }
    }
  }
}

/// The active columns as a sparse matrix.
void NewtonSystem::assemble(const std::vector<Block>& A, const std::vector<Block>& B,
                            double alpha) {
  const auto& groups = function_->groups();
  const auto touch = [this](int g) {
    if (is_in_column_[g] == 0) {
      is_in_column_[g] = 1;
      groups_in_column_.push_back(g);
      column_[g].setZero();
    }
  };
  outer_.assign(1, 0);
  inner_.clear();
  values_.clear();
  for (const int j : active_rows_) {
    groups_in_column_.clear();
    for (SparseMatrix::InnerIterator it(*W_, j); it; ++it) {
      const int i = static_cast<int>(it.row());
      const int g = function_->group_of(i);
      if (active_row_[i] >= 0) {
        touch(g);
        column_[g] += it.value() * B[g].col(i - groups[g].first);
      }
    }
    const int own = function_->group_of(j);
    touch(own);
    const int k = j - groups[own].first;
    column_[own] += A[own].col(k) + alpha * B[own].col(k);
    for (const auto& [row, value] : couplings_of_column_[j]) {
      const int g = function_->group_of(row);
      touch(g);
      column_[g][row - groups[g].first] += value;
    }
    std::sort(groups_in_column_.begin(), groups_in_column_.end());
    for (const int g : groups_in_column_) {
      is_in_column_[g] = 0;
      for (int i = 0; i < groups[g].dimension; ++i) {
        if (is_symmetric_ || column_[g][i] != 0.0) {
          inner_.push_back(active_row_[groups[g].first + i]);
          values_.push_back(column_[g][i]);
        }
      }
    }
    outer_.push_back(static_cast<int>(inner_.size()));
  }
}

bool NewtonSystem::factor_active() {
  const int n = static_cast<int>(active_rows_.size());
  if (n <= kDenseRows) {
    double* dense = dense_lu_.reset(n);
    for (int j = 0; j < n; ++j) {
      for (int k = outer_[j]; k < outer_[j + 1]; ++k) {
        dense[static_cast<std::size_t>(j) * n + inner_[k]] = values_[k];
      }
    }
    return dense_lu_.factor();
  }
  const SparseLu::View matrix(n, n, static_cast<Index>(values_.size()), outer_.data(),
                              inner_.data(), values_.data());
  if (is_symmetric_) {
    refined_lu_.analyse(matrix);
    return refined_lu_.factor(matrix);
  }
  sparse_lu_.analyse(matrix);
  return sparse_lu_.factor(matrix);
}

bool NewtonSystem::factor(const std::vector<Block>& A, const std::vector<Block>& B,
                          const std::vector<Coupling>& couplings, double alpha) {
  B_ = &B;
  find_active(B, couplings);
  if (active_rows_.empty()) {
    return true;
  }
  assemble(A, B, alpha);
  return factor_active();
}

/// right_ = -F - B W dx - couplings, of the active rows, for a dx of the others.
void NewtonSystem::set_right_side(const Vector& F, const Vector& dx) {
  const auto& groups = function_->groups();
  w_.noalias() = *W_ * dx;
  right_.resize(active_rows_.size());
  for (const int row : active_rows_) {
    const int g = function_->group_of(row);
    const int k = row - groups[g].first;
    double sum = 0.0;
    for (int j = 0; j < groups[g].dimension; ++j) {
      sum += (*B_)[g](k, j) * w_[groups[g].first + j];
    }
    right_[active_row_[row]] = -F[row] - sum;
  }
  for (Index j = 0; j < dx.size(); ++j) {
    for (const auto& [row, value] : couplings_of_column_[j]) {
      right_[active_row_[row]] -= value * dx[j];
    }
  }
}

bool NewtonSystem::solve(const Vector& F, Vector& dx) {
  dx = -F;
  if (active_rows_.empty()) {
    return dx.allFinite();
  }
  for (const int row : active_rows_) {
    dx[row] = 0.0;
  }
  set_right_side(F, dx);
  const int n = static_cast<int>(active_rows_.size());
  if (n <= kDenseRows) {
    dense_lu_.solve(right_.data());
  } else if (!is_symmetric_) {
    sparse_lu_.solve(right_);
  } else if (!refined_lu_.solve(right_)) {
    return false;
  }
  for (int k = 0; k < n; ++k) {
    dx[active_rows_[k]] = right_[k];
  }
  return dx.allFinite();
}

}  // namespace signorini::lcp
