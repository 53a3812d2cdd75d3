#pragma once

#include <signorini/validation/report.h>

#include <string>

namespace signorini::validation {

/// What a check says beside its numbers.
struct CheckText {
  std::string name;
  std::string engine = "signorini";
  std::string reference = "closed form";
  std::string unit = {};
  std::string reason = {};
};

/// error = |value - expected|, judged against the tolerance.
[[nodiscard]] Check absolute(const CheckText& text, double value, double expected,
                             double tolerance);
/// error = |value - expected| / |expected|; expected must not be 0.
[[nodiscard]] Check relative(const CheckText& text, double value, double expected,
                             double tolerance);
/// value <= bound: expected 0, error = max(0, value), NaN fails.
[[nodiscard]] Check at_most(const CheckText& text, double value, double bound);
/// The same numbers without a verdict: what the other engine does.
[[nodiscard]] Check shown(const CheckText& text, double value, double expected);

}  // namespace signorini::validation
