#pragma once

#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/principal_factor.h>
#include <signorini/lcp/principal_tableau.h>
#include <signorini/lcp/solver.h>
#include <signorini/lcp/symmetric_lcp.h>

#include <random>
#include <string>
#include <vector>

namespace signorini::lcp {

/// Settings of StructuredLemke. All are dimensionless.
struct StructuredLemkeSettings : SolverSettings {
  /// A row depends on the basic ones if its Schur complement, with M scaled to M_ii near 1, is at
  /// most this. In (0, 1e-3].
  double dependence_tolerance = 1e-12;
  /// The path ends where lambda |d|_inf is this fraction of |q|_inf; below it the redundant rows of
  /// a contact problem, whose w is proportional to lambda, would be exchanged without end. In [0,
  /// 1e-3].
  double stop_tolerance = 1e-11;
  /// Projected Gauss-Seidel sweeps that guess the first basis, >= 0. With 0 the path starts from
  /// z = 0. More sweeps cost more and leave fewer pivots.
  int crash_sweeps = 20;
  /// How often the path may be followed again, from z = 0 and with another d, when the certificate
  /// refuses the answer, >= 0.
  int restarts = 2;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Lemke's method for symmetric positive semidefinite M as parametric principal pivoting: the path
///
///     0 <= z ⊥ w = M z + q + lambda d >= 0
///
/// from a lambda at which the first basis is feasible down to lambda = 0 (Cottle, Pang, Stone, The
/// Linear Complementarity Problem, 2009, 4.5: the parametric form of Algorithm 4.4.1; Lloyd, Fast
/// implementation of Lemke's algorithm for rigid body contact simulation, 2005). Each pivot
/// exchanges one z_i with its w_i, or, where row i depends on the basic ones, moves z_i along the
/// null direction until a basic z_k is 0 and exchanges both. It solves every feasible problem; if
/// no z_k stops the move the problem is infeasible and the direction is the ray.
///
/// d is such that all basic variables grow at a rate from a fixed pseudo-random sequence in
/// [0.5, 1.5], so that equal contacts do not tie. The first basis is a warm start's active set, or
/// that of a few projected Gauss-Seidel sweeps (dependent rows left out), or empty. The path ends
/// at lambda |d|_inf <= stop_tolerance |q|_inf and the basis is solved at lambda = 0, refined from
/// M.
///
/// Endings besides solved: kInfeasible or another verdict on the ray, kIterationLimit, kTimeLimit,
/// kNumericalBreakdown.
///
/// Cost: from z = 0 between n/2 and 2 n pivots for contact problems, a fraction of that with a good
/// first basis; each pivot one column of PrincipalTableau (n <= kTableauRows or full M) or
/// PrincipalFactor.
class StructuredLemke : public Solver {
 public:
  /// The first basis costs as many exchanges as it has rows in a tableau, one factorisation in a
  /// factor: few rows are enough for that to pay.
  static constexpr int kTableauRows = 40;

  /// @throws std::invalid_argument for settings out of range.
  explicit StructuredLemke(const StructuredLemkeSettings& settings = {});

  [[nodiscard]] std::string_view name() const override { return "structured-lemke"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;
  void certify(const Problem& problem, Result& result) override;

 private:
  enum class Ending { kFinished, kRay, kLimit, kTime, kBreakdown };

  void guess(const Problem& problem, const Vector* warm_start, int attempt);
  void sweep();
  bool start(int attempt);
  Ending follow(const Deadline& deadline);
  void evaluate(const std::vector<double>& right, std::vector<double>& x);
  void refresh();
  [[nodiscard]] int first_to_vanish(double lambda, double& at) const;
  [[nodiscard]] bool depends(int row);
  [[nodiscard]] int null_block(double lambda) const;
  bool pivot(int row);
  void offer();
  void describe(std::string& detail) const;
  void collect_ray(int row, Result& result, const Problem& problem);

  StructuredLemkeSettings settings_;
  SymmetricLcp scaled_;
  PrincipalTableau tableau_;
  PrincipalFactor factor_;
  PrincipalBasis* basis_ = nullptr;
  BestIterate best_;

  std::minstd_rand generator_;
  std::vector<char> first_;   // the first basis, before dependent rows leave it
  std::vector<double> z_;     // work of the sweeps and of evaluate()
  std::vector<double> d_;     // of the path
  std::vector<double> x_q_;   // basic variables at lambda = 0
  std::vector<double> x_d_;   // their rate with lambda
  std::vector<double> rate_;  // a column
  std::vector<double> work_;
  Vector answer_;
  int ray_row_ = -1;

  int pivots_ = 0;
  int refinements_ = 0;
  int factorizations_ = 0;
  int since_refresh_ = 0;
  int double_exchanges_ = 0;
  int attempt_ = 0;
  int first_size_ = 0;
};

}  // namespace signorini::lcp
