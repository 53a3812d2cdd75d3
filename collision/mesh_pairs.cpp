#include <signorini/collision/convex_contacts.h>
#include <signorini/collision/gjk.h>
#include <signorini/collision/mesh_pairs.h>
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
  TriangleCore(const std::array<Vec3, 3>& corners, const Vec3& normal)
      : Convex((corners[0] + corners[1] + corners[2]) / 3.0, size_of(corners), 0.0),
        corners_(corners),
        normal_(normal) {}

  [[nodiscard]] const Vec3& normal() const { return normal_; }
  [[nodiscard]] const Vec3& corner(int k) const { return corners_[k]; }

  [[nodiscard]] Vec3 support(const Vec3& n) const override { return corners_[furthest(n)]; }

  void add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const override {
    const int v = furthest(n);
    std::array<bool, 3> is_near{false, false, false};
    is_near[v] = true;
    int edges = 0;
    for (const int k : {v, (v + 2) % 3}) {
      const Stratum stratum = edge(k);
      if (std::abs(stratum.axis.dot(n)) <= angle) {
        strata.push_back(stratum);
        is_near[k] = is_near[(k + 1) % 3] = true;
        ++edges;
      }
    }
    for (int k = 0; k < 3; ++k) {
      if (is_near[k]) {
        Stratum vertex;
        vertex.feature = static_cast<Feature>(k);
        vertex.anchor = corners_[k];
        strata.push_back(vertex);
      }
    }
    if (edges == 2) {
      strata.push_back(edge((v + 1) % 3));
    }
    if (normal_.cross(n).norm() <= std::max(angle, 1e-15)) {
      Stratum face;
      face.kind = Kind::kFace;
      face.feature = normal_.dot(n) > 0.0 ? kFront : kBack;
      face.anchor = corners_[v];
      face.axis = normal_.dot(n) > 0.0 ? normal_ : Vec3(-normal_);
      face.area = kFirst;
      strata.push_back(face);
    }
  }

  void facet(const Vec3& n, Facet& facet) const override {
    const bool is_front = normal_.dot(n) >= 0.0;
    facet.reset(is_front ? kFront : kBack, is_front ? normal_ : Vec3(-normal_));
    for (int i = 0; i < 3; ++i) {
      const int k = is_front ? i : 2 - i;
      const int edge = is_front ? k : (k + 2) % 3;
      facet.corners.push_back({corners_[k], static_cast<Feature>(k),
                               kEdges + static_cast<Feature>(edge), LocalSurface::vertex()});
    }
  }

 private:
  /// More than any other face has: of two faces that meet flat, the triangle's carries the normal.
  static constexpr double kFirst = 1e300;

  static double size_of(const std::array<Vec3, 3>& c) {
    const Vec3 centre = (c[0] + c[1] + c[2]) / 3.0;
    return std::max({(c[0] - centre).norm(), (c[1] - centre).norm(), (c[2] - centre).norm()});
  }
  [[nodiscard]] int furthest(const Vec3& n) const {
    int best = 0;
    for (int k = 1; k < 3; ++k) {
      if (n.dot(corners_[k] - corners_[best]) > 0.0) {
        best = k;
      }
    }
    return best;
  }
  [[nodiscard]] Stratum edge(int k) const {
    const Vec3& from = corners_[k];
    const Vec3& to = corners_[(k + 1) % 3];
    const double length = (to - from).norm();
    Stratum stratum;
    stratum.kind = Kind::kLine;
    stratum.feature = kEdges + static_cast<Feature>(k);
    stratum.anchor = from;
    stratum.axis = (to - from) / length;
    stratum.range = {0.0, length};
    stratum.ends = {static_cast<Feature>(k), static_cast<Feature>((k + 1) % 3)};
    return stratum;
  }

  std::array<Vec3, 3> corners_;
  Vec3 normal_;
};

TriangleCore core_of(const PlacedMesh& mesh, int t) {
  const MeshData::Triangle& triangle = mesh.data.triangles[t];
  std::array<Vec3, 3> corners;
  for (int k = 0; k < 3; ++k) {
    corners[k] = mesh.pose * mesh.data.vertices[triangle.vertices[k]];
  }
  return {corners, mesh.pose.orientation * triangle.normal};
}

/// How A meets one triangle.
struct TriangleMeeting {
  double distance = kInfinity;
  bool counts = false;  ///< the normal of that distance belongs to the feature that it is at
  FacingFace face;      ///< the triangle's, on the side on which A is least deep
};

FacingFace least_deep_face(const Convex& a, const TriangleCore& triangle) {
  const double front = separation_along(a, triangle, triangle.normal());
  const double back = separation_along(a, triangle, -triangle.normal());
  return front >= back ? FacingFace{false, triangle.normal(), front}
                       : FacingFace{false, -triangle.normal(), back};
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
  const Vec3 along = mesh.pose.orientation.conjugate() * N;
  const std::vector<int>& others =
      is_edge ? mesh.data.opposite[triangle.edges[k]] : mesh.data.neighbours[triangle.vertices[k]];
  return std::all_of(others.begin(), others.end(), [&](int v) {
    const Vec3 to = mesh.data.vertices[v] - at;
    return along.dot(to) <= kBelongs * to.norm();
  });
}

/// Are A and the triangle further apart than `reach` along one of the directions that lie in its
/// plane across its edges? (Then they are further apart.)
bool is_beside(const Convex& a, const TriangleCore& triangle, double reach) {
  for (int k = 0; k < 3; ++k) {
    const Vec3& from = triangle.corner(k);
    const Vec3 out = (triangle.corner((k + 1) % 3) - from).cross(triangle.normal()).normalized();
    if (out.dot(a.support(-out) - from) - a.rounding() > reach) {
      return true;
    }
  }
  return false;
}

/// @param reach what is further apart than this may be said to be at +infinity
/// @param found where not at +infinity and not by the face alone: what separate() says
TriangleMeeting meet(const Convex& a, const PlacedMesh& mesh, int t, const TriangleCore& triangle,
                     double reach, Separation& found) {
  TriangleMeeting meeting;
  meeting.face = least_deep_face(a, triangle);
  if (meeting.face.separation > reach || is_beside(a, triangle, reach)) {
    return meeting;
  }
  // The difference of a point or segment and a triangle may have no volume: only where they are
  // apart is there a direction to find.
  const double touch = kTouch * std::min(a.size(), triangle.size());
  if (a.rounding() > 0.0) {
    const double cores = gjk(a, triangle, 1e-8, 0.0).lower;
    if (cores <= touch) {
      meeting.distance = meeting.face.separation;
      return meeting;
    }
    if (cores * (1.0 - 1e-8) - a.rounding() > reach) {
      return meeting;
    }
  }
  separate(a, triangle, found);
  meeting.distance = found.distance;
  meeting.counts = std::any_of(found.meetings.begin(), found.meetings.end(),
                               [&](const Meeting& m) { return belongs(mesh, t, m.b, m.normal); });
  return meeting;
}

/// Widened by a distance and by some roundings of the two frames.
Bounds widened(const Bounds& near, double by, const MeshData& mesh) {
  const double far = near.low.cwiseAbs().maxCoeff() + near.high.cwiseAbs().maxCoeff() + mesh.radius;
  const Vec3 reach = Vec3::Constant(by + 64.0 * std::numeric_limits<double>::epsilon() * far);
  return {near.low - reach, near.high + reach};
}

std::vector<int> triangles_near(const Bounds& near, const MeshData& mesh) {
  std::vector<int> result;
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
void merge(std::vector<Contact>& contacts) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
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
  const double touch = kTouch * std::min(a.size(), triangle.size());
  if (a.rounding() == 0.0 || gjk(a, triangle, 1e-8, 0.0).lower > touch) {
    find_contacts(a, triangle, margin, contacts);
    return;
  }
  const FacingFace face = least_deep_face(a, triangle);
  const Vec3 on_a = a.support(-face.normal) - a.rounding() * face.normal;
  Contact contact = narrow::make_contact(on_a, on_a - face.separation * face.normal, face.normal,
                                         face.separation, kFront, NormalOwner::kFaceB);
  contact.surface_a = LocalSurface::sphere(a.rounding());
  contact.surface_b = LocalSurface::face();
  contacts.push_back(contact);
}

}  // namespace

double mesh_distance(const Convex& a, const Bounds& near, const PlacedMesh& b) {
  Separation found;
  const double least = b.data.tree.least(widened(near, 0.0, b.data), kInfinity, [&](int t) {
    return meet(a, b, t, core_of(b, t), kInfinity, found).distance;
  });
  if (least > 0.0) {
    return least;
  }
  std::vector<Contact> contacts;
  find_mesh_contacts(a, near, b, 0.0, contacts);
  double deepest = kInfinity;
  for (const Contact& contact : contacts) {
    deepest = std::min(deepest, contact.gap);
  }
  return deepest;
}

bool mesh_test(const Convex& a, const Bounds& near, const PlacedMesh& b) {
  const std::vector<int> triangles = triangles_near(widened(near, 0.0, b.data), b.data);
  Separation found;
  return std::any_of(triangles.begin(), triangles.end(), [&](int t) {
    return meet(a, b, t, core_of(b, t), 0.0, found).distance <= 0.0;
  });
}

void find_mesh_contacts(const Convex& a, const Bounds& near, const PlacedMesh& b, double margin,
                        std::vector<Contact>& contacts) {
  double least = kInfinity;
  int nearest = -1;
  std::vector<Contact> of_one;
  Separation apart;
  for (const int t : triangles_near(widened(near, margin, b.data), b.data)) {
    const TriangleCore triangle = core_of(b, t);
    const TriangleMeeting meeting = meet(a, b, t, triangle, margin, apart);
    if (meeting.distance < least) {
      least = meeting.distance;
      nearest = t;
    }
    of_one.clear();
    if (meeting.counts && meeting.distance <= margin) {
      find_contacts(a, triangle, apart, margin, of_one);
    } else if (!meeting.counts && meeting.distance <= margin) {
      find_contacts_on_face(a, triangle, meeting.face, margin, of_one);
    }
    number_features(b.data, t, 0, false, of_one);
    contacts.insert(contacts.end(), of_one.begin(), of_one.end());
  }
  merge(contacts);
  // Where no triangle's normal counts and A is over none, the nearest triangle has the last word.
  if (contacts.empty() && least <= margin) {
    add_last_word(a, core_of(b, nearest), margin, contacts);
    number_features(b.data, nearest, 0, true, contacts);
  }
}

}  // namespace signorini::collision
