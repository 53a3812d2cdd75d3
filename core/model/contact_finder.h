#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/model/motion.h>

#include <optional>
#include <span>

namespace signorini {

/// When two bodies first touch.
struct FirstContact {
  double time = 0.0;  ///< seconds from the start of the motions
  int body_a = -1;
  int body_b = -1;
};

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
  [[nodiscard]] virtual std::optional<FirstContact> first_contact(
      std::span<const Motion* const> motions, double duration) = 0;
};

}  // namespace signorini
