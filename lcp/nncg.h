#pragma once

#include <signorini/lcp/sweep_solver.h>

#include <vector>

namespace signorini::lcp {

/// Settings of the nonsmooth nonlinear conjugate gradient method.
struct NncgSettings : SweepSettings {};

/// Nonsmooth nonlinear conjugate gradients: a sweep of projected Gauss-Seidel (pgs.h) is taken for
/// a step along the negative gradient of a merit function, and Fletcher-Reeves directions are laid
/// over it,
///
///     z+ = PGS(z),   g = z+ - z,   beta = |g|^2 / |g before|^2,
///     z  = z+ + beta p,   p <- beta p + g;    beta > 1: p <- 0 and no step along it
///
/// (Silcowitz-Hansen, Niebe, Erleben, A nonsmooth nonlinear conjugate gradient method for
/// interactive contact force problems, The Visual Computer 26, 2010, algorithm 1). Differs in two
/// points: |g|^2 is sum M_ii g_i^2 (M_ii rounded to a power of four), so that units do not matter;
/// and the residual is looked at after the sweep, where z is in its bounds. What a sweep keeps of
/// M z is linear in z and goes along, so an iteration costs a sweep and two passes over vectors.
///
/// What it takes and statuses: SweepSolver. No proof of convergence, and it does not descend
/// evenly; to 1e-6 piles and stacks need a third to a twelfth of the sweeps of Pgs, coloured rows
/// fewer than rows in their natural order.
class Nncg final : public SweepSolver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit Nncg(const NncgSettings& settings = {}) : settings_(settings) { settings_.validate(); }

  /// "nncg" or "nncg-float".
  [[nodiscard]] std::string_view name() const override;

 protected:
  const SweepSettings& sweep_settings() const override { return settings_; }
  void begin() override;
  void advance(Sweeps<double>& sweeps) override { advance(sweeps, double_); }
  void advance(Sweeps<float>& sweeps) override { advance(sweeps, single_); }
  bool forget() override;

 private:
  /// Of states (sweeps.h): z and what is kept of M z.
  template <typename T>
  struct Memory {
    std::vector<T> change;     // g
    std::vector<T> direction;  // p
  };
  template <typename T>
  void advance(Sweeps<T>& sweeps, Memory<T>& memory);

  NncgSettings settings_;
  Memory<double> double_;
  Memory<float> single_;
  double squared_length_ = 0.0;  // of g
  double beta_ = 0.0;
  bool is_first_ = true;
  bool has_step_ = false;  // z has not yet been moved by beta p
};

}  // namespace signorini::lcp
