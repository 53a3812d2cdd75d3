#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>
#include <signorini/validation/input_error.h>
#include <signorini/validation/sdf_shapes.h>

#ifdef SIGNORINI_HAS_HULLS
#include <signorini/collision/hull_builder.h>
#endif
#ifdef SIGNORINI_HAS_MESH_FILES
#include <signorini/collision/mesh_file.h>
#endif

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <sdf/Filesystem.hh>
#include <sdf/Param.hh>
#include <sdf/sdf.hh>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace signorini::validation {
namespace {

namespace fs = std::filesystem;

/// The numbers of an element, which check_numbers() has seen. libsdformat keeps elements that it
/// does not know (<cone>) as text, so all are read as text.
template <int N>
Eigen::Matrix<double, N, 1> as_numbers(const sdf::Element& element, const std::string& field,
                                       const ShapeUse& use) {
  const std::string given = element.GetValue() == nullptr ? "" : element.GetValue()->GetAsString();
  std::istringstream stream(given);
  stream.imbue(std::locale::classic());
  Eigen::Matrix<double, N, 1> values;
  for (int k = 0; k < N; ++k) stream >> values[k];
  if (!stream) {
    throw InputError(
        fmt::format("{}: <{}>: must be {} numbers, got '{}'", use.where, field, N, given));
  }
  return values;
}

template <int N>
Eigen::Matrix<double, N, 1> numbers(const sdf::ElementPtr& shape, const std::string& field,
                                    const ShapeUse& use) {
  const sdf::ElementPtr child = shape->FindElement(field);
  if (child == nullptr || child->GetValue() == nullptr) {
    throw InputError(fmt::format("{}: <{}>: <{}> is missing", use.where, shape->GetName(), field));
  }
  return as_numbers<N>(*child, field, use);
}

double number(const sdf::ElementPtr& shape, const std::string& field, const ShapeUse& use) {
  return numbers<1>(shape, field, use)[0];
}

/// libsdformat normalises a zero normal to zero without a word.
Vec3 plane_normal(const sdf::ElementPtr& plane, const ShapeUse& use) {
  if (plane->FindElement("normal") == nullptr) return Vec3::UnitZ();
  const Vec3 normal = numbers<3>(plane, "normal", use);
  if (!(normal.norm() > 0.0)) throw InputError(use.where + ": <normal>: must not be zero");
  return normal.normalized();
}

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The corners of a polygon, counter-clockwise, without points that repeat or lie on a line.
std::vector<Vec2> corners_of(std::vector<Vec2> points) {
  double twice_area = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2& next = points[(i + 1) % points.size()];
    twice_area += cross(points[i] - points[0], next - points[0]);
    size = std::max(size, (next - points[0]).norm());
  }
  if (twice_area < 0.0) std::reverse(points.begin(), points.end());
  for (std::size_t i = 0; i < points.size() && points.size() > 2;) {
    const Vec2& before = points[(i + points.size() - 1) % points.size()];
    const Vec2& after = points[(i + 1) % points.size()];
    const Vec2 in = points[i] - before;
    const Vec2 out = after - points[i];
    // 1e-9 of the size: what make_hull() takes for one plane.
    const bool on_a_line = std::abs(cross(in, out)) <= 1e-9 * size * (in.norm() + out.norm());
    if (on_a_line && in.dot(out) >= 0.0) {
      points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    } else {
      ++i;
    }
  }
  return points;
}

collision::Shape read_polyline(const sdf::ElementPtr& polyline, const ShapeUse& use) {
  if (polyline->GetNextElement("polyline") != nullptr) {
    throw InputError(use.where + ": <polyline>: several in one <geometry> are not supported");
  }
  std::vector<Vec2> points;
  for (sdf::ElementPtr point = polyline->FindElement("point"); point != nullptr;
       point = point->GetNextElement("point")) {
    points.push_back(as_numbers<2>(*point, "point", use));
  }
  if (points.size() < 3) {
    throw InputError(fmt::format("{}: <polyline>: must have at least 3 <point>s, got {}", use.where,
                                 points.size()));
  }
  const double height = number(polyline, "height", use);
  const std::vector<Vec2> corners = corners_of(std::move(points));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2& a = corners[i];
    const Vec2& b = corners[(i + 1) % corners.size()];
    const Vec2& c = corners[(i + 2) % corners.size()];
    if (!(cross(b - a, c - b) > 0.0)) {
      throw InputError(fmt::format("{}: <polyline>: a concave one is not supported (corner {} {})",
                                   use.where, b.x(), b.y()));
    }
  }
  try {
    return collision::make_prism(corners, 0.0, height);
  } catch (const std::invalid_argument& error) {
    throw InputError(use.where + ": <polyline>: " + error.what());
  }
}

}  // namespace

collision::Shape ShapeReader::read(const sdf::ElementPtr& geometry, const ShapeUse& use,
                                   Pose& local) {
  const sdf::ElementPtr shape = geometry->GetFirstElement();
  const std::string kind = shape == nullptr ? "empty" : shape->GetName();
  if (kind == "box") return collision::Box{0.5 * numbers<3>(shape, "size", use)};
  if (kind == "sphere") return collision::Sphere{number(shape, "radius", use)};
  if (kind == "ellipsoid") return collision::Ellipsoid{numbers<3>(shape, "radii", use)};
  if (kind == "mesh") return read_mesh(shape, use);
  if (kind == "polyline") return read_polyline(shape, use);
  if (kind == "plane") {
    local.orientation =
        local.orientation * Quat::FromTwoVectors(Vec3::UnitZ(), plane_normal(shape, use));
    ++planes_;
    return collision::HalfSpace{};
  }
  if (kind == "cylinder" || kind == "capsule" || kind == "cone") {
    const double radius = number(shape, "radius", use);
    const double half = 0.5 * number(shape, "length", use);
    if (kind == "cone") return collision::Cone{radius, half};
    if (kind == "capsule" || use.capsule_as_cylinder) return collision::Capsule{radius, half};
    return collision::Cylinder{radius, half};
  }
  throw InputError(fmt::format("{}: collision shape <{}> is not supported", use.where, kind));
}

#ifdef SIGNORINI_HAS_MESH_FILES

namespace {

/// How much of the hull is not the mesh.
std::string compared_with(const collision::TriangleSoup& soup, double hull_volume) {
  if (!collision::is_closed(soup)) {
    return "the mesh is not closed, so what the hull adds is not known";
  }
  const double volume = std::abs(collision::enclosed_volume(soup));
  if (hull_volume <= volume * (1.0 + 1e-6)) return "the mesh is convex: nothing is added";
  return fmt::format("the mesh is concave: the hull has {:.4g} times its volume",
                     hull_volume / volume);
}

}  // namespace

ShapeReader::MeshUse ShapeReader::make_mesh_shape(const std::string& file, const std::string& part,
                                                  bool centred, const Vec3& scale,
                                                  const ShapeUse& use, bool convex) const {
  MeshUse made;
  try {
    collision::TriangleSoup soup = collision::read_mesh_file(file, part);
    if (centred) {
      Vec3 low = soup.vertices.front();
      Vec3 high = low;
      for (const Vec3& x : soup.vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
      }
      for (Vec3& x : soup.vertices) x -= 0.5 * (low + high);
    }
    for (Vec3& x : soup.vertices) x = x.cwiseProduct(scale);
    if (!convex) {
      const collision::TriangleMesh mesh = collision::make_mesh(soup.vertices, soup.triangles);
      made.what = fmt::format("{} triangles as they are", mesh.data->triangles.size());
      if (mesh.data->degenerate > 0) {
        made.what += fmt::format(", without {} that have no area", mesh.data->degenerate);
      }
      made.shape = mesh;
      return made;
    }
#ifdef SIGNORINI_HAS_HULLS
    const collision::ConvexHull hull = collision::hull_of_points(soup.vertices);
    made.what =
        fmt::format("the convex hull of {} triangles ({} vertices, {} faces; {}); {}",
                    soup.triangles.size(), hull.data->vertices.size(), hull.data->faces.size(),
                    use.is_dynamic ? "a moving body's shape must be convex" : "as the file asks",
                    compared_with(soup, hull.data->volume));
    if (use.optimization == "convex_decomposition") {
      made.what += "; one hull instead of the decomposition that the file asks for";
    }
    made.shape = hull;
    return made;
#else
    throw std::invalid_argument(
        "its convex hull is needed, and this build makes none (SIGNORINI_WITH_QHULL)");
#endif
  } catch (const std::invalid_argument& error) {
    throw InputError(use.where + ": <mesh>: " + error.what());
  }
}

#else

ShapeReader::MeshUse ShapeReader::make_mesh_shape(const std::string&, const std::string&, bool,
                                                  const Vec3&, const ShapeUse& use, bool) const {
  throw InputError(use.where + ": <mesh>: this build reads no mesh files (SIGNORINI_WITH_ASSIMP)");
}

#endif

collision::Shape ShapeReader::read_mesh(const sdf::ElementPtr& mesh, const ShapeUse& use) {
  const sdf::ElementPtr uri = mesh->FindElement("uri");
  if (uri == nullptr) throw InputError(use.where + ": <mesh>: <uri> is missing");
  const std::string file = find(uri->Get<std::string>(), use);
  files_.insert(file);
  const Vec3 scale =
      mesh->FindElement("scale") == nullptr ? Vec3::Ones().eval() : numbers<3>(mesh, "scale", use);
  std::string part;
  bool centred = false;
  if (const sdf::ElementPtr submesh = mesh->FindElement("submesh"); submesh != nullptr) {
    part = submesh->Get<std::string>("name", "").first;
    centred = submesh->Get<bool>("center", false).first;
  }
  const bool convex = use.is_dynamic || use.optimization.starts_with("convex_");
  const std::string key = fmt::format(
      "{}{}{}, scale {:g} {:g} {:g}{}", file, part.empty() ? "" : ", part " + part,
      centred ? ", centred" : "", scale.x(), scale.y(), scale.z(), convex ? "" : ", static");
  const auto [found, is_new] = meshes_.try_emplace(key);
  if (is_new) {
    found->second = make_mesh_shape(file, part, centred, scale, use, convex);
    found->second.first = use.body;
  }
  ++found->second.count;
  return found->second.shape;
}

std::string ShapeReader::find(const std::string& uri, const ShapeUse& use) const {
  const auto exists = [](const fs::path& path) {
    std::error_code error;
    return fs::exists(path, error);
  };
  const std::size_t colon = uri.find("://");
  if (colon == std::string::npos || uri.starts_with("file://")) {
    const fs::path path = fs::path(folder_) / uri.substr(colon == std::string::npos ? 0 : 7);
    if (exists(path)) return path.lexically_normal().string();
    throw InputError(fmt::format("{}: <mesh>: <uri>: there is no file {}", use.where,
                                 path.lexically_normal().string()));
  }
  const std::string inside = uri.substr(colon + 3);
  if (const std::string path = sdf::findFile("model://" + inside, true, true); !path.empty()) {
    return path;
  }
  std::error_code error;
  for (fs::path up = fs::absolute(folder_, error).lexically_normal(); !up.empty();
       up = up.parent_path()) {
    if (exists(up / inside)) return (up / inside).string();
    if (up == up.parent_path()) break;
  }
  throw InputError(fmt::format("{}: <mesh>: <uri>: '{}' was found neither in SDF_PATH nor above {}",
                               use.where, uri, folder_.empty() ? "this folder" : folder_));
}

std::vector<std::string> ShapeReader::notices() const {
  std::vector<std::string> lines;
  if (planes_ > 0) {
    lines.push_back(fmt::format(
        "<plane><size> ignored ({} planes): each is a whole half-space (in Bullet: a large box)",
        planes_));
  }
  for (const auto& [key, use] : meshes_) {
    lines.push_back(fmt::format("mesh {}: body '{}'{} has {}", key, use.first,
                                use.count > 1 ? fmt::format(" and {} more", use.count - 1) : "",
                                use.what));
  }
  return lines;
}

}  // namespace signorini::validation
