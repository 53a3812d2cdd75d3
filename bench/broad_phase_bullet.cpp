#include "bench/broad_phase_peer.h"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

namespace signorini::bench {
namespace {

btVector3 bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Two dynamic trees with fat bounds, and a hashed cache of pairs. Its pairs are those of the fat
/// bounds.
class BulletDbvt final : public BroadPhasePeer {
 public:
  explicit BulletDbvt(const std::vector<collision::Bounds>& start) {
    for (std::size_t i = 0; i < start.size(); ++i) {
      proxies_.push_back(broad_phase_.createProxy(bullet(start[i].low), bullet(start[i].high), 0,
                                                  nullptr, btBroadphaseProxy::DefaultFilter,
                                                  btBroadphaseProxy::AllFilter, nullptr));
      number_.resize(std::max<std::size_t>(number_.size(), proxies_.back()->m_uniqueId + 1));
      number_[proxies_.back()->m_uniqueId] = static_cast<int>(i);
    }
  }
  ~BulletDbvt() override {
    for (btBroadphaseProxy* proxy : proxies_) {
      broad_phase_.destroyProxy(proxy, nullptr);
    }
  }
  BulletDbvt(const BulletDbvt&) = delete;
  BulletDbvt& operator=(const BulletDbvt&) = delete;

  [[nodiscard]] std::string name() const override { return "Bullet btDbvtBroadphase"; }
  void step(const std::vector<collision::Bounds>& bounds,
            std::vector<std::pair<int, int>>& pairs) override {
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      broad_phase_.setAabb(proxies_[i], bullet(bounds[i].low), bullet(bounds[i].high), nullptr);
    }
    broad_phase_.calculateOverlappingPairs(nullptr);
    pairs.clear();
    const btBroadphasePairArray& found =
        broad_phase_.getOverlappingPairCache()->getOverlappingPairArray();
    for (int k = 0; k < found.size(); ++k) {
      pairs.emplace_back(number_[found[k].m_pProxy0->m_uniqueId],
                         number_[found[k].m_pProxy1->m_uniqueId]);
    }
  }

 private:
  btDbvtBroadphase broad_phase_;
  std::vector<btBroadphaseProxy*> proxies_;
  std::vector<int> number_;  ///< by Bullet's own id
};

}  // namespace

void add_bullet_broad_phases(const std::vector<collision::Bounds>& start, BroadPhasePeers& peers) {
  peers.push_back(std::make_unique<BulletDbvt>(start));
}

}  // namespace signorini::bench
