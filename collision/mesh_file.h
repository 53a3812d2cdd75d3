#pragma once

#include <signorini/core/model/types.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace signorini::collision {

/// The triangles of a mesh file, in the file's own axes and units of metres.
struct TriangleSoup {
  std::vector<Vec3> vertices;                 ///< m; equal ones are not merged
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise from the front
  std::size_t left_out = 0;                   ///< points and lines of the file
};

/// Reads a triangle mesh: STL, Wavefront OBJ, COLLADA and whatever else Assimp reads. Polygons are
/// cut into triangles, the parts of a file put at their places. COLLADA's unit is applied, its
/// up axis is not (as in Gazebo): coordinates are those that the file holds.
///
/// Only in builds with Assimp (SIGNORINI_WITH_ASSIMP): without it a mesh is given by its triangles,
/// make_mesh().
/// @param part the name of one object of the file; empty: all of them
/// @throws std::invalid_argument naming the file and what is wrong: missing or not readable as a
/// mesh (with Assimp's reason), no such part (the parts are named), no triangle, a vertex that is
/// not finite (numbered).
[[nodiscard]] TriangleSoup read_mesh_file(const std::string& path, const std::string& part = "");

/// The volume that the triangles enclose, m^3: the sum of a.(b x c) / 6, which means something if
/// they close a surface whose front is outside.
[[nodiscard]] double enclosed_volume(const TriangleSoup& soup);

/// True if every edge is run through once each way, vertices in one place being one: the triangles
/// enclose a volume.
[[nodiscard]] bool is_closed(const TriangleSoup& soup);

}  // namespace signorini::collision
