#pragma once

#include <signorini/collision/shape.h>

#include <map>
#include <sdf/Element.hh>
#include <set>
#include <string>
#include <vector>

namespace signorini::validation {

/// What the shape of a <collision> is read with.
struct ShapeUse {
  bool is_dynamic = true;
  std::string body;          ///< its name, for notices
  std::string where;         ///< how messages name the element
  std::string optimization;  ///< of a <mesh>, as the file says: "convex_hull" ...; mostly empty
  bool capsule_as_cylinder = false;  ///< a URDF's capsule, which libsdformat lacks
};

/// Turns <geometry> into shapes: box, sphere, cylinder, capsule, ellipsoid, cone, plane, mesh, and
/// one convex polyline (a prism from z = 0 up to its height, as in Gazebo).
///
/// A mesh is a convex hull if its body is dynamic or the file says optimization="convex_hull" (or
/// "convex_decomposition", of which this makes one hull), else its triangles as they are. What was
/// done is in the notices. Mesh files are looked for beside the scene's file; model:// and
/// package:// through libsdformat (SDF_PATH) and in the folders above the scene's file.
class ShapeReader {
 public:
  /// @param folder of the scene's file
  explicit ShapeReader(std::string folder) : folder_(std::move(folder)) {}

  /// @param local the pose of the <collision>; turned to a plane's normal
  /// @throws InputError naming the place and the field.
  [[nodiscard]] collision::Shape read(const sdf::ElementPtr& geometry, const ShapeUse& use,
                                      Pose& local);

  [[nodiscard]] std::vector<std::string> notices() const;
  /// The mesh files that were read.
  [[nodiscard]] const std::set<std::string>& files() const { return files_; }

 private:
  struct MeshUse {
    collision::Shape shape;
    std::string what;   ///< was made of the file
    std::string first;  ///< body
    int count = 0;
  };

  [[nodiscard]] collision::Shape read_mesh(const sdf::ElementPtr& mesh, const ShapeUse& use);
  [[nodiscard]] MeshUse make_mesh_shape(const std::string& file, const std::string& part,
                                        bool centred, const Vec3& scale, const ShapeUse& use,
                                        bool convex) const;
  [[nodiscard]] std::string find(const std::string& uri, const ShapeUse& use) const;

  std::string folder_;
  std::map<std::string, MeshUse> meshes_;  ///< by file, part, scale and kind
  std::set<std::string> files_;
  int planes_ = 0;
};

}  // namespace signorini::validation
