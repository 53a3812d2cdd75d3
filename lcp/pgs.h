#pragma once

#include <signorini/lcp/sweep_solver.h>

namespace signorini::lcp {

/// Settings of projected Gauss-Seidel.
struct PgsSettings : SweepSettings {};

/// Projected Gauss-Seidel: sweeps over the rows, each time setting
///
///     z_i <- clamp(z_i - w_i / M_ii, lower_i, upper_i),   w = M z + q,
///
/// with the newest z of the rows before it (Cottle, Pang, Stone, The Linear Complementarity
/// Problem, 1992, section 5.2, there for symmetric M; in games: Catto, Iterative Dynamics with
/// Temporal Coherence, 2005). What it takes, statuses and rows without a diagonal: SweepSolver. One
/// iteration is one sweep.
///
/// Converges for symmetric positive semidefinite M with M_ii > 0 if the problem has a solution,
/// slowly where M is badly conditioned; no promise for other M or with coupled limits.
class Pgs final : public SweepSolver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit Pgs(const PgsSettings& settings = {}) : settings_(settings) { settings_.validate(); }

  /// "pgs" or "pgs-float".
  [[nodiscard]] std::string_view name() const override;

 protected:
  const SweepSettings& sweep_settings() const override { return settings_; }
  void advance(Sweeps<double>& sweeps) override { sweeps.forward(); }
  void advance(Sweeps<float>& sweeps) override { sweeps.forward(); }

 private:
  PgsSettings settings_;
};

}  // namespace signorini::lcp
