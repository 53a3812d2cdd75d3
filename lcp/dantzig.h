#pragma once

#include <signorini/lcp/principal_factor.h>
#include <signorini/lcp/principal_tableau.h>
#include <signorini/lcp/solver.h>
#include <signorini/lcp/symmetric_lcp.h>

#include <vector>

namespace signorini::lcp {

/// Settings of Dantzig. All are dimensionless.
struct DantzigSettings : SolverSettings {
  /// A row depends on the basic ones if v.M v <= this times v.v, v the direction that moves its z
  /// with the basic w kept, M scaled to M_ii near 1. In (0, 1e-3]. Larger: nearly dependent rows
  /// count as dependent, which the certificate may refuse; smaller: rounding passes for a pivot.
  double dependence_tolerance = 1e-12;
  /// Coupled limits: how often the problem is solved again with the limits mu z_n of the last
  /// solution, >= 1.
  int limit_rounds = 100;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Cottle and Dantzig's principal pivoting for symmetric positive semidefinite M with bounds:
///
///     w = M z + q,   lower <= z <= upper,   w_i >= 0 at lower_i, <= 0 at upper_i, 0 in between.
///
/// (Cottle, Pang, Stone, The Linear Complementarity Problem, 2009, Algorithm 4.2.11 with bounds;
/// Baraff, Fast contact force computation for nonpenetrating rigid bodies, 1994.) The row with the
/// largest w_i^2 over its Schur complement (where that is at hand; else w_i^2) is driven: its z_i
/// moves with the w of the basic rows C kept at 0, until w_i = 0 (i enters C), z_i meets a bound, a
/// basic z_j meets one (j leaves C) or a good w_j becomes 0 (j enters). What is good stays good.
///
/// It departs from Baraff's in this:
/// - redundant rows are part of the method, not of its failures. A driven row that depends on C
///   (tested by its full Schur complement, recomputed from M where it is small and exchanges may
///   have lost it) has a direction v
///   with M v = 0: all forces move along v, no w changes, until a basic z_j meets a bound and
///   leaves, and the row may be independent of the rest. If none meets one, v is a ray that proves
///   infeasibility (Result::ray, for an LCP; otherwise the detail names the row);
/// - ties go to the largest pivot among the rows within rounding (Harris 1973);
/// - at the end z_C is refined from the problem's own M and rows that rounding left behind are
///   driven again.
///
/// **Coupled limits** |z_i| <= mu z_n. Solved first with all coupled rows at 0, then with the
/// limits fixed at mu z_n of the last solution, again and again, each from the last basis, until
/// the limits repeat: then the coupled problem is solved, as the certificate will say. There is no
/// guarantee that they do (large mu; then kStalled, with the rounds in the detail). One round of it
/// is what ODE's and Bullet's Dantzig return.
///
/// A warm start gives the first C (the z strictly within their bounds) and the sides of the rest.
///
/// It ends: every step is an exchange or a move from bound to bound, both count towards
/// max_iterations (default 1000 + 50 n); and a dependent row that went to its bound and is told to
/// go back, which only the rounding of a large z can say, has w computed anew, at most 50 times.
///
/// Endings besides solved: kRayUnproven with a ray, kIterationLimit, kTimeLimit, kStalled (w that
/// rounding decides, limits that do not repeat), kNumericalBreakdown (M not positive semidefinite,
/// for example).
///
/// Cost: between n/2 and 2 n exchanges for contact problems, exponential at worst. Each n^2/2
/// multiply-adds (n <= kTableauRows or full M: PrincipalTableau) or two passes over a sparse factor
/// (PrincipalFactor). Memory n^2 or the factor.
class Dantzig : public Solver {
 public:
  static constexpr int kTableauRows = 160;

  /// @throws std::invalid_argument for settings out of range.
  explicit Dantzig(const DantzigSettings& settings = {});

  [[nodiscard]] std::string_view name() const override { return "dantzig"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  /// kSatisfied: no row is violated. kNext: this row is done, there may be others. kRounding: w
  /// must be computed anew first.
  enum class Ending { kSatisfied, kNext, kRounding, kRay, kLimit, kTime, kStalled, kBreakdown };
  /// What ends a step along a driving direction.
  struct Event {
    int row;
    double step;
    double bound;  // of z_row, where a basic z meets one
    double rate;   // |rate| of the basic variable that blocks
  };

  bool start(const Problem& problem, const Vector* warm_start);
  void couple(const Problem& problem, bool first);
  Status run(const Problem& problem, const Deadline& deadline, Result& result);
  Status judge_direction(const Problem& problem, Result& result);
  Ending solve_box(const Deadline& deadline);
  Ending drive(int row, const Deadline& deadline);
  bool refresh();
  void correct();
  void measure();
  bool exchange(int row);
  bool leave(int row, double bound);
  [[nodiscard]] bool depends(int row);
  [[nodiscard]] double way(int row, double rate, double& bound) const;
  [[nodiscard]] Event first_block(int row, double direction, bool dependent);
  [[nodiscard]] double weight(int row, double amount) const;
  [[nodiscard]] int most_violated() const;
  [[nodiscard]] double violation(int row) const;
  [[nodiscard]] bool meets_limits(const Problem& problem) const;
  void describe(const Problem& problem, Result& result) const;

  DantzigSettings settings_;
  SymmetricLcp scaled_;
  PrincipalTableau tableau_;
  PrincipalFactor factor_;
  PrincipalBasis* basis_ = nullptr;

  std::vector<double> z_;     // scaled; within or at the bounds
  std::vector<double> w_;     // scaled
  std::vector<double> rate_;  // of the basic variables
  std::vector<double> work_;  // n numbers
  std::vector<Event> blocks_;
  std::vector<double> ray_work_;  // n numbers
  std::vector<double> slack_w_;   // violations of w below this count as rounding
  std::vector<double> slack_z_;   // of z
  std::vector<char> ignored_;     // rows whose w passed for blocking, but which depend on C
  bool any_ignored_ = false;
  double largest_z_ = 0.0;
  double least_pivot_ = 1.0;  // that a row entered C with

  int pivots_ = 0;
  int flips_ = 0;  // moves of a row from bound to bound
  int refinements_ = 0;
  int dependent_moves_ = 0;
  int rounds_ = 0;
  int looks_ = 0;  // at the clock, if it was asked
  int ray_row_ = -1;
};

}  // namespace signorini::lcp
