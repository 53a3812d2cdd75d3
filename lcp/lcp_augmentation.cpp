#include <signorini/lcp/lcp_augmentation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SparseMatrix formed(const MatrixForm& M) {
  if (const auto* factored = std::get_if<FactoredMatrix>(&M)) {
    return factored->form();
  }
  if (const auto* dense = std::get_if<Matrix>(&M)) {
    return dense->sparseView(0.0, 0.0);
  }
  return std::get<SparseMatrix>(M);
}

}  // namespace

bool LcpAugmentation::is_plain(const Problem& problem) {
  if (!problem.limits.empty() || !problem.cones.empty()) {
    return false;
  }
  for (Index i = 0; i < problem.size(); ++i) {
    const double lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    const double upper = problem.upper.size() > 0 ? problem.upper[i] : kInfinity;
    if (upper != kInfinity || (lower != 0.0 && lower != -kInfinity)) {
      return false;
    }
  }
  return true;
}

void LcpAugmentation::build(const Problem& problem) {
  n_ = problem.size();
  sign_.setOnes(n_);
  offset_.setZero(n_);
  range_.setConstant(n_, kInfinity);
  added_.clear();
  std::vector<Eigen::Triplet<double>> map;
  std::vector<char> is_coupled(n_, 0);
  for (const CoupledLimit& limit : problem.limits) {
    is_coupled[limit.row] = 1;
  }
  std::vector<char> is_free(n_, 0);
  for (int i = 0; i < n_; ++i) {
    const double lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    const double upper = problem.upper.size() > 0 ? problem.upper[i] : kInfinity;
    if (is_coupled[i] != 0) {
      continue;
    }
    if (lower > -kInfinity) {
      offset_[i] = lower;
      range_[i] = upper - lower;
      if (upper < kInfinity) {
        added_.push_back({i, -1, 0.0});
      }
    } else if (upper < kInfinity) {
      offset_[i] = upper;
      sign_[i] = -1.0;
    } else {
      is_free[i] = 1;
    }
  }
  for (const CoupledLimit& limit : problem.limits) {
    const double mu = limit.coefficient;
    added_.push_back({limit.row, limit.normal_row, 2.0 * mu});
    offset_[limit.row] = -mu * offset_[limit.normal_row];
    map.emplace_back(limit.row, limit.normal_row, -mu * sign_[limit.normal_row]);
  }
  for (int i = 0; i < n_; ++i) {
    map.emplace_back(i, i, sign_[i]);
  }
  map_.resize(n_, n_);
  map_.setFromTriplets(map.begin(), map.end());
  assemble(problem, is_free);
}

void LcpAugmentation::assemble(const Problem& problem, const std::vector<char>& is_free) {
  const Index size = n_ + static_cast<Index>(added_.size());
  augmented_.q.setZero(size);
  multiply(problem.M, offset_.data(), augmented_.q.data());
  augmented_.q.head(n_) = sign_.cwiseProduct(augmented_.q.head(n_) + problem.q);
  augmented_.lower.setZero(size);
  std::vector<Eigen::Triplet<double>> entries;
  const SparseMatrix mapped = formed(problem.M) * map_;
  for (int j = 0; j < n_; ++j) {
    for (SparseMatrix::InnerIterator it(mapped, j); it; ++it) {
      entries.emplace_back(static_cast<int>(it.row()), j, sign_[it.row()] * it.value());
    }
    augmented_.lower[j] = is_free[j] != 0 ? -kInfinity : 0.0;
  }
  for (std::size_t k = 0; k < added_.size(); ++k) {
    const auto [row, normal, slope] = added_[k];
    const int me = static_cast<int>(n_ + static_cast<Index>(k));
    entries.emplace_back(row, me, 1.0);
    entries.emplace_back(me, row, -1.0);
    if (normal < 0) {
      augmented_.q[me] = range_[row];
    } else {
      entries.emplace_back(me, normal, slope * sign_[normal]);
      augmented_.q[me] = slope * offset_[normal];
    }
  }
  SparseMatrix M(size, size);
  M.setFromTriplets(entries.begin(), entries.end());
  augmented_.M = std::move(M);
}

void LcpAugmentation::recover(const Vector& y, Vector& z) const {
  // y >= 0 holds exactly, the upper bounds of a box to rounding.
  z = offset_ + map_ * y.head(n_).cwiseMin(range_);
}

void LcpAugmentation::carry(const Problem& problem, const Vector& z, Vector& y) const {
  Vector w(n_);
  multiply(problem.M, z.data(), w.data());
  w += problem.q;
  y.setZero(augmented_.size());
  y.head(n_) = sign_.cwiseProduct(z - offset_);
  for (std::size_t k = 0; k < added_.size(); ++k) {
    const auto [row, normal, slope] = added_[k];
    if (normal >= 0) {  // z_t = y_t - mu z_n
      y[row] = z[row] + 0.5 * slope * z[normal];
    }
    y[n_ + static_cast<Index>(k)] = std::max(0.0, -w[row]);
  }
}

}  // namespace signorini::lcp
