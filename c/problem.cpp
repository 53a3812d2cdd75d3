#include "guard.h"
#include "handles.h"
#include "sparse_input.h"

#include <limits>
#include <utility>
#include <vector>

namespace signorini::c {
namespace {

constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void require_order(signorini_order order) {
  if (order != SIGNORINI_COLUMN_MAJOR && order != SIGNORINI_ROW_MAJOR) {
    refuse("order: must be SIGNORINI_COLUMN_MAJOR or SIGNORINI_ROW_MAJOR, got " +
           std::to_string(order));
  }
}

lcp::Vector copy(const double* values, std::int64_t count) {
  return count == 0 ? lcp::Vector() : lcp::Vector(Eigen::Map<const lcp::Vector>(values, count));
}

/// A problem with M and q, and nothing else.
void set_matrix(signorini_problem& problem, lcp::MatrixForm M, lcp::Vector q) {
  lcp::Problem fresh;
  fresh.M = std::move(M);
  fresh.q = std::move(q);
  problem.problem = std::move(fresh);
}

/// The blocks' sizes add up to what int can count, and so do their numbers. @return their sum
std::int64_t check_blocks(std::int64_t blocks, const std::int32_t* block_size) {
  require_count(blocks, kMost, "blocks");
  require_array(block_size, blocks, "block_size");
  std::int64_t sum = 0;
  std::int64_t numbers = 0;
  for (std::int64_t k = 0; k < blocks; ++k) {
    const std::int64_t size = block_size[k];
    numbers += size * size;
    sum += size;
    if (size < 1 || numbers > kMost) {
      refuse("block_size[" + std::to_string(k) + "] is " + std::to_string(size) +
             (size < 1 ? ", must be >= 1" : ": the blocks would hold more than 2^31 - 1 numbers"));
    }
  }
  return sum;
}

void add_blocks(std::int64_t blocks, const std::int32_t* block_size, signorini_mass_kind kind,
                const double* value, lcp::BlockMass& mass) {
  for (std::int64_t k = 0; k < blocks; ++k) {
    const std::int64_t size = block_size[k];
    const Eigen::Map<const lcp::Matrix> block(value, size, size);
    try {
      kind == SIGNORINI_MASS ? mass.add_mass(block) : mass.add_inverse(block);
    } catch (const std::invalid_argument& error) {
      refuse("block " + std::to_string(k) + ": " + error.what());
    }
    value += size * size;
  }
}

/// Adds the rows of J, each entry a whole block wide. @param block_of of every column of J
void add_rows(const RowMajorMatrix& J, const std::vector<int>& block_of, const double* compliance,
              lcp::FactoredMatrix& A) {
  std::int64_t numbers = 0;
  lcp::Vector entry;
  for (int i = 0; i < J.rows(); ++i) {
    A.add_row(compliance == nullptr ? 0.0 : compliance[i]);
    for (RowMajorMatrix::InnerIterator it(J, i); it;) {
      const int block = block_of[it.col()];
      entry.setZero(A.mass.dimension(block));
      for (; it && block_of[it.col()] == block; ++it) {
        entry[it.col() - A.mass.offset(block)] = it.value();
      }
      numbers += entry.size();
      if (numbers > kMost) {
        refuse("J: its rows, a whole block at a time, would hold more than 2^31 - 1 numbers");
      }
      A.add_entry(block, entry);
    }
  }
}

std::vector<int> blocks_of_columns(const lcp::BlockMass& mass) {
  std::vector<int> block_of;
  block_of.reserve(mass.degrees_of_freedom());
  for (int k = 0; k < mass.block_count(); ++k) {
    block_of.insert(block_of.end(), mass.dimension(k), k);
  }
  return block_of;
}

/// Puts `fresh` into the place of a field; takes it out again if the problem's shapes are then
/// wrong.
template <typename Field>
void replace(lcp::Problem& problem, Field lcp::Problem::*field, Field fresh) {
  std::swap(problem.*field, fresh);
  try {
    lcp::check_shapes(problem);
  } catch (...) {
    std::swap(problem.*field, fresh);
    throw;
  }
}

}  // namespace
}  // namespace signorini::c

using namespace signorini::c;
namespace lcp = signorini::lcp;

signorini_error signorini_problem_create(signorini_problem** problem) {
  return guard([&] {
    require(problem, "problem");
    *problem = nullptr;
    *problem = new signorini_problem;
  });
}

void signorini_problem_destroy(signorini_problem* problem) {
  delete problem;
}

signorini_error signorini_problem_set_dense(signorini_problem* problem, int64_t n,
                                            signorini_order order, const double* M,
                                            const double* q) {
  return guard([&] {
    require(problem, "problem");
    require_count(n, SIGNORINI_MAX_DENSE_ROWS, "n");
    require_order(order);
    require_array(M, n * n, "M");
    require_array(q, n, "q");
    lcp::Matrix matrix(n, n);
    if (n > 0 && order == SIGNORINI_ROW_MAJOR) {
      matrix = Eigen::Map<const RowMajor>(M, n, n);
    } else if (n > 0) {
      matrix = Eigen::Map<const lcp::Matrix>(M, n, n);
    }
    set_matrix(*problem, std::move(matrix), copy(q, n));
  });
}

signorini_error signorini_problem_set_sparse(signorini_problem* problem, int64_t n,
                                             signorini_order order, int64_t entries,
                                             const int32_t* start, const int32_t* index,
                                             const double* value, const double* q) {
  return guard([&] {
    require(problem, "problem");
    require_order(order);
    require_array(q, n, "q");
    const RowMajorMatrix given = checked_copy({"M", n, n, entries, start, index, value});
    lcp::SparseMatrix matrix = order == SIGNORINI_ROW_MAJOR ? lcp::SparseMatrix(given)
                                                            : lcp::SparseMatrix(given.transpose());
    set_matrix(*problem, std::move(matrix), copy(q, n));
  });
}

signorini_error signorini_problem_set_factored(signorini_problem* problem, int64_t n,
                                               int64_t entries, const int32_t* start,
                                               const int32_t* index, const double* value,
                                               int64_t blocks, const int32_t* block_size,
                                               signorini_mass_kind kind, const double* block_value,
                                               const double* compliance, const double* q) {
  return guard([&] {
    require(problem, "problem");
    require_array(q, n, "q");
    if (kind != SIGNORINI_INVERSE_MASS && kind != SIGNORINI_MASS) {
      refuse("kind: must be SIGNORINI_INVERSE_MASS or SIGNORINI_MASS, got " + std::to_string(kind));
    }
    const std::int64_t columns = check_blocks(blocks, block_size);
    require_array(block_value, blocks, "block_value");
    const RowMajorMatrix J = checked_copy({"J", n, columns, entries, start, index, value});
    lcp::FactoredMatrix A;
    add_blocks(blocks, block_size, kind, block_value, A.mass);
    add_rows(J, blocks_of_columns(A.mass), compliance, A);
    set_matrix(*problem, std::move(A), copy(q, n));
  });
}

signorini_error signorini_problem_set_bounds(signorini_problem* problem, int64_t n,
                                             const double* lower, const double* upper) {
  return guard([&] {
    require(problem, "problem");
    lcp::Problem& kept = problem->problem;
    if (n != kept.size()) {
      refuse("n: must be the problem's number of rows, " + std::to_string(kept.size()) + ", got " +
             std::to_string(n));
    }
    lcp::Vector below = lower == nullptr ? lcp::Vector() : copy(lower, n);
    lcp::Vector above = upper == nullptr ? lcp::Vector() : copy(upper, n);
    kept.lower = std::move(below);
    kept.upper = std::move(above);
  });
}

signorini_error signorini_problem_set_limits(signorini_problem* problem, int64_t count,
                                             const int32_t* row, const int32_t* normal_row,
                                             const double* coefficient) {
  return guard([&] {
    require(problem, "problem");
    lcp::Problem& kept = problem->problem;
    require_count(count, kept.size(), "count");
    require_array(row, count, "row");
    require_array(normal_row, count, "normal_row");
    require_array(coefficient, count, "coefficient");
    std::vector<lcp::CoupledLimit> limits;
    limits.reserve(count);
    for (std::int64_t k = 0; k < count; ++k) {
      limits.push_back({row[k], normal_row[k], coefficient[k]});
    }
    replace(kept, &lcp::Problem::limits, std::move(limits));
  });
}

signorini_error signorini_problem_set_cones(signorini_problem* problem, int64_t count,
                                            const int32_t* normal_row, const int32_t* dimension,
                                            const double* coefficient, signorini_friction_law law) {
  return guard([&] {
    require(problem, "problem");
    lcp::Problem& kept = problem->problem;
    require_count(count, kept.size(), "count");
    require_array(normal_row, count, "normal_row");
    require_array(dimension, count, "dimension");
    require_array(coefficient, count, "coefficient");
    if (law != SIGNORINI_COULOMB && law != SIGNORINI_ASSOCIATED) {
      refuse("law: must be SIGNORINI_COULOMB or SIGNORINI_ASSOCIATED, got " + std::to_string(law));
    }
    std::vector<lcp::FrictionCone> cones;
    cones.reserve(count);
    for (std::int64_t k = 0; k < count; ++k) {
      cones.push_back({normal_row[k], dimension[k], coefficient[k]});
    }
    replace(kept, &lcp::Problem::cones, std::move(cones));
    kept.friction_law =
        law == SIGNORINI_COULOMB ? lcp::FrictionLaw::kCoulomb : lcp::FrictionLaw::kAssociated;
  });
}

int64_t signorini_problem_size(const signorini_problem* problem) {
  return problem == nullptr ? 0 : problem->problem.size();
}

double* signorini_problem_q(signorini_problem* problem) {
  return problem == nullptr ? nullptr : problem->problem.q.data();
}

double* signorini_problem_matrix(signorini_problem* problem, int64_t* count) {
  double* values = nullptr;
  std::int64_t numbers = 0;
  if (problem != nullptr) {
    if (auto* dense = std::get_if<lcp::Matrix>(&problem->problem.M)) {
      values = dense->data();
      numbers = dense->size();
    } else if (auto* sparse = std::get_if<lcp::SparseMatrix>(&problem->problem.M)) {
      values = sparse->valuePtr();
      numbers = sparse->nonZeros();
    }
  }
  if (count != nullptr) {
    *count = numbers;
  }
  return values;
}
