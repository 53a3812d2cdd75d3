#include <signorini/collision/mesh_file.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <tuple>

namespace signorini::collision {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw std::invalid_argument("mesh file " + path + ": " + what);
}

/// Walks the nodes of a file, puts what they hold into a soup.
class SoupMaker {
 public:
  SoupMaker(const aiScene& scene, const std::string& part, TriangleSoup& soup)
      : scene_(scene), part_(part), soup_(soup) {}

  void walk(const aiNode& node, const aiMatrix4x4& parent, bool inside_part) {
    const aiMatrix4x4 place = parent * node.mTransformation;
    const bool named = node.mName.C_Str() == part_;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
      const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[m]];
      names_ += (names_.empty() ? "'" : ", '") + std::string(mesh.mName.C_Str()) + "'";
      if (part_.empty() || inside_part || named || mesh.mName.C_Str() == part_) add(mesh, place);
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
      walk(*node.mChildren[c], place, inside_part || named);
    }
  }

  [[nodiscard]] const std::string& names() const { return names_; }

 private:
  void add(const aiMesh& mesh, const aiMatrix4x4& place) {
    const int first = static_cast<int>(soup_.vertices.size());
    soup_.vertices.reserve(soup_.vertices.size() + mesh.mNumVertices);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D x = place * mesh.mVertices[v];
      soup_.vertices.emplace_back(x.x, x.y, x.z);
    }
    // A place that mirrors turns the triangles inside out.
    const bool mirrors = aiMatrix3x3(place).Determinant() < 0.0F;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) {
        ++soup_.left_out;
        continue;
      }
      const auto corner = [&](unsigned k) { return first + static_cast<int>(face.mIndices[k]); };
      soup_.triangles.push_back({corner(0), corner(mirrors ? 2 : 1), corner(mirrors ? 1 : 2)});
    }
  }

  const aiScene& scene_;
  const std::string& part_;
  TriangleSoup& soup_;
  std::string names_;
};

}  // namespace

TriangleSoup read_mesh_file(const std::string& path, const std::string& part) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) fail(path, "there is no such file");
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* const scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    fail(path, std::string("cannot be read as a mesh: ") + importer.GetErrorString());
  }
  TriangleSoup soup;
  SoupMaker maker(*scene, part, soup);
  maker.walk(*scene->mRootNode, aiMatrix4x4(), false);
  if (soup.vertices.empty() && !part.empty()) {
    fail(path, "no part '" + part + "'; its parts: " + maker.names());
  }
  if (soup.triangles.empty()) fail(path, "holds no triangle");
  for (std::size_t v = 0; v < soup.vertices.size(); ++v) {
    if (!soup.vertices[v].allFinite()) {
      fail(path, "vertex " + std::to_string(v) + ": must be finite");
    }
  }
  return soup;
}

double enclosed_volume(const TriangleSoup& soup) {
  // From a corner, so that a mesh far from the origin loses nothing.
  const Vec3 origin = soup.vertices.empty() ? Vec3::Zero().eval() : soup.vertices.front();
  double volume = 0.0;
  for (const auto& [a, b, c] : soup.triangles) {
    volume += (soup.vertices[a] - origin)
                  .dot((soup.vertices[b] - origin).cross(soup.vertices[c] - origin)) /
              6.0;
  }
  return volume;
}

bool is_closed(const TriangleSoup& soup) {
  std::map<std::tuple<double, double, double>, int> places;
  std::vector<int> place_of;
  place_of.reserve(soup.vertices.size());
  for (const Vec3& x : soup.vertices) {
    const auto key = std::tuple(x.x(), x.y(), x.z());
    place_of.push_back(places.try_emplace(key, static_cast<int>(places.size())).first->second);
  }
  std::map<std::pair<int, int>, int> runs;  // of each edge, once each way adds to nothing
  for (const auto& triangle : soup.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int from = place_of[triangle[k]];
      const int to = place_of[triangle[(k + 1) % 3]];
      if (from == to) continue;
      runs[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::all_of(runs.begin(), runs.end(), [](const auto& run) { return run.second == 0; });
}

}  // namespace signorini::collision
