#include <signorini/validation/bullet_profile.h>

#include <fmt/format.h>
#include <limits>
#include <stdexcept>

namespace signorini::validation {
namespace {

const char* text(BulletGyroscopic gyroscopic) {
  switch (gyroscopic) {
    case BulletGyroscopic::kNone: return "none";
    case BulletGyroscopic::kExplicit: return "explicit";
    case BulletGyroscopic::kImplicitBody: return "implicit, body frame (Bullet's default)";
    case BulletGyroscopic::kImplicitWorld: return "implicit, world frame";
  }
  return "";
}

}  // namespace

BulletProfile BulletProfile::neutral() {
  BulletProfile profile;
  profile.name = "neutral";
  return profile;
}

BulletProfile BulletProfile::bullet_default() {
  return {.name = "default",
          .iterations = 10,
          .contact_processing_threshold = std::numeric_limits<double>::infinity(),
          .split_impulse_penetration_threshold = -0.04,
          .restitution_velocity_threshold = 0.2};
}

BulletProfile BulletProfile::named(const std::string& name) {
  for (const BulletProfile& profile : {neutral(), bullet_default()}) {
    if (profile.name == name) return profile;
  }
  throw std::invalid_argument("Bullet profile: must be neutral or default, got '" + name + "'");
}

std::vector<std::string> BulletProfile::describe() const {
  return {
      fmt::format("Bullet, double precision, profile '{}': sequential impulses, {} iterations, "
                  "warm start {:g}, sleeping {}",
                  name, iterations, warm_starting_factor, sleeping ? "on" : "off"),
      fmt::format("Bullet: contact processing threshold {:g} m, split impulse below {:g} m, "
                  "restitution above {:g} m/s",
                  contact_processing_threshold, split_impulse_penetration_threshold,
                  restitution_velocity_threshold),
      fmt::format("Bullet: gyroscopic torque {}; no damping; half-spaces are boxes of half edge "
                  "{:g} m; every pair has the same friction and restitution as ours",
                  text(gyroscopic), ground_half_edge)};
}

}  // namespace signorini::validation
