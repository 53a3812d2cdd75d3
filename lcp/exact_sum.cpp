#include <signorini/lcp/exact_sum.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <functional>

namespace signorini::lcp {
namespace {

__extension__ typedef unsigned __int128 Wide;

constexpr int kDigitBits = 32;
constexpr std::uint64_t kDigitMask = 0xffffffffu;

/// A finite double as +-mantissa 2^exponent.
struct Parts {
  std::uint64_t mantissa;
  int exponent;
  bool is_negative;
};

Parts parts_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const int field = static_cast<int>((bits >> 52) & 0x7ff);
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
  const std::uint64_t leading = field > 0 ? std::uint64_t{1} << 52 : 0;  // 0: subnormal
  return {fraction | leading, std::max(field, 1) - 1075, (bits >> 63) != 0};
}

}  // namespace

void ExactSum::add_product(double a, double b) {
  assert(std::isfinite(a) && std::isfinite(b));
  const Parts x = parts_of(a);
  const Parts y = parts_of(b);
  const Wide product = Wide{x.mantissa} * y.mantissa;
  const int shift = x.exponent + y.exponent - kLowestExponent;  // >= 0
  const int first = shift / kDigitBits;
  const std::int64_t sign = x.is_negative == y.is_negative ? 1 : -1;
  for (int k = 0; k < 4; ++k) {
    const auto piece = static_cast<std::uint64_t>(product >> (kDigitBits * k)) & kDigitMask;
    const std::uint64_t shifted = piece << (shift % kDigitBits);
    digits_[first + k] += sign * static_cast<std::int64_t>(shifted & kDigitMask);
    digits_[first + k + 1] += sign * static_cast<std::int64_t>(shifted >> kDigitBits);
  }
}

ExactSum::Digits ExactSum::carried(const Digits& digits) {
  Digits result = digits;
  for (int k = 0; k + 1 < kDigits; ++k) {
    result[k + 1] += result[k] >> kDigitBits;
    result[k] &= static_cast<std::int64_t>(kDigitMask);
  }
  return result;
}

ExactSum::Digits ExactSum::carried_magnitude(bool negate) const {
  Digits digits = digits_;
  if (negate) {
    std::transform(digits.begin(), digits.end(), digits.begin(), std::negate<>());
  }
  return carried(digits);
}

int ExactSum::sign() const {
  const Digits digits = carried(digits_);
  if (digits.back() < 0) {
    return -1;
  }
  return std::any_of(digits.begin(), digits.end(), [](std::int64_t d) { return d != 0; }) ? 1 : 0;
}

Interval ExactSum::enclosure() const {
  const int s = sign();
  if (s == 0) {
    return {};
  }
  const Digits digits = carried_magnitude(s < 0);
  int top = kDigits - 1;
  while (top > 2 && digits[top] == 0) {
    --top;
  }
  // Three digits hold at least 65 significant bits; what is below them is less than one unit.
  Interval value = std::ldexp(static_cast<long double>(digits[top]), 2 * kDigitBits);
  value += std::ldexp(static_cast<long double>(digits[top - 1]), kDigitBits);
  value += static_cast<long double>(digits[top - 2]);
  if (std::any_of(digits.begin(), digits.begin() + (top - 2),
                  [](std::int64_t d) { return d != 0; })) {
    value += Interval(0.0L, 1.0L);
  }
  const int exponent = kDigitBits * (top - 2) + kLowestExponent;
  const long double lower = std::ldexp(value.lower, exponent);
  const long double upper = std::ldexp(value.upper, exponent);
  return s > 0 ? Interval(lower, upper) : Interval(-upper, -lower);
}

}  // namespace signorini::lcp
