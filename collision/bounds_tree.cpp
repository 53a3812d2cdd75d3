#include <signorini/collision/bounds_tree.h>

#include <numeric>
#include <tuple>

namespace signorini::collision {

BoundsTree::BoundsTree(const std::vector<Bounds>& items) {
  std::vector<int> order(items.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * items.size());
  if (!items.empty()) {
    build(items, order, 0, static_cast<int>(items.size()));
  }
}

int BoundsTree::build(const std::vector<Bounds>& items, std::vector<int>& order, int begin,
                      int end) {
  const int number = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Bounds all = items[order[begin]];
  const auto centre = [&](int item) { return Vec3(0.5 * (items[item].low + items[item].high)); };
  Vec3 low = centre(order[begin]);
  Vec3 high = low;
  for (int k = begin; k < end; ++k) {
    const Bounds& item = items[order[k]];
    all.low = all.low.cwiseMin(item.low);
    all.high = all.high.cwiseMax(item.high);
    low = low.cwiseMin(centre(order[k]));
    high = high.cwiseMax(centre(order[k]));
  }
  nodes_[number].bounds = all;
  if (end - begin == 1) {
    nodes_[number].item = order[begin];
    return number;
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(
      order.begin() + begin, order.begin() + middle, order.begin() + end,
      [&](int i, int j) { return std::pair(centre(i)[axis], i) < std::pair(centre(j)[axis], j); });
  build(items, order, begin, middle);
  const int second = build(items, order, middle, end);
  nodes_[number].second = second;
  return number;
}

}  // namespace signorini::collision
