#pragma once

#include <signorini/lcp/sweep_solver.h>

namespace signorini::lcp {

/// Settings of symmetric projected Gauss-Seidel.
struct SymmetricPgsSettings : SweepSettings {
  /// omega, dimensionless, in (0, 2), of both sweeps; see PsorSettings::relaxation.
  double relaxation = 1.0;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Symmetric projected Gauss-Seidel (pgs.h): one iteration is a sweep over the rows from the first
/// to the last and one back, so that neither end of a stack is favoured. Twice the work of an
/// iteration of Pgs. (Cottle, Pang, Stone, 1992, section 5.2: the symmetric splitting.) What it
/// takes and statuses: SweepSolver.
class SymmetricPgs final : public SweepSolver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit SymmetricPgs(const SymmetricPgsSettings& settings = {}) : settings_(settings) {
    settings_.validate();
  }

  /// "symmetric-pgs" or "symmetric-pgs-float".
  [[nodiscard]] std::string_view name() const override;

 protected:
  const SweepSettings& sweep_settings() const override { return settings_; }
  double relaxation() const override { return settings_.relaxation; }
  void advance(Sweeps<double>& sweeps) override;
  void advance(Sweeps<float>& sweeps) override;

 private:
  SymmetricPgsSettings settings_;
};

}  // namespace signorini::lcp
