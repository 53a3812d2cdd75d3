#pragma once

#include <signorini/core/response/coulomb_forces.h>
#include <signorini/core/response/event_stepper.h>

#include <vector>

namespace signorini {

/// A contact that rests, and what it does.
struct RestingContact {
  Contact contact;
  double normal_force = 0.0;               ///< f, N
  Vec3 force = Vec3::Zero();               ///< on A, world axes, N
  double b = 0.0;                          ///< d'' without contact forces, m/s^2
  ContactMode mode = ContactMode::kOpens;  ///< sets without friction: kCloses where f > 0
  bool may_stick = false;                  ///< it was free to: see find_support()
  bool turned_back = false;                ///< its slip turned back by the end of the segment
  Vec3 direction = Vec3::Zero();           ///< of its slip, see CoulombReport
};
using RestingContacts = std::vector<RestingContact>;

/// The same features of the same bodies, whatever their state.
[[nodiscard]] bool same_features(const Contact& a, const Contact& b);
/// The one of the same features, or null.
[[nodiscard]] const RestingContact* find(const RestingContacts& contacts, const Contact& contact);

/// The resting contacts of a state of an event-driven run and what they do to the bodies.
struct Support {
  RestingContacts contacts;  ///< by connected sets
  /// Of the first connected set whose forces' problem was not solved, else solved (to rounding).
  lcp::Status status = lcp::Status::kSolved;
  RestingContacts unsolved;   ///< the contacts of that set
  int redundancy = 0;         ///< see RestingReport; of sets without friction
  std::vector<Wrench> loads;  ///< gravity and contact forces, one a body
};

/// Which of the touching contacts rest, which of those slide, and their forces: each connected set
/// apart, by resting.h without friction and by coulomb_forces.h with it.
/// @param touching contacts found in this state
/// A contact with friction may stick if it slips slower than sticking_speed, if it stuck or turned
/// back in the segment before, or if another one of its connected set did and it slips slower than
/// resting_speed. It does if friction can also take the slip that is left to it within some
/// segments; else it slides in the direction of the slip at their end. The others slide in that of
/// their slip.
/// @param held of the segment before: what it held is held more firmly (separating_speed)
/// @throws std::invalid_argument for contacts that resist turning
[[nodiscard]] Support find_support(const Bodies& bodies, const State& state,
                                   const ContactSet& touching, const RestingContacts& held,
                                   const EventSettings& settings);

/// The slip velocity of a contact across its normal, m/s.
[[nodiscard]] Vec3 tangential_slip(const Bodies& bodies, const State& state,
                                   const Contact& contact);

}  // namespace signorini
