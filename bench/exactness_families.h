#pragma once

#include <signorini/lcp/problem.h>

#include <cstdint>
#include <random>
#include <span>
#include <string_view>

namespace signorini::bench {

/// Random integers, and nothing else.
class Draw {
 public:
  explicit Draw(const std::mt19937_64& random) : random_(random) {}
  int integer(int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random_);
  }
  bool coin() { return integer(0, 1) == 1; }
  /// 1, 1/2 or 1/4.
  double dyadic() { return 1.0 / (1 << integer(0, 2)); }
  lcp::Matrix matrix(lcp::Index rows, lcp::Index columns, int most);
  lcp::Vector vector(lcp::Index n, int most) { return matrix(n, 1, most); }

 private:
  std::mt19937_64 random_;
};

/// What the theory of Lemke's method promises about a family of problems.
enum class Promise {
  kDecided,  ///< a solution if there is one, else a ray that proves there is none
  kSolved,   ///< a solution, which always exists
  kNothing,  ///< it may end on a ray although there is a solution
};

/// A kind of LCP whose data are exact in binary: small integers, and multiples of powers of two.
struct ExactnessFamily {
  std::string_view name;
  std::string_view what;  ///< one line
  Promise promise;
  lcp::Problem (*draw)(Draw& draw);  ///< n = 1..12
};

/// All families, in the order of the tables.
[[nodiscard]] std::span<const ExactnessFamily> exactness_families();

/// Problem `index` of the study with this seed, drawn without the others; families take turns.
struct ExactnessProblem {
  const ExactnessFamily* family;
  lcp::Problem problem;
};
[[nodiscard]] ExactnessProblem draw_exactness_problem(std::uint64_t seed, int index);

}  // namespace signorini::bench
