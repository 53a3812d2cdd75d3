#include <signorini/lcp/principal_factor.h>

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <limits>
#include <numeric>

namespace signorini::lcp {

void PrincipalFactor::reset(const SymmetricLcp& problem) {
  problem_ = &problem;
  n_ = problem.size();
  factorizations_ = 0;
  updates_ = 0;
  regular_ = true;
  member_.assign(n_, 0);
  active_.assign(n_, 0);
  diagonal_.assign(n_, 1.0);
  x_.assign(n_, 0.0);
  if (problem.starts() != seen_start_ || problem.rows() != seen_row_) {
    analyse();
  }
  std::fill(value_.begin(), value_.end(), 0.0);
}

void PrincipalFactor::analyse() {
  seen_start_ = problem_->starts();
  seen_row_ = problem_->rows();
  const std::vector<double> ones(seen_row_.size(), 1.0);
  const Eigen::Map<const SparseMatrix> pattern(n_, n_, static_cast<Index>(seen_row_.size()),
                                               seen_start_.data(), seen_row_.data(), ones.data());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  const SparseMatrix copy = pattern.transpose();  // symmetric; and its rows are sorted
  Eigen::AMDOrdering<int>()(copy.selfadjointView<Eigen::Lower>(), order);
  row_of_.assign(order.indices().data(), order.indices().data() + n_);
  place_of_.resize(n_);
  for (int k = 0; k < n_; ++k) {
    place_of_[row_of_[k]] = k;
  }
  eliminate();
}

/// The elimination tree and the pattern of L, row by row.
void PrincipalFactor::eliminate() {
  parent_.assign(n_, -1);
  row_start_.assign(1, 0);
  row_column_.clear();
  std::vector<int> reached(n_, -1);
  std::vector<int> count(n_, 0);
  for (int k = 0; k < n_; ++k) {
    reached[k] = k;
    const int j = row_of_[k];
    for (int e = problem_->begin(j); e < problem_->end(j); ++e) {
      for (int i = place_of_[problem_->row(e)]; i < k && reached[i] != k; i = parent_[i]) {
        if (parent_[i] < 0) {
          parent_[i] = k;
        }
        reached[i] = k;
        row_column_.push_back(i);
        ++count[i];
      }
    }
    std::sort(row_column_.begin() + row_start_.back(), row_column_.end());
    row_start_.push_back(static_cast<int>(row_column_.size()));
  }
  column_start_.assign(n_ + 1, 0);
  std::partial_sum(count.begin(), count.end(), column_start_.begin() + 1);
  std::vector<int> next(column_start_.begin(), column_start_.end() - 1);
  column_row_.resize(row_column_.size());
  row_entry_.resize(row_column_.size());
  value_.resize(row_column_.size());
  for (int k = 0; k < n_; ++k) {
    for (int r = row_start_[k]; r < row_start_[k + 1]; ++r) {
      const int place = next[row_column_[r]]++;
      column_row_[place] = k;
      row_entry_[r] = place;
    }
  }
}

bool PrincipalFactor::refactor() {
  factor(-std::numeric_limits<double>::infinity());
  return regular_;
}

int PrincipalFactor::load(const std::vector<char>& wanted, double least_pivot) {
  member_.assign(wanted.begin(), wanted.end());
  factor(least_pivot);
  return static_cast<int>(std::count(member_.begin(), member_.end(), 1));
}

/// L D L^T of C, row by row; rows with a pivot of at most least_pivot leave C.
void PrincipalFactor::factor(double least_pivot) {
  ++factorizations_;
  updates_ = 0;
  regular_ = true;
  for (int k = 0; k < n_; ++k) {
    const int row = row_of_[k];
    active_[k] = member_[row];
    double pivot = 0.0;
    if (active_[k] != 0) {
      for (int e = problem_->begin(row); e < problem_->end(row); ++e) {
        const int i = place_of_[problem_->row(e)];
        if (i <= k && active_[i] != 0) {
          x_[i] = problem_->value(e);
        }
      }
      pivot = x_[k];
      x_[k] = 0.0;
    }
    for (int r = row_start_[k]; r < row_start_[k + 1]; ++r) {
      const int j = row_column_[r];
      const double y = x_[j];
      x_[j] = 0.0;
      const int own = row_entry_[r];
      value_[own] = 0.0;
      if (y != 0.0) {
        for (int e = column_start_[j]; e < own; ++e) {
          x_[column_row_[e]] -= value_[e] * y;
        }
        value_[own] = y / diagonal_[j];
        pivot -= value_[own] * y;
      }
    }
    if (active_[k] != 0 && !(pivot > least_pivot)) {
      member_[row] = active_[k] = 0;
      for (int r = row_start_[k]; r < row_start_[k + 1]; ++r) {
        value_[row_entry_[r]] = 0.0;
      }
    }
    regular_ = regular_ && (active_[k] == 0 || pivot > 0.0);
    diagonal_[k] = active_[k] != 0 ? pivot : 1.0;
  }
}

bool PrincipalFactor::exchange(int j) {
  const bool entering = member_[j] == 0;
  member_[j] = entering ? 1 : 0;
  if (++updates_ > kUpdates) {
    return refactor();
  }
  if (entering) {
    add(place_of_[j]);
  } else {
    remove(place_of_[j]);
  }
  return regular_ || refactor();
}

void PrincipalFactor::add(int k) {
  active_[k] = 1;
  const int row = row_of_[k];
  for (int e = problem_->begin(row); e < problem_->end(row); ++e) {
    const int i = place_of_[problem_->row(e)];
    if (active_[i] != 0) {
      x_[i] = problem_->value(e);
    }
  }
  double pivot = x_[k];
  x_[k] = 0.0;
  for (int r = row_start_[k]; r < row_start_[k + 1]; ++r) {
    const int j = row_column_[r];
    const double y = x_[j];
    x_[j] = 0.0;
    if (y == 0.0) {
      continue;
    }
    for (int e = column_start_[j]; e < column_start_[j + 1]; ++e) {
      x_[column_row_[e]] -= value_[e] * y;
    }
    const double l = y / diagonal_[j];
    value_[row_entry_[r]] = l;
    pivot -= l * y;
  }
  diagonal_[k] = pivot;
  regular_ = regular_ && pivot > 0.0;
  for (int e = column_start_[k]; e < column_start_[k + 1]; ++e) {
    double& x = x_[column_row_[e]];
    x /= pivot;
    value_[e] = x;
  }
  update(k, -pivot);
}

void PrincipalFactor::remove(int k) {
  active_[k] = 0;
  for (int r = row_start_[k]; r < row_start_[k + 1]; ++r) {
    value_[row_entry_[r]] = 0.0;
  }
  for (int e = column_start_[k]; e < column_start_[k + 1]; ++e) {
    x_[column_row_[e]] = value_[e];
    value_[e] = 0.0;
  }
  const double pivot = diagonal_[k];
  diagonal_[k] = 1.0;
  update(k, pivot);
}

/// L D L^T + alpha x x^T over the ancestors of k; x is zero afterwards.
void PrincipalFactor::update(int k, double alpha) {
  for (int j = parent_[k]; j >= 0; j = parent_[j]) {
    const double p = x_[j];
    x_[j] = 0.0;
    if (p == 0.0) {
      continue;
    }
    const double old = diagonal_[j];
    const double renewed = old + alpha * p * p;
    const double beta = alpha * p / renewed;
    alpha *= old / renewed;
    diagonal_[j] = renewed;
    regular_ = regular_ && renewed > 0.0;
    for (int e = column_start_[j]; e < column_start_[j + 1]; ++e) {
      double& x = x_[column_row_[e]];
      x -= p * value_[e];
      value_[e] += beta * x;
    }
  }
}

/// x = (L D L^T)^-1 x; entries outside C must be 0 and stay so.
void PrincipalFactor::solve_permuted() {
  for (int j = 0; j < n_; ++j) {
    const double x = x_[j];
    if (x == 0.0) {
      continue;
    }
    for (int e = column_start_[j]; e < column_start_[j + 1]; ++e) {
      x_[column_row_[e]] -= value_[e] * x;
    }
  }
  for (int j = n_ - 1; j >= 0; --j) {
    if (active_[j] == 0) {
      continue;
    }
    double sum = x_[j] / diagonal_[j];
    for (int e = column_start_[j]; e < column_start_[j + 1]; ++e) {
      sum -= value_[e] * x_[column_row_[e]];
    }
    x_[j] = sum;
  }
}

void PrincipalFactor::solve(double* x) {
  for (int k = 0; k < n_; ++k) {
    x_[k] = active_[k] != 0 ? x[row_of_[k]] : 0.0;
  }
  solve_permuted();
  for (int k = 0; k < n_; ++k) {
    if (active_[k] != 0) {
      x[row_of_[k]] = x_[k];
    }
    x_[k] = 0.0;
  }
}

void PrincipalFactor::column(int j, double* rate) {
  std::fill(rate, rate + n_, 0.0);
  const bool basic = member_[j] != 0;
  if (basic) {
    x_[place_of_[j]] = -1.0;
  } else {
    for (int e = problem_->begin(j); e < problem_->end(j); ++e) {
      const int i = place_of_[problem_->row(e)];
      x_[i] = active_[i] != 0 ? problem_->value(e) : 0.0;
      rate[problem_->row(e)] = problem_->value(e);
    }
  }
  solve_permuted();
  for (int k = 0; k < n_; ++k) {
    if (x_[k] != 0.0) {
      problem_->add_column(row_of_[k], -x_[k], rate);
    }
  }
  for (int k = 0; k < n_; ++k) {
    if (active_[k] != 0) {
      rate[row_of_[k]] = -x_[k];
    }
    x_[k] = 0.0;
  }
}

}  // namespace signorini::lcp
