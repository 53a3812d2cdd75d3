#pragma once

#include <signorini/core/model/contact_finder.h>
#include <signorini/core/response/coulomb_forces.h>
#include <signorini/core/response/impact.h>
#include <signorini/core/response/resting.h>

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace signorini {

/// Settings of EventStepper.
struct EventSettings {
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);  ///< m/s^2, finite
  /// Of one segment: the turn of a body in rad, its way in m (of bodies that contact forces push);
  /// finite, > 0.
  double tolerance = 1e-9;
  double longest_segment = 0.1;  ///< s, finite, > 0: forces are looked at anew at least so often
  /// Contacts with gap at most this touch; m, finite, > 0. At least the contact time's tolerance
  /// (collision/contact_time.h: 1e-9 of the smaller shape).
  double touching = 1e-7;
  /// The rule for bouncing without end: a contact that approaches slower than this has e = 0, so
  /// the infinitely many bounces that are left of it are skipped. What is skipped: flights of less
  /// than speed^2/(2 |d''|) height, and for e < 1 at most 2 e speed/(|d''| (1 - e)) seconds, which
  /// the event tells. m/s, finite, > 0; flights must stay above the contact time's tolerance.
  double resting_speed = 5e-4;
  /// Touching contacts that separate slower than this are held by resting forces (those that were
  /// held in the segment before: slower than resting_speed); m/s, finite, > 0.
  double separating_speed = 1e-7;
  /// Contacts with friction that slip slower than this may stick; m/s, finite, > 0. So may those
  /// that stuck in the segment before, those whose slip turned back in it, and with them those of
  /// their connected set that slip slower than resting_speed: a box comes to rest on all corners.
  double sticking_speed = 1e-7;
  /// Whatever they say: impact.colliding_threshold is resting_speed, and impact.friction is on
  /// where a touching contact has friction; then the law must be kNewton or kReflections.
  ImpactSettings impact = {};
  /// Whatever they say: resting.stabilization_time T is 4 segments, and at least 0.01 s: the gaps
  /// of resting contacts do not drift, and their forces hold the correction, g being off by about
  /// d/T^2 M; resting.slip_time is 2 segments.
  RestingSettings resting = {};
  int most_events = 1000000;   ///< of one advance(), >= 1
  int most_segments = 100000;  ///< of one advance(), >= 1
  /// Wall seconds of one advance(), looked at before each segment; > 0. A run that it ends is not
  /// the same twice.
  double time_limit = std::numeric_limits<double>::infinity();

  /// @throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

enum class EventKind : std::uint8_t {
  kImpact,    ///< a contact approached faster than resting_speed
  kRest,      ///< one with 0 < e < 1 bounced slower than that and was brought to rest by the rule
  kBreakUp,   ///< a resting force became zero
  kStick,     ///< a contact that slid came to rest and sticks
  kReversal,  ///< a contact that slid came to rest and slides the other way
  kSlip,      ///< a contact that stuck begins to slide
  /// No finite forces of the resting contacts were found (Painleve's paradox: Event::forces_status
  /// says whether that is proved); the impulses jumped though nothing approached:
  /// impact_without_collision.h. So is a settling of contacts slower than resting_speed whose
  /// impulses change the slip a thousand times as much (forces_status is then kNotRun).
  kImpactWithoutCollision,
};
[[nodiscard]] std::string_view to_string(EventKind kind);

/// One event of a run.
struct Event {
  EventKind kind = EventKind::kImpact;
  double time = 0.0;  ///< s from the start of advance()
  int body_a = -1;    ///< of the fastest contact (kBreakUp: of the contact that broke)
  int body_b = -1;
  double speed = 0.0;  ///< m/s, of approach; kImpactWithoutCollision: of the fastest slip; else 0
  /// kRest: the seconds that the skipped bounces would have taken, 2 e s/(|d''| (1 - e)).
  double skipped_seconds = 0.0;
  /// kImpactWithoutCollision: how the problem of the forces ended; kInfeasible and kNoSolutionBelow
  /// are proofs that there are none (below Z).
  lcp::Status forces_status = lcp::Status::kNotRun;
};

/// What EventStepper::advance() did.
struct EventReport {
  /// kSolved: the whole duration. kIterationLimit: most_events or most_segments. kTimeLimit:
  /// time_limit. Else the first impact or
  /// resting-force problem that was not solved (and was no inconsistent state); the state is that
  /// of `time`.
  lcp::Status status = lcp::Status::kNotRun;
  double time = 0.0;  ///< reached, s
  std::vector<Event> events;
  int segments = 0;      ///< pieces of motion
  int blind_pairs = 0;   ///< pairs of bodies passed over, see EventStepper; of all segments
  int force_solves = 0;  ///< resting-force problems
  /// Of the last resting-force problem: contacts, g (N), and how many are indeterminate.
  ContactSet resting_contacts;
  lcp::Vector resting_forces;
  std::vector<Vec3> resting_contact_forces;  ///< with friction, on A, world axes, N
  std::vector<ContactMode> resting_modes;
  int redundancy = 0;                  ///< of sets without friction
  double energy_change_impacts = 0.0;  ///< kinetic, of all impacts, driven work included, J
  std::string detail;
};

/// The notes' system (sections 2 to 5): unconstrained motion up to the contact time, impulses for
/// colliding contacts, forces for resting ones, both with Coulomb's friction where contacts have
/// it.
///
/// In turn, until the duration is over:
/// 1. Contacts with gap <= touching. If one approaches: an impact of all of them (impact.h), those
///    slower than resting_speed with e = 0.
/// 2. Touching contacts with d' <= separating_speed rest: their forces (resting.h), with
///    gyroscopic and curvature terms, moving supports, and the least norm where the support is
///    statically indeterminate. With friction (coulomb_forces.h): those that slip slide, the others
///    stick if they can. Where no such forces exist an impact without collision takes their place.
/// 3. A segment of constant forces (segment_motion.h), those of its middle: second order. Its
///    length is such that the turn in one piece and in two differ by less than the tolerance, and
///    the forces of the start and of the middle by less than the tolerance in the way they make.
/// 4. It is cut at the first contact time of the motion that is really taken
///    (ContactFinder::first_contact; between bodies that rest on each other, at the first overlap
///    of other features at the segment's end, so that one that dips in and out unseen can be
///    missed), where a resting force that was > 0 becomes zero, where the slip of a sliding contact
///    turns back, and where one that sticks begins to slide, found by bisection.
///
/// Two bodies that overlap by rounding and slide over each other's edges can have contacts that
/// separate while the gap closes: nothing to collide with, and a contact time of zero again and
/// again. Such a pair is passed over for 1e-5 s, and counted (EventReport::blind_pairs).
///
/// Free flight without torque is exact in x and p: apex heights are those of the parabola to the
/// rounding of the contact time. Velocity errors of resting contacts are of second order in a
/// segment and are stopped in step 1 when they approach. Anisotropic friction is taken, contacts
/// that resist turning are refused.
class EventStepper {
 public:
  /// @param finder must outlive the stepper. @throws std::invalid_argument for bad bodies, settings
  EventStepper(Bodies bodies, ContactFinder& finder, const EventSettings& settings);

  /// Advances by `duration` seconds. @throws std::invalid_argument for a bad state or duration, and
  /// for contacts that resist turning, or have friction under another impact law than kNewton and
  /// kReflections; state is then what it was when they were met.
  void advance(State& state, double duration, EventReport& report);

 private:
  class Run;
  Bodies bodies_;
  ContactFinder& finder_;
  EventSettings settings_;
};

}  // namespace signorini
