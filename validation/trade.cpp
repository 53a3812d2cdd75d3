#include <signorini/validation/trade.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::validation {
namespace {

/// What remains of an error when what cannot be seen counts as equal.
double seen(double error, const Trade& trade) {
  return std::max(error, kEqualErrors * trade.scale);
}

Loss against_ours(const Trade& trade, std::size_t theirs) {
  const TradePoint& their = trade.points[theirs];
  Loss loss{.theirs = theirs, .factor = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    const TradePoint& our = trade.points[i];
    if (our.engine != "signorini" || std::isnan(our.error)) continue;
    if (seen(our.error, trade) > seen(their.error, trade)) continue;
    const double factor = our.whole_seconds / their.whole_seconds;
    if (factor >= loss.factor) continue;
    loss.reached = true;
    loss.ours = i;
    loss.factor = factor;
  }
  return loss;
}

}  // namespace

std::vector<Loss> losses(const Trade& trade) {
  std::vector<Loss> found;
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    if (trade.points[i].engine == "signorini" || !(trade.points[i].error < trade.scale)) continue;
    const Loss loss = against_ours(trade, i);
    if (loss.factor > 1.0) found.push_back(loss);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Loss& a, const Loss& b) { return a.factor > b.factor; });
  return found;
}

}  // namespace signorini::validation
