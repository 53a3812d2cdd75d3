#pragma once

#include <cstdint>
#include <string_view>

namespace signorini::lcp {

/// How a solve ended. Only kSolved and kSolvedToRounding claim an answer, and both are given by the
/// certificate (certificate.h), recomputed from the caller's data, never by a solver's own belief.
/// In every other case z holds the best iterate (kInvalidInput, kNotRun: NaN).
enum class Status : std::uint8_t {
  kNotRun,              ///< nothing was computed yet; z, w and the certificate are NaN
  kSolved,              ///< both residuals are within the tolerance
  kSolvedToRounding,    ///< residual above the tolerance, but at most four rounding floors and 1e-5
  kInfeasible,          ///< Result::ray proves, in exact arithmetic, that no z satisfies the bounds
  kNoSolutionBelow,     ///< Result::ray proves that every feasible z has |z|_1 >= Result::ray_bound
  kRayUnproven,         ///< ended on a ray that proves nothing about this matrix
  kIterationLimit,      ///< the iteration limit was reached
  kTimeLimit,           ///< the time limit was reached
  kStalled,             ///< the method converged or stopped making progress short of the tolerance
  kNumericalBreakdown,  ///< a factorisation or a pivot failed, or the certificate refused the
                        ///< answer
  kInvalidInput,        ///< NaN, infinity or crossed bounds in the problem; nothing was computed
};

/// The text of a status, for example "solved to rounding".
[[nodiscard]] std::string_view to_string(Status status);

/// True for kSolved and kSolvedToRounding.
[[nodiscard]] constexpr bool is_solved(Status status) {
  return status == Status::kSolved || status == Status::kSolvedToRounding;
}

}  // namespace signorini::lcp
