#include "bench/broad_phase_peer.h"

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

namespace signorini::bench {
namespace {

namespace geometry = boost::geometry;
using Point = geometry::model::point<double, 3, geometry::cs::cartesian>;
using BoostBox = geometry::model::box<Point>;
using Value = std::pair<BoostBox, int>;
using Tree = geometry::index::rtree<Value, geometry::index::quadratic<16>>;

BoostBox boost_box(const collision::Bounds& b) {
  return {Point(b.low.x(), b.low.y(), b.low.z()), Point(b.high.x(), b.high.y(), b.high.z())};
}

/// Packed anew each step (its bulk loading; moving values means removing and inserting them, which
/// is slower), then one query a body.
class BoostRTree final : public BroadPhasePeer {
 public:
  [[nodiscard]] std::string name() const override { return "Boost.Geometry R-tree, packed"; }
  void step(const std::vector<collision::Bounds>& bounds,
            std::vector<std::pair<int, int>>& pairs) override {
    values_.clear();
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      values_.emplace_back(boost_box(bounds[i]), static_cast<int>(i));
    }
    const Tree tree(values_);
    pairs.clear();
    for (const auto& [box, i] : values_) {
      for (auto it = tree.qbegin(geometry::index::intersects(box)); it != tree.qend(); ++it) {
        if (i < it->second) {
          pairs.emplace_back(i, it->second);
        }
      }
    }
  }

 private:
  std::vector<Value> values_;
};

}  // namespace

void add_boost_broad_phases(const std::vector<collision::Bounds>&, BroadPhasePeers& peers) {
  peers.push_back(std::make_unique<BoostRTree>());
}

}  // namespace signorini::bench
