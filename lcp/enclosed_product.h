#pragma once

#include <signorini/lcp/interval.h>
#include <signorini/lcp/problem.h>
#include <signorini/lcp/types.h>

#include <vector>

namespace signorini::lcp {

/// Receives M x, every entry in an interval around its exact value over the doubles given: [0, 0]
/// only if it is 0, and the sign of an interval that does not hold 0 is that of the entry.
///
/// For a given M sums run in ExactSum, so that every sign is known. For the factored form
/// M x = J W p + c x, p = J^T x is exact, and W p runs in intervals, which may leave a sign open;
/// the W is the one that BlockMass::apply_inverse() applies.
///
/// Cost: about ten products with M; allocates.
/// @param x finite numbers, as many as M has columns
void enclose_product(const MatrixForm& M, const VectorRef& x, std::vector<Interval>& product);

/// The same of M^T x.
void enclose_transposed_product(const MatrixForm& M, const VectorRef& x,
                                std::vector<Interval>& product);

}  // namespace signorini::lcp
