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

}  // namespace

void validate(const Material& material) {
  if (!(material.friction >= 0.0) || !std::isfinite(material.friction)) {
    throw std::invalid_argument("material: friction: must be finite and >= 0, got " +
                                number_text(material.friction));
  }
  if (!(material.restitution >= 0.0 && material.restitution <= 1.0)) {
    throw std::invalid_argument("material: restitution: must be in [0, 1], got " +
                                number_text(material.restitution));
  }
}

Material pair(const Material& a, const Material& b, PairingRule rule) {
  return {combine(a.friction, b.friction, rule), combine(a.restitution, b.restitution, rule)};
}

}  // namespace signorini
