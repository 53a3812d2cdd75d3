#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/model/motion.h>

#include <optional>
#include <span>
#include <utility>

namespace signorini {

/// When two bodies first touch.
struct FirstContact {
  double time = 0.0;  ///< seconds from the start of the motions
  int body_a = -1;
  int body_b = -1;
};

/// Pairs of bodies, each (smaller number, larger number).
using RestingPairs = std::span<const std::pair<int, int>>;

/// What a stepper asks of collision detection. `collision` implements it; an engine with its own
/// collision detection implements it over its own data.
class ContactFinder {
 public:
  virtual ~ContactFinder() = default;

  /// The reduced contact set at a state: every contact with gap <= margin.
  /// @param margin metres, >= 0; contacts with 0 < gap <= margin are apart and reported as such
  virtual void find(const State& state, double margin, ContactSet& contacts) = 0;

  /// The first time in [0, duration] at which a pair that is apart, or touching and approaching,
  /// comes into contact. A pair that touches and rests or separates reports its next approach.
  /// @param motions one a body, in body order
  /// @param resting pairs that are not asked about: what rests would cost most, and its next
  /// contact is the caller's to see
  [[nodiscard]] virtual std::optional<FirstContact> first_contact(
      std::span<const Motion* const> motions, double duration, RestingPairs resting) = 0;
  /// Of all pairs.
  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const> motions,
                                                          double duration) {
    return first_contact(motions, duration, {});
  }
};

}  // namespace signorini
