#include <signorini/collision/compound.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>
#include <signorini/validation/scene_playback.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

namespace signorini::validation {
namespace {

constexpr std::size_t kMostTriangles = 20000;
constexpr std::size_t kMostContacts = 3000;  // of a run

std::array<double, 3> numbers(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Playback::Placement placement(const Pose& pose) {
  const Quat& q = pose.orientation;
  return {numbers(pose.position), {q.w(), q.x(), q.y(), q.z()}};
}

std::string kind_name(BodyKind kind) {
  switch (kind) {
    case BodyKind::kDynamic: return "dynamic";
    case BodyKind::kFixed: return "fixed";
    case BodyKind::kKinematic: return "kinematic";
  }
  return "unknown";
}

Playback::Surface surface_of(const collision::HullData& hull) {
  Playback::Surface surface;
  for (const Vec3& vertex : hull.vertices) surface.vertices.push_back(numbers(vertex));
  for (const std::vector<int>& face : hull.faces) {
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
      surface.triangles.push_back({face[0], face[k], face[k + 1]});
    }
  }
  surface.whole_triangles = surface.triangles.size();
  return surface;
}

/// Vertices in one cell of a grid become the first of them; triangles that lose a corner go.
Playback::Surface merged(const Playback::Surface& whole, double cell) {
  Playback::Surface surface;
  surface.whole_triangles = whole.whole_triangles;
  std::map<std::array<long, 3>, int> cells;
  std::vector<int> number;
  for (const auto& vertex : whole.vertices) {
    const std::array<long, 3> key = {std::lround(vertex[0] / cell), std::lround(vertex[1] / cell),
                                     std::lround(vertex[2] / cell)};
    const auto [found, is_new] = cells.try_emplace(key, static_cast<int>(surface.vertices.size()));
    if (is_new) surface.vertices.push_back(vertex);
    number.push_back(found->second);
  }
  for (const auto& [a, b, c] : whole.triangles) {
    const std::array<int, 3> triangle = {number[a], number[b], number[c]};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

Playback::Surface surface_of(const collision::MeshData& mesh) {
  Playback::Surface whole;
  for (const Vec3& vertex : mesh.vertices) whole.vertices.push_back(numbers(vertex));
  for (const auto& triangle : mesh.triangles) whole.triangles.push_back(triangle.vertices);
  whole.whole_triangles = whole.triangles.size();
  Playback::Surface thinned = whole;
  for (double cell = mesh.radius / 128.0;
       thinned.triangles.size() > kMostTriangles && cell < mesh.radius; cell *= 1.5) {
    thinned = merged(whole, cell);
  }
  return thinned;
}

/// Collects shapes; hulls and meshes that are shared are written once.
class ShapeWriter {
 public:
  explicit ShapeWriter(Playback& playback) : playback_(playback) {}

  void add(const collision::Collider& collider) {
    add(collider.shape, collider.local, collider.body, collider.name);
  }

 private:
  void add(const collision::Shape& shape, const Pose& local, int body, const std::string& name) {
    if (const auto* compound = std::get_if<collision::Compound>(&shape)) {
      for (const collision::CompoundPart& part : compound->data->parts) {
        add(part.shape, local * part.local, body, name);
      }
      return;
    }
    Playback::DrawnShape drawn;
    drawn.name = name;
    drawn.body = body;
    drawn.local = placement(local);
    std::visit([&](const auto& s) { describe(s, drawn); }, shape);
    playback_.shapes.push_back(std::move(drawn));
  }

  static void describe(const collision::Sphere& s, Playback::DrawnShape& drawn) {
    drawn.kind = "sphere";
    drawn.sizes = {s.radius};
  }
  static void describe(const collision::Box& s, Playback::DrawnShape& drawn) {
    drawn.kind = "box";
    drawn.sizes = {s.half_extents.x(), s.half_extents.y(), s.half_extents.z()};
  }
  static void describe(const collision::Capsule& s, Playback::DrawnShape& drawn) {
    drawn.kind = "capsule";
    drawn.sizes = {s.radius, s.half_length};
  }
  static void describe(const collision::Cylinder& s, Playback::DrawnShape& drawn) {
    drawn.kind = "cylinder";
    drawn.sizes = {s.radius, s.half_length};
  }
  static void describe(const collision::Cone& s, Playback::DrawnShape& drawn) {
    drawn.kind = "cone";
    drawn.sizes = {s.radius, s.half_height};
  }
  static void describe(const collision::Ellipsoid& s, Playback::DrawnShape& drawn) {
    drawn.kind = "ellipsoid";
    drawn.sizes = {s.radii.x(), s.radii.y(), s.radii.z()};
  }
  static void describe(const collision::HalfSpace&, Playback::DrawnShape& drawn) {
    drawn.kind = "half_space";
  }
  void describe(const collision::ConvexHull& s, Playback::DrawnShape& drawn) {
    drawn.kind = "hull";
    drawn.surface = shared(*s.data);
  }
  void describe(const collision::TriangleMesh& s, Playback::DrawnShape& drawn) {
    drawn.kind = "mesh";
    drawn.surface = shared(*s.data);
  }
  static void describe(const collision::Compound&, Playback::DrawnShape&) {}  // add() took it apart

  template <typename Data>
  int shared(const Data& data) {
    const auto [found, is_new] =
        numbers_.try_emplace(&data, static_cast<int>(playback_.surfaces.size()));
    if (is_new) playback_.surfaces.push_back(surface_of(data));
    return found->second;
  }

  Playback& playback_;
  std::map<const void*, int> numbers_;
};

/// All of them, or the strongest, strongest first.
std::vector<Playback::DrawnContact> drawn(std::vector<ContactSample> contacts, std::size_t most) {
  if (contacts.size() > most) {
    const auto stronger = [](const ContactSample& a, const ContactSample& b) {
      return a.force.squaredNorm() > b.force.squaredNorm();
    };
    std::stable_sort(contacts.begin(), contacts.end(), stronger);
    contacts.resize(most);
  }
  std::vector<Playback::DrawnContact> result;
  result.reserve(contacts.size());
  for (const ContactSample& contact : contacts) {
    result.push_back(
        {contact.body_a, contact.body_b, numbers(contact.point), numbers(contact.force)});
  }
  return result;
}

Playback::PlaybackTrack play(const Scene& scene, const Track& track) {
  Playback::PlaybackTrack result;
  result.engine = track.engine;
  std::size_t total = 0;
  for (const auto& contacts : track.frame_contacts) total += contacts.size();
  const std::size_t most = total <= kMostContacts ? total : kMostContacts / track.frames.size();
  for (std::size_t f = 0; f < track.frames.size(); ++f) {
    Playback::Frame frame;
    frame.time = track.time[track.frames[f]];
    const std::vector<BodySample>& sample = track.bodies[track.frames[f]];
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].kind != BodyKind::kFixed) {
        frame.poses.push_back(placement(sample[i].pose));
      }
    }
    frame.contacts = drawn(track.frame_contacts[f], most);
    frame.all_contacts = track.frame_contacts[f].size();
    result.frames.push_back(std::move(frame));
  }
  return result;
}

}  // namespace

Playback make_playback(const Scene& scene, const Runs& runs) {
  Playback playback;
  playback.gravity = numbers(scene.gravity);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    playback.bodies.push_back(
        {scene.bodies[i].name, kind_name(scene.bodies[i].kind), placement(scene.state[i].pose())});
  }
  ShapeWriter shapes(playback);
  for (const collision::Collider& collider : scene.colliders) shapes.add(collider);
  for (const Joint& joint : scene.joints) {
    playback.joints.push_back({joint.name, std::string(to_string(joint.kind)), joint.body_a,
                               joint.body_b, numbers(joint.anchor_a), numbers(joint.anchor_b)});
  }
  runs.for_each([&](const Track& track) { playback.tracks.push_back(play(scene, track)); });
  return playback;
}

}  // namespace signorini::validation
