#include <signorini/lcp/body_newton_system.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <span>
#include <utility>

namespace signorini::lcp {

using Block = AlartCurnierFunction::Block;
using Entries = std::span<const WhitenedRows::Entry>;

void BodyNewtonSystem::set(const WhitenedRows& rows, const AlartCurnierFunction& function) {
  rows_ = &rows;
  function_ = &function;
  set_pattern();
  if (H_.rows() > 0) {
    lu_.isSymmetric(true);
    lu_.setPivotThreshold(0.1);
    lu_.analyzePattern(H_);
  }
}

/// One dense block for every two bodies that share a group, and the diagonal.
void BodyNewtonSystem::set_pattern() {
  struct Body {
    int dimension = 0;
    int column_length = 0;
    std::map<int, int> row_offset;  // of the bodies it meets, by their offsets in u
  };
  std::map<int, Body> bodies;  // by offset in u
  rows_->visit_groups([&bodies](Entries entries, const double*, int) {
    for (const auto& e : entries) {
      if (e.dimension == 0) {  // no row moves this body; its offset is the next one's
        continue;
      }
      Body& body = bodies[e.offset];
      body.dimension = e.dimension;
      for (const auto& f : entries) {
        if (f.dimension > 0) {
          body.row_offset[f.offset] = f.dimension;
        }
      }
    }
  });
  const int n = static_cast<int>(rows_->degrees_of_freedom());
  std::vector<int> outer(1, 0);
  std::vector<int> inner;
  diagonal_.resize(n);
  for (auto& [offset, body] : bodies) {
    for (auto& [other, start] : body.row_offset) {  // dimension becomes where it starts
      const int dimension = start;
      start = body.column_length;
      body.column_length += dimension;
    }
    for (int k = 0; k < body.dimension; ++k) {
      for (const auto& [other, start] : body.row_offset) {
        for (int i = 0; i < bodies[other].dimension; ++i) {
          if (other + i == offset + k) {
            diagonal_[offset + k] = static_cast<int>(inner.size());
          }
          inner.push_back(other + i);
        }
      }
      outer.push_back(static_cast<int>(inner.size()));
    }
  }
  row_offset_.clear();
  rows_->visit_groups([&](Entries entries, const double*, int) {
    for (const auto& f : entries) {
      for (const auto& e : entries) {
        const bool meets = e.dimension > 0 && f.dimension > 0;
        row_offset_.push_back(meets ? bodies[f.offset].row_offset[e.offset] : 0);
      }
    }
  });
  H_.resize(n, n);
  H_.resizeNonZeros(static_cast<Index>(inner.size()));
  std::copy(outer.begin(), outer.end(), H_.outerIndexPtr());
  std::copy(inner.begin(), inner.end(), H_.innerIndexPtr());
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

/// H = I + G^T D G.
void BodyNewtonSystem::assemble(const std::vector<Block>& B) {
  double* values = H_.valuePtr();
  std::fill(values, values + H_.nonZeros(), 0.0);
  for (const int position : diagonal_) {
    values[position] = 1.0;
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
        for (const auto& e : entries) {
          const int start = row_offset_[at++];
          for (int c = 0; c < f.dimension; ++c) {
            double* column = values + H_.outerIndexPtr()[f.offset + c] + start;
            for (int i = 0; i < d; ++i) {
              const double right = product_[i * width + f.column + c];
              const double* left = G + i * width + e.column;
              for (int r = 0; r < e.dimension; ++r) {
                column[r] += left[r] * right;
              }
            }
          }
        }
      }
    }
    pair += pairs;
    ++g;
  });
}

bool BodyNewtonSystem::factor(const std::vector<Block>& A, const std::vector<Block>& B,
                              double alpha) {
  if (!invert_blocks(A, B, alpha)) {
    return false;
  }
  B_ = &B;
  if (rows_->degrees_of_freedom() == 0) {
    return true;
  }
  assemble(B);
  lu_.factorize(H_);
  return lu_.info() == Eigen::Success;
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

bool BodyNewtonSystem::solve(const Vector& F, Vector& dx) {
  if (rows_->degrees_of_freedom() > 0) {
    apply(inverse_, F, h_);
    rows_->transpose_times(h_, y_);
    y_ = lu_.solve(-y_).eval();
    rows_->times(y_, gy_);
    apply(*B_, gy_, h_);
    h_ += F;
  } else {
    h_ = F;
  }
  apply(inverse_, h_, dx);
  dx = -dx;
  return dx.allFinite();
}

}  // namespace signorini::lcp
