#include <signorini/validation/checks.h>

#include <cmath>

namespace signorini::validation {
namespace {

Check filled(const CheckText& text, double value, double expected) {
  Check check;
  check.name = text.name;
  check.engine = text.engine;
  check.reference = text.reference;
  check.unit = text.unit;
  check.reason = text.reason;
  check.value = value;
  check.expected = expected;
  check.error = std::abs(value - expected);
  check.error_kind = "absolute";
  return check;
}

Check judged(Check check, double tolerance) {
  check.tolerance = tolerance;
  check.verdict = judge(check.error, tolerance);
  return check;
}

}  // namespace

Check absolute(const CheckText& text, double value, double expected, double tolerance) {
  return judged(filled(text, value, expected), tolerance);
}

Check relative(const CheckText& text, double value, double expected, double tolerance) {
  Check check = filled(text, value, expected);
  check.error = std::abs(value - expected) / std::abs(expected);
  check.error_kind = "relative";
  return judged(check, tolerance);
}

Check at_most(const CheckText& text, double value, double bound) {
  Check check = filled(text, value, 0.0);
  check.error = std::isnan(value) ? value : std::fmax(0.0, value);
  return judged(check, bound);
}

Check shown(const CheckText& text, double value, double expected) {
  return filled(text, value, expected);
}

}  // namespace signorini::validation
