#include <signorini/lcp/absolute_product.h>
#include <signorini/lcp/weighted_product.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace signorini::lcp {
namespace {

constexpr int kLanes = WeightedProduct::kSize;
constexpr int kBlock = kLanes * kLanes;

const WeightedProduct& weighted_product() {
  static const WeightedProduct& fastest = weighted_products().front();
  return fastest;
}

bool on_same_blocks(const FactoredMatrix& A, int i, int j) {
  return std::ranges::equal(A.entries(i), A.entries(j), {}, &FactoredMatrix::Entry::block,
                            &FactoredMatrix::Entry::block);
}

}  // namespace

bool AbsoluteProduct::find_bundles(const FactoredMatrix& A) {
  bundles_.clear();
  for (int i = 0; i < A.rows(); ++i) {
    if (i > 0 && bundles_.back().rows < kLanes && on_same_blocks(A, i - 1, i)) {
      ++bundles_.back().rows;
    } else {
      bundles_.push_back({i, 1, 0, static_cast<int>(A.entries(i).size())});
    }
  }
  return 2 * bundles_.size() <= static_cast<std::size_t>(A.rows());
}

void AbsoluteProduct::find_parts(const FactoredMatrix& A) {
  parts_.clear();
  numbers_.clear();
  use_start_.assign(A.mass.block_count() + 1, 0);
  for (int g = 0; g < static_cast<int>(bundles_.size()); ++g) {
    Bundle& bundle = bundles_[g];
    bundle.part = static_cast<int>(parts_.size());
    for (int p = 0; p < bundle.parts; ++p) {
      const int block = A.entries(bundle.row)[p].block;
      const int d = A.mass.dimension(block);
      parts_.push_back({block, g, numbers_.size()});
      numbers_.resize(numbers_.size() + static_cast<std::size_t>(d) * kLanes, 0.0);
      double* numbers = numbers_.data() + parts_.back().numbers;
      for (int r = 0; r < bundle.rows; ++r) {
        const double* row = A.values(A.entries(bundle.row + r)[p]);
        for (int k = 0; k < d; ++k) {
          numbers[k * kLanes + r] = row[k];
        }
      }
      ++use_start_[block + 1];
      if (static_cast<int>(ones_.size()) < d) {
        ones_.resize(d, 1.0);
        row_.resize(2 * static_cast<std::size_t>(d));
        moved_.resize(static_cast<std::size_t>(d) * kLanes);
      }
    }
  }
  for (int b = 0; b < A.mass.block_count(); ++b) {
    use_start_[b + 1] += use_start_[b];
  }
  uses_.resize(parts_.size());
  for (int p = static_cast<int>(parts_.size()) - 1; p >= 0; --p) {
    uses_[--use_start_[parts_[p].block + 1]] = p;  // ends at the starts
  }
  use_start_.erase(use_start_.begin());
  use_start_.push_back(static_cast<int>(parts_.size()));
}

/// sum_ += what a block of A, the rows of `other` a lane each, and its transpose make of |z|.
void AbsoluteProduct::add_block(const double* block, int bundle, int other) {
  const double* z = z_.data() + static_cast<std::size_t>(bundle) * kLanes;
  const double* z_other = z_.data() + static_cast<std::size_t>(other) * kLanes;
  double* sum = sum_.data() + static_cast<std::size_t>(bundle) * kLanes;
  std::array<double, kLanes> of_other{};
  for (int c = 0; c < bundles_[bundle].rows; ++c, block += kLanes) {
    std::array<double, kLanes> of_row{};
    for (int r = 0; r < kLanes; ++r) {
      const double a = std::abs(block[r]);
      of_row[r] = a * z_other[r];
      of_other[r] += a * z[c];
    }
    sum[c] += ((of_row[0] + of_row[1]) + (of_row[2] + of_row[3])) +
              ((of_row[4] + of_row[5]) + (of_row[6] + of_row[7]));
  }
  if (other != bundle) {
    double* sum_other = sum_.data() + static_cast<std::size_t>(other) * kLanes;
    for (int r = 0; r < kLanes; ++r) {
      sum_other[r] += of_other[r];
    }
  }
}

/// moved_: W_b J_ib^T of the rows of a part, a lane each.
void AbsoluteProduct::move(const BlockMass& mass, const Part& part, int rows) {
  const int d = mass.dimension(part.block);
  const double* numbers = numbers_.data() + part.numbers;
  if (!mass.is_factor(part.block)) {
    weighted_product().multiply(moved_.data(), numbers, mass.stored(part.block).data(), kLanes, d,
                                ones_.data(), d, d);
    return;
  }
  for (int r = 0; r < rows; ++r) {
    for (int k = 0; k < d; ++k) {
      row_[k] = numbers[k * kLanes + r];
    }
    mass.apply_inverse(part.block, row_.data(), row_.data() + d);
    for (int k = 0; k < d; ++k) {
      moved_[k * kLanes + r] = row_[d + k];
    }
  }
}

/// The blocks of A beside the bundle's rows, of the bundles up to itself. blocks_[0] is its own.
void AbsoluteProduct::multiply_bundle(const FactoredMatrix& A, int bundle) {
  const Bundle& own = bundles_[bundle];
  touched_.assign(1, bundle);
  place_[bundle] = 0;
  blocks_.resize(std::max<std::size_t>(blocks_.size(), kBlock));
  std::fill_n(blocks_.data(), own.rows * kLanes, 0.0);
  std::array<double, kBlock> block;
  for (int p = own.part; p < own.part + own.parts; ++p) {
    const int b = parts_[p].block;
    const int d = A.mass.dimension(b);
    move(A.mass, parts_[p], own.rows);
    for (int use = use_start_[b]; parts_[uses_[use]].bundle <= bundle; ++use) {
      const int other = parts_[uses_[use]].bundle;
      const bool matters = other == bundle || !is_zero_[bundle] || !is_zero_[other];
      if (matters) {
        const bool is_first = place_[other] < 0;
        if (is_first) {
          place_[other] = static_cast<int>(touched_.size());
          touched_.push_back(other);
          blocks_.resize(std::max(blocks_.size(), touched_.size() * kBlock));
        }
        double* target = blocks_.data() + static_cast<std::size_t>(place_[other]) * kBlock;
        weighted_product().multiply(is_first ? target : block.data(),
                                    numbers_.data() + parts_[uses_[use]].numbers, moved_.data(),
                                    kLanes, kLanes, ones_.data(), d, own.rows);
        for (int k = 0; !is_first && k < own.rows * kLanes; ++k) {
          target[k] += block[k];
        }
      }
      if (other == bundle) {
        break;
      }
    }
  }
}

bool AbsoluteProduct::compute(const FactoredMatrix& A, std::span<const double> absolute_z,
                              std::span<double> product, Vector& diagonal) {
  if (!find_bundles(A)) {
    return false;
  }
  find_parts(A);
  const std::size_t lanes = bundles_.size() * kLanes;
  z_.assign(lanes, 0.0);
  sum_.assign(lanes, 0.0);
  is_zero_.resize(bundles_.size());
  place_.assign(bundles_.size(), -1);
  for (std::size_t g = 0; g < bundles_.size(); ++g) {
    const auto z = absolute_z.subspan(bundles_[g].row, bundles_[g].rows);
    std::ranges::copy(z, z_.begin() + static_cast<std::ptrdiff_t>(g * kLanes));
    is_zero_[g] = std::ranges::all_of(z, [](double value) { return value == 0.0; }) ? 1 : 0;
  }
  diagonal.resize(A.rows());
  for (int g = 0; g < static_cast<int>(bundles_.size()); ++g) {
    multiply_bundle(A, g);
    for (int r = 0; r < bundles_[g].rows; ++r) {
      double& own = blocks_[r * kLanes + r];
      own += A.compliance(bundles_[g].row + r);
      diagonal[bundles_[g].row + r] = own;
    }
    for (std::size_t k = 0; k < touched_.size(); ++k) {
      add_block(blocks_.data() + k * kBlock, g, touched_[k]);
      place_[touched_[k]] = -1;
    }
  }
  for (std::size_t g = 0; g < bundles_.size(); ++g) {
    std::copy_n(sum_.data() + g * kLanes, bundles_[g].rows, product.data() + bundles_[g].row);
  }
  return true;
}

}  // namespace signorini::lcp
