#include <signorini/collision/collision_world.h>
#include <signorini/collision/contact_time.h>
#include <signorini/collision/feature_id.h>
#include <signorini/collision/pair_query.h>
#include <signorini/core/model/number_text.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace signorini::collision {
namespace {

/// Widened by a margin and by some roundings of its numbers, so that shapes that touch are never
/// passed over.
Bounds widened(const Bounds& tight, double margin) {
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
  const Vec3 far = tight.low.cwiseAbs().cwiseMax(tight.high.cwiseAbs());
  const Vec3 reach = Vec3::Constant(margin) + kRounding * (far + Vec3::Constant(margin));
  return {tight.low - reach, tight.high + reach};
}

/// Everywhere that a collider can be in [0, duration].
Bounds swept_bounds(const Collider& collider, const Motion& motion, double duration) {
  const SpeedBound speed = motion.speed_bound(0.0, duration);
  const double reach = bounding_radius(collider.shape, collider.local);
  const Vec3 centre = motion.pose(0.0).position;
  return widened({centre, centre}, reach + speed.linear * duration);
}

void check_finder_input(const std::string& what, std::size_t given, std::size_t bodies,
                        const char* number, double value) {
  if (given != bodies) {
    throw std::invalid_argument(what + ": must be one a body, " + std::to_string(bodies) +
                                ", got " + std::to_string(given));
  }
  if (!(value >= 0.0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string(number) + ": must be finite and >= 0, got " +
                                number_text(value));
  }
}

std::vector<bool> dynamic_bodies(const Bodies& bodies) {
  std::vector<bool> result;
  result.reserve(bodies.size());
  for (const Body& body : bodies) {
    result.push_back(body.is_dynamic());
  }
  return result;
}

}  // namespace

CollisionWorld::CollisionWorld(const Bodies& bodies, std::vector<Collider> colliders,
                               PairingRule rule, IgnoredPairs ignored)
    : colliders_(std::move(colliders)),
      is_dynamic_(dynamic_bodies(bodies)),
      rule_(rule),
      ignored_(std::move(ignored)) {
  ignored_.validate(static_cast<int>(bodies.size()));
  for (Collider& collider : colliders_) {
    validate(collider, static_cast<int>(bodies.size()));
    if (must_be_immovable(collider.shape) && is_dynamic_[collider.body]) {
      const bool is_mesh = std::holds_alternative<TriangleMesh>(collider.shape);
      throw std::invalid_argument("collider '" + collider.name + "': body: a " +
                                  (is_mesh ? "mesh" : "half-space") + " is immovable, body " +
                                  std::to_string(collider.body) + " is dynamic");
    }
    collider.local.orientation.normalize();
    is_immovable_.push_back(is_dynamic_[collider.body] ? 0 : 1);
  }
}

bool CollisionWorld::may_touch(int collider_a, int collider_b) const {
  const Collider& a = colliders_[collider_a];
  const Collider& b = colliders_[collider_b];
  return a.body != b.body && (is_dynamic_[a.body] || is_dynamic_[b.body]) &&
         may_collide(a.filter, b.filter) && !ignored_.contains(a.body, b.body);
}

void CollisionWorld::keep_at_most(int contacts_of_a_patch) {
  if (contacts_of_a_patch != 0 && contacts_of_a_patch < 3) {
    throw std::invalid_argument("keep_at_most: must be 0 (all) or >= 3, got " +
                                std::to_string(contacts_of_a_patch));
  }
  most_of_a_patch_ = contacts_of_a_patch;
  known_.forget();
}

void CollisionWorld::find(const State& state, double margin, ContactSet& contacts) {
  check_finder_input("state", state.size(), is_dynamic_.size(), "margin", margin);
  for (std::size_t i = 0; i < state.size(); ++i) {
    try {
      validate(state[i].pose());
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("body " + std::to_string(i) + ": " + error.what());
    }
  }

  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  const Clock::time_point start = Clock::now();
  poses_.clear();
  bounds_.clear();
  for (const Collider& collider : colliders_) {
    const Pose pose = state[collider.body].pose() * collider.local;
    poses_.push_back(pose);
    bounds_.push_back(widened(bounds(collider.shape, pose), 0.5 * margin));
  }
  broad_phase_.find(bounds_, is_immovable_, pairs_);
  const Clock::time_point paired = Clock::now();

  contacts.clear();
  loss_ = {};
  pairs_asked_ = 0;
  known_.begin(poses_, margin);
  for (const std::pair<int, int>& pair : pairs_) {
    if (!may_touch(pair.first, pair.second)) {
      continue;
    }
    ReductionLoss loss;
    std::span<const Contact> of_pair;
    if (const KnownContacts::Pair* known = known_.look_up(pair)) {
      loss = known->loss;
      of_pair = known_.contacts(*known);
    } else {
      loss = ask(pair, margin);
      of_pair = found_;
    }
    loss_.points += loss.points;
    loss_.area_before += loss.area_before;
    loss_.area_after += loss.area_after;
    contacts.insert(contacts.end(), of_pair.begin(), of_pair.end());
    known_.keep(pair, loss, of_pair);
  }
  find_seconds_ = {Seconds(paired - start).count(), Seconds(Clock::now() - paired).count()};
}

/// The contacts of a pair, as find() gives them, into found_.
ReductionLoss CollisionWorld::ask(const std::pair<int, int>& colliders, double margin) {
  ++pairs_asked_;
  const auto& [a, b] = colliders;
  find_intersection(colliders_[a].shape, poses_[a], colliders_[b].shape, poses_[b], margin, found_);
  ReductionLoss loss;
  if (most_of_a_patch_ != 0) {
    loss = reduce_contacts(found_, most_of_a_patch_);
  }
  for (Contact& contact : found_) {
    contact.body_a = colliders_[a].body;
    contact.body_b = colliders_[b].body;
    contact.material = pair(colliders_[a].material, colliders_[b].material, rule_);
    contact.friction_direction = friction_direction(a, b);
    contact.feature_id = scene_feature_id(a, b, contact.feature_id);
  }
  return loss;
}

/// That of collider a, if it has one, else that of b; world axes.
Vec3 CollisionWorld::friction_direction(int collider_a, int collider_b) const {
  const bool of_a = !colliders_[collider_a].friction_direction.isZero(0.0);
  const int chosen = of_a ? collider_a : collider_b;
  return poses_[chosen].orientation * colliders_[chosen].friction_direction;
}

std::optional<FirstContact> CollisionWorld::first_contact(std::span<const Motion* const> motions,
                                                          double duration, RestingPairs resting) {
  check_finder_input("motions", motions.size(), is_dynamic_.size(), "duration", duration);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (motions[i] == nullptr) {
      throw std::invalid_argument("motions: " + std::to_string(i) + ": must not be null");
    }
  }
  bounds_.clear();
  for (const Collider& collider : colliders_) {
    bounds_.push_back(swept_bounds(collider, *motions[collider.body], duration));
  }
  broad_phase_.find(bounds_, is_immovable_, pairs_);

  std::optional<FirstContact> first;
  for (const auto& [a, b] : pairs_) {
    const std::pair<int, int> bodies = std::minmax(colliders_[a].body, colliders_[b].body);
    if (!may_touch(a, b) || std::find(resting.begin(), resting.end(), bodies) != resting.end()) {
      continue;
    }
    const MovingShape moving_a{colliders_[a].shape, *motions[colliders_[a].body],
                               colliders_[a].local};
    const MovingShape moving_b{colliders_[b].shape, *motions[colliders_[b].body],
                               colliders_[b].local};
    const std::optional<double> time =
        contact_time(moving_a, moving_b, first ? first->time : duration);
    if (time && (!first || *time < first->time)) {
      first = FirstContact{*time, colliders_[a].body, colliders_[b].body};
    }
  }
  return first;
}

}  // namespace signorini::collision
