#include <signorini/collision/compound.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>
#include <signorini/validation/bullet_shapes.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

namespace signorini::validation {
namespace {

/// Of cones and hulls, whose collision margin lies outside, as a part of their smallest size.
constexpr double kMargin = 1e-3;

btVector3 bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// An ellipsoid by its support function. Bullet adds the margin m to what the shape says, so the
/// shape says the body whose points lie m further in along the normal; that body is convex while m
/// is below the least radius of curvature, min^2 / max of the radii.
class BulletEllipsoid final : public btConvexInternalShape {
 public:
  explicit BulletEllipsoid(const Vec3& radii) : radii_(bullet(radii)) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
    setMargin(0.5 * radii.minCoeff() * radii.minCoeff() / radii.maxCoeff());
  }

  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& direction) const override {
    const btScalar length = direction.length();
    const btVector3 n = length > 0.0 ? direction / length : btVector3(1.0, 0.0, 0.0);
    const btVector3 scaled = radii_ * n;
    return radii_ * scaled / scaled.length() - getMargin() * n;
  }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* directions,
                                                         btVector3* vertices,
                                                         int count) const override {
    for (int i = 0; i < count; ++i) {
      vertices[i] = localGetSupportingVertexWithoutMargin(directions[i]);
    }
  }
  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override {
    const btVector3 squares = radii_ * radii_;
    inertia =
        mass / 5.0 *
        btVector3(squares.y() + squares.z(), squares.z() + squares.x(), squares.x() + squares.y());
  }
  void getAabb(const btTransform& pose, btVector3& low, btVector3& high) const override {
    // The half extent along an axis is the support in its direction.
    btVector3 half;
    for (int k = 0; k < 3; ++k) half[k] = (radii_ * pose.getBasis().getRow(k)).length();
    low = pose.getOrigin() - half;
    high = pose.getOrigin() + half;
  }
  const char* getName() const override { return "Ellipsoid"; }

 private:
  btVector3 radii_;
};

class ShapeMaker {
 public:
  explicit ShapeMaker(double ground_half_edge) : ground_half_edge_(ground_half_edge) {}

  BulletShape operator()(const collision::Sphere& s) const {
    return plain(std::make_unique<btSphereShape>(s.radius));
  }
  BulletShape operator()(const collision::Box& s) const {
    auto box = std::make_unique<btBoxShape>(bullet(s.half_extents));
    box->initializePolyhedralFeatures();  // against hulls; boxes have their own algorithm
    return plain(std::move(box));
  }
  BulletShape operator()(const collision::Capsule& s) const {
    return plain(std::make_unique<btCapsuleShapeZ>(s.radius, 2.0 * s.half_length));
  }
  BulletShape operator()(const collision::Cylinder& s) const {
    return plain(std::make_unique<btCylinderShapeZ>(btVector3(s.radius, s.radius, s.half_length)));
  }
  BulletShape operator()(const collision::Cone& s) const {
    auto cone = std::make_unique<btConeShapeZ>(s.radius, 2.0 * s.half_height);
    const double margin = kMargin * std::min(s.radius, 2.0 * s.half_height);
    cone->setMargin(margin);
    return {.mesh = nullptr,
            .shape = std::move(cone),
            .in_ours = {},
            .remark = "cones are larger than ours by a collision margin of 1/1000 of their size"};
  }
  BulletShape operator()(const collision::Ellipsoid& s) const {
    return {.mesh = nullptr,
            .shape = std::make_unique<BulletEllipsoid>(s.radii),
            .in_ours = {},
            .remark =
                "ellipsoids, which Bullet lacks, are convex shapes by their exact support "
                "function"};
  }
  BulletShape operator()(const collision::ConvexHull& s) const {
    auto hull = std::make_unique<btConvexHullShape>();
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (const Vec3& vertex : s.data->vertices) {
      hull->addPoint(bullet(vertex), false);
      low = low.cwiseMin(vertex);
      high = high.cwiseMax(vertex);
    }
    hull->setMargin(kMargin * (high - low).minCoeff());
    hull->recalcLocalAabb();
    hull->initializePolyhedralFeatures();
    return {.mesh = nullptr,
            .shape = std::move(hull),
            .in_ours = {},
            .remark = "hulls are larger than ours by a collision margin of 1/1000 of their size"};
  }
  BulletShape operator()(const collision::HalfSpace&) const {
    // The top face of a large box is its surface.
    const double edge = ground_half_edge_;
    BulletShape result = (*this)(collision::Box{Vec3::Constant(edge)});
    result.in_ours.position = Vec3(0.0, 0.0, -edge);
    return result;
  }
  BulletShape operator()(const collision::TriangleMesh& s) const {
    auto triangles = std::make_unique<btTriangleMesh>();
    for (const auto& triangle : s.data->triangles) {
      const auto& [a, b, c] = triangle.vertices;
      triangles->addTriangle(bullet(s.data->vertices[a]), bullet(s.data->vertices[b]),
                             bullet(s.data->vertices[c]));
    }
    auto mesh = std::make_unique<btBvhTriangleMeshShape>(triangles.get(), true);
    mesh->setMargin(0.0);
    return {.mesh = std::move(triangles),
            .shape = std::move(mesh),
            .in_ours = {},
            .remark =
                "meshes and height fields are btBvhTriangleMeshShape without margin, whose "
                "inner edges make contacts of their own"};
  }
  BulletShape operator()(const collision::Compound&) const { return {}; }  // taken apart below

 private:
  static BulletShape plain(std::unique_ptr<btCollisionShape> shape) {
    return {.mesh = nullptr, .shape = std::move(shape), .in_ours = {}, .remark = ""};
  }

  double ground_half_edge_;
};

}  // namespace

std::vector<BulletShape> make_bullet_shapes(const collision::Shape& shape,
                                            double ground_half_edge) {
  const ShapeMaker make(ground_half_edge);
  std::vector<BulletShape> result;
  const auto* compound = std::get_if<collision::Compound>(&shape);
  if (compound == nullptr) {
    result.push_back(std::visit(make, shape));
    return result;
  }
  for (const collision::CompoundPart& part : compound->data->parts) {
    result.push_back(std::visit(make, part.shape));
    result.back().in_ours = part.local * result.back().in_ours;
  }
  return result;
}

}  // namespace signorini::validation
