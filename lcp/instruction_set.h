#pragma once

#include <signorini/lcp/sweep_kernels.h>

#include <span>
#include <string_view>

namespace signorini::lcp {

/// Which kernels of sweep_kernels.h are run. AVX-512 was measured and is no faster: a row is twelve
/// numbers.
enum class InstructionSet : std::uint8_t {
  kBaseline,  ///< what every processor of the architecture has
  kAvx2,      ///< the bits of kBaseline, 1 to 2 times as fast in double
  kFma,       ///< other bits: products are not rounded before they are added. 1.15 (natural order)
              ///< to 1.4 times (coloured) as fast as kAvx2
};
[[nodiscard]] std::string_view to_string(InstructionSet set);

/// What this build has kernels for and this machine can run, the slowest first; never empty.
[[nodiscard]] std::span<const InstructionSet> available_instruction_sets();
/// The fastest of them with the bits of kBaseline; or, where bits may differ, the fastest.
[[nodiscard]] InstructionSet best_instruction_set(bool fused = false);

/// T is double or float. @param set must be one of available_instruction_sets().
template <typename T>
[[nodiscard]] const SweepKernels<T>& sweep_kernels(InstructionSet set);

}  // namespace signorini::lcp
