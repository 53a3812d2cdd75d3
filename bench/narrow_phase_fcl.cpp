#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>

#include "bench/narrow_phase_peer.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

namespace signorini::bench {
namespace {

std::shared_ptr<fcl::CollisionGeometry<double>> fcl_hull(const collision::HullData& data) {
  auto vertices = std::make_shared<std::vector<Vec3>>(data.vertices);
  auto faces = std::make_shared<std::vector<int>>();
  for (const std::vector<int>& loop : data.faces) {
    faces->push_back(static_cast<int>(loop.size()));
    faces->insert(faces->end(), loop.begin(), loop.end());
  }
  return std::make_shared<fcl::Convex<double>>(vertices, static_cast<int>(data.faces.size()),
                                               faces);
}

std::shared_ptr<fcl::CollisionGeometry<double>> fcl_mesh(const collision::MeshData& data) {
  auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSS<double>>>();
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(data.triangles.size());
  for (const auto& triangle : data.triangles) {
    const auto& [i, j, k] = triangle.vertices;
    triangles.emplace_back(i, j, k);
  }
  mesh->beginModel();
  mesh->addSubModel(data.vertices, triangles);
  mesh->endModel();
  return mesh;
}

std::shared_ptr<fcl::CollisionGeometry<double>> fcl_shape(const collision::Shape& shape) {
  if (const auto* sphere = std::get_if<collision::Sphere>(&shape)) {
    return std::make_shared<fcl::Sphere<double>>(sphere->radius);
  }
  if (const auto* box = std::get_if<collision::Box>(&shape)) {
    return std::make_shared<fcl::Box<double>>(Vec3(2.0 * box->half_extents));
  }
  if (const auto* capsule = std::get_if<collision::Capsule>(&shape)) {
    return std::make_shared<fcl::Capsule<double>>(capsule->radius, 2.0 * capsule->half_length);
  }
  if (const auto* cylinder = std::get_if<collision::Cylinder>(&shape)) {
    return std::make_shared<fcl::Cylinder<double>>(cylinder->radius, 2.0 * cylinder->half_length);
  }
  if (const auto* hull = std::get_if<collision::ConvexHull>(&shape)) {
    return fcl_hull(*hull->data);
  }
  if (const auto* mesh = std::get_if<collision::TriangleMesh>(&shape)) {
    return fcl_mesh(*mesh->data);
  }
  return nullptr;
}

/// fcl::collide() with up to eight contacts. Its contacts have one point: half the depth is put on
/// either side of it.
class FclPair final : public NarrowPhasePeer {
 public:
  FclPair(std::shared_ptr<fcl::CollisionGeometry<double>> a,
          std::shared_ptr<fcl::CollisionGeometry<double>> b)
      : a_(std::move(a)), b_(std::move(b)), request_(8, true) {}

  [[nodiscard]] std::string name() const override { return "FCL"; }
  void query(const Pose& a, const Pose& b) override {
    result_.clear();
    fcl::collide(a_.get(), transform(a), b_.get(), transform(b), request_, result_);
  }
  void read(std::vector<Contact>& contacts) override {
    contacts.clear();
    for (std::size_t k = 0; k < result_.numContacts(); ++k) {
      const fcl::Contact<double>& found = result_.getContact(k);
      Contact contact;
      contact.normal = found.o1 == a_.get() ? Vec3(-found.normal) : Vec3(found.normal);
      contact.gap = -found.penetration_depth;
      contact.point_a = found.pos + 0.5 * contact.gap * contact.normal;
      contact.point_b = found.pos - 0.5 * contact.gap * contact.normal;
      contacts.push_back(contact);
    }
  }

 private:
  static fcl::Transform3<double> transform(const Pose& pose) {
    fcl::Transform3<double> result = fcl::Transform3<double>::Identity();
    result.linear() = pose.orientation.toRotationMatrix();
    result.translation() = pose.position;
    return result;
  }

  std::shared_ptr<fcl::CollisionGeometry<double>> a_;
  std::shared_ptr<fcl::CollisionGeometry<double>> b_;
  fcl::CollisionRequest<double> request_;
  fcl::CollisionResult<double> result_;
};

}  // namespace

void add_fcl_narrow_phase(const collision::Shape& a, const collision::Shape& b,
                          NarrowPhasePeers& peers) {
  auto shape_a = fcl_shape(a);
  auto shape_b = fcl_shape(b);
  if (shape_a != nullptr && shape_b != nullptr) {
    peers.push_back(std::make_unique<FclPair>(std::move(shape_a), std::move(shape_b)));
  }
}

}  // namespace signorini::bench
