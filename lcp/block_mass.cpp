#include <signorini/lcp/block_mass.h>
#include <signorini/lcp/number_text.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace signorini::lcp {
namespace {

constexpr double kAsymmetry = 1e-12;  // rounding of a rotated inertia, of the largest entry

void check_block(const MatrixRef& block, const char* what) {
  if (block.rows() != block.cols() || block.rows() == 0) {
    throw std::invalid_argument(std::string(what) + ": must be square and not empty, got " +
                                std::to_string(block.rows()) + " x " +
                                std::to_string(block.cols()));
  }
  if (!block.allFinite()) {
    throw std::invalid_argument(std::string(what) + ": must be finite");
  }
  const double asymmetry = (block - block.transpose()).cwiseAbs().maxCoeff();
  if (const double largest = block.cwiseAbs().maxCoeff(); asymmetry > kAsymmetry * largest) {
    throw std::invalid_argument(std::string(what) + ": must be symmetric to 1e-12 of its largest " +
                                "entry " + number_text(largest) + ", got an asymmetry of " +
                                number_text(asymmetry));
  }
}

}  // namespace

int BlockMass::add_inverse(const MatrixRef& inverse_mass) {
  check_block(inverse_mass, "BlockMass: inverse mass");
  if ((inverse_mass.diagonal().array() < 0.0).any()) {
    throw std::invalid_argument("BlockMass: inverse mass: its diagonal must be >= 0, got " +
                                number_text(inverse_mass.diagonal().minCoeff()));
  }
  const int block = add(inverse_mass, false);
  Eigen::Map<Matrix> kept(values_.data() + blocks_.back().values, inverse_mass.rows(),
                          inverse_mass.cols());
  kept.triangularView<Eigen::StrictlyUpper>() = inverse_mass.transpose();
  return block;
}

int BlockMass::add_mass(const MatrixRef& mass) {
  check_block(mass, "BlockMass: mass");
  const Eigen::LLT<Matrix> factor(mass);
  if (factor.info() != Eigen::Success) {
    throw std::invalid_argument("BlockMass: mass: must be positive definite");
  }
  return add(Matrix(factor.matrixL()), true);
}

int BlockMass::add_factor(const MatrixRef& factor) {
  if (factor.rows() != factor.cols() || factor.rows() == 0 || !factor.allFinite() ||
      !factor.isLowerTriangular(0.0) || !(factor.diagonal().array() > 0.0).all()) {
    throw std::invalid_argument(
        "BlockMass: factor: must be square, finite, lower triangular and > 0 on its diagonal");
  }
  return add(factor, true);
}

int BlockMass::add(const MatrixRef& values, bool is_factor) {
  const int dimension = static_cast<int>(values.rows());
  blocks_.push_back({degrees_of_freedom_, dimension, static_cast<int>(values_.size()), is_factor});
  for (Index column = 0; column < values.cols(); ++column) {
    const double* numbers = values.data() + column * values.outerStride();
    values_.insert(values_.end(), numbers, numbers + dimension);
  }
  degrees_of_freedom_ += dimension;
  return block_count() - 1;
}

bool BlockMass::inverse_root(int block, double* F) const {
  const auto [offset, d, start, is_factor] = blocks_[block];
  const double* v = values_.data() + start;
  std::fill_n(F, d * d, 0.0);
  for (int j = 0; j < d; ++j) {
    if (is_factor) {  // column j of L^-T: L^T f = e_j
      for (int i = j; i >= 0; --i) {
        double sum = i == j ? 1.0 : 0.0;
        for (int k = i + 1; k <= j; ++k) {
          sum -= v[i * d + k] * F[j * d + k];
        }
        F[j * d + i] = sum / v[i * d + i];
      }
      continue;
    }
    double pivot = v[j * d + j];
    for (int k = 0; k < j; ++k) {
      pivot -= F[k * d + j] * F[k * d + j];
    }
    if (!(pivot > 0.0)) {
      return false;
    }
    F[j * d + j] = std::sqrt(pivot);
    for (int i = j + 1; i < d; ++i) {
      double sum = v[j * d + i];
      for (int k = 0; k < j; ++k) {
        sum -= F[k * d + i] * F[k * d + j];
      }
      F[j * d + i] = sum / F[j * d + j];
    }
  }
  return true;
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

}  // namespace signorini::lcp
