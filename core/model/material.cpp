#include <signorini/core/model/material.h>
#include <signorini/core/model/number_text.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace signorini {
namespace {

double combine(double a, double b, PairingRule rule) {
  switch (rule) {
    case PairingRule::kMultiply: return a * b;
    case PairingRule::kMinimum: return std::min(a, b);
    case PairingRule::kMaximum: return std::max(a, b);
    case PairingRule::kMean: return 0.5 * (a + b);
  }
  throw std::invalid_argument("pairing rule: not one of the four rules");
}

void require_not_negative(double value, const char* field, const char* unit) {
  if (!(value >= 0.0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string("material: ") + field +
                                ": must be finite and >= 0, got " + number_text(value) + unit);
  }
}

}  // namespace

void validate(const Material& material) {
  require_not_negative(material.friction, "friction", "");
  require_not_negative(material.rolling_friction, "rolling_friction", " m");
  require_not_negative(material.spinning_friction, "spinning_friction", " m");
  if (!(material.friction_ratio > 0.0) || !std::isfinite(material.friction_ratio)) {
    throw std::invalid_argument("material: friction_ratio: must be finite and > 0, got " +
                                number_text(material.friction_ratio));
  }
  if (!(material.restitution >= 0.0 && material.restitution <= 1.0)) {
    throw std::invalid_argument("material: restitution: must be in [0, 1], got " +
                                number_text(material.restitution));
  }
}

Material pair(const Material& a, const Material& b, PairingRule rule) {
  Material both{combine(a.friction, b.friction, rule), combine(a.restitution, b.restitution, rule)};
  if (both.friction > 0.0 && (a.friction_ratio != 1.0 || b.friction_ratio != 1.0)) {
    const double across =
        combine(a.friction * a.friction_ratio, b.friction * b.friction_ratio, rule);
    both.friction_ratio = across / both.friction;
  }
  both.rolling_friction = std::max(a.rolling_friction, b.rolling_friction);
  both.spinning_friction = std::max(a.spinning_friction, b.spinning_friction);
  return both;
}

}  // namespace signorini
