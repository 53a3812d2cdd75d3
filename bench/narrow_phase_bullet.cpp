#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>

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

/// Bullet's shape, and what it points to.
struct BulletShape {
  std::unique_ptr<btTriangleMesh> triangles;
  std::unique_ptr<btCollisionShape> shape;
};

/// Bullet grows a hull by its margin: here none, for the hull that was given.
std::unique_ptr<btCollisionShape> bullet_hull(const collision::HullData& data, bool with_faces) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Vec3& vertex : data.vertices) {
    hull->addPoint(bullet(vertex));
  }
  hull->setMargin(0.0);
  if (with_faces) {
    hull->initializePolyhedralFeatures();
  }
  return hull;
}

BulletShape bullet_mesh(const collision::MeshData& data) {
  BulletShape result{std::make_unique<btTriangleMesh>(), nullptr};
  for (const auto& triangle : data.triangles) {
    result.triangles->addTriangle(bullet(data.vertices[triangle.vertices[0]]),
                                  bullet(data.vertices[triangle.vertices[1]]),
                                  bullet(data.vertices[triangle.vertices[2]]));
  }
  auto mesh = std::make_unique<btBvhTriangleMeshShape>(result.triangles.get(), true);
  mesh->setMargin(0.0);
  result.shape = std::move(mesh);
  return result;
}

BulletShape bullet_shape(const collision::Shape& shape, bool with_faces) {
  if (const auto* sphere = std::get_if<collision::Sphere>(&shape)) {
    return {nullptr, std::make_unique<btSphereShape>(sphere->radius)};
  }
  if (const auto* box = std::get_if<collision::Box>(&shape)) {
    return {nullptr, std::make_unique<btBoxShape>(bullet(box->half_extents))};
  }
  if (const auto* capsule = std::get_if<collision::Capsule>(&shape)) {
    return {nullptr,
            std::make_unique<btCapsuleShapeZ>(capsule->radius, 2.0 * capsule->half_length)};
  }
  if (const auto* cylinder = std::get_if<collision::Cylinder>(&shape)) {
    const double r = cylinder->radius;
    return {nullptr, std::make_unique<btCylinderShapeZ>(btVector3(r, r, cylinder->half_length))};
  }
  if (const auto* hull = std::get_if<collision::ConvexHull>(&shape)) {
    return {nullptr, bullet_hull(*hull->data, with_faces)};
  }
  if (const auto* mesh = std::get_if<collision::TriangleMesh>(&shape)) {
    return bullet_mesh(*mesh->data);
  }
  return {};
}

/// The algorithm that Bullet's dispatcher has for the two shapes, on a manifold emptied before each
/// query.
class BulletPair final : public NarrowPhasePeer {
 public:
  BulletPair(std::string name, BulletShape a, BulletShape b)
      : name_(std::move(name)),
        dispatcher_(&configuration_),
        shape_a_(std::move(a)),
        shape_b_(std::move(b)) {
    a_.setCollisionShape(shape_a_.shape.get());
    b_.setCollisionShape(shape_b_.shape.get());
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

  [[nodiscard]] std::string name() const override { return name_; }
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
        : a(nullptr, pair.shape_a_.shape.get(), &pair.a_, pair.a_.getWorldTransform(), -1, -1),
          b(nullptr, pair.shape_b_.shape.get(), &pair.b_, pair.b_.getWorldTransform(), -1, -1) {}
  };
  static btTransform transform(const Pose& pose) {
    const Quat& q = pose.orientation;
    return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), bullet(pose.position));
  }

  std::string name_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDispatcherInfo info_;
  BulletShape shape_a_;
  BulletShape shape_b_;
  btCollisionObject a_;
  btCollisionObject b_;
  btPersistentManifold* manifold_ = nullptr;
  bool is_ours_ = true;
  btCollisionAlgorithm* algorithm_ = nullptr;
};

}  // namespace

void add_bullet_narrow_phase(const collision::Shape& a, const collision::Shape& b,
                             NarrowPhasePeers& peers) {
  const bool has_hull = std::holds_alternative<collision::ConvexHull>(a) ||
                        std::holds_alternative<collision::ConvexHull>(b);
  for (const bool with_faces : {false, true}) {
    BulletShape shape_a = bullet_shape(a, with_faces);
    BulletShape shape_b = bullet_shape(b, with_faces);
    if (shape_a.shape == nullptr || shape_b.shape == nullptr || (with_faces && !has_hull)) {
      continue;
    }
    peers.push_back(std::make_unique<BulletPair>(with_faces ? "Bullet (faces)" : "Bullet",
                                                 std::move(shape_a), std::move(shape_b)));
  }
}

}  // namespace signorini::bench
