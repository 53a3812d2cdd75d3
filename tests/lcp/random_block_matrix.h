#pragma once

#include <signorini/lcp/types.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace signorini::lcp {

/// Blocks of random sizes on a random graph, with a symmetric pattern, numbers that are not, and so
/// much on the diagonal.
inline SparseMatrix random_block_matrix(int blocks, double edges, double diagonal,
                                        std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> size(1, 7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<int> start{0};
  for (int b = 0; b < blocks; ++b) {
    start.push_back(start.back() + size(random));
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int b = 0; b < blocks; ++b) {
    for (int a = b; a < blocks; ++a) {
      if (a != b && std::abs(uniform(random)) > edges / blocks) {
        continue;
      }
      for (int j = start[b]; j < start[b + 1]; ++j) {
        for (int i = start[a]; i < start[a + 1]; ++i) {
          entries.emplace_back(i, j, i == j ? diagonal : uniform(random));
          if (a != b) {
            entries.emplace_back(j, i, uniform(random));
          }
        }
      }
    }
  }
  SparseMatrix matrix(start.back(), start.back());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace signorini::lcp
