#include <signorini/lcp/symmetric_pgs.h>

namespace signorini::lcp {
namespace {

template <typename T>
void there_and_back(Sweeps<T>& sweeps) {
  sweeps.forward();
  sweeps.backward();
}

}  // namespace

void SymmetricPgsSettings::validate() const {
  SweepSettings::validate();
  check_relaxation(relaxation);
}

std::string_view SymmetricPgs::name() const {
  return settings_.precision == Precision::kFloat ? "symmetric-pgs-float" : "symmetric-pgs";
}

void SymmetricPgs::advance(Sweeps<double>& sweeps) {
  there_and_back(sweeps);
}
void SymmetricPgs::advance(Sweeps<float>& sweeps) {
  there_and_back(sweeps);
}

}  // namespace signorini::lcp
