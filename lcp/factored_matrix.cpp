#include <signorini/lcp/factored_matrix.h>
#include <signorini/lcp/number_text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr int kRigidBody = 6;  // the dimension that the compiler gets to unroll

template <typename Scalar>
inline void add_row_times(const double* row, Scalar z, Scalar* p, int dimension) {
  for (int k = 0; k < dimension; ++k) {
    p[k] += row[k] * z;
  }
}

template <typename Scalar>
inline void add_product(const double* row, const Scalar* v, int dimension, Scalar& sum) {
  for (int k = 0; k < dimension; ++k) {
    sum += row[k] * v[k];
  }
}

}  // namespace

int FactoredMatrix::add_row(double compliance) {
  if (!(compliance >= 0.0) || !std::isfinite(compliance)) {
    throw std::invalid_argument("FactoredMatrix: compliance of row " + std::to_string(rows()) +
                                ": must be finite and >= 0, got " + number_text(compliance));
  }
  compliance_.push_back(compliance);
  row_start_.push_back(row_start_.back());
  return rows() - 1;
}

void FactoredMatrix::add_entry(int block, const VectorRef& values) {
  if (rows() == 0) {
    throw std::invalid_argument("FactoredMatrix: add_entry before the first add_row");
  }
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("FactoredMatrix: entry of row " + std::to_string(rows() - 1) +
                                ": " + what);
  };
  if (block < 0 || block >= mass.block_count()) {
    refuse("block " + std::to_string(block) + " is not one of the " +
           std::to_string(mass.block_count()) + " blocks");
  }
  if (values.size() != mass.dimension(block)) {
    refuse(std::to_string(values.size()) + " values for block " + std::to_string(block) +
           " of dimension " + std::to_string(mass.dimension(block)));
  }
  for (const Entry& entry : entries(rows() - 1)) {
    if (entry.block == block) {
      refuse("block " + std::to_string(block) + " given twice");
    }
  }
  entries_.push_back({block, static_cast<int>(values_.size())});
  values_.insert(values_.end(), values.data(), values.data() + values.size());
  ++row_start_.back();
}

void FactoredMatrix::clear() {
  mass.clear();
  row_start_.resize(1);
  entries_.clear();
  values_.clear();
  compliance_.clear();
}

template <typename Scalar>
void FactoredMatrix::transpose_times(const Scalar* z, Scalar* p) const {
  std::fill(p, p + degrees_of_freedom(), Scalar(0));
  for (int i = 0; i < rows(); ++i) {
    if (z[i] == Scalar(0)) {  // contacts that do not press
      continue;
    }
    for (const Entry& entry : entries(i)) {
      Scalar* target = p + mass.offset(entry.block);
      const int dimension = mass.dimension(entry.block);
      if (dimension == kRigidBody) {
        add_row_times(values(entry), z[i], target, kRigidBody);
      } else {
        add_row_times(values(entry), z[i], target, dimension);
      }
    }
  }
}

template <typename Scalar>
void FactoredMatrix::apply_inverse_mass(const Scalar* p, Scalar* v) const {
  for (int b = 0; b < mass.block_count(); ++b) {
    mass.apply_inverse(b, p + mass.offset(b), v + mass.offset(b));
  }
}

template <typename Scalar>
void FactoredMatrix::times(const Scalar* v, const Scalar* z, Scalar* w) const {
  for (int i = 0; i < rows(); ++i) {
    Scalar sum = Scalar(compliance_[i]) * z[i];
    for (const Entry& entry : entries(i)) {
      const Scalar* block = v + mass.offset(entry.block);
      const int dimension = mass.dimension(entry.block);
      if (dimension == kRigidBody) {
        add_product(values(entry), block, kRigidBody, sum);
      } else {
        add_product(values(entry), block, dimension, sum);
      }
    }
    w[i] = sum;
  }
}

template <typename Scalar>
void FactoredMatrix::multiply(const Scalar* z, Scalar* w) const {
  std::vector<Scalar> p(degrees_of_freedom());
  std::vector<Scalar> v(degrees_of_freedom());
  transpose_times(z, p.data());
  apply_inverse_mass(p.data(), v.data());
  times(v.data(), z, w);
}

void FactoredMatrix::diagonal(Vector& d) const {
  d.resize(rows());
  std::array<double, 6> of_rigid_body;
  std::vector<double> of_large_block;
  for (int i = 0; i < rows(); ++i) {
    d[i] = compliance_[i];
    for (const Entry& entry : entries(i)) {
      const int size = mass.dimension(entry.block);
      double* moved = of_rigid_body.data();  // W_b J_ib^T
      if (size > static_cast<int>(of_rigid_body.size())) {
        of_large_block.resize(size);
        moved = of_large_block.data();
      }
      mass.apply_inverse(entry.block, values(entry), moved);
      d[i] +=
          Eigen::Map<const Vector>(moved, size).dot(Eigen::Map<const Vector>(values(entry), size));
    }
  }
}

void FactoredMatrix::start_visit(VisitWorkspace& workspace) const {
  auto& [use_start, uses, moved, product, seen, touched] = workspace;
  use_start.assign(mass.block_count() + 1, 0);
  for (const Entry& entry : entries_) {
    ++use_start[entry.block + 1];
  }
  int widest = 0;
  for (int b = 0; b < mass.block_count(); ++b) {
    use_start[b + 1] += use_start[b];
    widest = std::max(widest, mass.dimension(b));
  }
  uses.resize(entries_.size());
  for (int i = rows() - 1; i >= 0; --i) {  // from the end, so that use_start ends at the starts
    for (const Entry& entry : entries(i)) {
      uses[--use_start[entry.block + 1]] = {i, entry.values};
    }
  }
  use_start.erase(use_start.begin());
  use_start.push_back(static_cast<int>(entries_.size()));
  moved.resize(widest);
  product.resize(rows());
  seen.assign(rows(), -1);
  touched.reserve(rows());
}

SparseMatrix FactoredMatrix::form() const {
  struct Use {
    int row;
    int values;
  };
  std::vector<std::vector<Use>> uses(mass.block_count());
  for (int i = 0; i < rows(); ++i) {
    for (const Entry& entry : entries(i)) {
      uses[entry.block].push_back({i, entry.values});
    }
  }
  std::vector<Eigen::Triplet<double>> triplets;
  Vector inverse_mass_row;
  for (int j = 0; j < rows(); ++j) {
    if (compliance_[j] > 0.0) {
      triplets.emplace_back(j, j, compliance_[j]);
    }
    for (const Entry& entry : entries(j)) {
      const int size = mass.dimension(entry.block);
      inverse_mass_row.resize(size);
      mass.apply_inverse(entry.block, values(entry), inverse_mass_row.data());
      for (const Use& use : uses[entry.block]) {
        if (use.row < j) {
          continue;  // the lower triangle is the mirror image, so that A is symmetric to the bit
        }
        const double a =
            inverse_mass_row.dot(Eigen::Map<const Vector>(values_.data() + use.values, size));
        triplets.emplace_back(use.row, j, a);
        if (use.row != j) {
          triplets.emplace_back(j, use.row, a);
        }
      }
    }
  }
  SparseMatrix formed(rows(), rows());
  formed.setFromTriplets(triplets.begin(), triplets.end());
  return formed;
}

template void FactoredMatrix::transpose_times(const double*, double*) const;
template void FactoredMatrix::transpose_times(const long double*, long double*) const;
template void FactoredMatrix::apply_inverse_mass(const double*, double*) const;
template void FactoredMatrix::apply_inverse_mass(const long double*, long double*) const;
template void FactoredMatrix::times(const double*, const double*, double*) const;
template void FactoredMatrix::times(const long double*, const long double*, long double*) const;
template void FactoredMatrix::multiply(const double*, double*) const;
template void FactoredMatrix::multiply(const long double*, long double*) const;

}  // namespace signorini::lcp
