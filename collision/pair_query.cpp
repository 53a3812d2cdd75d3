#include <signorini/collision/box_box.h>
#include <signorini/collision/capsule_pairs.h>
#include <signorini/collision/compound_pairs.h>
#include <signorini/collision/convex_pairs.h>
#include <signorini/collision/half_space_pairs.h>
#include <signorini/collision/mesh_pairs.h>
#include <signorini/collision/pair_query.h>
#include <signorini/collision/sphere_pairs.h>
#include <signorini/core/model/number_text.h>

#include <stdexcept>
#include <utility>

namespace signorini::collision {
namespace {

template <class T, class Variant>
struct IndexIn;
template <class T, class... Others>
struct IndexIn<T, std::variant<T, Others...>> : std::integral_constant<int, 0> {};
template <class T, class First, class... Others>
struct IndexIn<T, std::variant<First, Others...>>
    : std::integral_constant<int, 1 + IndexIn<T, std::variant<Others...>>::value> {};

/// Calls query(first, pose_first, second, pose_second, exchanged) with the shapes' own types in the
/// order of Shape's alternatives, in which the pairs are written; exchanged: `first` is B. A new
/// shape needs narrow::test, distance and find with every shape before it and itself, and nothing
/// here.
template <class Query>
auto visit_pair(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                Query&& query) {
  return std::visit(
      [&]<class ShapeA, class ShapeB>(const ShapeA& x, const ShapeB& y) {
        if constexpr (IndexIn<ShapeA, Shape>::value <= IndexIn<ShapeB, Shape>::value) {
          return query(x, pose_a, y, pose_b, false);
        } else {
          return query(y, pose_b, x, pose_a, true);
        }
      },
      a, b);
}

/// Two poses with B's position as the origin, so that the pairs work in small coordinates.
struct NearPoses {
  Vec3 origin;
  Pose a;
  Pose b;

  NearPoses(const Pose& pose_a, const Pose& pose_b)
      : origin(pose_b.position),
        a{pose_a.position - origin, pose_a.orientation.normalized()},
        b{Vec3::Zero(), pose_b.orientation.normalized()} {}
};

void check(const Shape& shape, const Pose& pose) {
  validate(shape);
  validate(pose);
}

void exchange_bodies(Contact& contact) {
  std::swap(contact.point_a, contact.point_b);
  std::swap(contact.surface_a, contact.surface_b);
  contact.normal = -contact.normal;
  contact.feature_id = exchanged(contact.feature_id);
  if (contact.owner == NormalOwner::kFaceA) {
    contact.owner = NormalOwner::kFaceB;
  } else if (contact.owner == NormalOwner::kFaceB) {
    contact.owner = NormalOwner::kFaceA;
  }
}

}  // namespace

bool test_intersection(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  check(a, pose_a);
  check(b, pose_b);
  const NearPoses poses(pose_a, pose_b);
  return visit_pair(a, poses.a, b, poses.b,
                    [](const auto& x, const Pose& pose_x, const auto& y, const Pose& pose_y, bool) {
                      return narrow::test(x, pose_x, y, pose_y);
                    });
}

void find_intersection(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                       double margin, std::vector<Contact>& contacts) {
  check(a, pose_a);
  check(b, pose_b);
  if (!(margin >= 0.0)) {
    throw std::invalid_argument("find_intersection: margin: must be >= 0, got " +
                                number_text(margin) + " m");
  }
  contacts.clear();
  const NearPoses poses(pose_a, pose_b);
  visit_pair(
      a, poses.a, b, poses.b,
      [&](const auto& x, const Pose& pose_x, const auto& y, const Pose& pose_y, bool is_exchanged) {
        narrow::find(x, pose_x, y, pose_y, margin, contacts);
        if (is_exchanged) {
          for (Contact& contact : contacts) {
            exchange_bodies(contact);
          }
        }
      });
  for (Contact& contact : contacts) {
    contact.point_a += poses.origin;
    contact.point_b += poses.origin;
  }
}

double signed_distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  check(a, pose_a);
  check(b, pose_b);
  const NearPoses poses(pose_a, pose_b);
  return visit_pair(a, poses.a, b, poses.b,
                    [](const auto& x, const Pose& pose_x, const auto& y, const Pose& pose_y, bool) {
                      return narrow::distance(x, pose_x, y, pose_y);
                    });
}

}  // namespace signorini::collision
