#pragma once

#include <limits>
#include <string>

namespace signorini {

/// The accuracy dial: the residual that a step's contact problems may keep, in m/s. What it means:
/// each contact's relative velocity and impulse are within this of a pair that obeys the contact
/// law (lcp/certificate.h: the unit-free residual times |q|_inf of the island). It chooses the
/// solvers (island_solver.h); docs/accuracy-dial.md says what each position costs.
class Accuracy {
 public:
  /// @throws std::invalid_argument unless the residual is finite and > 0, m/s
  explicit Accuracy(double residual);

  [[nodiscard]] static Accuracy preview() { return Accuracy(1e-2); }
  [[nodiscard]] static Accuracy game() { return Accuracy(1e-4); }
  [[nodiscard]] static Accuracy engineering() { return Accuracy(1e-8); }
  [[nodiscard]] static Accuracy reference() { return Accuracy(1e-13); }
  /// One of these four by name, or a number in m/s. @throws std::invalid_argument listing the names
  [[nodiscard]] static Accuracy named(const std::string& text);

  [[nodiscard]] double residual() const { return residual_; }
  /// "game", or "1e-06 m/s".
  [[nodiscard]] std::string name() const;

  /// The same residual.
  friend bool operator==(const Accuracy&, const Accuracy&) = default;

 private:
  double residual_;
};

/// What the contact problems of one step may cost; islands share it by their contacts and joint
/// rows. Where it runs out the best iterate is applied, with its certificate and status.
struct StepBudget {
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  /// One unit: a thousand rows swept once. A step with a factorisation counts kSweepsOfAFactor
  /// sweeps. The same input gives the same bits. >= 0
  double work = kNone;
  /// Wall time, s, > 0. The same input need not give the same answer twice: StepReport says so.
  double seconds = kNone;

  static constexpr double kSweepsOfAFactor = 30.0;

  /// What an island gets of it.
  [[nodiscard]] StepBudget share(double part) const {
    return {.work = part * work, .seconds = part * seconds};
  }
  [[nodiscard]] bool is_limited() const { return work < kNone || seconds < kNone; }
  /// @throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

}  // namespace signorini
