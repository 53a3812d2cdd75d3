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
  Vec3 normal = Vec3::Zero();  ///< outward, unit
  double offset = 0.0;         ///< of its plane; > 0: the origin is inside
  bool is_final = false;       ///< on the surface, to tolerance
  bool is_seen = false;        ///< from the point that is being added
};

/// What a polytope is made of: kept from query to query.
struct PolytopeMemory {
  std::vector<Vec3> points;
  std::vector<Face> faces;
  std::vector<Face*> open;
  std::vector<std::array<int, 2>> horizon;
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
        horizon_(memory.horizon) {
    found_.clear();
    points_.clear();
    faces_.clear();
  }

  /// Leaves the directions in `found`.
  void expand() {
    if (!start()) {
      return;
    }
    while (static_cast<int>(points_.size()) < kMostPoints) {
      Face* const nearest = nearest_face();
      if (nearest == nullptr || nearest->offset > least_ + tolerance_) {
        break;
      }
      const Vec3 u = nearest->normal;
      const Vec3 point = support(u);
      if (u.dot(point) - nearest->offset <= tolerance_) {
        nearest->is_final = true;
      } else {
        add(*nearest, point);
      }
    }
    // By insertion, which is stable and needs no memory.
    for (auto axis = found_.begin(); axis != found_.end(); ++axis) {
      const auto place = std::upper_bound(
          found_.begin(), axis, *axis,
          [](const Axis& p, const Axis& q) { return p.separation > q.separation; });
      std::rotate(place, axis, axis + 1);
    }
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
    add_face(0, 1, 2);
    add_face(0, 3, 1);
    add_face(1, 3, 2);
    add_face(2, 3, 0);
    return true;
  }

  /// The one of the two support points along n that measures more.
  template <class Measure>
  Vec3 further(const Vec3& n, Measure&& measure) {
    const Vec3 p = support(n);
    const Vec3 q = support(-n);
    return measure(p) >= measure(q) ? p : q;
  }

  void add_face(int i, int j, int k) {
    Face face{{i, j, k}};
    const Vec3 area = (points_[j] - points_[i]).cross(points_[k] - points_[i]);
    const double norm = area.norm();
    face.normal = norm > 0.0 ? Vec3(area / norm) : Vec3(Vec3::Zero());
    face.offset = norm > 0.0 ? face.normal.dot(points_[i]) : kInfinity;
    faces_.push_back(face);
  }

  Face* nearest_face() {
    Face* nearest = nullptr;
    for (Face& face : faces_) {
      if (!face.is_final && (nearest == nullptr || face.offset < nearest->offset)) {
        nearest = &face;
      }
    }
    return nearest;
  }

  /// Replaces the faces that the point sees: from `first` on, across edges, so that rounding among
  /// faces that are nearly coplanar with the point cannot tear the surface.
  void add(Face& first, const Vec3& point) {
    first.is_seen = true;
    open_.assign({&first});
    horizon_.clear();
    while (!open_.empty()) {
      const Face& face = *open_.back();
      open_.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int from = face.corners[k];
        const int to = face.corners[(k + 1) % 3];
        Face& next = face_along(to, from);
        if (next.is_seen) {
          continue;
        }
        if (next.normal.dot(point) > next.offset) {
          next.is_seen = true;
          open_.push_back(&next);
        } else {
          horizon_.push_back({from, to});
        }
      }
    }
    // A face that was seen after one of its edges had been listed takes the edge with it.
    std::erase_if(horizon_, [&](const std::array<int, 2>& edge) {
      return face_along(edge[1], edge[0]).is_seen;
    });
    std::erase_if(faces_, [](const Face& face) { return face.is_seen; });
    const int number = static_cast<int>(points_.size());
    points_.push_back(point);
    for (const auto& [from, to] : horizon_) {
      add_face(from, to, number);
    }
  }

  /// The face around which the edge runs this way.
  Face& face_along(int from, int to) {
    return *std::find_if(faces_.begin(), faces_.end(), [&](const Face& face) {
      const auto& [i, j, k] = face.corners;
      return (i == from && j == to) || (j == from && k == to) || (k == from && i == to);
    });
  }

  const Convex& a_;
  const Convex& b_;
  double tolerance_;
  double least_ = kInfinity;  ///< of the reaches seen
  std::vector<Axis>& found_;
  std::vector<Vec3>& points_;
  std::vector<Face>& faces_;
  std::vector<Face*>& open_;
  std::vector<std::array<int, 2>>& horizon_;
};

}  // namespace

void penetration(const Convex& a, const Convex& b, double tolerance, std::vector<Axis>& axes) {
  thread_local PolytopeMemory memory;
  Polytope(a, b, tolerance, memory, axes).expand();
}

}  // namespace signorini::collision
