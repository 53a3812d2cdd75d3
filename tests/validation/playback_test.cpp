#include <signorini/collision/compound.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>
#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/bullet_runner.h>
#include <signorini/validation/playback_json.h>
#include <signorini/validation/scene_playback.h>
#include <signorini/validation/signorini_runner.h>

#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace signorini::validation {
namespace {

using Json = nlohmann::ordered_json;

/// As docs/report-schema.md says: 16-bit integers, low byte first.
std::vector<std::int16_t> unpack(const Json& base64) {
  const std::string text = base64.get<std::string>();
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  for (std::size_t i = 0; i + 3 < text.size(); i += 4) {
    std::uint32_t group = 0;
    int count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      group <<= 6U;
      if (text[i + k] == '=') continue;
      group |= static_cast<std::uint32_t>(alphabet.find(text[i + k]));
      ++count;
    }
    for (int k = 0; k + 1 < count; ++k) {
      bytes.push_back(static_cast<unsigned char>(group >> (16U - 8U * static_cast<unsigned>(k))));
    }
  }
  std::vector<std::int16_t> values;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    values.push_back(static_cast<std::int16_t>(bytes[i] | (bytes[i + 1] << 8)));
  }
  return values;
}

Runs both(const Scene& scene) {
  Runs runs;
  runs.signorini = run_signorini(scene, step_settings(scene));
  runs.bullet = run_bullet(scene, BulletProfile::neutral());
  return runs;
}

Scene builtin(const std::string& name, double duration) {
  Scene scene = load_builtin_scene(*find_builtin_scene(name));
  scene.duration = duration;
  return scene;
}

TEST(Playback, PosesComeBackToASixteenthBit) {
  const Scene scene = builtin("ball-drop-e0.5", 1.0);
  const Runs runs = both(scene);
  const Json json = playback_json(make_playback(scene, runs));
  ASSERT_EQ(json["bodies"].size(), 2U);
  EXPECT_EQ(json["bodies"][0]["kind"], "dynamic");
  EXPECT_EQ(json["bodies"][1]["kind"], "fixed");
  ASSERT_EQ(json["tracks"].size(), 2U);
  for (const Track* track : {&*runs.signorini, &*runs.bullet}) {
    const Json& played = json["tracks"][track == &*runs.signorini ? 0 : 1];
    EXPECT_EQ(played["engine"], track->engine);
    const Json& poses = played["poses"];
    const std::vector<std::int16_t> data = unpack(poses["data"]);
    ASSERT_EQ(data.size(), track->frames.size() * 7);  // the ground does not move
    ASSERT_EQ(played["time"].size(), track->frames.size());
    EXPECT_LE(track->frames.size(), 302U);
    EXPECT_EQ(track->frames.back(), track->size() - 1);
    for (std::size_t f = 0; f < track->frames.size(); ++f) {
      const Pose& pose = track->bodies[track->frames[f]][0].pose;
      for (int k = 0; k < 3; ++k) {
        const double step = poses["step"][k];
        const double value = poses["middle"][k].get<double>() + step * data[f * 7 + k];
        // Half a step, and the 7 digits of the middle where nothing moves.
        EXPECT_NEAR(value, pose.position[k], 0.51 * step + 1e-6);
      }
      EXPECT_NEAR(data[f * 7 + 3] / 32767.0, pose.orientation.w(), 0.51 / 32767.0);
    }
  }
}

TEST(Playback, AJointIsThereWithItsAnchors) {
  const Scene scene = builtin("pendulum", 0.1);
  ASSERT_FALSE(scene.joints.empty());
  const Json joints = playback_json(make_playback(scene, both(scene)))["joints"];
  ASSERT_EQ(joints.size(), scene.joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = scene.joints[i];
    EXPECT_EQ(joints[i]["kind"], to_string(joint.kind));
    EXPECT_EQ(joints[i]["body_a"], joint.body_a);
    EXPECT_EQ(joints[i]["body_b"], joint.body_b);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(joints[i]["anchor_a"][k].get<double>(), joint.anchor_a[k], 1e-6);
      EXPECT_NEAR(joints[i]["anchor_b"][k].get<double>(), joint.anchor_b[k], 1e-6);
    }
  }
}

TEST(Playback, ImpactsBetweenFramesAreSeenInBothEngines) {
  Scene scene = builtin("ball-drop-e0.5", 1.0);
  scene.step /= 8.0;
  ASSERT_GT(frame_stride(scene.step_count(), scene.bodies.size()), 1);
  const Runs runs = both(scene);
  for (const Playback::PlaybackTrack& track : make_playback(scene, runs).tracks) {
    double impulse = 0.0;  // on the ball
    for (std::size_t f = 1; f < track.frames.size(); ++f) {
      const double elapsed = track.frames[f].time - track.frames[f - 1].time;
      for (const Playback::DrawnContact& contact : track.frames[f].contacts) {
        impulse += (contact.body_a == 0 ? 1.0 : -1.0) * contact.force[2] * elapsed;
      }
    }
    const Track& run = track.engine == "bullet" ? *runs.bullet : *runs.signorini;
    const double change = run.last(0).velocity.linear.z() - run.bodies[0][0].velocity.linear.z();
    const double weight = scene.bodies[0].mass * scene.gravity.norm() * run.time.back();
    EXPECT_NEAR(impulse, scene.bodies[0].mass * change + weight, 1e-6) << track.engine;
  }
}

TEST(Playback, ForcesAreThoseThatChangeTheMomentumInBothEngines) {
  const Scene scene = builtin("stack-of-5", 0.5);
  ASSERT_EQ(frame_stride(scene.step_count(), scene.bodies.size()), 1);
  const Runs runs = both(scene);
  const Playback playback = make_playback(scene, runs);
  const int ground = scene.body("ground");
  double weight = 0.0;
  for (const Body& body : scene.bodies) {
    if (body.is_dynamic()) weight += body.mass * scene.gravity.norm();
  }
  for (const Playback::PlaybackTrack& track : playback.tracks) {
    EXPECT_TRUE(track.frames.front().contacts.empty());
    double impulse = 0.0;  // by the ground, upwards
    for (const Playback::Frame& frame : track.frames) {
      for (const Playback::DrawnContact& contact : frame.contacts) {
        if (contact.body_b == ground) impulse += contact.force[2] * scene.step;
        if (contact.body_a == ground) impulse -= contact.force[2] * scene.step;
        EXPECT_LT(std::abs(contact.point[2] - std::round(contact.point[2])), 0.05);
      }
    }
    const Track& run = track.engine == "bullet" ? *runs.bullet : *runs.signorini;
    const double change =
        (momentum(scene.bodies, run.bodies.back()) - momentum(scene.bodies, run.bodies.front()))
            .z();
    const double time = run.time.back();
    EXPECT_GT(impulse, 0.5 * weight * time);
    EXPECT_NEAR(impulse, weight * time + change, 1e-9 * weight * time) << track.engine;
  }
  const Json json = playback_json(playback);
  for (const Json& track : json["tracks"]) {
    const std::size_t frames = track["time"].size();
    ASSERT_EQ(track["contacts"]["count"].size(), frames);
    std::size_t total = 0;
    for (const Json& count : track["contacts"]["count"]) total += count.get<std::size_t>();
    EXPECT_EQ(track["contacts"]["count"], track["contacts"]["count_whole"]);
    EXPECT_EQ(unpack(track["contacts"]["bodies"]).size(), 2 * total);
    EXPECT_EQ(unpack(track["contacts"]["data"]).size(), 6 * total);
  }
}

Scene one_body(const collision::Shape& shape) {
  Scene scene;
  Body body;
  body.kind = BodyKind::kFixed;
  scene.bodies.push_back(body);
  scene.state.emplace_back();
  collision::Collider collider;
  collider.body = 0;
  collider.shape = shape;
  scene.colliders.push_back(collider);
  return scene;
}

TEST(Playback, DrawsEveryKindOfShape) {
  const collision::ConvexHull hull =
      collision::make_hull({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                           {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
  const std::vector<std::pair<collision::Shape, std::string>> kinds = {
      {collision::Sphere{2.0}, "sphere"},
      {collision::Box{Vec3(1, 2, 3)}, "box"},
      {collision::Capsule{1.0, 2.0}, "capsule"},
      {collision::Cylinder{1.0, 2.0}, "cylinder"},
      {collision::Cone{1.0, 2.0}, "cone"},
      {collision::Ellipsoid{Vec3(1, 2, 3)}, "ellipsoid"},
      {collision::HalfSpace{}, "half_space"},
      {hull, "hull"},
      {collision::make_mesh({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}), "mesh"}};
  for (const auto& [shape, kind] : kinds) {
    const Playback playback = make_playback(one_body(shape), {});
    ASSERT_EQ(playback.shapes.size(), 1U);
    EXPECT_EQ(playback.shapes[0].kind, kind);
    EXPECT_EQ(playback.surfaces.size(), kind == "hull" || kind == "mesh" ? 1U : 0U);
    const Json json = playback_json(playback);
    EXPECT_EQ(json["shapes"][0]["surface"].is_null(), playback.surfaces.empty());
  }
}

TEST(Playback, CompoundIsItsPartsAndASharedHullIsWrittenOnce) {
  const collision::ConvexHull hull =
      collision::make_hull({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                           {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
  const collision::Compound compound =
      collision::make_compound({{hull, Pose{Vec3(1, 0, 0), Quat::Identity()}},
                                {hull, Pose{Vec3(0, 2, 0), Quat::Identity()}}});
  Scene scene = one_body(compound);
  scene.colliders[0].local.position = Vec3(0, 0, 5);
  const Playback playback = make_playback(scene, {});
  ASSERT_EQ(playback.shapes.size(), 2U);
  EXPECT_EQ(playback.surfaces.size(), 1U);
  EXPECT_EQ(playback.surfaces[0].triangles.size(), 4U);
  EXPECT_EQ(playback.shapes[1].local.position, (std::array<double, 3>{0.0, 2.0, 5.0}));
}

TEST(Playback, LargeMeshesAreThinnedAndSaySo) {
  constexpr int kSide = 201;
  const collision::TriangleMesh field =
      collision::make_height_field(std::vector<double>(kSide * kSide, 0.5), kSide, kSide, 0.1, 0.1);
  const Playback playback = make_playback(one_body(field), {});
  ASSERT_EQ(playback.surfaces.size(), 1U);
  EXPECT_EQ(playback.surfaces[0].whole_triangles, 2U * (kSide - 1) * (kSide - 1));
  EXPECT_LE(playback.surfaces[0].triangles.size(), 20000U);
  EXPECT_GT(playback.surfaces[0].triangles.size(), 2000U);
}

TEST(Playback, ManyBodiesGetFewerFrames) {
  EXPECT_EQ(frame_stride(300, 10), 1);
  EXPECT_EQ(frame_stride(5000, 10), 17);
  EXPECT_EQ(frame_stride(1000, 3000), 34);
  EXPECT_EQ(frame_stride(1000, 3000) % recording_stride(1000, 3000), 0);
}

}  // namespace
}  // namespace signorini::validation
