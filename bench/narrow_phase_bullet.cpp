#include "bench/narrow_phase_peer.h"

#include <btBulletCollisionCommon.h>

namespace signorini::bench {
namespace {

btVector3 bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

std::unique_ptr<btCollisionShape> bullet_shape(const collision::Shape& shape) {
  if (const auto* sphere = std::get_if<collision::Sphere>(&shape)) {
    return std::make_unique<btSphereShape>(sphere->radius);
  }
  if (const auto* box = std::get_if<collision::Box>(&shape)) {
    return std::make_unique<btBoxShape>(bullet(box->half_extents));
  }
  return nullptr;
}

/// The algorithm that Bullet's dispatcher has for the two shapes, on a manifold emptied before each
/// query.
class BulletPair final : public NarrowPhasePeer {
 public:
  BulletPair(std::unique_ptr<btCollisionShape> a, std::unique_ptr<btCollisionShape> b)
      : dispatcher_(&configuration_), shape_a_(std::move(a)), shape_b_(std::move(b)) {
    a_.setCollisionShape(shape_a_.get());
    b_.setCollisionShape(shape_b_.get());
    manifold_ = dispatcher_.getNewManifold(&a_, &b_);
    const Wrapped wrapped(*this);
    algorithm_ =
        dispatcher_.findAlgorithm(&wrapped.a, &wrapped.b, manifold_, BT_CONTACT_POINT_ALGORITHMS);
    query(Pose{}, Pose{});
    btManifoldArray own;  // two boxes make their own
    algorithm_->getAllContactManifolds(own);
    if (own.size() > 0) {
      dispatcher_.releaseManifold(manifold_);
      manifold_ = own[0];
      is_ours_ = false;
    }
  }
  ~BulletPair() override {
    algorithm_->~btCollisionAlgorithm();  // and its own manifold
    dispatcher_.freeCollisionAlgorithm(algorithm_);
    if (is_ours_) {
      dispatcher_.releaseManifold(manifold_);
    }
  }
  BulletPair(const BulletPair&) = delete;
  BulletPair& operator=(const BulletPair&) = delete;

  [[nodiscard]] std::string name() const override { return "Bullet"; }
  void query(const Pose& a, const Pose& b) override {
    a_.setWorldTransform(transform(a));
    b_.setWorldTransform(transform(b));
    manifold_->clearManifold();
    const Wrapped wrapped(*this);
    btManifoldResult result(&wrapped.a, &wrapped.b);
    result.setPersistentManifold(manifold_);
    algorithm_->processCollision(&wrapped.a, &wrapped.b, info_, &result);
  }
  void read(std::vector<Contact>& contacts) override {
    contacts.clear();
    const bool is_exchanged = manifold_->getBody0() != &a_;
    for (int k = 0; k < manifold_->getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold_->getContactPoint(k);
      Contact contact;
      contact.point_a = ours(point.getPositionWorldOnA());
      contact.point_b = ours(point.getPositionWorldOnB());
      contact.normal = ours(point.m_normalWorldOnB);
      contact.gap = point.getDistance();
      if (is_exchanged) {
        std::swap(contact.point_a, contact.point_b);
        contact.normal = -contact.normal;
      }
      contacts.push_back(contact);
    }
  }

 private:
  struct Wrapped {
    btCollisionObjectWrapper a;
    btCollisionObjectWrapper b;
    explicit Wrapped(const BulletPair& pair)
        : a(nullptr, pair.shape_a_.get(), &pair.a_, pair.a_.getWorldTransform(), -1, -1),
          b(nullptr, pair.shape_b_.get(), &pair.b_, pair.b_.getWorldTransform(), -1, -1) {}
  };
  static btTransform transform(const Pose& pose) {
    const Quat& q = pose.orientation;
    return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), bullet(pose.position));
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDispatcherInfo info_;
  std::unique_ptr<btCollisionShape> shape_a_;
  std::unique_ptr<btCollisionShape> shape_b_;
  btCollisionObject a_;
  btCollisionObject b_;
  btPersistentManifold* manifold_ = nullptr;
  bool is_ours_ = true;
  btCollisionAlgorithm* algorithm_ = nullptr;
};

}  // namespace

void add_bullet_narrow_phase(const collision::Shape& a, const collision::Shape& b,
                             NarrowPhasePeers& peers) {
  auto shape_a = bullet_shape(a);
  auto shape_b = bullet_shape(b);
  if (shape_a != nullptr && shape_b != nullptr) {
    peers.push_back(std::make_unique<BulletPair>(std::move(shape_a), std::move(shape_b)));
  }
}

}  // namespace signorini::bench
