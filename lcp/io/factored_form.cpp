#include <signorini/lcp/io/factored_form.h>

#include <Eigen/Cholesky>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

namespace signorini::lcp {
namespace {

using WideMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using WideVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

constexpr int kMaxInt = std::numeric_limits<int>::max();

int root_of(std::vector<int>& parent, int row) {
  while (parent[row] != row) {
    row = parent[row] = parent[parent[row]];
  }
  return row;
}

void join(std::vector<int>& parent, int a, int b) {
  const int root_a = root_of(parent, a);
  const int root_b = root_of(parent, b);
  parent[std::max(root_a, root_b)] = std::min(root_a, root_b);
}

MassBlocks blocks_of(std::vector<int>& parent) {
  const int count = static_cast<int>(parent.size());
  MassBlocks result;
  result.block.resize(count);
  result.position.resize(count);
  for (int row = 0; row < count; ++row) {
    const int root = root_of(parent, row);
    if (root == row) {
      result.block[row] = static_cast<int>(result.rows.size());
      result.rows.emplace_back();
    }
    result.block[row] = result.block[root];
    std::vector<int>& rows = result.rows[result.block[row]];
    result.position[row] = static_cast<int>(rows.size());
    rows.push_back(row);
  }
  return result;
}

void join_parts(const std::vector<int>& sizes, std::vector<int>& parent) {
  int first = 0;
  for (const int size : sizes) {
    for (int k = 1; k < size; ++k) {
      join(parent, first, first + k);
    }
    first += size;
  }
}

/// M^-1 f.
WideVector solve_blocks(const std::vector<Matrix>& masses, const MassBlocks& blocks,
                        const Vector& f) {
  WideVector v(f.size());
  for (std::size_t b = 0; b < masses.size(); ++b) {
    const WideMatrix block = masses[b].cast<long double>();
    const WideVector force = f(blocks.rows[b]).cast<long double>();
    v(blocks.rows[b]) = WideVector(block.llt().solve(force));
  }
  return v;
}

}  // namespace

MassBlocks connected_blocks(const CoordinateMatrix& M, const std::vector<int>& at_least_joined) {
  std::vector<int> parent(M.rows);
  std::iota(parent.begin(), parent.end(), 0);
  join_parts(at_least_joined, parent);
  for (const CoordinateMatrix::Entry& entry : M.entries) {
    if (entry.value != 0.0) {
      join(parent, entry.row, entry.column);
    }
  }
  return blocks_of(parent);
}

MassBlocks consecutive_blocks(const std::vector<int>& sizes) {
  std::vector<int> parent(std::accumulate(sizes.begin(), sizes.end(), 0));
  std::iota(parent.begin(), parent.end(), 0);
  join_parts(sizes, parent);
  return blocks_of(parent);
}

std::string block_text(const std::vector<int>& rows) {
  return "block of rows " + std::to_string(rows.front() + 1) + " to " +
         std::to_string(rows.back() + 1);
}

std::vector<Matrix> dense_blocks(const CoordinateMatrix& M, const MassBlocks& blocks) {
  std::int64_t numbers = 0;
  for (const std::vector<int>& rows : blocks.rows) {
    if (rows.size() > kMaxMassBlock) {
      throw std::invalid_argument(block_text(rows) + ": " + std::to_string(rows.size()) +
                                  " coupled rows, expected at most " +
                                  std::to_string(kMaxMassBlock));
    }
    numbers += static_cast<std::int64_t>(rows.size() * rows.size());
  }
  if (numbers > kMaxInt) {
    throw std::invalid_argument("its blocks have more than " + std::to_string(kMaxInt) +
                                " numbers");
  }
  std::vector<Matrix> dense;
  dense.reserve(blocks.rows.size());
  for (const std::vector<int>& rows : blocks.rows) {
    dense.emplace_back(Matrix::Zero(rows.size(), rows.size()));
  }
  for (const CoordinateMatrix::Entry& entry : M.entries) {
    if (entry.value == 0.0) {
      continue;
    }
    if (blocks.block[entry.row] != blocks.block[entry.column]) {
      throw std::invalid_argument("entry (" + std::to_string(entry.row + 1) + ", " +
                                  std::to_string(entry.column + 1) + ") lies outside the blocks");
    }
    Matrix& block = dense[blocks.block[entry.row]];
    const int i = blocks.position[entry.row];
    const int j = blocks.position[entry.column];
    block(i, j) = entry.value;
    if (M.symmetric) {
      block(j, i) = entry.value;
    }
  }
  return dense;
}

void add_masses(const std::vector<Matrix>& masses, const MassBlocks& blocks, BlockMass& out) {
  for (std::size_t b = 0; b < masses.size(); ++b) {
    const Matrix& block = masses[b];
    try {
      if (!block.isDiagonal(0.0)) {
        out.add_mass(block);
        continue;
      }
      const Vector inverse = block.diagonal().cwiseInverse();
      if (!((block.diagonal().array() > 0.0).all() && inverse.allFinite())) {
        throw std::invalid_argument("BlockMass: mass: must be positive definite");
      }
      out.add_inverse(inverse.asDiagonal().toDenseMatrix());
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(block_text(blocks.rows[b]) + ": " + error.what());
    }
  }
}

void add_rows(const SparseMatrix& H, const MassBlocks& blocks, const Vector& compliance,
              FactoredMatrix& out) {
  for (Index i = 0; i < H.outerSize(); ++i) {
    out.add_row(compliance.size() > 0 ? compliance[i] : 0.0);
    std::map<int, Vector> entries;
    for (SparseMatrix::InnerIterator it(H, i); it; ++it) {
      const int block = blocks.block[it.row()];
      Vector& values =
          entries.try_emplace(block, Vector::Zero(out.mass.dimension(block))).first->second;
      values[blocks.position[it.row()]] = it.value();
    }
    for (const auto& [block, values] : entries) {
      out.add_entry(block, values);
    }
  }
}

Vector velocities_without_impulses(const SparseMatrix& H, const std::vector<Matrix>& masses,
                                   const MassBlocks& blocks, const Vector& f, const Vector& w) {
  const WideVector v = solve_blocks(masses, blocks, f);
  Vector q(H.cols());
  for (Index i = 0; i < H.cols(); ++i) {
    long double sum = w[i];
    for (SparseMatrix::InnerIterator it(H, i); it; ++it) {
      sum += it.value() * v[it.row()];
    }
    q[i] = static_cast<double>(sum);
  }
  return q;
}

SparseMatrix mass_matrix(const BlockMass& mass) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (int b = 0; b < mass.block_count(); ++b) {
    const int d = mass.dimension(b);
    WideMatrix inverse(d, d);
    for (int j = 0; j < d; ++j) {
      const WideVector unit = WideVector::Unit(d, j);
      mass.apply_inverse(b, unit.data(), inverse.col(j).data());
    }
    const WideMatrix block = inverse.llt().solve(WideMatrix::Identity(d, d));
    for (int j = 0; j < d; ++j) {
      for (int i = j; i < d; ++i) {
        const auto value = static_cast<double>(block(i, j));
        if (value == 0.0) {
          continue;
        }
        triplets.emplace_back(mass.offset(b) + i, mass.offset(b) + j, value);
        if (i != j) {
          triplets.emplace_back(mass.offset(b) + j, mass.offset(b) + i, value);
        }
      }
    }
  }
  SparseMatrix M(mass.degrees_of_freedom(), mass.degrees_of_freedom());
  M.setFromTriplets(triplets.begin(), triplets.end());
  return M;
}

SparseMatrix transposed_jacobian(const FactoredMatrix& A) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (int i = 0; i < A.rows(); ++i) {
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      for (int k = 0; k < A.mass.dimension(entry.block); ++k) {
        if (A.values(entry)[k] != 0.0) {
          triplets.emplace_back(A.mass.offset(entry.block) + k, i, A.values(entry)[k]);
        }
      }
    }
  }
  SparseMatrix H(A.degrees_of_freedom(), A.rows());
  H.setFromTriplets(triplets.begin(), triplets.end());
  return H;
}

}  // namespace signorini::lcp
