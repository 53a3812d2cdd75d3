#include <signorini/collision/convex_contacts.h>
#include <signorini/collision/mesh_pairs.h>
#include <signorini/collision/segments.h>
#include <signorini/collision/separation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::collision {
namespace {

using Kind = Stratum::Kind;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBelongs = 1e-6;
/// Of separate(): nearer than this, relative to the smaller size, cores count as touching.
constexpr double kTouch = 1e-4;

// Features of one triangle: corner k is k, edge k is kEdges + k.
constexpr Feature kEdges = 3;
constexpr Feature kFront = 6;
constexpr Feature kBack = 7;

/// A triangle as a flat convex polyhedron with two faces.
class TriangleCore final : public Convex {
 public:
  explicit TriangleCore(const Triangle& triangle)
      : Convex(centre_of(triangle), size_of(triangle), 0.0), triangle_(triangle) {}

  [[nodiscard]] const Triangle& triangle() const { return triangle_; }
  /// The piece of an edge at a parameter of Triangle::edge_of().
  [[nodiscard]] Stratum piece_at(int edge, double t) const {
    const double half = triangle_.edge_of(edge).half;
    if (std::abs(t) < half) {
      return edge_piece(edge);
    }
    return vertex_piece(t < 0.0 ? edge : (edge + 1) % 3);
  }

  [[nodiscard]] Vec3 support(const Vec3& n) const override {
    return triangle_.corners[furthest(n)];
  }

  void add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const override {
    const int v = furthest(n);
    std::array<bool, 3> is_near{false, false, false};
    is_near[v] = true;
    int edges = 0;
    for (const int k : {v, (v + 2) % 3}) {
      const Stratum stratum = edge_piece(k);
      if (std::abs(stratum.axis.dot(n)) <= angle) {
        strata.push_back(stratum);
        is_near[k] = is_near[(k + 1) % 3] = true;
        ++edges;
      }
    }
    for (int k = 0; k < 3; ++k) {
      if (is_near[k]) {
        strata.push_back(vertex_piece(k));
      }
    }
    if (edges == 2) {
      strata.push_back(edge_piece((v + 1) % 3));
    }
    const Vec3& normal = triangle_.normal;
    if (normal.cross(n).norm() <= std::max(angle, 1e-15)) {
      Stratum face;
      face.kind = Kind::kFace;
      face.feature = normal.dot(n) > 0.0 ? kFront : kBack;
      face.anchor = triangle_.corners[v];
      face.axis = normal.dot(n) > 0.0 ? normal : Vec3(-normal);
      face.area = kFirst;
      strata.push_back(face);
    }
  }

  void facet(const Vec3& n, Facet& facet) const override {
    const Vec3& normal = triangle_.normal;
    if (std::abs(normal.dot(n)) < kEdgeOn * n.norm()) {
      facet_edge_on(n, facet);
      return;
    }
    const bool is_front = normal.dot(n) >= 0.0;
    facet.reset(is_front ? kFront : kBack, is_front ? normal : Vec3(-normal));
    for (int i = 0; i < 3; ++i) {
      const int k = is_front ? i : 2 - i;
      const int edge = is_front ? k : (k + 2) % 3;
      facet.corners.push_back({triangle_.corners[k], static_cast<Feature>(k),
                               kEdges + static_cast<Feature>(edge), LocalSurface::vertex()});
    }
  }

 private:
  /// Sine of the angle between n and the plane below which n sees edges and corners, no face.
  static constexpr double kEdgeOn = 1e-3;

  /// The edge that lies across n, or the corner that is furthest along it.
  void facet_edge_on(const Vec3& n, Facet& facet) const {
    const int v = furthest(n);
    const auto add = [&](int k) {
      facet.corners.push_back({triangle_.corners[k], static_cast<Feature>(k),
                               kEdges + static_cast<Feature>(k), LocalSurface::vertex()});
    };
    for (const int k : {v, (v + 2) % 3}) {
      if (std::abs(triangle_.edge_of(k).axis.dot(n)) < kEdgeOn * n.norm()) {
        facet.reset(kEdges + static_cast<Feature>(k), n.normalized());
        add(k);
        add((k + 1) % 3);
        return;
      }
    }
    facet.reset(static_cast<Feature>(v), n.normalized());
    add(v);
  }

  /// More than any other face has: of two faces that meet flat, the triangle's carries the normal.
  static constexpr double kFirst = 1e300;

  static Vec3 centre_of(const Triangle& triangle) {
    return (triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0;
  }
  static double size_of(const Triangle& triangle) {
    const Vec3 centre = centre_of(triangle);
    double squared = 0.0;
    for (const Vec3& corner : triangle.corners) {
      squared = std::max(squared, (corner - centre).squaredNorm());
    }
    return std::sqrt(squared);
  }
  [[nodiscard]] int furthest(const Vec3& n) const {
    int best = 0;
    for (int k = 1; k < 3; ++k) {
      if (n.dot(triangle_.corners[k] - triangle_.corners[best]) > 0.0) {
        best = k;
      }
    }
    return best;
  }
  [[nodiscard]] Stratum vertex_piece(int k) const {
    Stratum vertex;
    vertex.feature = static_cast<Feature>(k);
    vertex.anchor = triangle_.corners[k];
    return vertex;
  }
  [[nodiscard]] Stratum edge_piece(int k) const {
    const LineSegment edge = triangle_.edge_of(k);
    Stratum stratum;
    stratum.kind = Kind::kLine;
    stratum.feature = kEdges + static_cast<Feature>(k);
    stratum.anchor = triangle_.corners[k];
    stratum.axis = edge.axis;
    stratum.range = {0.0, 2.0 * edge.half};
    stratum.ends = {static_cast<Feature>(k), static_cast<Feature>((k + 1) % 3)};
    return stratum;
  }

  Triangle triangle_;
};

TriangleCore core_of(const PlacedMesh& mesh, int t) {
  const MeshData::Triangle& of_mesh = mesh.data.triangles[t];
  Triangle triangle;
  for (int k = 0; k < 3; ++k) {
    triangle.corners[k] = mesh.axes * mesh.data.vertices[of_mesh.vertices[k]] + mesh.position;
  }
  triangle.normal = mesh.axes * of_mesh.normal;
  return TriangleCore(triangle);
}

/// How A meets one triangle.
struct TriangleMeeting {
  double distance = kInfinity;
  bool counts = false;  ///< the normal of that distance belongs to the edge or vertex that it is at
  FacingFace face;      ///< the triangle's, on the side on which A is least deep; else it counts
};

FacingFace least_deep_face(const Convex& a, const Triangle& triangle) {
  const auto separation = [&](const Vec3& n) {
    return n.dot(a.support(-n) - triangle.corners[0]) - a.rounding();
  };
  const double front = separation(triangle.normal);
  const double back = separation(-triangle.normal);
  return front >= back ? FacingFace{false, triangle.normal, front}
                       : FacingFace{false, -triangle.normal, back};
}

/// No vertex next to the feature reaches further along N than it.
bool belongs(const PlacedMesh& mesh, int t, const Stratum& piece, const Vec3& N) {
  if (piece.kind == Kind::kFace) {
    return true;
  }
  const MeshData::Triangle& triangle = mesh.data.triangles[t];
  const bool is_edge = piece.kind == Kind::kLine;
  const int k = static_cast<int>(is_edge ? piece.feature - kEdges : piece.feature);
  const Vec3& at = mesh.data.vertices[triangle.vertices[k]];
  const Vec3 along = mesh.axes.transpose() * N;
  const std::vector<int>& others =
      is_edge ? mesh.data.opposite[triangle.edges[k]] : mesh.data.neighbours[triangle.vertices[k]];
  return std::all_of(others.begin(), others.end(), [&](int v) {
    const Vec3 to = mesh.data.vertices[v] - at;
    return along.dot(to) <= kBelongs * to.norm();
  });
}

/// Are A and the triangle further apart than `reach` along one of the directions that lie in its
/// plane across its edges? (Then they are further apart.)
bool is_beside(const Convex& a, const Triangle& triangle, double reach) {
  for (int k = 0; k < 3; ++k) {
    const Vec3 out = triangle.outward_of(k).normalized();
    if (out.dot(a.support(-out) - triangle.corners[k]) - a.rounding() > reach) {
      return true;
    }
  }
  return false;
}

/// A sphere or capsule, by its centre or axis. Where that comes within a touch of the triangle it
/// has no direction from it, and the face counts.
void meet_segment(const Convex& a, const PlacedMesh& mesh, int t, const TriangleCore& triangle,
                  double reach, TriangleMeeting& meeting, Separation& found) {
  SegmentOnTriangle nearest;
  if (!nearest_points(*a.segment(), triangle.triangle(), reach + a.rounding(), nearest)) {
    return;
  }
  const double cores = nearest.between.norm();
  if (nearest.edge < 0 || cores <= kTouch * std::min(a.size(), triangle.size())) {
    meeting.distance = meeting.face.separation;
    return;
  }
  meeting.distance = cores - a.rounding();
  if (meeting.distance > reach) {
    return;
  }
  const Meeting at{nearest.between / cores, piece_at(*a.segment(), nearest.s),
                   triangle.piece_at(nearest.edge, nearest.t)};
  meeting.counts = belongs(mesh, t, at.b, at.normal);
  if (meeting.counts) {
    found.distance = meeting.distance;
    found.meetings.assign(1, at);
    found.face.reset();
    if (is_as_far(a, triangle, meeting.distance, meeting.face.separation)) {
      found.face = meeting.face;
    }
  }
}

/// @param reach what is further apart than this may be said to be at +infinity
/// @param found where a normal counts: what separate() would say
TriangleMeeting meet(const Convex& a, const PlacedMesh& mesh, int t, const TriangleCore& triangle,
                     double reach, Separation& found) {
  TriangleMeeting meeting;
  meeting.face = least_deep_face(a, triangle.triangle());
  if (meeting.face.separation > reach) {
    return meeting;
  }
  if (a.segment() != nullptr) {
    meet_segment(a, mesh, t, triangle, reach, meeting, found);
    return meeting;
  }
  if (is_beside(a, triangle.triangle(), reach)) {
    return meeting;
  }
  if (meeting.face.separation > 0.0 &&
      triangle.triangle().is_under(a.support(-meeting.face.normal))) {
    meeting.distance = meeting.face.separation;  // between A's nearest point and its foot
    return meeting;
  }
  separate(a, triangle, found);
  meeting.distance = found.distance;
  meeting.counts = std::any_of(found.meetings.begin(), found.meetings.end(),
                               [&](const Meeting& m) { return belongs(mesh, t, m.b, m.normal); });
  return meeting;
}

/// Where A is apart from a triangle, or touches it, beside it, but is deep below its plane, that
/// depth means nothing; and as the normal beside it belongs to another triangle, that one has the
/// contact.
bool is_only_beside(const Convex& a, const TriangleCore& triangle, const TriangleMeeting& meeting) {
  const double tolerance = preference_tolerance(a, triangle);
  return !meeting.counts && meeting.distance > -tolerance &&
         meeting.face.separation < std::min(meeting.distance, 0.0) - tolerance;
}

/// Some roundings of the two frames, m.
double last_digits(const Bounds& near, const MeshData& mesh) {
  const double far = near.low.cwiseAbs().maxCoeff() + near.high.cwiseAbs().maxCoeff() + mesh.radius;
  return 64.0 * std::numeric_limits<double>::epsilon() * far;
}

/// Widened by a distance and by some roundings.
Bounds widened(const Bounds& near, double by, const MeshData& mesh) {
  const Vec3 reach = Vec3::Constant(by + last_digits(near, mesh));
  return {near.low - reach, near.high + reach};
}

/// What a query works on: kept from query to query of a thread.
struct MeshMemory {
  std::vector<int> near;
  Separation apart;
  std::vector<Contact> deepest;
};

MeshMemory& memory() {
  thread_local MeshMemory of_this_thread;
  return of_this_thread;
}

/// In ascending order.
const std::vector<int>& triangles_near(const Bounds& near, const MeshData& mesh) {
  std::vector<int>& result = memory().near;
  result.clear();
  mesh.tree.visit_overlaps(near, [&](int t) { result.push_back(t); });
  std::sort(result.begin(), result.end());
  return result;
}

/// Gives the contacts from `first` on the mesh's features; leaves out those inside a flat piece.
void number_features(const MeshData& mesh, int t, std::size_t first, bool keep_all,
                     std::vector<Contact>& contacts) {
  const MeshData::Triangle& triangle = mesh.triangles[t];
  std::size_t kept = first;
  for (std::size_t i = first; i < contacts.size(); ++i) {
    Contact contact = contacts[i];
    const auto of_a = static_cast<Feature>(contact.feature_id >> 32);
    const auto local = static_cast<Feature>(contact.feature_id);
    const bool on_face = contact.owner == NormalOwner::kFaceB;
    Feature feature = mesh.piece_feature(t);
    bool is_inner = false;
    if (local < kEdges) {
      const int k = static_cast<int>(local);
      feature = on_face ? mesh.corner_feature(t, k) : mesh.vertex_feature(triangle.vertices[k]);
      is_inner = triangle.is_inner_corner[k];
    } else if (local < kFront) {
      const int k = static_cast<int>(local - kEdges);
      feature = on_face ? mesh.border_feature(t, k) : mesh.edge_feature(t, k);
      is_inner = triangle.is_inner_edge[k];
    }
    if (is_inner && on_face && !keep_all) {
      continue;
    }
    contact.feature_id = feature_pair_id(of_a, feature);
    contacts[kept++] = contact;
  }
  contacts.resize(kept);
}

/// Of contacts with one id the one with the least gap stays, in the place of the first.
/// @param kept so many at the start have different ids
void merge(std::size_t kept, std::vector<Contact>& contacts) {
  for (std::size_t i = kept; i < contacts.size(); ++i) {
    std::size_t same = 0;
    while (same < kept && contacts[same].feature_id != contacts[i].feature_id) {
      ++same;
    }
    if (same == kept) {
      contacts[kept++] = contacts[i];
    } else if (contacts[i].gap < contacts[same].gap) {
      contacts[same] = contacts[i];
    }
  }
  contacts.resize(kept);
}

/// The contacts with one triangle, whatever their normals.
void add_last_word(const Convex& a, const TriangleCore& triangle, double margin,
                   std::vector<Contact>& contacts) {
  SegmentOnTriangle nearest;
  const double touch = kTouch * std::min(a.size(), triangle.size());
  const FacingFace face = least_deep_face(a, triangle.triangle());
  const Vec3 on_a = a.support(-face.normal) - a.rounding() * face.normal;
  const bool is_pierced = a.segment() != nullptr &&
                          !(nearest_points(*a.segment(), triangle.triangle(), kInfinity, nearest) &&
                            nearest.between.norm() > touch);
  if (!is_pierced || !triangle.triangle().is_under(on_a)) {
    find_contacts(a, triangle, margin, contacts);
    return;
  }
  Contact contact = narrow::make_contact(on_a, on_a - face.separation * face.normal, face.normal,
                                         face.separation, kFront, NormalOwner::kFaceB);
  contact.surface_a = LocalSurface::sphere(a.rounding());
  contact.surface_b = LocalSurface::face();
  contacts.push_back(contact);
}

/// The contacts of A with the triangles within `margin` of it; what is nearest.
struct NearestTriangle {
  double distance = kInfinity;
  int number = -1;
};

NearestTriangle add_contacts(const Convex& a, const Bounds& near, const PlacedMesh& b,
                             double margin, std::vector<Contact>& contacts) {
  NearestTriangle least;
  Separation& apart = memory().apart;
  for (const int t : triangles_near(widened(near, margin, b.data), b.data)) {
    const TriangleCore triangle = core_of(b, t);
    const TriangleMeeting meeting = meet(a, b, t, triangle, margin, apart);
    if (meeting.distance < least.distance) {
      least = {meeting.distance, t};
    }
    if (meeting.distance > margin) {
      continue;
    }
    const std::size_t before = contacts.size();
    if (meeting.counts) {
      find_contacts(a, triangle, apart, margin, contacts);
    } else if (!is_only_beside(a, triangle, meeting)) {
      find_contacts_on_face(a, triangle, meeting.face, margin, contacts);
    }
    number_features(b.data, t, before, false, contacts);
    merge(before, contacts);
  }
  return least;
}

}  // namespace

double mesh_distance(const Convex& a, const Bounds& near, const PlacedMesh& b) {
  Separation& found = memory().apart;
  const double least = b.data.tree.least(widened(near, 0.0, b.data), kInfinity, [&](int t) {
    return meet(a, b, t, core_of(b, t), kInfinity, found).distance;
  });
  if (least > 0.0) {
    return least;
  }
  std::vector<Contact>& contacts = memory().deepest;
  contacts.clear();
  find_mesh_contacts(a, near, b, 0.0, contacts);
  double deepest = 0.0;  // they overlap, whatever rounding makes of the gaps
  for (const Contact& contact : contacts) {
    deepest = std::min(deepest, contact.gap);
  }
  return deepest;
}

bool mesh_test(const Convex& a, const Bounds& near, const PlacedMesh& b) {
  const std::vector<int>& triangles = triangles_near(widened(near, 0.0, b.data), b.data);
  return std::any_of(triangles.begin(), triangles.end(), [&](int t) {
    return meet(a, b, t, core_of(b, t), 0.0, memory().apart).distance <= 0.0;
  });
}

void find_mesh_contacts(const Convex& a, const Bounds& near, const PlacedMesh& b, double margin,
                        std::vector<Contact>& contacts) {
  const double within = margin + last_digits(near, b.data);
  const NearestTriangle nearest = add_contacts(a, near, b, within, contacts);
  if (nearest.distance > within) {
    return;
  }
  const TriangleCore triangle = core_of(b, nearest.number);
  const double tolerance = preference_tolerance(a, triangle);
  const auto is_met = [&] {
    return std::any_of(contacts.begin(), contacts.end(), [&](const Contact& contact) {
      return contact.gap <= std::max(nearest.distance, 0.0) + tolerance;
    });
  };
  // The one that touches beside another triangle's edge leaves the contact to that one, which may
  // be a little further away.
  if (contacts.empty()) {
    add_contacts(a, near, b, within + tolerance, contacts);
  }
  // Where no triangle's normal counts, and none has A's deep points over it (at a border), the
  // nearest triangle has the last word.
  if (!is_met()) {
    const std::size_t before = contacts.size();
    add_last_word(a, triangle, within, contacts);
    number_features(b.data, nearest.number, before, true, contacts);
    merge(before, contacts);
  }
}

}  // namespace signorini::collision
