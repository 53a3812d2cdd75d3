#pragma once

#include <signorini/lcp/interval.h>

#include <array>
#include <cstdint>

namespace signorini::lcp {

/// A sum of products of doubles without any rounding: a fixed-point number long enough for every
/// product of two finite doubles, 2^-2148 .. 2^2048 (the "complete arithmetic" of U. Kulisch,
/// Computer Arithmetic and Validity, 2013, chapter 8). Holds up to 2^30 products. About ten times
/// the cost of a product in floating point, and needs no library.
class ExactSum {
 public:
  /// Adds a b. @pre a and b are finite
  void add_product(double a, double b);

  /// -1, 0 or 1: the sign of the sum, exact.
  [[nodiscard]] int sign() const;

  /// The sum between two long doubles that differ by at most three units in the last place, equal
  /// where the sum is a long double.
  [[nodiscard]] Interval enclosure() const;

 private:
  // value = sum_k digits_[k] 2^(32 k - 2148). A product adds less than 2^33 to a digit, so that a
  // signed 64-bit digit holds 2^30 of them before any carry.
  static constexpr int kLowestExponent = -2148;
  static constexpr int kDigits = 134;
  using Digits = std::array<std::int64_t, kDigits>;

  /// All digits but the last in [0, 2^32); the last one carries the sign.
  static Digits carried(const Digits& digits);
  [[nodiscard]] Digits carried_magnitude(bool negate) const;

  Digits digits_{};
};

}  // namespace signorini::lcp
