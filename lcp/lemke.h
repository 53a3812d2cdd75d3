#pragma once

#include <signorini/lcp/active_set_polish.h>
#include <signorini/lcp/basis_factor.h>
#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/lcp_augmentation.h>
#include <signorini/lcp/scaled_lcp.h>
#include <signorini/lcp/solver.h>

#include <cstdint>
#include <random>
#include <vector>

namespace signorini::lcp {

/// Settings of Lemke. All are dimensionless: the problem is scaled to numbers near 1 first.
struct LemkeSettings : SolverSettings {
  /// An entry of the entering column counts as positive if it exceeds this fraction of the column's
  /// largest entry. In (0, 1e-2]. Larger: dependent rows are never pivoted on, but true small
  /// pivots are missed and z or w may become negative by about this much.
  double pivot_tolerance = 1e-11;
  /// Rows tie if after the step their variables are within this fraction of zero. In (0, 1e-2].
  /// Ties are broken lexicographically. Larger: more rows of B^-1 are computed.
  double tie_tolerance = 1e-11;
  /// Pivots between two factorisations, >= 1. Larger: fewer factorisations, longer eta files.
  int refactorisation_period = 64;
  /// Refinement steps (long double residual) of every solve with the basis, 0 .. 10.
  int refinements_per_solve = 1;
  /// The covering variable z_0 counts as zero at this fraction of its first value; below it the
  /// redundant rows of a contact problem, whose w is proportional to z_0, would be exchanged
  /// without end. In [0, 1e-3].
  double cover_tolerance = 1e-11;
  /// How often the pivoting may start again when an ending is not confirmed by the certificate or
  /// by the ray's verdict, >= 0: with another cover vector and a larger pivot tolerance, from the
  /// second time on also from another complementary basis.
  int restarts = 16;
  /// A path longer than 50 + path_budget n pivots is given up for one from another cover vector
  /// (exponential examples), and twice as many are allowed each time, >= 0; 0: paths are never
  /// given up. Contact problems need up to 5 n.
  int path_budget = 10;
  /// The cover of the first path is the book's (1, .., 1), scaled like the problem, instead of the
  /// pseudo-random one: for comparison, equal rows tie then.
  bool textbook_cover = false;
  /// Rounds of the final active-set polish, >= 0. With 0 the result is plain Lemke's.
  int polish_rounds = 20;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Lemke's complementary pivoting for the LCP w = M z + q, 0 <= z ⊥ w >= 0, general M.
///
/// Follows the path of w = M z + q + d z_0 from a large z_0 to z_0 = 0 (Cottle, Pang, Stone, The
/// Linear Complementarity Problem, 2009, Algorithm 4.4.1), lexicographic ratio test (4.9). It finds
/// a solution for every q if M is strictly copositive, P, or R_0 and copositive, and if the LCP is
/// feasible for copositive-plus M (positive semidefinite: contact problems without friction); for
/// the pyramid friction LCP see Anitescu and Potra 1997. Outside these classes it may end on a ray
/// although a solution exists.
///
/// It departs from the book in this:
/// - revised: a factorised basis with product-form updates (BasisFactor), every solve refined with
///   residuals in long double; the whole tableau never exists;
/// - the problem is scaled by powers of two (ScaledLcp);
/// - the cover vector d is not (1, .., 1) but a fixed pseudo-random sequence in [1, 2) in the
/// scaled
///   problem, so that equal rows (equal contacts) do not tie;
/// - it stops at z_0 <= cover_tolerance times the first z_0 and solves at z_0 = 0;
/// - the answer is polished (ActiveSetPolish), and what the certificate refuses is started again
///   with another d, later from another complementary basis B_0 with the cover column B_0 d (which
///   is Lemke's method for the principal transform of the problem, and solves some that it does
///   not, bimatrix games for example). Both are named in Result::detail.
///
/// **Exponential examples.** The path of a P-matrix can have 2^n - 1 pivots (Murty 1978), for a
/// cover and a q made for each other. A cover drawn at random makes that improbable, so the first
/// one is pseudo-random, and a path that outgrows path_budget is given up for another random cover,
/// the share of each row now of the size of its own q. The budget doubles each time, so that no
/// finite path is given up for ever: up to max_iterations the method stays complete. Result::detail
/// says how many paths were given up and after how many pivots.
///
/// **Mixed problems.** A free row (w_i = 0) has its z_i in every basis, where it blocks nothing;
/// the first basis is completed by other z_i where M on the free rows is singular (circuits).
/// Bounds and coupled limits become rows of their own (LcpAugmentation), so that a coupled box
/// friction problem is solved as it stands. Rays are judged for an LCP only; else the ending is
/// kRayUnproven without a ray.
///
/// A warm start gives the first basis: z_i > 0 active. If its active set solves the problem no
/// pivot is made; if its basis is singular it is not used.
///
/// Endings besides solved: a ray (Result::ray: the z-part of the secondary ray, recomputed from a
/// fresh factorisation before it is believed; kInfeasible, kNoSolutionBelow or kRayUnproven),
/// kIterationLimit, kTimeLimit, kNumericalBreakdown. In all of them z is the best vector seen.
///
/// Cost of a pivot with k active z: O(k^2 + entries of M + n period); memory n^2.
class Lemke : public Solver {
 public:
  /// @throws std::invalid_argument for settings out of range.
  explicit Lemke(const LemkeSettings& settings = {});

  [[nodiscard]] std::string_view name() const override { return "lemke"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  /// How one run of the pivoting ended. kRefused: numerical trouble, or the certificate refused.
  /// kLong: the path outgrew its budget.
  enum class Ending { kSolved, kRefused, kLong, kRay, kLimit, kTime };

  Status solve_plain(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                     Result& result);
  void find_free_rows(const Problem& problem);
  bool complete_free_basis();
  [[nodiscard]] bool holds_free(int position) const;
  [[nodiscard]] bool is_feasible() const;
  Status run(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
             Result& result);
  Ending pivot(int attempt, const Problem& problem, const Deadline& deadline);
  Ending refuse();
  bool start(int attempt);
  bool start_from(const std::vector<char>& active);
  void draw_ratios();
  [[nodiscard]] std::int64_t path_limit() const;
  double uniform();
  bool enter_cover();
  bool refactor();
  void solve_refined(int variable, Vector& x);
  int choose_leaving();
  int break_tie();
  void exchange(int position);
  bool finish(const Problem& problem, const Deadline& deadline);
  bool polish(std::vector<char> active, const Problem& problem, const Deadline& deadline);
  void offer_current();
  void collect_ray();
  [[nodiscard]] bool ray_is_tight();
  [[nodiscard]] int complement(int variable) const;
  [[nodiscard]] int pivot_limit() const;
  void describe(Result& result) const;

  LemkeSettings settings_;
  ScaledLcp scaled_;
  BasisFactor basis_;
  ActiveSetPolish polish_;
  BestIterate best_;

  LcpAugmentation augmentation_;
  Vector carried_;
  std::vector<char> is_free_;
  std::vector<char> free_basis_;  // the free rows and those that make M on them regular
  int free_count_ = 0;

  // One run of the pivoting.
  double pivot_tolerance_ = 0.0;
  std::minstd_rand generator_;
  Vector ratios_;  // the cover in terms of the first basis, in [1, 2)
  Vector cover_;
  Vector x_;         // values of the basic variables
  Vector y_;         // B^-1 times the entering column
  Vector residual_;  // work
  int entering_ = -1;
  std::vector<int> tied_;
  Matrix tied_rows_;
  std::vector<char> active_;  // of the polish
  std::vector<char> start_;   // of the first basis
  Vector z_;
  Vector ray_;

  // Over all runs of one solve.
  int pivots_ = 0;
  int factorizations_ = 0;
  int refinements_ = 0;
  int restarts_ = 0;
  int other_bases_ = 0;
  int long_paths_ = 0;        // given up
  int long_path_pivots_ = 0;  // spent on them
  bool early_stop_ = false;
};

}  // namespace signorini::lcp
