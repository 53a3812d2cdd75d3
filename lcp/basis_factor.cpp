#include <signorini/lcp/basis_factor.h>
#include <signorini/lcp/column_room.h>

#include <algorithm>
#include <numeric>

namespace signorini::lcp {

void BasisFactor::reset(const ScaledLcp& lcp, const std::vector<char>& active,
                        const Vector& cover) {
  lcp_ = &lcp;
  cover_ = &cover;
  n_ = lcp.size();
  at_.resize(n_);
  for (int i = 0; i < n_; ++i) {
    at_[i] = active[i] != 0 ? n_ + i : i;
  }
  cover_position_ = -1;
  alpha_.clear();
  rows_.clear();
  place_.assign(n_, -1);
  cover_row_ = -1;
  eta_position_.clear();
}

bool BasisFactor::factor() {
  alpha_.clear();
  rows_.clear();
  std::vector<int>& is_w = place_;
  std::fill(is_w.begin(), is_w.end(), -1);
  const bool has_cover = cover_position_ >= 0;
  for (const Variable variable : at_) {
    if (variable < n_) {
      is_w[variable] = 1;
    } else if (variable < cover_variable()) {
      alpha_.push_back(variable - n_);
    }
  }
  std::sort(alpha_.begin(), alpha_.end());
  for (int i = 0; i < n_; ++i) {
    if (is_w[i] < 0) {
      rows_.push_back(i);
    }
  }
  // Everybody to the own position; the cover to the index that has neither w nor z.
  cover_row_ = -1;
  std::fill(place_.begin(), place_.end(), -1);
  std::iota(at_.begin(), at_.end(), 0);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    place_[rows_[k]] = static_cast<int>(k);
    at_[rows_[k]] = cover_variable();
  }
  for (const int j : alpha_) {
    at_[j] = n_ + j;
  }
  if (has_cover) {
    cover_row_ = *std::find_if(rows_.begin(), rows_.end(),
                               [this](int i) { return at_[i] == cover_variable(); });
  }
  cover_position_ = cover_row_;
  eta_position_.clear();

  const Index m = static_cast<Index>(rows_.size());
  if (m == 0) {
    return true;
  }
  if (storage_.rows() < m) {
    const Index capacity = std::min<Index>(n_, std::max<Index>(m, 2 * storage_.rows()));
    storage_.resize(capacity, capacity);
  }
  auto compact = storage_.topLeftCorner(m, m);
  compact.setZero();
  for (std::size_t k = 0; k < alpha_.size(); ++k) {
    lcp_->gather_column(alpha_[k], place_, compact.col(static_cast<Index>(k)).data());
  }
  if (has_cover) {
    for (Index k = 0; k < m; ++k) {
      compact(k, m - 1) = (*cover_)[rows_[k]];
    }
  }
  lu_.emplace(compact);
  const auto pivots = lu_->matrixLU().diagonal().array();
  return pivots.isFinite().all() && (pivots != 0.0).all();
}

void BasisFactor::solve_factored(Vector& x) {
  const Index m = static_cast<Index>(rows_.size());
  if (m == 0) {
    return;
  }
  compact_.resize(m);
  for (Index k = 0; k < m; ++k) {
    compact_[k] = -x[rows_[k]];
    x[rows_[k]] = 0.0;
  }
  compact_ = lu_->solve(compact_);
  for (std::size_t k = 0; k < alpha_.size(); ++k) {
    if (compact_[k] != 0.0) {
      lcp_->add_column(alpha_[k], compact_[k], x.data());
    }
  }
  if (cover_row_ >= 0) {
    x += compact_[m - 1] * *cover_;
    x[cover_row_] = compact_[m - 1];
  }
  for (std::size_t k = 0; k < alpha_.size(); ++k) {
    x[alpha_[k]] = compact_[k];
  }
}

void BasisFactor::solve_factored_transposed(Vector& x) {
  // B^T u = x: u_beta = x_beta; for column j in alpha: -M_j . u = x_j, and -d . u = x_cover.
  const Index m = static_cast<Index>(rows_.size());
  if (m == 0) {
    return;
  }
  compact_.resize(m);
  for (std::size_t k = 0; k < alpha_.size(); ++k) {
    compact_[k] = -x[alpha_[k]];
  }
  if (cover_row_ >= 0) {
    compact_[m - 1] = -x[cover_row_];
  }
  for (const int row : rows_) {
    x[row] = 0.0;
  }
  for (std::size_t k = 0; k < alpha_.size(); ++k) {
    compact_[k] -= lcp_->dot_column(alpha_[k], x);
  }
  if (cover_row_ >= 0) {
    compact_[m - 1] -= cover_->dot(x);
  }
  compact_ = lu_->transpose().solve(compact_);
  for (Index k = 0; k < m; ++k) {
    x[rows_[k]] = compact_[k];
  }
}

void BasisFactor::solve(Vector& x) {
  solve_factored(x);
  for (std::size_t k = 0; k < eta_position_.size(); ++k) {
    const int p = eta_position_[k];
    if (x[p] == 0.0) {
      continue;
    }
    const auto eta = etas_.col(static_cast<Index>(k));
    const double step = x[p] / eta[p];
    x.noalias() -= step * eta.head(n_);
    x[p] = step;
  }
}

void BasisFactor::solve_transposed(Vector& x) {
  for (std::size_t k = eta_position_.size(); k-- > 0;) {
    const int p = eta_position_[k];
    const auto eta = etas_.col(static_cast<Index>(k)).head(n_);
    const double own = x[p];
    x[p] = 0.0;
    x[p] = (own - eta.dot(x)) / eta[p];
  }
  solve_factored_transposed(x);
}

void BasisFactor::residual(Variable column_variable, const Vector& x, Vector& residual) {
  wide_.assign(n_, 0.0L);
  if (column_variable < 0) {
    for (int i = 0; i < n_; ++i) {
      wide_[i] = lcp_->q()[i];
    }
  } else if (column_variable < n_) {
    wide_[column_variable] = 1.0L;
  } else if (column_variable < cover_variable()) {
    lcp_->add_column(column_variable - n_, -1.0L, wide_.data());
  } else {
    for (int i = 0; i < n_; ++i) {
      wide_[i] = -(*cover_)[i];
    }
  }
  for (int p = 0; p < n_; ++p) {
    if (x[p] == 0.0) {
      continue;
    }
    const long double value = x[p];
    if (at_[p] < n_) {
      wide_[at_[p]] -= value;
    } else if (at_[p] < cover_variable()) {
      lcp_->add_column(at_[p] - n_, value, wide_.data());
    } else {
      for (int i = 0; i < n_; ++i) {
        wide_[i] += value * (*cover_)[i];
      }
    }
  }
  for (int i = 0; i < n_; ++i) {
    residual[i] = static_cast<double>(wide_[i]);
  }
}

void BasisFactor::multiply(const Vector& x, Vector& a) const {
  a.setZero(n_);
  for (int p = 0; p < n_; ++p) {
    if (at_[p] < n_) {
      a[at_[p]] += x[p];
    } else if (at_[p] < cover_variable()) {
      lcp_->add_column(at_[p] - n_, -x[p], a.data());
    } else {
      a -= x[p] * *cover_;
    }
  }
}

void BasisFactor::column(Variable variable, Vector& a) const {
  if (variable == cover_variable()) {
    a = -*cover_;
    return;
  }
  a.setZero(n_);
  if (variable < n_) {
    a[variable] = 1.0;
  } else {
    lcp_->add_column(variable - n_, -1.0, a.data());
  }
}

void BasisFactor::exchange(int position, Variable entering, const Vector& y) {
  const Index k = static_cast<Index>(eta_position_.size());
  make_room(etas_, n_, k + 1);
  etas_.col(k).head(n_) = y;
  eta_position_.push_back(position);
  if (position == cover_position_) {
    cover_position_ = -1;
  }
  at_[position] = entering;
  if (entering == cover_variable()) {
    cover_position_ = position;
  }
}

}  // namespace signorini::lcp
