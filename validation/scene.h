#pragma once

#include <signorini/collision/shape.h>
#include <signorini/core/model/body.h>
#include <signorini/core/model/joint.h>
#include <signorini/core/model/material.h>

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace signorini::validation {

/// Who of ours runs a scene.
enum class Stepper : unsigned char {
  kTime,    ///< TimeStepper: fixed steps
  kEvents,  ///< EventStepper: from event to event; the scene's step is that of what is recorded
};

/// What is simulated, whoever simulates it. Plain data; SI units, world axes.
struct Scene {
  std::string name;         ///< short, usable in a file name
  std::string title;        ///< for people
  std::string description;  ///< a paragraph
  std::string source;       ///< the file, or what stands for it
  std::string text;         ///< of that file, as it was read
  /// Every other file that it was made of (included models, meshes), sorted, each once.
  std::vector<std::string> files = {};
  bool is_bullet_file = false;  ///< text is a .bullet file, whose own world Bullet runs
  Bodies bodies;
  State state;  ///< at t = 0
  std::vector<collision::Collider> colliders;
  Joints joints;
  /// Pairs of bodies whose contacts do not exist (first < second, sorted): links of one model
  /// without self_collide, and bodies that a joint connects.
  std::vector<std::pair<int, int>> never_collide;
  Vec3 gravity = Vec3(0.0, 0.0, -9.8);  ///< m/s^2, SDFormat's default
  double step = 0.001;                  ///< s, > 0, SDFormat's default
  double duration = 5.0;                ///< s, > 0
  /// Gazebo's rule for friction and restitution.
  PairingRule rule = PairingRule::kMinimum;
  std::vector<std::string> notices;  ///< what of the file a run ignores
  /// What happens in it: one of scene_kinds(), or empty: not said.
  std::string kind;
  /// The name of the check whose error stands for the scene; empty: none does.
  std::string error;
  Stepper stepper = Stepper::kTime;
  double error_scale = 1.0;  ///< > 0: an error of this size is a wholly wrong answer; its unit

  /// Steps that cover the duration: the nearest whole number to duration / step, at least 1.
  [[nodiscard]] long step_count() const;
  /// The index of the body with this name. @throws std::out_of_range naming it.
  [[nodiscard]] int body(const std::string& body_name) const;
};

/// "stands", "slides" (rolling too), "bounces" (impacts of any kind), "free" (no contact).
[[nodiscard]] std::span<const std::string_view> scene_kinds();

/// Checks the whole scene. @throws InputError naming the scene, the body or collider and the field.
void validate(const Scene& scene);

/// The material of every kind of pair that can touch, one line a distinct value:
/// "friction 0.5, restitution 0 (ball / ground, and 3 more pairs)".
[[nodiscard]] std::vector<std::string> describe_pairs(const Scene& scene);

[[nodiscard]] std::string to_string(PairingRule rule);
/// "time-stepping", "event-driven".
[[nodiscard]] std::string to_string(Stepper stepper);

}  // namespace signorini::validation
