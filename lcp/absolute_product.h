#pragma once

#include <signorini/lcp/factored_matrix.h>

#include <cstddef>
#include <span>
#include <vector>

namespace signorini::lcp {

/// |A| |z| and the diagonal of a factored A, of which no entry is kept. Rows that follow each other
/// on the same bodies (the contacts of a pair) are a bundle: what two bundles have in common is one
/// small product (weighted_product.h), several times as fast as entry by entry
/// (FactoredMatrix::visit_lower()). Keeps its memory.
class AbsoluteProduct {
 public:
  /// @param absolute_z |z_i|, n numbers
  /// @param product receives sum_j |A_ij| |z_j|, n numbers @param diagonal receives A_ii
  /// @return false, with nothing written, where most rows are on other bodies than their
  /// neighbours: entry by entry is faster there. Cost: half the sum over the blocks of (rows on the
  /// block)^2.
  [[nodiscard]] bool compute(const FactoredMatrix& A, std::span<const double> absolute_z,
                             std::span<double> product, Vector& diagonal);

 private:
  struct Bundle {
    int row;    // the first
    int rows;   // at most as many as a product has lanes
    int part;   // the first
    int parts;  // blocks that its rows are on
  };
  struct Part {
    int block;
    int bundle;
    std::size_t numbers;  // J_ib^T of the rows of the bundle, a lane each
  };
  [[nodiscard]] bool find_bundles(const FactoredMatrix& A);
  void find_parts(const FactoredMatrix& A);
  void move(const BlockMass& mass, const Part& part, int rows);
  void multiply_bundle(const FactoredMatrix& A, int bundle);
  void add_block(const double* block, int bundle, int other);

  std::vector<Bundle> bundles_;
  std::vector<Part> parts_;
  std::vector<double> numbers_;        // of the parts
  std::vector<int> use_start_, uses_;  // the parts on every block, bundles ascending
  std::vector<double> z_, sum_;        // |z| and |A||z| by bundles, a lane each
  std::vector<char> is_zero_;          // z of a bundle
  std::vector<double> row_, moved_;    // W_b J_ib^T of a row, and of the rows of a bundle
  std::vector<double> ones_;
  std::vector<int> place_;      // of a bundle in touched_, or -1
  std::vector<int> touched_;    // bundles that have bodies in common with the one at hand
  std::vector<double> blocks_;  // their blocks of A
};

}  // namespace signorini::lcp
