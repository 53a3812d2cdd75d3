#include <signorini/lcp/shifted_system.h>

namespace signorini::lcp {

bool ShiftedSystem::factor(const Vector& e, double proximal) {
  if (factored_ && proximal == proximal_ && e.size() == e_.size() && e == e_) {
    return true;
  }
  ++factorizations_;
  factored_ = factor_new(e, proximal);
  proximal_ = proximal;
  e_ = e;
  return factored_;
}

void ShiftedSystem::forget_factor() {
  factored_ = false;
  factorizations_ = 0;
}

}  // namespace signorini::lcp
