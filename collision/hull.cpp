#include <signorini/collision/hull.h>
#include <signorini/core/model/number_text.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace signorini::collision {
namespace {

/// Relative to the size: how far a vertex may be off the plane of its face.
constexpr double kFlat = 1e-9;
constexpr double kLeastVolume = 1e-9;

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("hull: " + what);
}

double size_of(const std::vector<Vec3>& vertices) {
  Vec3 low = vertices.front();
  Vec3 high = vertices.front();
  for (const Vec3& v : vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return (high - low).maxCoeff();
}

void check_vertices(const std::vector<Vec3>& vertices) {
  if (vertices.size() < 4) {
    refuse("vertices: must be at least 4, got " + std::to_string(vertices.size()));
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i].allFinite()) {
      refuse("vertex " + std::to_string(i) + ": must be finite, got " + number_text(vertices[i]));
    }
  }
}

/// The doubled vector area of a loop (Newell).
Vec3 doubled_area(const std::vector<Vec3>& vertices, const std::vector<int>& loop) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 2; k < loop.size(); ++k) {
    sum += (vertices[loop[k - 1]] - vertices[loop[0]]).cross(vertices[loop[k]] - vertices[loop[0]]);
  }
  return sum;
}

class Maker {
 public:
  Maker(std::vector<Vec3> vertices, std::vector<std::vector<int>> faces) {
    check_vertices(vertices);
    size_ = size_of(vertices);
    hull_.vertices = std::move(vertices);
    hull_.faces = std::move(faces);
  }

  HullData make() {
    link_vertices();
    link_edges();
    for (int f = 0; f < static_cast<int>(hull_.faces.size()); ++f) {
      add_plane(f);
    }
    for (const HullData::Edge& edge : hull_.edges) {
      hull_.arcs.push_back(hull_.normals[edge.right].cross(hull_.normals[edge.left]).normalized());
    }
    integrate();
    return std::move(hull_);
  }

 private:
  void link_vertices() {
    const int count = static_cast<int>(hull_.vertices.size());
    hull_.faces_of_vertex.resize(count);
    for (int f = 0; f < static_cast<int>(hull_.faces.size()); ++f) {
      const std::vector<int>& loop = hull_.faces[f];
      if (loop.size() < 3) {
        refuse("face " + std::to_string(f) + ": must have at least 3 vertices, got " +
               std::to_string(loop.size()));
      }
      for (const int v : loop) {
        if (v < 0 || v >= count) {
          refuse("face " + std::to_string(f) + ": vertex numbers must be in [0, " +
                 std::to_string(count) + "), got " + std::to_string(v));
        }
        hull_.faces_of_vertex[v].push_back(f);
      }
    }
    for (int v = 0; v < count; ++v) {
      if (hull_.faces_of_vertex[v].size() < 3) {
        refuse("vertex " + std::to_string(v) + ": must be in at least 3 faces, is in " +
               std::to_string(hull_.faces_of_vertex[v].size()));
      }
    }
  }

  /// Every directed edge of a loop must have its opposite in one other loop.
  void link_edges() {
    std::map<std::pair<int, int>, int> face_left_of;
    for (int f = 0; f < static_cast<int>(hull_.faces.size()); ++f) {
      const std::vector<int>& loop = hull_.faces[f];
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const std::pair<int, int> ends(loop[k], loop[(k + 1) % loop.size()]);
        if (!face_left_of.emplace(ends, f).second) {
          refuse_edge(ends, "runs the same way around two faces");
        }
      }
    }
    const int count = static_cast<int>(hull_.vertices.size());
    hull_.neighbours.resize(count);
    hull_.edges_of_vertex.resize(count);
    std::map<std::pair<int, int>, int> number;
    for (const auto& [ends, face] : face_left_of) {
      const auto opposite = face_left_of.find({ends.second, ends.first});
      if (opposite == face_left_of.end()) {
        refuse_edge(ends, "has a face on one side only");
      }
      if (ends.first < ends.second) {
        const int e = static_cast<int>(hull_.edges.size());
        hull_.edges.push_back({ends.first, ends.second, face, opposite->second});
        for (const auto& [v, w] : {ends, std::pair(ends.second, ends.first)}) {
          number[{v, w}] = e;
          hull_.edges_of_vertex[v].push_back(e);
          hull_.neighbours[v].push_back(w);
        }
      }
    }
    for (const std::vector<int>& loop : hull_.faces) {
      std::vector<int>& around = hull_.edges_of_face.emplace_back();
      for (std::size_t k = 0; k < loop.size(); ++k) {
        around.push_back(number[{loop[k], loop[(k + 1) % loop.size()]}]);
      }
    }
  }

  [[noreturn]] static void refuse_edge(const std::pair<int, int>& ends, const std::string& what) {
    refuse("edge " + std::to_string(ends.first) + " to " + std::to_string(ends.second) + ": " +
           what);
  }

  void add_plane(int f) {
    const Vec3 area = doubled_area(hull_.vertices, hull_.faces[f]);
    if (!(area.norm() > kFlat * kFlat * size_ * size_)) {
      refuse("face " + std::to_string(f) + ": has no area");
    }
    const Vec3 n = area.normalized();
    double offset = n.dot(hull_.vertices[hull_.faces[f][0]]);
    for (const int v : hull_.faces[f]) {
      if (std::abs(n.dot(hull_.vertices[v]) - offset) > kFlat * size_) {
        refuse("face " + std::to_string(f) + ": is not flat, vertex " + std::to_string(v) + " is " +
               number_text(n.dot(hull_.vertices[v]) - offset) + " m off its plane");
      }
    }
    const double plane = offset;
    for (std::size_t v = 0; v < hull_.vertices.size(); ++v) {
      const double height = n.dot(hull_.vertices[v]);
      if (height - plane > kFlat * size_) {
        refuse("not convex: vertex " + std::to_string(v) + " is " + number_text(height - plane) +
               " m outside face " + std::to_string(f));
      }
      offset = std::max(offset, height);
    }
    hull_.normals.push_back(n);
    hull_.offsets.push_back(offset);
    hull_.areas.push_back(0.5 * area.norm());
  }

  void integrate() {
    Vec3 inside = Vec3::Zero();
    for (const Vec3& v : hull_.vertices) {
      inside += v / static_cast<double>(hull_.vertices.size());
    }
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (const std::vector<int>& loop : hull_.faces) {
      for (std::size_t k = 2; k < loop.size(); ++k) {
        const Vec3 a = hull_.vertices[loop[0]] - inside;
        const Vec3 b = hull_.vertices[loop[k - 1]] - inside;
        const Vec3 c = hull_.vertices[loop[k]] - inside;
        const double det = a.dot(b.cross(c));
        const Vec3 s = a + b + c;
        hull_.volume += det / 6.0;
        first += det / 24.0 * s;
        second += det / 120.0 *
                  (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
      }
    }
    if (!(hull_.volume > kLeastVolume * size_ * size_ * size_)) {
      refuse("volume: must be > " + number_text(kLeastVolume) + " size^3 (size " +
             number_text(size_) + " m), got " + number_text(hull_.volume) + " m^3");
    }
    const Vec3 offset = first / hull_.volume;
    hull_.centre = inside + offset;
    hull_.second_moment = second - hull_.volume * offset * offset.transpose();
    for (const Vec3& v : hull_.vertices) {
      hull_.radius = std::max(hull_.radius, (v - hull_.centre).norm());
    }
  }

  HullData hull_;
  double size_ = 0.0;
};

}  // namespace

ConvexHull make_hull(std::vector<Vec3> vertices, std::vector<std::vector<int>> faces) {
  return {std::make_shared<const HullData>(Maker(std::move(vertices), std::move(faces)).make())};
}

ConvexHull make_prism(const std::vector<Eigen::Vector2d>& corners, double bottom, double top) {
  const int n = static_cast<int>(corners.size());
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>> faces(2);
  for (const double z : {bottom, top}) {
    for (const Eigen::Vector2d& corner : corners) {
      vertices.emplace_back(corner.x(), corner.y(), z);
    }
  }
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    faces[0].push_back(n - 1 - i);
    faces[1].push_back(n + i);
    faces.push_back({i, next, n + next, n + i});
  }
  return make_hull(std::move(vertices), std::move(faces));
}

}  // namespace signorini::collision
