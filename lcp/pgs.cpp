#include <signorini/lcp/pgs.h>

namespace signorini::lcp {

std::string_view Pgs::name() const {
  return settings_.precision == Precision::kFloat ? "pgs-float" : "pgs";
}

}  // namespace signorini::lcp
