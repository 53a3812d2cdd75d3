#include <signorini/collision/hull_builder.h>
#include <signorini/collision/mesh.h>
#include <signorini/validation/bullet_file.h>
#include <signorini/validation/bullet_file_chunks.h>
#include <signorini/validation/bullet_file_world.h>
#include <signorini/validation/input_error.h>
#include <signorini/validation/scene_contacts.h>

#include "tools/child_process.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>

namespace signorini::validation {
namespace {

constexpr double kStep = 1.0 / 240.0;  // s
constexpr double kRunSeconds = 3600.0;

Vec3 vector_of(const FileVector& v) {
  return {v[0], v[1], v[2]};
}
Pose pose_of(const FilePose& p) {
  return {Vec3(p[0], p[1], p[2]), Quat(p[3], p[4], p[5], p[6]).normalized()};
}

/// What the work made of the bytes in a child. @throws InputError saying how the child ended
template <typename Answer>
Answer in_child(const std::string& source, double seconds, const auto& work) {
  const tools::ChildAnswer answer = tools::run_in_child(
      [&](const std::function<void()>& loaded) {
        loaded();
        return tools::to_bytes(work());
      },
      {.seconds = seconds});
  if (answer.end != tools::ChildEnd::kAnswered) {
    throw InputError(source + ": Bullet's loader and world ended without an answer: " +
                     (answer.end == tools::ChildEnd::kInterrupted ? "stopped" : answer.reason));
  }
  return tools::from_bytes<Answer>(answer.answer);
}

collision::Shape shape_of(const FileShape& shape) {
  std::vector<Vec3> points;
  for (const FileVector& point : shape.points) points.push_back(vector_of(point));
  switch (shape.kind) {
    case FileShapeKind::kSphere: return collision::Sphere{shape.size[0]};
    case FileShapeKind::kBox: return collision::Box{vector_of(shape.size)};
    case FileShapeKind::kCapsule: return collision::Capsule{shape.size[0], shape.size[1]};
    case FileShapeKind::kCylinder: return collision::Cylinder{shape.size[0], shape.size[1]};
    case FileShapeKind::kCone: return collision::Cone{shape.size[0], shape.size[1]};
    case FileShapeKind::kHalfSpace: return collision::HalfSpace{};
    case FileShapeKind::kMesh: return collision::make_mesh(points, shape.triangles);
    case FileShapeKind::kHull: break;
  }
#ifdef SIGNORINI_HAS_HULLS
  return collision::hull_of_points(points);
#else
  throw std::invalid_argument("convex hulls need Qhull (libqhull-dev), which this build lacks");
#endif
}

void add_body(const FileBody& from, Scene& scene) {
  Body body;
  body.name = from.name;
  body.kind = from.mass > 0.0 ? BodyKind::kDynamic : BodyKind::kFixed;
  if (body.is_dynamic()) {
    body.mass = from.mass;
    body.inertia = vector_of(from.moments).asDiagonal();
    body.gravity_scale = from.gravity_scale;
  }
  BodyState state;
  const Pose pose = pose_of(from.pose);
  state.x = pose.position;
  state.q = pose.orientation;
  if (body.is_dynamic()) {
    set_velocity(body, {vector_of(from.linear), vector_of(from.angular)}, state);
  }
  const int index = static_cast<int>(scene.bodies.size());
  scene.bodies.push_back(body);
  scene.state.push_back(state);
  for (std::size_t k = 0; k < from.shapes.size(); ++k) {
    collision::Collider collider;
    collider.body = index;
    collider.shape = shape_of(from.shapes[k]);
    collider.local = pose_of(from.shapes[k].pose);
    collider.material.friction = from.friction;
    collider.material.restitution = from.restitution;
    collider.name = from.shapes.size() == 1 ? from.name : fmt::format("{} {}", from.name, k + 1);
    scene.colliders.push_back(std::move(collider));
  }
}

JointKind kind_of(FileJointKind kind) {
  switch (kind) {
    case FileJointKind::kFixed: return JointKind::kFixed;
    case FileJointKind::kBall: return JointKind::kBall;
    case FileJointKind::kHinge: return JointKind::kHinge;
    case FileJointKind::kSlider: return JointKind::kSlider;
  }
  throw std::invalid_argument("unknown kind of joint");
}

/// The world as a body, for joints to it.
int world_body(Scene& scene) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == "world") return static_cast<int>(i);
  }
  Body world;
  world.name = "world";
  world.kind = BodyKind::kFixed;
  scene.bodies.push_back(world);
  scene.state.emplace_back();
  return static_cast<int>(scene.bodies.size()) - 1;
}

void add_joint(const FileJoint& from, Scene& scene) {
  Joint joint;
  joint.name = from.name;
  joint.kind = kind_of(from.kind);
  joint.body_a = from.body_a < 0 ? world_body(scene) : from.body_a;
  joint.body_b = from.body_b < 0 ? world_body(scene) : from.body_b;
  const Pose in_a = pose_of(from.in_a);
  const Pose in_b = pose_of(from.in_b);
  joint.anchor_a = in_a.position;
  joint.anchor_b = in_b.position;
  joint.axis =
      in_b.orientation * (joint.kind == JointKind::kSlider ? Vec3::UnitX() : Vec3::UnitZ()).eval();
  joint.axis.normalize();
  // R_A F_A = R_B F_B where nothing is turned.
  joint.reference = (in_b.orientation * in_a.orientation.conjugate()).normalized();
  if (joint.has_coordinate()) {
    joint.limits = {from.lower, from.upper};
    joint.motor = {from.motor_speed, from.motor_impulse / scene.step};
  }
  joint.bodies_collide = from.bodies_collide;
  if (!joint.bodies_collide) {
    scene.never_collide.push_back(std::minmax(joint.body_a, joint.body_b));
  }
  scene.joints.push_back(std::move(joint));
}

void refuse_or_note(const FileContents& contents, const ReadOptions& options, Scene& scene) {
  if (!contents.unsupported.empty() && !options.skip_unsupported) {
    throw InputError(scene.source + ": not supported: " + contents.unsupported.front() +
                     (contents.unsupported.size() > 1
                          ? fmt::format(" (and {} more)", contents.unsupported.size() - 1)
                          : ""));
  }
  for (const std::string& what : contents.unsupported) {
    scene.notices.push_back("skipped in ours: " + what);
  }
  scene.notices.insert(scene.notices.end(), contents.notices.begin(), contents.notices.end());
}

}  // namespace

Scene read_bullet_bytes(const std::string& bytes, const std::string& source,
                        const ReadOptions& options) {
  const BulletFileHeader header = check_bullet_chunks(bytes, source);
  const auto contents =
      in_child<FileContents>(source, 60.0, [&] { return BulletFileWorld(bytes).contents(); });
  Scene scene;
  scene.source = source;
  scene.text = bytes;
  scene.is_bullet_file = true;
  scene.name = std::filesystem::path(source).stem().string();
  scene.title = scene.name;
  scene.description = fmt::format(
      "A world of Bullet {}.{:02}, {} precision. Bullet runs the file's own world with the file's "
      "own settings; ours runs its bodies, shapes, constraints and materials.",
      header.version / 100, header.version % 100, header.is_double ? "double" : "single");
  scene.step = kStep;
  scene.gravity = vector_of(contents.gravity);
  scene.rule = PairingRule::kMultiply;
  scene.notices.push_back("a .bullet file has no step and no duration: 1/240 s and 5 s");
  refuse_or_note(contents, options, scene);
  try {
    for (const FileBody& body : contents.bodies) add_body(body, scene);
    for (const FileJoint& joint : contents.joints) add_joint(joint, scene);
  } catch (const std::invalid_argument& error) {
    throw InputError(source + ": " + error.what());
  }
  std::sort(scene.never_collide.begin(), scene.never_collide.end());
  if (options.ground) {
    throw InputError(source + ": --ground: a .bullet file is run as it is");
  }
  validate(scene);
  return scene;
}

Track run_bullet_file(const Scene& scene, const StopFlag* stop) {
  const long steps = scene.step_count();
  const long stride = recording_stride(steps, scene.bodies.size());
  Track track;
  track.engine = "bullet";
  track.step = scene.step;
  FileRun run;
  try {
    run = in_child<FileRun>(scene.source, kRunSeconds, [&] {
      return BulletFileWorld(scene.text).run(scene.step, steps, stride);
    });
  } catch (const InputError&) {
    if (stop == nullptr || !stop->load()) throw;
    track.interrupted = true;
  }
  track.remarks.push_back(fmt::format(
      "the file's own world and settings ({} iterations; of the profile nothing is used), sleeping "
      "off; contacts are not recorded",
      run.iterations));
  track.wall_seconds = run.seconds;
  SceneContacts ruler(scene);
  TrackRecorder recorder(scene.bodies, scene.gravity, steps, track);
  for (std::size_t record = 0; record < run.samples.size(); ++record) {
    const long k = std::min(static_cast<long>(record) * stride, steps);
    // Bodies that the scene has beside the file's (the world of its joints) rest.
    std::vector<BodySample> sample = sample_of(scene.bodies, scene.state);
    State state = scene.state;
    const std::vector<double>& numbers = run.samples[record];
    constexpr std::size_t kNumbers = 13;
    if (numbers.size() > kNumbers * sample.size()) {
      throw InputError(scene.source + ": Bullet's run has other bodies than the scene");
    }
    for (std::size_t i = 0; kNumbers * i < numbers.size(); ++i) {
      const double* n = numbers.data() + kNumbers * i;
      sample[i].pose = pose_of({n[0], n[1], n[2], n[3], n[4], n[5], n[6]});
      sample[i].velocity = {Vec3(n[7], n[8], n[9]), Vec3(n[10], n[11], n[12])};
      state[i].x = sample[i].pose.position;
      state[i].q = sample[i].pose.orientation;
    }
    track.steps = k;
    if (!is_finite(state)) {
      track.broke_down = true;
      break;
    }
    const OverlapMeasure overlap = measure_overlap(ruler, state);
    recorder.record(static_cast<double>(k) * scene.step, std::move(sample), overlap.deepest,
                    overlap.contacts);
    if (k == 0 || recorder.wants_frame(k)) recorder.record_frame();
  }
  return track;
}

}  // namespace signorini::validation
