#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/sleeping.h>
#include <signorini/core/response/time_step_settings.h>

#include <cstdint>
#include <vector>

namespace signorini {

/// Which of the contacts found are in a step's problem, and how fast each may close: rules 2 and 3
/// of TimeStepper. Keeps its memory from step to step.
class ContactSelection {
 public:
  /// @param d_dot, d_dot_free gap velocities at the step's start and with the step's forces, m/s
  void choose(const ContactSet& found, const std::vector<double>& d_dot,
              const std::vector<double>& d_dot_free, const TimeStepSettings& settings,
              const Bodies& bodies, const Sleepers& sleepers);

  /// The contacts in the problem, and of each how fast it may close, m/s.
  void fill(const ContactSet& found, ContactSet& contacts, std::vector<double>& allowance) const;
  /// Sets the bodies of the contacts that are in the problem or apart.
  void mark_bodies(const ContactSet& found, std::vector<bool>& marked) const;

  [[nodiscard]] int apart() const { return count(Fate::kApart); }
  [[nodiscard]] int about_to_bounce() const { return count(Fate::kAboutToBounce); }
  [[nodiscard]] int asleep() const { return count(Fate::kAsleep); }

  /// Puts back those that close farther than allowed. When it happens again, all of bodies awake:
  /// in a loose stack, which falls as one, every contact would else wait for the one below it.
  /// @param back receives their bodies; empty: none closes too far
  void put_back(const ContactSet& found, const std::vector<Velocity>& velocities,
                const State& state, const Sleepers& sleepers, BodyPairs& back);

 private:
  enum class Fate : std::uint8_t { kInProblem, kAboutToBounce, kApart, kAsleep };
  [[nodiscard]] int count(Fate fate) const;

  std::vector<Fate> fate_;         // one a contact found
  std::vector<double> allowance_;  // m/s
  std::vector<bool> closes_;
  bool has_put_back_ = false;
};

}  // namespace signorini
