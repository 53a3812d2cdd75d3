#pragma once

#include <signorini/c/signorini.h>
#include <signorini/lcp/types.h>

#include <cstdint>

namespace signorini::c {

/// A caller's compressed matrix, not yet trusted.
struct CompressedMatrix {
  const char* name;    ///< for messages
  std::int64_t major;  ///< columns of CSC, rows of CSR
  std::int64_t minor;
  std::int64_t entries;
  const std::int32_t* start;
  const std::int32_t* index;
  const double* value;
};

/// The rows (of CSR; of CSC: the columns) with their entries in ascending order.
using RowMajorMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// A checked copy: starts ascending from 0 to `entries`, indices in range, none twice.
/// @throws std::invalid_argument that names what is wrong, before memory is asked for
[[nodiscard]] RowMajorMatrix checked_copy(const CompressedMatrix& matrix);

}  // namespace signorini::c
