#include <signorini/lcp/mass_ratio.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {

double mass_ratio(const BlockMass& mass) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double most = 0.0;
  double least = kInfinity;
  for (int b = 0; b < mass.block_count(); ++b) {
    if (mass.dimension(b) > 0) {
      const double first = mass.stored(b)(0, 0);
      const double of_block = mass.is_factor(b) ? first * first : 1.0 / first;
      most = std::max(most, of_block);
      least = std::min(least, of_block);
    }
  }
  if (least == kInfinity && most == 0.0) {
    return 1.0;
  }
  return least > 0.0 && std::isfinite(most) ? most / least : kInfinity;
}

}  // namespace signorini::lcp
