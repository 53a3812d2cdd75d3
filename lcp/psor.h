#pragma once

#include <signorini/lcp/sweep_solver.h>

namespace signorini::lcp {

/// Settings of projected successive over-relaxation.
struct PsorSettings : SweepSettings {
  /// omega, dimensionless, in (0, 2). 1 is Gauss-Seidel, the safest; below 1 damps problems that
  /// are not symmetric; larger is faster on long chains of contacts and amplifies rounding.
  double relaxation = 1.5;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Projected successive over-relaxation: projected Gauss-Seidel (pgs.h) with each step multiplied
/// by omega,
///
///     z_i <- clamp(z_i - omega w_i / M_ii, lower_i, upper_i)
///
/// (Cryer, The Solution of a Quadratic Programming Problem Using Systematic Overrelaxation, SIAM J.
/// Control 9, 1971). For symmetric positive semidefinite M the objective 1/2 z.M z + q.z falls with
/// every omega in (0, 2). What it takes and statuses: SweepSolver. One iteration is one sweep.
class Psor final : public SweepSolver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit Psor(const PsorSettings& settings = {}) : settings_(settings) { settings_.validate(); }

  /// "psor" or "psor-float".
  [[nodiscard]] std::string_view name() const override;

 protected:
  const SweepSettings& sweep_settings() const override { return settings_; }
  double relaxation() const override { return settings_.relaxation; }
  void advance(Sweeps<double>& sweeps) override { sweeps.forward(); }
  void advance(Sweeps<float>& sweeps) override { sweeps.forward(); }

 private:
  PsorSettings settings_;
};

}  // namespace signorini::lcp
