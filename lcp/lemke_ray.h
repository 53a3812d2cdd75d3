#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/ray.h>

namespace signorini::lcp {

/// Makes the most of a secondary ray found in floating point. Tries, in this order, and keeps the
/// candidate of which judge_ray() proves most:
///
/// 1. the direction with entries below 1e-9 of the largest (rounding, negative ones included) set
///    to 0;
/// 2. that vector rounded to integers over one denominator D <= 1e9, found entry by entry by
///    continued fractions, where such a vector lies within rounding: data with exact null vectors
///    (integers, dyadics) is then proven infeasible exactly.
///
/// @param direction n numbers, the z-part of the ray, any positive multiple
/// @param sharpened receives n numbers >= 0
/// @return judge_ray(problem, sharpened)
[[nodiscard]] RayVerdict sharpen_ray(const Problem& problem, const VectorRef& direction,
                                     Vector& sharpened);

}  // namespace signorini::lcp
