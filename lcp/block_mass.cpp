#include <signorini/lcp/block_mass.h>

#include <Eigen/Cholesky>
#include <stdexcept>
#include <string>

namespace signorini::lcp {
namespace {

void check_block(const MatrixRef& block, const char* what) {
  if (block.rows() != block.cols() || block.rows() == 0) {
    throw std::invalid_argument(std::string(what) + ": must be square and not empty, got " +
                                std::to_string(block.rows()) + " x " +
                                std::to_string(block.cols()));
  }
  if (!block.allFinite()) {
    throw std::invalid_argument(std::string(what) + ": must be finite");
  }
}

}  // namespace

int BlockMass::add_inverse(const MatrixRef& inverse_mass) {
  check_block(inverse_mass, "BlockMass: inverse mass");
  return add(inverse_mass, false);
}

int BlockMass::add_mass(const MatrixRef& mass) {
  check_block(mass, "BlockMass: mass");
  const double scale = mass.cwiseAbs().maxCoeff();
  if ((mass - mass.transpose()).cwiseAbs().maxCoeff() > 1e-12 * scale) {
    throw std::invalid_argument("BlockMass: mass: must be symmetric to 1e-12 of its largest entry");
  }
  const Eigen::LLT<Matrix> factor(mass);
  if (factor.info() != Eigen::Success) {
    throw std::invalid_argument("BlockMass: mass: must be positive definite");
  }
  return add(factor.matrixL(), true);
}

int BlockMass::add(const Matrix& values, bool is_factor) {
  const int dimension = static_cast<int>(values.rows());
  blocks_.push_back({degrees_of_freedom_, dimension, static_cast<int>(values_.size()), is_factor});
  values_.insert(values_.end(), values.data(), values.data() + values.size());
  degrees_of_freedom_ += dimension;
  return block_count() - 1;
}

void BlockMass::clear() {
  blocks_.clear();
  values_.clear();
  degrees_of_freedom_ = 0;
}

void BlockMass::reserve(int blocks, int dimension_each) {
  blocks_.reserve(blocks);
  values_.reserve(static_cast<std::size_t>(blocks) * dimension_each * dimension_each);
}

template <typename Scalar>
void BlockMass::apply_inverse(int block, const Scalar* x, Scalar* y) const {
  const auto [offset, d, start, is_factor] = blocks_[block];
  const double* v = values_.data() + start;
  if (!is_factor) {
    for (int i = 0; i < d; ++i) {
      y[i] = 0;
    }
    for (int j = 0; j < d; ++j) {
      for (int i = 0; i < d; ++i) {
        y[i] += v[j * d + i] * x[j];
      }
    }
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

template void BlockMass::apply_inverse(int, const double*, double*) const;
template void BlockMass::apply_inverse(int, const long double*, long double*) const;

}  // namespace signorini::lcp
