#include <signorini/core/model/contact_kinematics.h>
#include <signorini/core/model/number_text.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/event_stepper.h>
#include <signorini/core/response/event_support.h>
#include <signorini/core/response/impact_without_collision.h>
#include <signorini/core/response/segment_motion.h>

#include <algorithm>
#include <chrono>
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
/// RestingSettings::stabilization_time over the length of the segment: drift fades in so many; and
/// the shortest, s: in less time overlap would take forces that themselves shorten the segments.
constexpr double kStabilizing = 4.0;
constexpr double kShortestStabilizing = 0.01;
/// RestingSettings::slip_time over the length of the segment; friction bounds its forces.
constexpr double kStopping = 2.0;
/// Shorter segments are not divided, s.
constexpr double kShortest = 1e-10;
/// How long a pair is passed over whose gap closes while its contacts separate, s.
constexpr double kBlind = 1e-5;

void require_positive(double value, const char* field, const char* unit) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw std::invalid_argument(std::string("event settings: ") + field +
                                ": must be finite and > 0, got " + number_text(value) + " " + unit);
  }
}

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
  require_positive(sticking_speed, "sticking_speed", "m/s");
  if (most_events < 1) {
    throw std::invalid_argument("event settings: most_events: must be >= 1, got " +
                                std::to_string(most_events));
  }
  if (most_segments < 1) {
    throw std::invalid_argument("event settings: most_segments: must be >= 1, got " +
                                std::to_string(most_segments));
  }
  if (!(time_limit > 0.0)) {
    throw std::invalid_argument("event settings: time_limit: must be > 0, got " +
                                number_text(time_limit) + " s");
  }
  impact.validate(0);
  resting.validate();
}

std::string_view to_string(EventKind kind) {
  switch (kind) {
    case EventKind::kImpact: return "impact";
    case EventKind::kRest: return "rest";
    case EventKind::kBreakUp: return "break-up";
    case EventKind::kStick: return "stick";
    case EventKind::kReversal: return "reversal";
    case EventKind::kSlip: return "slip";
    case EventKind::kImpactWithoutCollision: return "impact without collision";
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
      settings_.resting.stabilization_time =
          std::max(kStabilizing * next_length_, kShortestStabilizing);
      settings_.resting.slip_time = kStopping * next_length_;
      support_ = support(state_);
      const bool consistent = lcp::is_solved(support_.status);
      if (consistent) {
        note_changes();
        hold();
      } else if (!end_inconsistency()) {
        return;
      }
      if (is_out_of_bounds()) {
        return;
      }
      if (consistent) {
        take_segment();
      }
    }
    find(state_);
    if (settle()) {
      report_.status = lcp::Status::kSolved;
    }
  }

 private:
  /// Whether a limit of the settings ends the run; the report then says which.
  bool is_out_of_bounds() {
    const auto end = [this](lcp::Status status, const char* which) {
      report_.status = status;
      report_.detail = std::string(which) + " at " + number_text(report_.time) + " s";
      return true;
    };
    if (static_cast<int>(report_.events.size()) >= settings_.most_events) {
      return end(lcp::Status::kIterationLimit, "most_events");
    }
    if (report_.segments >= settings_.most_segments) {
      return end(lcp::Status::kIterationLimit, "most_segments");
    }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
    return spent.count() > settings_.time_limit && end(lcp::Status::kTimeLimit, "time_limit");
  }

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
    settings_.impact.friction =
        std::any_of(contacts_.begin(), contacts_.end(),
                    [](const Contact& contact) { return contact.material.friction > 0.0; });
    const State before = state_;
    resolve_impact(bodies_, contacts_, settings_.impact, state_, impact);
    if (!lcp::is_solved(impact.status)) {
      report_.status = impact.status;
      report_.detail = "impact at " + number_text(report_.time) + " s: " + impact.detail;
      return false;
    }
    report_.energy_change_impacts += impact.energy_after - impact.energy_before;
    note_jam(before, -d_dot.minCoeff());
    return true;
  }

  /// Impulses that settle what all but rests change the slip by a few times what they settle. Where
  /// they change it a thousand times as much the state was inconsistent, and they jumped.
  void note_jam(const State& before, double speed) {
    constexpr double kJumps = 1e3;
    if (speed > settings_.resting_speed) {
      return;
    }
    Event event{.kind = EventKind::kImpactWithoutCollision, .time = report_.time};
    bool has_jumped = false;
    for (const Contact& contact : contacts_) {
      const Vec3 slip = tangential_slip(bodies_, before, contact);
      const Vec3 change = tangential_slip(bodies_, state_, contact) - slip;
      has_jumped =
          has_jumped || (contact.material.friction > 0.0 && change.norm() > kJumps * speed &&
                         change.norm() > settings_.resting_speed);
      if (contact.material.friction > 0.0 && slip.norm() > event.speed) {
        event.speed = slip.norm();
        event.body_a = contact.body_a;
        event.body_b = contact.body_b;
      }
    }
    if (has_jumped) {
      report_.events.push_back(event);
    }
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
      forget_struck(d_dot);
      report_.events.push_back(event);
    } else if (e > 0.0 && e < 1.0 && speed > settings_.separating_speed && !is_held(contact)) {
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

  /// What rested in connected sets with an impact is no longer held.
  void forget_struck(const lcp::Vector& d_dot) {
    const std::vector<int> set_of_contact = connected_sets(bodies_, contacts_);
    std::vector<bool> is_struck(contacts_.size(), false);  // by set
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (d_dot[static_cast<lcp::Index>(i)] < -settings_.resting_speed) {
        is_struck[set_of_contact[i]] = true;
      }
    }
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (is_struck[set_of_contact[i]]) {
        forget(contacts_[i]);
      }
    }
  }

  void forget(const Contact& contact) {
    std::erase_if(held_,
                  [&](const RestingContact& held) { return same_features(held.contact, contact); });
  }

  /// Of the contacts found last, in their state.
  [[nodiscard]] Support support(const State& state) {
    Support made = find_support(bodies_, state, contacts_, held_, settings_);
    report_.force_solves += made.contacts.empty() ? 0 : 1;
    return made;
  }

  /// The impact without collision of the contacts whose forces were not found, if it is one.
  bool end_inconsistency() {
    const RestingContacts& contacts = support_.unsolved;
    ContactSet set;
    lcp::Vector b(static_cast<lcp::Index>(contacts.size()));
    Event event{.kind = EventKind::kImpactWithoutCollision,
                .time = report_.time,
                .forces_status = support_.status};
    for (const RestingContact& one : contacts) {
      b[static_cast<lcp::Index>(set.size())] = one.b;
      set.push_back(one.contact);
      const double slip = tangential_slip(bodies_, state_, one.contact).norm();
      if (one.contact.material.friction > 0.0 && slip > event.speed) {
        event.speed = slip;
        event.body_a = one.contact.body_a;
        event.body_b = one.contact.body_b;
      }
    }
    report_.status = support_.status;
    report_.detail = "resting forces at " + number_text(report_.time) + " s";
    if (event.speed <= settings_.sticking_speed) {
      return false;
    }
    const double before = kinetic_energy(bodies_, state_);
    const ShockReport shock = impact_without_collision(bodies_, set, b, settings_.resting, state_);
    if (!lcp::is_solved(shock.status)) {
      report_.detail +=
          ", and no impact without collision: " + std::string(lcp::to_string(shock.status)) +
          (shock.detail.empty() ? "" : " (" + shock.detail + ")");
      return false;
    }
    report_.status = lcp::Status::kNotRun;
    report_.detail.clear();
    report_.energy_change_impacts += kinetic_energy(bodies_, state_) - before;
    report_.events.push_back(event);
    for (const RestingContact& one : contacts) {
      forget(one.contact);
    }
    return true;
  }

  /// Contacts that stuck in the last segment and slide now, and the other way round.
  void note_changes() {
    for (const RestingContact& now : support_.contacts) {
      const RestingContact* before = signorini::find(held_, now.contact);
      if (before == nullptr) {
        continue;
      }
      Event event{.time = report_.time, .body_a = now.contact.body_a, .body_b = now.contact.body_b};
      const bool slid = before->mode == ContactMode::kSlides;
      const bool slides = now.mode == ContactMode::kSlides;
      if (slid && now.mode == ContactMode::kSticks) {
        event.kind = EventKind::kStick;
      } else if (slid && slides && now.direction.dot(before->direction) < 0.0) {
        event.kind = EventKind::kReversal;
      } else if (before->mode == ContactMode::kSticks && slides) {
        event.kind = EventKind::kSlip;
      } else {
        continue;
      }
      report_.events.push_back(event);
    }
  }

  /// What rests now is what the next segment holds, and what the report tells.
  void hold() {
    held_ = support_.contacts;
    report_.redundancy = support_.redundancy;
    report_.resting_contacts.clear();
    report_.resting_contact_forces.clear();
    report_.resting_modes.clear();
    report_.resting_forces.resize(static_cast<lcp::Index>(held_.size()));
    for (const RestingContact& one : held_) {
      report_.resting_forces[static_cast<lcp::Index>(report_.resting_contacts.size())] =
          one.normal_force;
      report_.resting_contacts.push_back(one.contact);
      report_.resting_contact_forces.push_back(one.force);
      report_.resting_modes.push_back(one.mode);
    }
  }

  [[nodiscard]] bool is_held(const Contact& contact) const {
    return signorini::find(held_, contact) != nullptr;
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

  /// The middle's forces for a segment of this length. @return false if it goes too far straight
  /// on: a contact that closes at the start is gone midway, or there are no forces there.
  bool middle_loads(double length, std::vector<Wrench>& loads) {
    loads = support_.loads;
    if (support_.contacts.empty()) {
      return true;
    }
    const State halfway = at(motions(support_.loads), 0.5 * length);
    find(halfway);
    const Support middle = support(halfway);
    if (!lcp::is_solved(middle.status)) {
      return false;
    }
    loads = middle.loads;
    return std::all_of(support_.contacts.begin(), support_.contacts.end(),
                       [&](const RestingContact& one) {
                         return one.mode == ContactMode::kOpens ||
                                signorini::find(middle.contacts, one.contact) != nullptr;
                       });
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

  void take_segment() {
    double length = std::min({duration_ - report_.time, next_length_, settings_.longest_segment});
    std::vector<Wrench> loads;
    for (;;) {
      const double error = middle_loads(length, loads) ? relative_error(length, loads) : 1e3;
      if (error > 1.0 && length > kShortest) {
        length *= std::clamp(0.9 / std::cbrt(error), 0.1, 0.7);
        continue;
      }
      const std::vector<SegmentMotion> made = motions(loads);
      next_length_ = length * (error < 0.01 ? 2.0 : 1.2);
      finish_segment(free_length(made, length), made);
      return;
    }
  }

  /// Up to where nothing new meets. Pairs that rest are looked at at the end alone, and what else
  /// meets between them is found by bisection: forces of second order let them drift by more than
  /// the contact time's tolerance.
  double free_length(const std::vector<SegmentMotion>& motions, double length) {
    length = until_contact(motions, length);
    if (held_.empty() || !something_new_overlaps(motions, length)) {
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

  double until_contact(const std::vector<SegmentMotion>& motions, double length) {
    BodyPairs passed_over = resting_pairs();
    for (;;) {
      const std::optional<FirstContact> first = first_contact(motions, length, passed_over);
      if (!first) {
        return length;
      }
      if (first->time > kShortest) {
        return first->time;
      }
      find(state_);
      if (!separates(first->body_a, first->body_b)) {
        return kShortest;
      }
      passed_over.push_back(std::minmax(first->body_a, first->body_b));
      length = std::min(length, kBlind);
      ++report_.blind_pairs;
    }
  }

  /// Whether two bodies touch now and none of their contacts, those found last, approaches.
  [[nodiscard]] bool separates(int body_a, int body_b) const {
    bool touch = false;
    for (const Contact& contact : contacts_) {
      if (std::minmax(contact.body_a, contact.body_b) == std::minmax(body_a, body_b)) {
        touch = true;
        if (gap_velocity(bodies_, state_, contact) < 0.0) {
          return false;
        }
      }
    }
    return touch;
  }

  /// Between bodies that rest on each other.
  bool something_new_overlaps(const std::vector<SegmentMotion>& motions, double t) {
    const State then = at(motions, t);
    find(then);
    return std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& contact) {
      return contact.gap <= 0.0 && rests(contact.body_a, contact.body_b) && !is_held(contact) &&
             gap_velocity(bodies_, then, contact) < 0.0;
    });
  }

  [[nodiscard]] bool rests(int body_a, int body_b) const {
    return std::any_of(held_.begin(), held_.end(), [&](const RestingContact& held) {
      return std::minmax(held.contact.body_a, held.contact.body_b) == std::minmax(body_a, body_b);
    });
  }

  [[nodiscard]] std::optional<FirstContact> first_contact(const std::vector<SegmentMotion>& motions,
                                                          double length,
                                                          const BodyPairs& passed_over) const {
    std::vector<const Motion*> pointers;
    pointers.reserve(motions.size());
    for (const SegmentMotion& motion : motions) {
      pointers.push_back(&motion);
    }
    return finder_.first_contact(pointers, length, passed_over);
  }

  [[nodiscard]] BodyPairs resting_pairs() const {
    BodyPairs pairs;
    for (const RestingContact& held : held_) {
      pairs.push_back(std::minmax(held.contact.body_a, held.contact.body_b));
    }
    return pairs;
  }

  void finish_segment(double length, const std::vector<SegmentMotion>& motions) {
    const RestingContact* broken = nullptr;
    if (!support_.contacts.empty() && changes_at(motions, length, broken)) {
      find_change(motions, length, broken);
    }
    const State end = at(motions, length);
    find(end);
    for (RestingContact& held : held_) {
      const auto now = std::find_if(contacts_.begin(), contacts_.end(), [&](const Contact& one) {
        return same_features(held.contact, one);
      });
      held.turned_back = now != contacts_.end() && turns_back(held, *now, end);
    }
    state_ = end;
    const bool last = length >= duration_ - report_.time;
    report_.time = last ? duration_ : report_.time + length;
    ++report_.segments;
    if (broken != nullptr) {
      const Contact& contact = broken->contact;
      forget(contact);
      report_.events.push_back({.kind = EventKind::kBreakUp,
                                .time = report_.time,
                                .body_a = contact.body_a,
                                .body_b = contact.body_b});
    }
  }

  /// Shortens the segment to the first change.
  void find_change(const std::vector<SegmentMotion>& motions, double& length,
                   const RestingContact*& broken) {
    double whole = 0.0;
    while (length - whole > std::max(kTimeResolution, 1e-15 * length)) {
      const double middle = 0.5 * (whole + length);
      const RestingContact* now = nullptr;
      if (changes_at(motions, middle, now)) {
        length = middle;
        broken = now;
      } else {
        whole = middle;
      }
    }
  }

  /// Whether a contact of the segment's start no longer does at t what it did; broken: the first
  /// that closed and does not push.
  bool changes_at(const std::vector<SegmentMotion>& motions, double t,
                  const RestingContact*& broken) {
    broken = nullptr;
    const State then = at(motions, t);
    find(then);
    const Support now = support(then);
    if (!lcp::is_solved(now.status)) {
      return true;
    }
    bool changes = false;
    for (const RestingContact& one : support_.contacts) {
      const RestingContact* other = signorini::find(now.contacts, one.contact);
      const bool open = other == nullptr || other->mode == ContactMode::kOpens;
      if (one.mode != ContactMode::kOpens && open) {
        broken = &one;
        return true;
      }
      if (other == nullptr) {
        continue;  // it was about to open, and did
      }
      changes = changes || turns_back(one, other->contact, then) ||
                (one.mode == ContactMode::kSticks && other->mode == ContactMode::kSlides);
    }
    return changes;
  }

  /// Whether a contact that slid in the direction of its slip slips the other way then.
  [[nodiscard]] bool turns_back(const RestingContact& start, const Contact& now,
                                const State& then) const {
    return start.mode == ContactMode::kSlides && !start.may_stick &&
           tangential_slip(bodies_, then, now).dot(start.direction) <= 0.0;
  }

  const Bodies& bodies_;
  ContactFinder& finder_;
  EventSettings settings_;
  State& state_;
  double duration_;
  EventReport& report_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double next_length_;
  ContactSet contacts_;   // touching, of the state looked at last
  Support support_;       // of the segment's start
  RestingContacts held_;  // those of it that did not break
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
