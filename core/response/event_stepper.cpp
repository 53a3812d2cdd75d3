#include <signorini/core/model/contact_kinematics.h>
#include <signorini/core/model/number_text.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/event_stepper.h>
#include <signorini/core/response/segment_motion.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

namespace signorini {
namespace {

/// Slower approach than this is left to the next look; m/s.
constexpr double kSettled = 1e-11;
/// A break-up is found to this, s; relative to the segment to some roundings.
constexpr double kTimeResolution = 1e-12;
/// RestingSettings::stabilization_time over the length of the segment: drift fades in so many.
constexpr double kStabilizing = 4.0;
/// Shorter segments are not divided, s.
constexpr double kShortest = 1e-10;

void require_positive(double value, const char* field, const char* unit) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string("event settings: ") + field +
                                ": must be finite and > 0, got " + number_text(value) + " " + unit);
  }
}

/// Resting contacts and what they do to the bodies.
struct Support {
  ContactSet contacts;
  RestingReport forces;
  std::vector<Wrench> loads;  // gravity and contact forces, one a body
};

}  // namespace

void EventSettings::validate() const {
  if (!gravity.allFinite()) {
    throw std::invalid_argument("event settings: gravity: must be finite, got " +
                                number_text(gravity) + " m/s^2");
  }
  require_positive(tolerance, "tolerance", "(rad, m)");
  require_positive(longest_segment, "longest_segment", "s");
  require_positive(touching, "touching", "m");
  require_positive(resting_speed, "resting_speed", "m/s");
  require_positive(separating_speed, "separating_speed", "m/s");
  if (impact.friction) {
    throw std::invalid_argument("event settings: impact.friction: must be off, got on");
  }
  if (most_events < 1) {
    throw std::invalid_argument("event settings: most_events: must be >= 1, got " +
                                std::to_string(most_events));
  }
  impact.validate(0);
}

std::string_view to_string(EventKind kind) {
  switch (kind) {
    case EventKind::kImpact: return "impact";
    case EventKind::kRest: return "rest";
    case EventKind::kBreakUp: return "break-up";
  }
  return "unknown event";
}

/// One advance().
class EventStepper::Run {
 public:
  Run(EventStepper& stepper, State& state, double duration, EventReport& report)
      : bodies_(stepper.bodies_),
        finder_(stepper.finder_),
        settings_(stepper.settings_),
        state_(state),
        duration_(duration),
        report_(report),
        next_length_(stepper.settings_.longest_segment) {
    settings_.impact.colliding_threshold = settings_.resting_speed;
  }

  void go() {
    report_ = {};
    while (report_.time < duration_) {
      find(state_);
      if (!settle()) {
        return;
      }
      if (static_cast<int>(report_.events.size()) >= settings_.most_events) {
        report_.status = lcp::Status::kIterationLimit;
        return;
      }
      settings_.resting.stabilization_time = kStabilizing * next_length_;
      if (!support(state_, support_)) {
        return;
      }
      held_ = support_.contacts;
      report_.resting_contacts = support_.contacts;
      report_.resting_forces = support_.forces.forces;
      report_.redundancy = support_.forces.redundancy;
      if (!take_segment()) {
        return;
      }
    }
    find(state_);
    if (settle()) {
      report_.status = lcp::Status::kSolved;
    }
  }

 private:
  void find(const State& state) {
    contacts_.clear();
    finder_.find(state, settings_.touching, contacts_);
    validate(contacts_, static_cast<int>(bodies_.size()));
    for (const Contact& contact : contacts_) {
      if (contact.material.resists_turning()) {
        throw std::invalid_argument("event stepper: rolling and spinning friction must be 0, got " +
                                    number_text(contact.material.rolling_friction) + " and " +
                                    number_text(contact.material.spinning_friction) + " m");
      }
      if (contact.material.friction > 0.0) {
        throw std::invalid_argument("event stepper: friction of bodies " +
                                    std::to_string(contact.body_a) + " and " +
                                    std::to_string(contact.body_b) + ": must be 0, got " +
                                    number_text(contact.material.friction));
      }
    }
  }

  /// The impact of the contacts found, if one approaches. @return false if it was not solved.
  bool settle() {
    const lcp::Vector d_dot = gap_velocities(bodies_, state_, contacts_);
    if (contacts_.empty() || d_dot.minCoeff() >= -kSettled) {
      return true;
    }
    ImpactReport impact;
    note_event(d_dot);
    resolve_impact(bodies_, contacts_, settings_.impact, state_, impact);
    if (!lcp::is_solved(impact.status)) {
      report_.status = impact.status;
      report_.detail = "impact at " + number_text(report_.time) + " s: " + impact.detail;
      return false;
    }
    report_.energy_change_impacts += impact.energy_after - impact.energy_before;
    return true;
  }

  /// An impact, or, slower and with 0 < e < 1, the end of the bounces; settling is no event.
  void note_event(const lcp::Vector& d_dot) {
    lcp::Index fastest = 0;
    const double speed = -d_dot.minCoeff(&fastest);
    const Contact& contact = contacts_[fastest];
    const double e = contact.material.restitution;
    Event event{
        .time = report_.time, .body_a = contact.body_a, .body_b = contact.body_b, .speed = speed};
    if (speed > settings_.resting_speed) {
      held_.clear();
      report_.events.push_back(event);
    } else if (e > 0.0 && e < 1.0 && speed > settings_.separating_speed) {
      event.kind = EventKind::kRest;
      RestingReport free;
      resting_forces(bodies_, state_, {contact}, gravity_loads(bodies_, settings_.gravity), {},
                     settings_.resting, free);
      if (free.b[0] < 0.0) {
        event.skipped_seconds = 2.0 * e * speed / (-free.b[0] * (1.0 - e));
      }
      report_.events.push_back(event);
    }
  }

  /// The forces of the resting contacts of a state, of the contacts found last.
  /// @return false if their problem was not solved.
  bool support(const State& state, Support& out) {
    const lcp::Vector d_dot = gap_velocities(bodies_, state, contacts_);
    out.contacts.clear();
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const double most =
          is_held(contacts_[i]) ? settings_.resting_speed : settings_.separating_speed;
      if (d_dot[static_cast<lcp::Index>(i)] <= most) {
        out.contacts.push_back(contacts_[i]);
      }
    }
    out.loads = gravity_loads(bodies_, settings_.gravity);
    out.forces = {};
    if (out.contacts.empty()) {
      return true;
    }
    ++report_.force_solves;
    resting_forces(bodies_, state, out.contacts, out.loads, {}, settings_.resting, out.forces);
    if (!lcp::is_solved(out.forces.status)) {
      report_.status = out.forces.status;
      report_.detail = "resting forces at " + number_text(report_.time) + " s";
      return false;
    }
    for (std::size_t i = 0; i < out.contacts.size(); ++i) {
      const Contact& contact = out.contacts[i];
      const Vec3 force = out.forces.forces[static_cast<lcp::Index>(i)] * contact.normal;
      push(contact.body_a, contact.point_a, force, state, out.loads);
      push(contact.body_b, contact.point_b, -force, state, out.loads);
    }
    return true;
  }

  [[nodiscard]] bool is_held(const Contact& contact) const {
    return std::any_of(held_.begin(), held_.end(),
                       [&](const Contact& held) { return same(contact, held); });
  }

  void push(int body, const Vec3& point, const Vec3& force, const State& state,
            std::vector<Wrench>& loads) const {
    if (bodies_[body].is_dynamic()) {
      loads[body].force += force;
      loads[body].torque += (point - state[body].x).cross(force);
    }
  }

  [[nodiscard]] std::vector<SegmentMotion> motions(const std::vector<Wrench>& loads) const {
    std::vector<SegmentMotion> made;
    made.reserve(bodies_.size());
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      made.emplace_back(bodies_[k], state_[k], loads[k]);
    }
    return made;
  }

  [[nodiscard]] static State at(const std::vector<SegmentMotion>& motions, double t) {
    State state;
    for (const SegmentMotion& motion : motions) {
      state.push_back(motion.state(t));
    }
    return state;
  }

  /// The middle's forces for a segment of this length; lost: a contact that pushes is gone there.
  /// @return false if they were not found.
  bool middle_loads(double length, std::vector<Wrench>& loads, bool& lost) {
    loads = support_.loads;
    lost = false;
    if (support_.contacts.empty()) {
      return true;
    }
    Support middle;
    const State halfway = at(motions(support_.loads), 0.5 * length);
    find(halfway);
    if (!support(halfway, middle)) {
      return false;
    }
    // A contact that pushes at the start and is gone midway was lost by going too far straight on.
    lost = std::any_of(support_.contacts.begin(), support_.contacts.end(), [&](const Contact& one) {
      return pushes(one, support_) &&
             !std::any_of(middle.contacts.begin(), middle.contacts.end(),
                          [&](const Contact& other) { return same(one, other); });
    });
    loads = middle.loads;
    return true;
  }

  /// The error of a segment over the tolerance.
  [[nodiscard]] double relative_error(double length, const std::vector<Wrench>& loads) const {
    double error = 0.0;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      if (!bodies_[k].is_dynamic()) {
        continue;
      }
      const SegmentMotion whole(bodies_[k], state_[k], loads[k]);
      const SegmentMotion second(bodies_[k], whole.state(0.5 * length), loads[k]);
      const Quat halves = second.state(0.5 * length).q;
      error = std::max(error, whole.state(length).q.angularDistance(halves));
      const double half_square = 0.5 * length * length;
      const Vec3 force = loads[k].force - support_.loads[k].force;
      const Vec3 torque = loads[k].torque - support_.loads[k].torque;
      error = std::max(error, half_square * force.norm() / bodies_[k].mass);
      error = std::max(
          error, half_square * (inverse_inertia_world(bodies_[k], state_[k]) * torque).norm());
    }
    return error / settings_.tolerance;
  }

  /// @return false if a problem was not solved.
  bool take_segment() {
    double length = std::min({duration_ - report_.time, next_length_, settings_.longest_segment});
    std::vector<Wrench> loads;
    for (;;) {
      bool lost = false;
      if (!middle_loads(length, loads, lost)) {
        return false;
      }
      const double error = lost ? 1e3 : relative_error(length, loads);
      if (error > 1.0 && length > kShortest) {
        length *= std::clamp(0.9 / std::cbrt(error), 0.1, 0.7);
        continue;
      }
      const std::vector<SegmentMotion> made = motions(loads);
      next_length_ = length * (error < 0.01 ? 2.0 : 1.2);
      return finish_segment(free_length(made, length), made);
    }
  }

  /// Up to where nothing new meets. The contact time's tolerance is far below what forces of second
  /// order let a resting pair drift, so it may report such a pair; what else meets in the segment
  /// is then looked for at its end, and found by bisection.
  double free_length(const std::vector<SegmentMotion>& motions, double length) {
    const std::optional<FirstContact> first = first_contact(motions, length);
    if (!first) {
      return length;
    }
    const bool rests = std::any_of(held_.begin(), held_.end(), [&](const Contact& held) {
      return std::minmax(held.body_a, held.body_b) == std::minmax(first->body_a, first->body_b);
    });
    if (!rests) {
      return std::max(first->time, kShortest);
    }
    if (!something_new_overlaps(motions, length)) {
      return length;
    }
    double free = 0.0;
    double met = length;
    while (met - free > std::max(kTimeResolution, 1e-15 * length)) {
      const double middle = 0.5 * (free + met);
      (something_new_overlaps(motions, middle) ? met : free) = middle;
    }
    return std::max(met, kShortest);
  }

  bool something_new_overlaps(const std::vector<SegmentMotion>& motions, double t) {
    const State then = at(motions, t);
    find(then);
    return std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& contact) {
      return contact.gap <= 0.0 && !is_held(contact) && gap_velocity(bodies_, then, contact) < 0.0;
    });
  }

  [[nodiscard]] std::optional<FirstContact> first_contact(const std::vector<SegmentMotion>& motions,
                                                          double length) const {
    std::vector<const Motion*> pointers;
    pointers.reserve(motions.size());
    for (const SegmentMotion& motion : motions) {
      pointers.push_back(&motion);
    }
    return finder_.first_contact(pointers, length);
  }

  bool finish_segment(double length, const std::vector<SegmentMotion>& motions) {
    int broken = -1;
    if (!find_break_up(motions, length, broken)) {
      return false;
    }
    state_ = at(motions, length);
    const bool last = length >= duration_ - report_.time;
    report_.time = last ? duration_ : report_.time + length;
    ++report_.segments;
    if (broken >= 0) {
      const Contact& contact = support_.contacts[broken];
      std::erase_if(held_, [&](const Contact& held) { return same(contact, held); });
      report_.events.push_back({.kind = EventKind::kBreakUp,
                                .time = report_.time,
                                .body_a = contact.body_a,
                                .body_b = contact.body_b});
    }
    return true;
  }

  /// Shortens the segment to where a force that was > 0 became 0; broken: its contact.
  bool find_break_up(const std::vector<SegmentMotion>& motions, double& length, int& broken) {
    if (support_.contacts.empty()) {
      return true;
    }
    if (!broken_at(motions, length, broken) || broken < 0) {
      return report_.status == lcp::Status::kNotRun;
    }
    double whole = 0.0;
    while (length - whole > std::max(kTimeResolution, 1e-15 * length)) {
      const double middle = 0.5 * (whole + length);
      int now = -1;
      if (!broken_at(motions, middle, now)) {
        return false;
      }
      if (now < 0) {
        whole = middle;
      } else {
        length = middle;
        broken = now;
      }
    }
    return true;
  }

  /// The first contact whose force was > 0 at the start and which does not push at t; -1: none.
  bool broken_at(const std::vector<SegmentMotion>& motions, double t, int& broken) {
    broken = -1;
    const State then = at(motions, t);
    find(then);
    Support now;
    if (!support(then, now)) {
      return false;
    }
    for (std::size_t i = 0; i < support_.contacts.size() && broken < 0; ++i) {
      const bool pushed = support_.forces.forces[static_cast<lcp::Index>(i)] > 0.0;
      if (pushed && !pushes(support_.contacts[i], now)) {
        broken = static_cast<int>(i);
      }
    }
    return true;
  }

  static bool pushes(const Contact& contact, const Support& support) {
    for (std::size_t j = 0; j < support.contacts.size(); ++j) {
      if (same(contact, support.contacts[j])) {
        return support.forces.forces[static_cast<lcp::Index>(j)] > 0.0;
      }
    }
    return false;
  }

  static bool same(const Contact& a, const Contact& b) {
    return a.body_a == b.body_a && a.body_b == b.body_b && a.feature_id == b.feature_id;
  }

  const Bodies& bodies_;
  ContactFinder& finder_;
  EventSettings settings_;
  State& state_;
  double duration_;
  EventReport& report_;
  double next_length_;
  ContactSet contacts_;  // touching, of the state looked at last
  Support support_;      // of the segment's start
  ContactSet held_;      // those of it that did not break
};

EventStepper::EventStepper(Bodies bodies, ContactFinder& finder, const EventSettings& settings)
    : bodies_(std::move(bodies)), finder_(finder), settings_(settings) {
  settings_.validate();
  for (const Body& body : bodies_) {
    validate(body);
  }
}

void EventStepper::advance(State& state, double duration, EventReport& report) {
  validate(bodies_, state);
  if (!(duration >= 0.0) || !std::isfinite(duration)) {
    throw std::invalid_argument("event stepper: duration: must be finite and >= 0, got " +
                                number_text(duration) + " s");
  }
  Run(*this, state, duration, report).go();
}

}  // namespace signorini
