#pragma once

#include <signorini/lcp/problem.h>
#include <signorini/lcp/shifted_system.h>
#include <signorini/lcp/types.h>

#include <limits>

namespace signorini::lcp {

/// A problem with bounds in the coordinates of a ShiftedSystem, x = S z:
///
///     r = A x + g,   lower <= x <= upper,   r_i >= 0 at the lower bound, <= 0 at the upper one,
///
/// with the certificate's residuals in double, and the best x that was looked at.
class ScaledProblem {
 public:
  /// @param system has taken over problem.M and stays alive
  void set(const Problem& problem, ShiftedSystem& system);

  [[nodiscard]] Index size() const { return g_.size(); }
  [[nodiscard]] const Vector& g() const { return g_; }
  [[nodiscard]] const Vector& lower() const { return lower_; }  ///< -infinity: none
  [[nodiscard]] const Vector& upper() const { return upper_; }
  [[nodiscard]] bool has_upper() const { return has_upper_; }
  [[nodiscard]] ShiftedSystem& system() { return *system_; }

  /// out = A x + g.
  void gradient(const Vector& x, Vector& out);
  /// The larger residual of the certificate at x, bounds kept. Keeps the best x.
  /// @param gradient A x + g
  double consider(const Vector& x, const Vector& gradient);

  [[nodiscard]] double best_residual() const { return best_residual_; }
  [[nodiscard]] const Vector& best() const { return best_x_; }
  /// z of the best x, inside its bounds.
  void best_z(Vector& z) const;

 private:
  const Problem* problem_ = nullptr;
  ShiftedSystem* system_ = nullptr;
  Vector g_, lower_, upper_, best_x_;
  bool is_lcp_ = false;
  bool has_upper_ = false;
  double natural_scale_ = 1.0;
  double unit_free_scale_ = 1.0;
  double best_residual_ = std::numeric_limits<double>::infinity();
};

}  // namespace signorini::lcp
