#include <signorini/collision/sweep.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace signorini::collision {
namespace {

/// The axis of the largest variance of the centres that are finite.
int widest_axis(const std::vector<Bounds>& bounds) {
  Vec3 sum = Vec3::Zero();
  Vec3 squares = Vec3::Zero();
  double count = 0.0;
  for (const Bounds& b : bounds) {
    const Vec3 centre = 0.5 * (b.low + b.high);
    if (centre.allFinite()) {
      sum += centre;
      squares += centre.cwiseAbs2();
      count += 1.0;
    }
  }
  int axis = 0;
  if (count > 0.0) {
    (squares - sum.cwiseAbs2() / count).maxCoeff(&axis);
  }
  return axis;
}

}  // namespace

void overlapping_pairs(const std::vector<Bounds>& bounds, std::vector<std::pair<int, int>>& pairs) {
  pairs.clear();
  const int axis = widest_axis(bounds);
  std::vector<int> order(bounds.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    return std::pair(bounds[i].low[axis], i) < std::pair(bounds[j].low[axis], j);
  });

  std::vector<int> open;  // those whose high end was not reached yet
  for (const int i : order) {
    std::erase_if(open, [&](int j) { return bounds[j].high[axis] < bounds[i].low[axis]; });
    for (const int j : open) {
      if (bounds[i].overlaps(bounds[j])) {
        pairs.emplace_back(std::min(i, j), std::max(i, j));
      }
    }
    open.push_back(i);
  }
  std::sort(pairs.begin(), pairs.end());
}

}  // namespace signorini::collision
