#include <signorini/lcp/principal_tableau.h>

#include <algorithm>
#include <cmath>

namespace signorini::lcp {
namespace {

// The wider registers change no bit: they come without fused multiply-add.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SIGNORINI_WIDE __attribute__((target_clones("default", "avx2")))
#else
#define SIGNORINI_WIDE
#endif

constexpr int kLanes = 4;

/// The lower triangle of table -= t t^T inverse, n x n, by whole lanes: column k from the last
/// multiple of kLanes up to k on, to `height`, a multiple of kLanes >= n. What stands above the
/// diagonal and below row n changes with it, and is read by nobody.
SIGNORINI_WIDE void subtract_product(int n, int height, double inverse, const double* __restrict t,
                                     double* __restrict table) {
  for (int k = 0; k < n; ++k, table += height) {
    const double factor = inverse * t[k];
    if (factor != 0.0) {
      for (int i = k / kLanes * kLanes; i < height; i += kLanes) {
        for (int lane = i; lane < i + kLanes; ++lane) {
          table[lane] -= factor * t[lane];
        }
      }
    }
  }
}

}  // namespace

void PrincipalTableau::reset(const SymmetricLcp& problem) {
  problem_ = &problem;
  n_ = problem.size();
  factorizations_ = 0;
  member_.assign(n_, 0);
  height_ = (n_ + kLanes - 1) / kLanes * kLanes;
  column_.assign(height_, 0.0);
  right_.resize(n_);
  table_.resize(static_cast<std::size_t>(n_) * height_);
  copy();
}

void PrincipalTableau::copy() {
  for (int j = 0; j < n_; ++j) {
    if (problem_->is_dense()) {
      std::copy(problem_->dense_column(j) + j, problem_->dense_column(j) + n_, at(j) + j);
    } else {
      std::fill(at(j) + j, at(j) + n_, 0.0);
      for (int k = problem_->begin(j); k < problem_->end(j); ++k) {
        if (problem_->row(k) >= j) {
          at(j)[problem_->row(k)] = problem_->value(k);
        }
      }
    }
  }
}

void PrincipalTableau::column(int j, double* rate) {
  for (int i = 0; i < j; ++i) {
    rate[i] = at(i)[j];
  }
  std::copy(at(j) + j, at(j) + n_, rate + j);
  for (int i = 0; i < n_; ++i) {
    rate[i] = member_[i] != 0 ? -rate[i] : rate[i];
  }
}

/// T - t t^T / p with t = T_j, p = t_j, but row and column j become t / |p| and the pivot -1 / p.
bool PrincipalTableau::exchange(int j) {
  double* t = column_.data();
  for (int i = 0; i < j; ++i) {
    t[i] = at(i)[j];
  }
  std::copy(at(j) + j, at(j) + n_, t + j);
  const double inverse = 1.0 / t[j];
  t[j] = 0.0;
  subtract_product(n_, height_, inverse, t, table_.data());
  const double own = std::abs(inverse);
  for (int i = 0; i < j; ++i) {
    at(i)[j] = own * t[i];
  }
  for (int i = j; i < n_; ++i) {
    at(j)[i] = own * t[i];
  }
  at(j)[j] = -inverse;
  member_[j] = member_[j] != 0 ? 0 : 1;
  return std::isfinite(inverse);
}

void PrincipalTableau::solve(double* x) {
  members_.clear();
  for (int i = 0; i < n_; ++i) {
    if (member_[i] != 0) {
      members_.push_back(i);
      right_[i] = 0.0;
    }
  }
  for (std::size_t a = 0; a < members_.size(); ++a) {
    const int j = members_[a];
    const double* column = at(j);
    right_[j] -= column[j] * x[j];
    for (std::size_t b = a + 1; b < members_.size(); ++b) {
      const int i = members_[b];
      right_[i] -= column[i] * x[j];
      right_[j] -= column[i] * x[i];
    }
  }
  for (const int i : members_) {
    x[i] = right_[i];
  }
}

/// Sweeps members_ in, largest pivot first. @return how many stayed out
int PrincipalTableau::sweep_members(double least_pivot) {
  ++factorizations_;
  std::fill(member_.begin(), member_.end(), 0);
  copy();
  while (!members_.empty()) {
    const auto best = std::max_element(members_.begin(), members_.end(),
                                       [this](int a, int b) { return at(a)[a] < at(b)[b]; });
    const int j = *best;
    if (!(at(j)[j] > least_pivot) || !exchange(j)) {
      break;
    }
    *best = members_.back();
    members_.pop_back();
  }
  return static_cast<int>(members_.size());
}

bool PrincipalTableau::refactor() {
  members_.clear();
  for (int i = 0; i < n_; ++i) {
    if (member_[i] != 0) {
      members_.push_back(i);
    }
  }
  return sweep_members(0.0) == 0;
}

int PrincipalTableau::load(const std::vector<char>& wanted, double least_pivot) {
  members_.clear();
  for (int i = 0; i < n_; ++i) {
    if (wanted[i] != 0) {
      members_.push_back(i);
    }
  }
  const int count = static_cast<int>(members_.size());
  return count - sweep_members(least_pivot);
}

}  // namespace signorini::lcp
