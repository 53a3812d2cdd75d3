#pragma once

#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/scaled_lcp.h>
#include <signorini/lcp/solver.h>

#include <vector>

namespace signorini::lcp {

/// The last step of a pivoting method: given which z_i are active, solves
///
///     w_i = (M z + q)_i = 0 for the active i,   z_i = 0 for the others
///
/// (rows are 0 <= z_i ⊥ w_i >= 0 or free; free ones are always active)
/// as exactly as the doubles allow: residuals from the caller's M and q in long double, iterative
/// refinement of a z that is kept in long double. The linear system is tried by a pivoted LU in
/// double, then in long double, then by a complete orthogonal decomposition (least norm), which is
/// what dependent active rows need. Where the signs then refuse the set (z_i < 0, or w_i < 0 beyond
/// rounding), those indices change sides and the solve is repeated, a few rounds. Every vector goes
/// through BestIterate, so the answer never gets worse.
class ActiveSetPolish {
 public:
  struct Settings {
    double tolerance = 1e-8;  ///< of judge()
    int rounds = 20;          ///< how often the active set may be changed
    int refinements = 10;     ///< refinement steps of one solve
  };

  /// What it did, added up over the calls since reset_counts().
  struct Counts {
    int rounds = 0;  ///< changes of the active set
    int factorizations = 0;
    int refinements = 0;
    bool long_double = false;  ///< a long double LU was used
    bool orthogonal = false;   ///< a complete orthogonal decomposition was used
  };

  /// @param problem every row an LCP's or free
  /// @param active n flags, changed in place
  /// @return true if the best iterate is now solved by judge().
  bool run(const Problem& problem, const ScaledLcp& scaled, const Settings& settings,
           const Deadline& deadline, std::vector<char>& active, BestIterate& best);

  void reset_counts() { counts_ = {}; }
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  bool solve_active();
  template <typename Factor, typename Scalar>
  bool refine(const Factor& factor, Scalar);
  double evaluate();
  bool change_sides(bool all);
  [[nodiscard]] bool is_free(int i) const;

  const Problem* problem_ = nullptr;
  const ScaledLcp* scaled_ = nullptr;
  Settings settings_;
  std::vector<char>* active_ = nullptr;
  Counts counts_;

  std::vector<int> alpha_;             // the active indices
  std::vector<int> place_;             // their places in alpha_, else -1
  Matrix compact_;                     // M'_alpha,alpha
  std::vector<long double> z_;         // caller's units
  std::vector<long double> w_;         // caller's units
  std::vector<long double> scaled_w_;  // of the scaled problem
  Vector magnitude_;                   // |M'||z'| + |q'|
  Vector rounded_;                     // z_ clamped at 0, in double
};

}  // namespace signorini::lcp
