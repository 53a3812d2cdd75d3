#pragma once

#include <signorini/collision/bounds.h>

#include <algorithm>
#include <vector>

namespace signorini::collision {

/// A hierarchy of bounds that do not move: each node's two children split its items at the median
/// of their centres along the axis on which these spread most. Leaves hold one item.
class BoundsTree {
 public:
  BoundsTree() = default;
  /// @param items finite bounds. Cost: n log n.
  explicit BoundsTree(const std::vector<Bounds>& items);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  /// Of all items. @pre not empty
  [[nodiscard]] const Bounds& all() const { return nodes_.front().bounds; }

  /// visit(item) for every item whose bounds overlap these.
  template <class Visit>
  void visit_overlaps(const Bounds& bounds, Visit&& visit) const {
    if (!empty()) {
      visit_overlaps(0, bounds, visit);
    }
  }

  /// The least of value(item), a number that is nowhere less than the distance of the item's bounds
  /// from these, as far as it is > 0: near items first, far ones not at all.
  /// @return `least` if no item has less
  template <class Value>
  [[nodiscard]] double least(const Bounds& bounds, double least, Value&& value) const {
    if (!empty()) {
      find_least(0, bounds, least, value);
    }
    return least;
  }

 private:
  struct Node {
    Bounds bounds;
    int second = -1;  ///< of the two children; the first is the next node. -1: a leaf
    int item = -1;
  };

  int build(const std::vector<Bounds>& items, std::vector<int>& order, int begin, int end);

  template <class Visit>
  void visit_overlaps(int number, const Bounds& bounds, Visit& visit) const {
    const Node& node = nodes_[number];
    if (!node.bounds.overlaps(bounds)) {
      return;
    }
    if (node.second < 0) {
      visit(node.item);
      return;
    }
    visit_overlaps(number + 1, bounds, visit);
    visit_overlaps(node.second, bounds, visit);
  }

  template <class Value>
  void find_least(int number, const Bounds& bounds, double& least, Value& value) const {
    const Node& node = nodes_[number];
    if (node.second < 0) {
      least = std::min(least, value(node.item));
      return;
    }
    int near = number + 1;
    int far = node.second;
    double near_distance = nodes_[near].bounds.distance(bounds);
    double far_distance = nodes_[far].bounds.distance(bounds);
    if (far_distance < near_distance) {
      std::swap(near, far);
      std::swap(near_distance, far_distance);
    }
    if (near_distance <= std::max(least, 0.0)) {
      find_least(near, bounds, least, value);
    }
    if (far_distance <= std::max(least, 0.0)) {
      find_least(far, bounds, least, value);
    }
  }

  std::vector<Node> nodes_;
};

}  // namespace signorini::collision
