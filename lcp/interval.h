#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {

/// A closed interval [lower, upper] that holds the true value of the expression it was computed
/// from: every operation rounds outward, and not at all where it is exact. Overflow and 0/0 end in
/// infinite or NaN bounds, never in a finite wrong one. For proofs, not for speed.
///
/// The operations are those that BlockMass::apply_inverse() needs.
struct Interval {
  long double lower = 0.0L;
  long double upper = 0.0L;

  Interval() = default;
  Interval(long double value) : lower(value), upper(value) {}  // NOLINT: a number is an interval
  Interval(long double lowest, long double highest) : lower(lowest), upper(highest) {}

  Interval& operator+=(const Interval& other) {
    lower = round(lower + other.lower, sum_is_exact(lower, other.lower), -kInfinity);
    upper = round(upper + other.upper, sum_is_exact(upper, other.upper), kInfinity);
    return *this;
  }
  Interval& operator-=(const Interval& other) {
    return *this += Interval(-other.upper, -other.lower);
  }

  friend Interval operator*(double factor, const Interval& x) {
    const long double at_lower = factor >= 0.0 ? x.lower : x.upper;
    const long double at_upper = factor >= 0.0 ? x.upper : x.lower;
    return {round(factor * at_lower, product_is_exact(factor, at_lower), -kInfinity),
            round(factor * at_upper, product_is_exact(factor, at_upper), kInfinity)};
  }

  /// @pre divisor > 0
  friend Interval operator/(const Interval& x, long double divisor) {
    return {round(x.lower / divisor, quotient_is_exact(x.lower, divisor), -kInfinity),
            round(x.upper / divisor, quotient_is_exact(x.upper, divisor), kInfinity)};
  }

 private:
  static constexpr long double kInfinity = std::numeric_limits<long double>::infinity();
  // Above this a rounding error of a product is itself representable, so that fma() shows it.
  static constexpr long double kNoUnderflow = 0x1p-16000L;
  static_assert(std::numeric_limits<long double>::max_exponent >= 16384,
                "the exponents of products of doubles must fit in long double");

  static long double round(long double value, bool is_exact, long double toward) {
    return is_exact ? value : std::nextafter(value, toward);
  }
  static bool sum_is_exact(long double a, long double b) {  // Knuth's TwoSum has no remainder
    const long double sum = a + b;
    const long double b_in_sum = sum - a;
    return (a - (sum - b_in_sum)) + (b - b_in_sum) == 0.0L;  // false for infinity and NaN
  }
  static bool product_is_exact(long double a, long double b) {
    const long double product = a * b;
    return a == 0.0L || b == 0.0L ||
           (std::abs(product) > kNoUnderflow && std::fma(a, b, -product) == 0.0L);
  }
  static bool quotient_is_exact(long double a, long double b) {
    const long double quotient = a / b;
    return a == 0.0L || (std::abs(quotient) > kNoUnderflow && std::abs(a) > kNoUnderflow &&
                         std::fma(quotient, b, -a) == 0.0L);
  }
};

}  // namespace signorini::lcp
