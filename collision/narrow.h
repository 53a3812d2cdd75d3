#pragma once
// What every pair of shapes implements, and nothing else includes: the functions of a pair are
// overloads of these three names in namespace narrow, for one order of the two shapes (the order of
// the alternatives of Shape). pair_query.cpp exchanges A and B where needed, checks the input, and
// moves the origin near the shapes, so that the pairs work in small coordinates.
//
//   bool   test(a, pose_a, b, pose_b);
//   double distance(a, pose_a, b, pose_b);
//   void   find(a, pose_a, b, pose_b, margin, contacts);   // contacts comes empty

#include <signorini/collision/feature_id.h>
#include <signorini/collision/shape.h>
#include <signorini/core/model/contact.h>

namespace signorini::collision::narrow {

/// A contact with body_a = 0, body_b = 1 and the points gap apart along the normal.
[[nodiscard]] inline Contact make_contact(const Vec3& point_a, const Vec3& point_b,
                                          const Vec3& normal, double gap,
                                          std::uint64_t feature_pair, NormalOwner owner) {
  Contact contact;
  contact.body_a = 0;
  contact.body_b = 1;
  contact.point_a = point_a;
  contact.point_b = point_b;
  contact.normal = normal;
  contact.gap = gap;
  contact.feature_id = feature_pair;
  contact.owner = owner;
  return contact;
}

}  // namespace signorini::collision::narrow
