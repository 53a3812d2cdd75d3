#include <signorini/collision/convex_shapes.h>

#include <cmath>
#include <utility>

namespace signorini::collision {
namespace {

using Kind = Stratum::Kind;

Stratum vertex_stratum(const Vec3& point, Feature feature) {
  Stratum stratum;
  stratum.feature = feature;
  stratum.anchor = point;
  return stratum;
}

Stratum edge_stratum(const Vec3& from, const Vec3& to, Feature feature, Feature first,
                     Feature last) {
  Stratum stratum = vertex_stratum(from, feature);
  const double length = (to - from).norm();
  stratum.kind = Kind::kLine;
  stratum.axis = (to - from) / length;
  stratum.range = {0.0, length};
  stratum.ends = {first, last};
  return stratum;
}

Stratum face_stratum(const Vec3& point, const Vec3& normal, double area, Feature feature) {
  Stratum stratum = vertex_stratum(point, feature);
  stratum.kind = Kind::kFace;
  stratum.axis = normal;
  stratum.area = area;
  return stratum;
}

/// The cube |x| <= 1: vertex v is the corner whose coordinates have the signs of its bits, face
/// 2 k and 2 k + 1 the low and high one of axis k.
const HullData& unit_cube() {
  static const ConvexHull cube = [] {
    std::vector<Vec3> corners;
    corners.reserve(8);
    for (int v = 0; v < 8; ++v) {
      corners.emplace_back(v & 1 ? 1.0 : -1.0, v & 2 ? 1.0 : -1.0, v & 4 ? 1.0 : -1.0);
    }
    return make_hull(
        std::move(corners),
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}});
  }();
  return *cube.data;
}

BoxSides sides_of(int cube_vertex) {
  return {cube_vertex & 1 ? 1 : -1, cube_vertex & 2 ? 1 : -1, cube_vertex & 4 ? 1 : -1};
}

}  // namespace

Stratum Polyhedron::edge(int number) const {
  const auto [from, to, left, right] = shape->edges[number];
  Feature first = static_cast<Feature>(from);
  Feature last = static_cast<Feature>(to);
  Feature feature = static_cast<Feature>(shape->vertices.size()) + static_cast<Feature>(number);
  if (is_box) {
    BoxSides sides = sides_of(from);
    first = box_feature(sides);
    last = box_feature(sides_of(to));
    for (int k = 0; k < 3; ++k) {
      sides[k] = sides[k] == sides_of(to)[k] ? sides[k] : 0;
    }
    feature = box_feature(sides);
  }
  return edge_stratum(position + axes * vertices[from], position + axes * vertices[to], feature,
                      first, last);
}

BoxCore::BoxCore(const Box& box, const Pose& pose)
    : Convex(pose.position, box.half_extents.norm(), 0.0), box_(box, pose) {
  const HullData& cube = unit_cube();
  for (int v = 0; v < 8; ++v) {
    vertices_[v] = box_.half.cwiseProduct(cube.vertices[v]);
  }
  for (int f = 0; f < 6; ++f) {
    const int k = f / 2;
    offsets_[f] = box_.half[k];
    areas_[f] = 4.0 * box_.half[(k + 1) % 3] * box_.half[(k + 2) % 3];
  }
  polyhedron_ = {
      &cube, vertices_.data(), offsets_.data(), areas_.data(), box_.centre, box_.axes, size(), 8, 6,
      true};
}

Vec3 BoxCore::support(const Vec3& n) const {
  BoxSides sides;
  for (int k = 0; k < 3; ++k) {
    sides[k] = box_.axes.col(k).dot(n) < 0.0 ? -1 : 1;
  }
  return box_.at(sides);
}

void BoxCore::add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const {
  const Vec3 along = box_.axes.transpose() * n;
  // On an axis that n is nearly across, both sides.
  std::array<std::array<int, 2>, 3> choices;
  for (int k = 0; k < 3; ++k) {
    const int side = along[k] < 0.0 ? -1 : 1;
    choices[k] = {side, std::abs(along[k]) <= angle ? -side : 0};
  }
  for (int k = 0; k < 3; ++k) {
    if (choices[(k + 1) % 3][1] != 0 && choices[(k + 2) % 3][1] != 0) {
      BoxSides sides{0, 0, 0};
      sides[k] = choices[k][0];
      strata.push_back(face_stratum(box_.at(sides), sides[k] * box_.axes.col(k),
                                    4.0 * box_.half[(k + 1) % 3] * box_.half[(k + 2) % 3],
                                    box_feature(sides)));
    }
  }
  for (const int x : choices[0]) {
    for (const int y : choices[1]) {
      for (const int z : choices[2]) {
        if (x == 0 || y == 0 || z == 0) {
          continue;
        }
        const BoxSides sides{x, y, z};
        strata.push_back(vertex_stratum(box_.at(sides), box_feature(sides)));
        for (int k = 0; k < 3; ++k) {
          if (choices[k][1] != 0 && sides[k] == -1) {
            BoxSides edge = sides;
            edge[k] = 0;
            BoxSides last = sides;
            last[k] = 1;
            strata.push_back(edge_stratum(box_.at(sides), box_.at(last), box_feature(edge),
                                          box_feature(sides), box_feature(last)));
          }
        }
      }
    }
  }
}

void BoxCore::facet(const Vec3& n, Facet& facet) const {
  const BoxFace face = face_against(box_, -n);
  const auto corners = face_corners(face);
  facet.reset(box_feature(face.sides()), face.sign * box_.axes.col(face.axis));
  for (int k = 0; k < 4; ++k) {
    // face_corners() runs counter-clockwise about the axis itself.
    const int here = face.sign > 0 ? k : 3 - k;
    const int next = face.sign > 0 ? (k + 1) % 4 : (6 - k) % 4;
    BoxSides edge = corners[here];
    for (int i = 0; i < 3; ++i) {
      edge[i] = corners[here][i] == corners[next][i] ? edge[i] : 0;
    }
    facet.corners.push_back({box_.at(corners[here]), box_feature(corners[here]), box_feature(edge),
                             LocalSurface::vertex()});
  }
}

HullCore::HullCore(const ConvexHull& hull, const Pose& pose)
    : Convex(pose * hull.data->centre, hull.data->radius, 0.0),
      data_(hull.data.get()),
      position_(pose.position),
      axes_(pose.orientation.toRotationMatrix()),
      polyhedron_{data_,
                  data_->vertices.data(),
                  data_->offsets.data(),
                  data_->areas.data(),
                  position_,
                  axes_,
                  size(),
                  static_cast<int>(data_->vertices.size()),
                  static_cast<int>(data_->faces.size()),
                  false} {}

Feature HullCore::edge_feature(int e) const {
  return static_cast<Feature>(data_->vertices.size()) + static_cast<Feature>(e);
}

Feature HullCore::face_feature(int f) const {
  return static_cast<Feature>(data_->vertices.size() + data_->edges.size()) +
         static_cast<Feature>(f);
}

int HullCore::support_vertex(const Vec3& local_n) const {
  int best = 0;
  double highest = local_n.dot(data_->vertices[0]);
  for (int v = 1; v < static_cast<int>(data_->vertices.size()); ++v) {
    const double height = local_n.dot(data_->vertices[v]);
    if (height > highest) {
      highest = height;
      best = v;
    }
  }
  return best;
}

Vec3 HullCore::support(const Vec3& n) const {
  return vertex(support_vertex(axes_.transpose() * n));
}

void HullCore::add_strata(const Vec3& n, double angle, std::vector<Stratum>& strata) const {
  const Vec3 local = axes_.transpose() * n;
  const int v = support_vertex(local);
  strata.push_back(vertex_stratum(vertex(v), static_cast<Feature>(v)));
  for (const int e : data_->edges_of_vertex[v]) {
    const HullData::Edge& edge = data_->edges[e];
    const Stratum stratum =
        edge_stratum(vertex(edge.from), vertex(edge.to), edge_feature(e),
                     static_cast<Feature>(edge.from), static_cast<Feature>(edge.to));
    if (std::abs(stratum.axis.dot(n)) <= angle) {
      strata.push_back(stratum);
      const int other = edge.from == v ? edge.to : edge.from;
      strata.push_back(vertex_stratum(vertex(other), static_cast<Feature>(other)));
    }
  }
  for (const int f : data_->faces_of_vertex[v]) {
    const Vec3& normal = data_->normals[f];
    if (normal.dot(local) > 0.0 && normal.cross(local).norm() <= angle) {
      strata.push_back(face_stratum(vertex(v), axes_ * normal, data_->areas[f], face_feature(f)));
    }
  }
}

void HullCore::facet(const Vec3& n, Facet& facet) const {
  // Of faces that face n equally to 1e-6 the first, so that rounding does not choose; a face with
  // this very normal before them.
  constexpr double kTie = 1e-6;
  constexpr double kSame = 1e-14;
  const Vec3 local = axes_.transpose() * n;
  const int count = static_cast<int>(data_->faces.size());
  int face = 0;
  double highest = local.dot(data_->normals[0]);
  for (int f = 1; f < count && highest < 1.0 - kSame; ++f) {
    const double along = local.dot(data_->normals[f]);
    if (along > highest) {
      highest = along;
      face = f;
    }
  }
  for (int f = 0; highest < 1.0 - kSame && f < face; ++f) {
    if (local.dot(data_->normals[f]) >= highest - kTie) {
      face = f;
    }
  }
  facet_of(face, facet);
}

void HullCore::facet_of(int face, Facet& facet) const {
  facet.reset(face_feature(face), axes_ * data_->normals[face]);
  for (std::size_t k = 0; k < data_->faces[face].size(); ++k) {
    const int v = data_->faces[face][k];
    facet.corners.push_back({vertex(v), static_cast<Feature>(v),
                             edge_feature(data_->edges_of_face[face][k]), LocalSurface::vertex()});
  }
}

}  // namespace signorini::collision
