#include <signorini/collision/penetration.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace signorini::collision {
namespace {

constexpr int kMostPoints = 256;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Face {
  std::array<int, 3> corners;
  std::array<int, 3> beyond{};  ///< the face across the edge from corner k to corner k + 1
  Vec3 normal = Vec3::Zero();   ///< outward, unit
  double offset = 0.0;          ///< of its plane; > 0: the origin is inside
  bool is_final = false;        ///< on the surface, to tolerance
  bool is_seen = false;         ///< from the point that is being added
  bool is_gone = false;         ///< its place is free
};

/// An edge between faces that are seen and one that is not, as it runs around those.
struct HorizonEdge {
  int from;
  int to;
  int beyond;  ///< the face that is not seen
};

/// What a polytope is made of: kept from query to query.
struct PolytopeMemory {
  std::vector<Vec3> points;
  std::vector<Face> faces;
  std::vector<int> open;
  std::vector<int> gone;  ///< the places of faces that a new one may take
  std::vector<HorizonEdge> horizon;
  std::vector<int> starting;  ///< of each point: the new face whose horizon edge starts there
};

class Polytope {
 public:
  Polytope(const Convex& a, const Convex& b, double tolerance, PolytopeMemory& memory,
           std::vector<Axis>& found)
      : a_(a),
        b_(b),
        tolerance_(tolerance),
        found_(found),
        points_(memory.points),
        faces_(memory.faces),
        open_(memory.open),
        gone_(memory.gone),
        horizon_(memory.horizon),
        starting_(memory.starting) {
    found_.clear();
    points_.clear();
    faces_.clear();
    gone_.clear();
    starting_.assign(kMostPoints, -1);
  }

  /// Leaves the directions in `found`. False: it ended before the least was certain.
  bool expand() {
    if (!start()) {
      return true;
    }
    bool is_certain = false;
    while (static_cast<int>(points_.size()) < kMostPoints) {
      const int nearest = nearest_face();
      is_certain = nearest < 0 || faces_[nearest].offset > least_ + tolerance_;
      if (is_certain) {
        break;
      }
      const Vec3 u = faces_[nearest].normal;
      const Vec3 point = support(u);
      if (u.dot(point) - faces_[nearest].offset <= tolerance_) {
        faces_[nearest].is_final = true;
      } else {
        add(nearest, point);
      }
    }
    // By insertion, which is stable and needs no memory.
    for (auto axis = found_.begin(); axis != found_.end(); ++axis) {
      const auto place = std::upper_bound(
          found_.begin(), axis, *axis,
          [](const Axis& p, const Axis& q) { return p.separation > q.separation; });
      std::rotate(place, axis, axis + 1);
    }
    return is_certain;
  }

 private:
  /// The point of A - B furthest along u; keeps the direction if it is among the best.
  Vec3 support(const Vec3& u) {
    Vec3 point = a_.support(u) - b_.support(-u);
    const double reach = u.dot(point);
    if (reach < least_) {
      least_ = reach;
      std::erase_if(found_,
                    [&](const Axis& axis) { return -axis.separation > least_ + tolerance_; });
    }
    if (reach <= least_ + tolerance_) {
      found_.push_back({-u, -reach});
    }
    return point;
  }

  /// A tetrahedron with volume; false if the difference has none.
  bool start() {
    constexpr double kLeastShape = 1e-10;
    const Vec3 first = support(Vec3::UnitX());
    const Vec3 second = support(-Vec3::UnitX());
    points_.assign({first, second});
    Vec3 span = second - first;
    for (const Vec3& axis : {Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
      const Vec3 low = support(-axis);
      const Vec3 high = support(axis);
      if ((high - low).norm() > span.norm()) {
        span = high - low;
        points_.assign({low, high});
      }
    }
    const double size = span.norm();
    if (!(size > 0.0)) {
      return false;
    }
    const auto from_line = [&](const Vec3& p) {
      return (p - points_[0]).cross(span).norm() / size;
    };
    const Vec3 across = span.unitOrthogonal();
    const Vec3 third = further(across, from_line);
    const Vec3 other = further(span.cross(across) / size, from_line);
    points_.push_back(from_line(third) >= from_line(other) ? third : other);
    const Vec3 area = (points_[1] - points_[0]).cross(points_[2] - points_[0]);
    if (!(area.norm() > kLeastShape * size * size)) {
      return false;
    }
    const Vec3 n = area.normalized();
    points_.push_back(further(n, [&](const Vec3& p) { return std::abs(n.dot(p - points_[0])); }));
    const double height = n.dot(points_[3] - points_[0]);
    if (!(std::abs(height) > kLeastShape * size)) {
      return false;
    }
    if (height > 0.0) {
      std::swap(points_[1], points_[2]);
    }
    faces_ = {face_of(0, 1, 2), face_of(0, 3, 1), face_of(1, 3, 2), face_of(2, 3, 0)};
    faces_[0].beyond = {1, 2, 3};
    faces_[1].beyond = {3, 2, 0};
    faces_[2].beyond = {1, 3, 0};
    faces_[3].beyond = {2, 1, 0};
    return true;
  }

  /// The one of the two support points along n that measures more.
  template <class Measure>
  Vec3 further(const Vec3& n, Measure&& measure) {
    const Vec3 p = support(n);
    const Vec3 q = support(-n);
    return measure(p) >= measure(q) ? p : q;
  }

  [[nodiscard]] Face face_of(int i, int j, int k) const {
    Face face{{i, j, k}};
    const Vec3 area = (points_[j] - points_[i]).cross(points_[k] - points_[i]);
    const double norm = area.norm();
    face.normal = norm > 0.0 ? Vec3(area / norm) : Vec3(Vec3::Zero());
    face.offset = norm > 0.0 ? face.normal.dot(points_[i]) : kInfinity;
    return face;
  }

  /// Its number; -1: all are final.
  [[nodiscard]] int nearest_face() const {
    int nearest = -1;
    double least = kInfinity;
    for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
      const Face& face = faces_[f];
      if (!face.is_final && !face.is_gone && (nearest < 0 || face.offset < least)) {
        nearest = f;
        least = face.offset;
      }
    }
    return nearest;
  }

  /// Replaces the faces that the point sees: from `first` on, across edges, so that rounding among
  /// faces that are nearly coplanar with the point cannot tear the surface.
  void add(int first, const Vec3& point) {
    find_horizon(first, point);
    const int number = static_cast<int>(points_.size());
    points_.push_back(point);
    for (const HorizonEdge& edge : horizon_) {
      const int f = place_for_face();
      faces_[f] = face_of(edge.from, edge.to, number);
      faces_[f].beyond = {edge.beyond, f, f};
      link(edge.beyond, edge.to, f);
      starting_[edge.from] = f;
    }
    // The new faces among themselves: around the new point. Where rounding has made the horizon
    // pass a point twice one of them keeps itself as its neighbour.
    for (const HorizonEdge& edge : horizon_) {
      const int f = starting_[edge.from];
      const int next = starting_[edge.to];
      if (next >= 0) {
        faces_[f].beyond[1] = next;
        faces_[next].beyond[2] = f;
      }
    }
    for (const HorizonEdge& edge : horizon_) {
      starting_[edge.from] = -1;
    }
  }

  /// Frees the faces that are seen and lists the edges around them.
  void find_horizon(int first, const Vec3& point) {
    faces_[first].is_seen = true;
    open_.assign({first});
    horizon_.clear();
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const Face& face = faces_[open_[i]];
      for (int k = 0; k < 3; ++k) {
        Face& next = faces_[face.beyond[k]];
        if (next.is_seen) {
          continue;
        }
        if (next.normal.dot(point) > next.offset) {
          next.is_seen = true;
          open_.push_back(face.beyond[k]);
        } else {
          horizon_.push_back({face.corners[k], face.corners[(k + 1) % 3], face.beyond[k]});
        }
      }
    }
    // A face that was seen after one of its edges had been listed takes the edge with it.
    std::erase_if(horizon_, [&](const HorizonEdge& edge) { return faces_[edge.beyond].is_seen; });
    for (const int f : open_) {
      faces_[f].is_gone = true;
      gone_.push_back(f);
    }
  }

  int place_for_face() {
    if (gone_.empty()) {
      faces_.emplace_back();
      return static_cast<int>(faces_.size()) - 1;
    }
    const int place = gone_.back();
    gone_.pop_back();
    return place;
  }

  /// The edge of a face that starts at a point leads to another face now.
  void link(int face, int from, int to_face) {
    for (int k = 0; k < 3; ++k) {
      if (faces_[face].corners[k] == from) {
        faces_[face].beyond[k] = to_face;
      }
    }
  }

  const Convex& a_;
  const Convex& b_;
  double tolerance_;
  double least_ = kInfinity;  ///< of the reaches seen
  std::vector<Axis>& found_;
  std::vector<Vec3>& points_;
  std::vector<Face>& faces_;
  std::vector<int>& open_;
  std::vector<int>& gone_;
  std::vector<HorizonEdge>& horizon_;
  std::vector<int>& starting_;
};

}  // namespace

bool penetration(const Convex& a, const Convex& b, double tolerance, std::vector<Axis>& axes) {
  thread_local PolytopeMemory memory;
  return Polytope(a, b, tolerance, memory, axes).expand();
}

}  // namespace signorini::collision
