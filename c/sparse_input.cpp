#include "sparse_input.h"

#include "guard.h"

#include <limits>
#include <string>
#include <vector>

namespace signorini::c {
namespace {

constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();

std::string indexed(const CompressedMatrix& matrix, const char* field, std::int64_t k) {
  return std::string(matrix.name) + ": " + field + "[" + std::to_string(k) + "]";
}

void check(const CompressedMatrix& matrix) {
  const std::string name = matrix.name;
  require_count(matrix.major, kMost - 1, "n");
  require_count(matrix.entries, kMost, (name + ": entries").c_str());
  require_array(matrix.start, matrix.major + 1, (name + ": start").c_str());
  require_array(matrix.index, matrix.entries, (name + ": index").c_str());
  require_array(matrix.value, matrix.entries, (name + ": value").c_str());
  for (std::int64_t j = 0; j <= matrix.major; ++j) {
    const std::int64_t before = j == 0 ? 0 : matrix.start[j - 1];
    const std::int64_t most = j == 0 ? 0 : matrix.entries;
    if (matrix.start[j] < before || matrix.start[j] > most) {
      refuse(indexed(matrix, "start", j) + " is " + std::to_string(matrix.start[j]) +
             ", must be in [" + std::to_string(before) + ", " + std::to_string(most) + "]");
    }
  }
  if (matrix.start[matrix.major] != matrix.entries) {
    refuse(indexed(matrix, "start", matrix.major) + " is " +
           std::to_string(matrix.start[matrix.major]) + ", must be the number of entries, " +
           std::to_string(matrix.entries));
  }
  for (std::int64_t k = 0; k < matrix.entries; ++k) {
    if (matrix.index[k] < 0 || matrix.index[k] >= matrix.minor) {
      refuse(indexed(matrix, "index", k) + " is " + std::to_string(matrix.index[k]) +
             ", must be in [0, " + std::to_string(matrix.minor - 1) + "]");
    }
  }
}

}  // namespace

RowMajorMatrix checked_copy(const CompressedMatrix& matrix) {
  check(matrix);
  const Eigen::Map<const RowMajorMatrix> given(matrix.major, matrix.minor, matrix.entries,
                                               matrix.start, matrix.index, matrix.value);
  RowMajorMatrix sorted = lcp::SparseMatrix(given);  // turning it round sorts, twice gives it back
  for (int j = 0; j < sorted.outerSize(); ++j) {
    for (int k = sorted.outerIndexPtr()[j] + 1; k < sorted.outerIndexPtr()[j + 1]; ++k) {
      if (sorted.innerIndexPtr()[k] == sorted.innerIndexPtr()[k - 1]) {
        refuse(std::string(matrix.name) + ": index " + std::to_string(sorted.innerIndexPtr()[k]) +
               " is given twice between start[" + std::to_string(j) + "] and start[" +
               std::to_string(j + 1) + "]");
      }
    }
  }
  return sorted;
}

}  // namespace signorini::c
