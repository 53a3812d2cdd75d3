#include <signorini/collision/mesh.h>
#include <signorini/core/model/number_text.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>

namespace signorini::collision {
namespace {

constexpr double kSamePlane = 1e-6;  // radians
constexpr double kNoArea = 1e-12;    // of the longest edge squared

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("mesh: " + what);
}

/// The vertices without their doubles, and for each of the input's its number among them.
std::vector<int> merge_vertices(const std::vector<Vec3>& vertices, std::vector<Vec3>& merged) {
  std::map<std::tuple<double, double, double>, int> numbers;
  std::vector<int> result;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3& v = vertices[i];
    if (!v.allFinite()) {
      refuse("vertex " + std::to_string(i) + ": must be finite, got " + number_text(v) + " m");
    }
    const auto [at, is_new] =
        numbers.try_emplace({v.x(), v.y(), v.z()}, static_cast<int>(merged.size()));
    if (is_new) {
      merged.push_back(v);
    }
    result.push_back(at->second);
  }
  return result;
}

void add_triangles(const std::vector<std::array<int, 3>>& triangles, const std::vector<int>& merged,
                   MeshData& mesh) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    MeshData::Triangle added{};
    std::array<Vec3, 3> p;
    for (int k = 0; k < 3; ++k) {
      const int v = triangles[t][k];
      if (v < 0 || v >= static_cast<int>(merged.size())) {
        refuse("triangle " + std::to_string(t) + ": vertex: must be in [0, " +
               std::to_string(merged.size()) + "), got " + std::to_string(v));
      }
      added.vertices[k] = merged[v];
      p[k] = mesh.vertices[merged[v]];
    }
    const Vec3 twice_area = (p[1] - p[0]).cross(p[2] - p[0]);
    const double longest = std::max(
        {(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
    if (!(twice_area.norm() > kNoArea * longest)) {
      ++mesh.degenerate;
      continue;
    }
    added.normal = twice_area.stableNormalized();
    mesh.triangles.push_back(added);
  }
  if (mesh.triangles.empty()) {
    refuse("triangles: at least one must have an area, got " + std::to_string(triangles.size()) +
           " without");
  }
}

using HalfEdges = std::map<std::pair<int, int>, std::vector<int>>;  // by vertices, ascending

HalfEdges half_edges_of(const MeshData& mesh) {
  HalfEdges edges;
  for (int h = 0; h < 3 * static_cast<int>(mesh.triangles.size()); ++h) {
    const auto& v = mesh.triangles[h / 3].vertices;
    edges[std::minmax({v[h % 3], v[(h + 1) % 3]})].push_back(h);
  }
  return edges;
}

int root_of(std::vector<int>& parent, int t) {
  while (parent[t] != t) {
    t = parent[t] = parent[parent[t]];
  }
  return t;
}

/// Flat pieces, edges and what lies opposite to them.
void join_triangles(MeshData& mesh) {
  std::vector<int> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  mesh.opposite.resize(3 * mesh.triangles.size());
  mesh.neighbours.resize(mesh.vertices.size());
  for (const auto& [ends, halves] : half_edges_of(mesh)) {
    mesh.neighbours[ends.first].push_back(ends.second);
    mesh.neighbours[ends.second].push_back(ends.first);
    const Vec3& normal = mesh.triangles[halves[0] / 3].normal;
    const bool is_inner = halves.size() == 2 &&
                          normal.dot(mesh.triangles[halves[1] / 3].normal) > 0.0 &&
                          normal.cross(mesh.triangles[halves[1] / 3].normal).norm() <= kSamePlane;
    for (const int h : halves) {
      MeshData::Triangle& triangle = mesh.triangles[h / 3];
      triangle.edges[h % 3] = halves[0];
      triangle.is_inner_edge[h % 3] = is_inner;
      mesh.opposite[halves[0]].push_back(triangle.vertices[(h + 2) % 3]);
    }
    if (is_inner) {
      const auto [first, second] =
          std::minmax({root_of(parent, halves[0] / 3), root_of(parent, halves[1] / 3)});
      parent[second] = first;
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.triangles[t].piece = root_of(parent, static_cast<int>(t));
  }
}

/// Corners: of which pieces a vertex is a corner, and where it is inside one.
void number_corners(MeshData& mesh) {
  std::vector<bool> is_on_border(mesh.vertices.size(), false);
  std::map<std::pair<int, int>, int> first;  // of vertex and piece
  for (int h = 0; h < 3 * static_cast<int>(mesh.triangles.size()); ++h) {
    MeshData::Triangle& triangle = mesh.triangles[h / 3];
    const int v = triangle.vertices[h % 3];
    triangle.corners[h % 3] = first.try_emplace({v, triangle.piece}, h).first->second;
    if (!triangle.is_inner_edge[h % 3]) {
      is_on_border[v] = true;
      is_on_border[triangle.vertices[(h + 1) % 3]] = true;
    }
  }
  for (MeshData::Triangle& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      triangle.is_inner_corner[k] = !is_on_border[triangle.vertices[k]];
    }
  }
}

BoundsTree tree_of(const MeshData& mesh) {
  std::vector<Bounds> bounds;
  for (const MeshData::Triangle& triangle : mesh.triangles) {
    const Vec3& first = mesh.vertices[triangle.vertices[0]];
    Bounds box{first, first};
    for (const int v : triangle.vertices) {
      box.low = box.low.cwiseMin(mesh.vertices[v]);
      box.high = box.high.cwiseMax(mesh.vertices[v]);
    }
    bounds.push_back(box);
  }
  return BoundsTree(bounds);
}

}  // namespace

Feature MeshData::piece_feature(int triangle) const {
  return static_cast<Feature>(triangles[triangle].piece);
}
Feature MeshData::edge_feature(int triangle, int k) const {
  return static_cast<Feature>(triangles.size()) +
         static_cast<Feature>(triangles[triangle].edges[k]);
}
Feature MeshData::border_feature(int triangle, int k) const {
  return 4 * static_cast<Feature>(triangles.size()) + static_cast<Feature>(3 * triangle + k);
}
Feature MeshData::corner_feature(int triangle, int k) const {
  return 7 * static_cast<Feature>(triangles.size()) +
         static_cast<Feature>(triangles[triangle].corners[k]);
}
Feature MeshData::vertex_feature(int vertex) const {
  return 10 * static_cast<Feature>(triangles.size()) + static_cast<Feature>(vertex);
}

TriangleMesh make_mesh(const std::vector<Vec3>& vertices,
                       const std::vector<std::array<int, 3>>& triangles) {
  const auto mesh = std::make_shared<MeshData>();
  const std::vector<int> merged = merge_vertices(vertices, mesh->vertices);
  add_triangles(triangles, merged, *mesh);
  join_triangles(*mesh);
  number_corners(*mesh);
  mesh->tree = tree_of(*mesh);
  for (const Vec3& v : mesh->vertices) {
    mesh->radius = std::max(mesh->radius, v.stableNorm());
  }
  return {mesh};
}

TriangleMesh make_height_field(const std::vector<double>& heights, int columns, int rows, double dx,
                               double dy) {
  if (columns < 2 || rows < 2 ||
      heights.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {
    throw std::invalid_argument(
        "height field: columns, rows: must be >= 2 with a height each, got " +
        std::to_string(columns) + " x " + std::to_string(rows) + " and " +
        std::to_string(heights.size()) + " heights");
  }
  for (const auto& [name, spacing] : {std::pair("dx", dx), std::pair("dy", dy)}) {
    if (!(spacing > 0.0) || !std::isfinite(spacing)) {
      throw std::invalid_argument(std::string("height field: ") + name +
                                  ": must be finite and > 0, got " + number_text(spacing) + " m");
    }
  }
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int v = i + j * columns;
      vertices.emplace_back(dx * (i - 0.5 * (columns - 1)), dy * (j - 0.5 * (rows - 1)),
                            heights[v]);
      if (i + 1 < columns && j + 1 < rows) {
        triangles.push_back({v, v + 1, v + columns + 1});
        triangles.push_back({v, v + columns + 1, v + columns});
      }
    }
  }
  return make_mesh(vertices, triangles);
}

}  // namespace signorini::collision
