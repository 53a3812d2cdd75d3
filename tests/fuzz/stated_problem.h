#pragma once

#include <signorini/c/signorini.h>

#include "plain_problem.h"

#include <cstdint>
#include <span>

namespace signorini::testing {

/// What the arrays say that signorini_problem_set_dense(), _sparse() and _factored() took.
[[nodiscard]] PlainProblem stated_dense(int n, signorini_order order, const double* M,
                                        const double* q);
[[nodiscard]] PlainProblem stated_sparse(int n, signorini_order order, const std::int32_t* start,
                                         const std::int32_t* index, const double* value,
                                         const double* q);
/// Blocks of one or two rows. The sizes grow with what inverting a mass may lose.
[[nodiscard]] PlainProblem stated_factored(int n, const std::int32_t* start,
                                           const std::int32_t* index, const double* value,
                                           std::span<const std::int32_t> block_size,
                                           signorini_mass_kind kind, const double* block_value,
                                           const double* compliance, const double* q);

}  // namespace signorini::testing
