#include "bench/broad_phase_peer.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision_object.h>

namespace signorini::bench {
namespace {

using Object = fcl::CollisionObject<double>;
using Pairs = std::vector<std::pair<int, int>>;

/// Refit each step, collided with itself.
class FclTree final : public BroadPhasePeer {
 public:
  explicit FclTree(const std::vector<collision::Bounds>& start) : number_(start.size()) {
    for (std::size_t i = 0; i < start.size(); ++i) {
      objects_.push_back(std::make_unique<Object>(
          std::make_shared<fcl::Box<double>>(Vec3(start[i].high - start[i].low))));
      number_[i] = static_cast<int>(i);
      objects_[i]->setUserData(&number_[i]);
    }
    move_to(start);
    std::vector<Object*> all;
    for (const auto& object : objects_) {
      all.push_back(object.get());
    }
    manager_.registerObjects(all);
    manager_.setup();
  }

  [[nodiscard]] std::string name() const override { return "FCL dynamic AABB tree"; }
  void step(const std::vector<collision::Bounds>& bounds, Pairs& pairs) override {
    pairs.clear();
    move_to(bounds);
    manager_.update();
    manager_.collide(&pairs, [](Object* a, Object* b, void* found) {
      static_cast<Pairs*>(found)->emplace_back(*static_cast<int*>(a->getUserData()),
                                               *static_cast<int*>(b->getUserData()));
      return false;
    });
  }

 private:
  void move_to(const std::vector<collision::Bounds>& bounds) {
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      objects_[i]->setTranslation(0.5 * (bounds[i].low + bounds[i].high));
      objects_[i]->computeAABB();
    }
  }

  std::vector<std::unique_ptr<Object>> objects_;
  std::vector<int> number_;
  fcl::DynamicAABBTreeCollisionManager<double> manager_;
};

}  // namespace

void add_fcl_broad_phases(const std::vector<collision::Bounds>& start, BroadPhasePeers& peers) {
  peers.push_back(std::make_unique<FclTree>(start));
}

}  // namespace signorini::bench
