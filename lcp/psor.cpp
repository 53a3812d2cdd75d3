#include <signorini/lcp/psor.h>

namespace signorini::lcp {

void PsorSettings::validate() const {
  SweepSettings::validate();
  check_relaxation(relaxation);
}

std::string_view Psor::name() const {
  return settings_.precision == Precision::kFloat ? "psor-float" : "psor";
}

}  // namespace signorini::lcp
