#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/response/assembly.h>

#include <limits>
#include <vector>

namespace signorini {

/// When bodies at rest are left out of the steps. Off by default: a body that creeps more slowly
/// than this is stopped, which is no law of mechanics.
struct SleepSettings {
  /// A set of bodies that touch or are joined falls asleep when all have been slower than both
  /// speeds for this long; s, >= 0. Infinity: never.
  double after = std::numeric_limits<double>::infinity();
  double speed = 1e-3;  ///< of the centre of mass, m/s, finite and >= 0
  double spin = 1e-3;   ///< rad/s, finite and >= 0

  [[nodiscard]] bool is_on() const { return after < std::numeric_limits<double>::infinity(); }
  /// @throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// Which bodies sleep. A set falls asleep as one and wakes as one: it wakes when one of its
/// contacts or joints acts with a body that is awake or driven and moving, when the caller changed
/// a pose or a momentum, and when asked.
class Sleepers {
 public:
  Sleepers(const SleepSettings& settings, int bodies);

  [[nodiscard]] bool is_on() const { return settings_.is_on(); }
  [[nodiscard]] bool is_asleep(int body) const { return group_[body] >= 0; }
  /// Bodies asleep.
  [[nodiscard]] int count() const { return asleep_; }

  /// Wakes the body's set. @return how many bodies woke
  int wake(int body);
  /// Wakes the sets of which a body is not as settle() left it; all, where a body that is not
  /// dynamic is elsewhere than the last step took it. @return how many bodies woke
  int notice(const Bodies& bodies, const State& state);
  /// Wakes the sets that one of the pairs joins to a dynamic body that is awake, or to a driven one
  /// that moves. @return how many bodies woke
  int wake_touched(const Bodies& bodies, const State& state, const BodyPairs& pairs);
  /// After a step: sets of awake bodies that have been slow for long enough fall asleep, and lose
  /// their momenta. Bodies in no pair stay awake: nothing holds them.
  /// @param pairs that touch or are joined
  /// @return the kinetic energy lost, J
  double settle(const Bodies& bodies, const BodyPairs& pairs, double step, State& state);

 private:
  [[nodiscard]] bool moves(const Body& body, const BodyState& state, int index) const;

  SleepSettings settings_;
  std::vector<int> group_;                // of every body, -1: awake
  std::vector<std::vector<int>> groups_;  // empty: free to be used again
  std::vector<double> slow_for_;          // s
  State left_;                            // as the last step left it
  LinkedSets sets_;                       // from here on memory of settle()
  std::vector<double> rest_;
  std::vector<int> group_of_set_;
  int asleep_ = 0;
};

}  // namespace signorini
