#include <signorini/lcp/instruction_set.h>

#include <array>
#include <type_traits>

namespace signorini::lcp {

#define SIGNORINI_DECLARE_KERNELS(name)      \
  namespace name {                           \
  extern const SweepKernels<double> kDouble; \
  extern const SweepKernels<float> kFloat;   \
  }
SIGNORINI_DECLARE_KERNELS(kernels_baseline)
#ifdef SIGNORINI_HAS_X86_KERNELS
SIGNORINI_DECLARE_KERNELS(kernels_avx2)
SIGNORINI_DECLARE_KERNELS(kernels_fma)
#endif
#undef SIGNORINI_DECLARE_KERNELS

namespace {

struct Available {
  std::array<InstructionSet, 3> sets{InstructionSet::kBaseline};
  std::size_t count = 1;

  Available() {
#ifdef SIGNORINI_HAS_X86_KERNELS
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2")) {
      sets[count++] = InstructionSet::kAvx2;
      if (__builtin_cpu_supports("fma")) {
        sets[count++] = InstructionSet::kFma;
      }
    }
#endif
  }
};

template <typename T>
const SweepKernels<T>& pick(const SweepKernels<double>& of_double,
                            const SweepKernels<float>& of_float) {
  if constexpr (std::is_same_v<T, double>) {
    return of_double;
  } else {
    return of_float;
  }
}

}  // namespace

std::string_view to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::kBaseline: return "baseline";
    case InstructionSet::kAvx2: return "avx2";
    case InstructionSet::kFma: return "fma";
  }
  return "unknown";
}

std::span<const InstructionSet> available_instruction_sets() {
  static const Available available;
  return {available.sets.data(), available.count};
}

InstructionSet best_instruction_set(bool fused) {
  InstructionSet best = InstructionSet::kBaseline;
  for (const InstructionSet set : available_instruction_sets()) {
    if (fused || set != InstructionSet::kFma) {
      best = set;
    }
  }
  return best;
}

template <typename T>
const SweepKernels<T>& sweep_kernels(InstructionSet set) {
#ifdef SIGNORINI_HAS_X86_KERNELS
  switch (set) {
    case InstructionSet::kBaseline: break;
    case InstructionSet::kAvx2: return pick<T>(kernels_avx2::kDouble, kernels_avx2::kFloat);
    case InstructionSet::kFma: return pick<T>(kernels_fma::kDouble, kernels_fma::kFloat);
  }
#else
  static_cast<void>(set);
#endif
  return pick<T>(kernels_baseline::kDouble, kernels_baseline::kFloat);
}

template const SweepKernels<double>& sweep_kernels(InstructionSet);
template const SweepKernels<float>& sweep_kernels(InstructionSet);

}  // namespace signorini::lcp
