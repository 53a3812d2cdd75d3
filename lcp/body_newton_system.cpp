#include <signorini/lcp/body_newton_system.h>

#include <Eigen/LU>
#include <algorithm>
#include <span>
#include <utility>

namespace signorini::lcp {

using Block = AlartCurnierFunction::Block;
using Entries = std::span<const WhitenedRows::Entry>;

void BodyNewtonSystem::set(const WhitenedRows& rows, const AlartCurnierFunction& function) {
  rows_ = &rows;
  function_ = &function;
  find_pairs();
  set_pattern();
  lu_.analyse(matrix());
}

/// Bodies that no row moves have no dimension, and are in no pair.
void BodyNewtonSystem::find_pairs() {
  bodies_.clear();
  pairs_.clear();
  rows_->visit_groups([this](Entries entries, const double*, int) {
    for (const auto& f : entries) {
      bodies_.resize(std::max<std::size_t>(bodies_.size(), f.body + 1), Body{});
      bodies_[f.body] = {f.dimension, f.offset};
      for (const auto& e : entries) {
        if (e.dimension > 0 && f.dimension > 0) {
          pairs_.emplace_back(f.body, e.body);
        }
      }
    }
  });
  for (const CoupledLimit& limit : function_->limits()) {
    for (const auto& f : rows_->entries_of(function_->group_of(limit.normal_row))) {
      for (const auto& e : rows_->entries_of(function_->group_of(limit.row))) {
        if (e.dimension > 0 && f.dimension > 0) {
          pairs_.emplace_back(f.body, e.body);
          pairs_.emplace_back(e.body, f.body);  // the order is that of a symmetric pattern
        }
      }
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
}

int BodyNewtonSystem::find_start(int column, int row) const {
  const auto found = std::lower_bound(pairs_.begin(), pairs_.end(), std::pair(column, row));
  return pair_start_[found - pairs_.begin()];
}

/// One dense block for every pair.
void BodyNewtonSystem::set_pattern() {
  outer_.assign(1, 0);
  inner_.clear();
  pair_start_.clear();
  diagonal_.resize(rows_->degrees_of_freedom());
  for (std::size_t first = 0, last = 0; first < pairs_.size(); first = last) {
    const Body& column = bodies_[pairs_[first].first];
    int length = 0;
    for (; last < pairs_.size() && pairs_[last].first == pairs_[first].first; ++last) {
      pair_start_.push_back(length);
      length += bodies_[pairs_[last].second].dimension;
    }
    for (int c = column.offset; c < column.offset + column.dimension; ++c) {
      for (std::size_t k = first; k < last; ++k) {
        const Body& row = bodies_[pairs_[k].second];
        for (int r = row.offset; r < row.offset + row.dimension; ++r) {
          if (r == c) {
            diagonal_[c] = static_cast<int>(inner_.size());
          }
          inner_.push_back(r);
        }
      }
      outer_.push_back(static_cast<int>(inner_.size()));
    }
  }
  values_.assign(inner_.size(), 0.0);
  row_offset_.clear();
  rows_->visit_groups([this](Entries entries, const double*, int) {
    for (const auto& f : entries) {
      for (const auto& e : entries) {
        const bool meets = e.dimension > 0 && f.dimension > 0;
        row_offset_.push_back(meets ? find_start(f.body, e.body) : 0);
      }
    }
  });
}

RefinedLu::View BodyNewtonSystem::matrix() const {
  const Index n = rows_->degrees_of_freedom();
  return {n, n, static_cast<Index>(inner_.size()), outer_.data(), inner_.data(), values_.data()};
}

bool BodyNewtonSystem::invert_blocks(const std::vector<Block>& A, const std::vector<Block>& B,
                                     double alpha) {
  const auto& groups = function_->groups();
  inverse_.resize(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    Block K = Block::Identity();
    for (int j = 0; j < groups[g].dimension; ++j) {
      const double softness = rows_->compliance()[groups[g].first + j] + alpha;
      for (int i = 0; i < groups[g].dimension; ++i) {
        K(i, j) = A[g](i, j) + B[g](i, j) * softness;
      }
    }
    inverse_[g] = K.inverse();
    if (!inverse_[g].allFinite()) {
      return false;
    }
  }
  return true;
}

/// block += left^T right over the d rows of a group, which are `width` numbers apart.
void BodyNewtonSystem::add_product(const double* left, const double* right, int d, int width,
                                   int rows, int columns, double* block, int ld) const {
  if (d == 3) {
    kernels_.add_product_of_three(block, ld, left, right, width, rows, columns);
    return;
  }
  for (int c = 0; c < columns; ++c, block += ld) {
    for (int i = 0; i < d; ++i) {
      for (int r = 0; r < rows; ++r) {
        block[r] += left[i * width + r] * right[i * width + c];
      }
    }
  }
}

/// H = I + G^T D G. The columns of a body have one length.
void BodyNewtonSystem::assemble(const std::vector<Block>& B) {
  std::fill(values_.begin(), values_.end(), 0.0);
  for (const int position : diagonal_) {
    values_[position] = 1.0;
  }
  std::size_t g = 0;
  std::size_t pair = 0;
  rows_->visit_groups([&](Entries entries, const double* G, int width) {
    const int d = function_->groups()[g].dimension;
    const Block D = inverse_[g] * B[g];
    const std::size_t pairs = entries.size() * entries.size();
    if (!D.isZero(0.0)) {
      product_.assign(static_cast<std::size_t>(d) * width, 0.0);
      for (int i = 0; i < d; ++i) {
        for (int j = 0; j < d; ++j) {
          for (int k = 0; k < width; ++k) {
            product_[i * width + k] += D(i, j) * G[j * width + k];
          }
        }
      }
      std::size_t at = pair;
      for (const auto& f : entries) {
        const int column = f.dimension > 0 ? outer_[f.offset] : 0;
        const int length = f.dimension > 0 ? outer_[f.offset + 1] - column : 0;
        for (const auto& e : entries) {
          double* block = values_.data() + column + row_offset_[at++];
          add_product(G + e.column, product_.data() + f.column, d, width, e.dimension, f.dimension,
                      block, length);
        }
      }
    }
    pair += pairs;
    ++g;
  });
}

/// H += G^T D G of the couplings: column n of D, d_n = K_n^-1 B_n, goes on to the rows t that
/// follow it as D_tn = -E_tn d_n.
void BodyNewtonSystem::add_couplings(const std::vector<Block>& B) {
  for (const auto& [row, column, value] : *couplings_) {
    const int normal = function_->group_of(column);
    const int tangent = function_->group_of(row);
    const double D = -value * inverse_[normal](0, 0) * B[normal](0, 0);
    if (D == 0.0) {
      continue;
    }
    for (const auto& f : rows_->entries_of(normal)) {
      for (const auto& e : rows_->entries_of(tangent)) {
        if (e.dimension == 0 || f.dimension == 0) {
          continue;
        }
        const int start = find_start(f.body, e.body);
        const double* left = rows_->values_of(tangent) + e.column;
        const double* right = rows_->values_of(normal) + f.column;
        for (int c = 0; c < f.dimension; ++c) {
          double* sum = values_.data() + outer_[f.offset + c] + start;
          for (int r = 0; r < e.dimension; ++r) {
            sum[r] += left[r] * D * right[c];
          }
        }
      }
    }
  }
}

bool BodyNewtonSystem::factor(const std::vector<Block>& A, const std::vector<Block>& B,
                              const std::vector<AlartCurnierFunction::Coupling>& couplings,
                              double alpha) {
  if (!invert_blocks(A, B, alpha)) {
    return false;
  }
  B_ = &B;
  couplings_ = &couplings;
  if (rows_->degrees_of_freedom() == 0) {
    return true;
  }
  assemble(B);
  add_couplings(B);
  return lu_.factor(matrix());
}

/// out = blocks in.
void BodyNewtonSystem::apply(const std::vector<Block>& blocks, const Vector& in,
                             Vector& out) const {
  const auto& groups = function_->groups();
  out.resize(in.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const int d = groups[g].dimension;
    const int first = groups[g].first;
    for (int i = 0; i < d; ++i) {
      double sum = 0.0;
      for (int j = 0; j < d; ++j) {
        sum += blocks[g](i, j) * in[first + j];
      }
      out[first + i] = sum;
    }
  }
}

/// out = K^-1 in.
void BodyNewtonSystem::apply_inverse(const Vector& in, Vector& out) const {
  apply(inverse_, in, out);
  for (const auto& [row, column, value] : *couplings_) {
    out[row] -= value * out[column];
  }
}

bool BodyNewtonSystem::solve(const Vector& F, Vector& dx) {
  if (rows_->degrees_of_freedom() > 0) {
    apply_inverse(F, h_);
    rows_->transpose_times(h_, y_);
    y_ = -y_;
    if (!lu_.solve({y_.data(), static_cast<std::size_t>(y_.size())})) {
      return false;
    }
    rows_->times(y_, gy_);
    apply(*B_, gy_, h_);
    h_ += F;
  } else {
    h_ = F;
  }
  apply_inverse(h_, dx);
  dx = -dx;
  return dx.allFinite();
}

}  // namespace signorini::lcp
