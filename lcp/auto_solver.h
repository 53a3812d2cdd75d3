#pragma once

#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/solver.h>

#include <memory>
#include <string_view>
#include <vector>

namespace signorini::lcp {

/// Settings of AutoSolver. max_iterations is handed to every solver tried, in its own unit.
struct AutoSettings : SolverSettings {
  /// Where sweeps may win, a few are tried first, and gone on with while their residual promises
  /// the tolerance within this many; >= 0, 0: never. Larger: more is lost where they stall, more
  /// won where they do not.
  int most_sweeps = 500;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

/// Chooses solvers for the problem and tries them in turn until one solves it.
///
/// The choice depends on counts and on the data alone, never on a clock (unless time is limited,
/// which each solver then gets what is left of): the same input gives the same bits.
///
/// | problem | tried in this order |
/// |---|---|
/// | friction cones | sticking (factored M, from a start) or cone-interior-point (factored M, from
/// none; the associated law, n > 100), frictionless (factored M, from none, up to 300 rows that are
/// not tangential), alart-curnier (400 steps; not for Coulomb's law, factored M, from none),
/// cone-smoothing, alart-curnier (unless max_iterations is set and it was tried), frictionless (if
/// it was not tried, up to 2000 such rows), nsgs; with coupled limits besides, where the path is
/// refused, alart-curnier once |
/// | LCP, factored M, 48 < n <= 180, one contact a pair of bodies | structured-lemke (360 pivots;
/// behind the sweeps of the row for n > 100), then as below |
/// | symmetric M, n <= 100 | interior-point (factored M, from no start, n > 48; not up to 72 where
/// more pairs touch than there are bodies and masses differ by more than 100), dantzig,
/// structured-lemke, alart-curnier, lemke, pgs |
/// | factored M, n > 100 | nncg, for a few sweeps and then if they promise to end soon (with a
/// tolerance of 1e-5 or more, or n > 5000; mass ratio <= 1e3), interior-point, alart-curnier,
/// structured-lemke, lemke, pgs |
/// | symmetric M given whole, n > 100 | block-pivoting (50 sets), interior-point, alart-curnier,
/// structured-lemke, lemke, pgs |
/// | other M | interior-point, alart-curnier, lemke, pgs |
///
/// One contact a pair: at most one row in eight is on the bodies of the row before.
///
/// Symmetric is what SymmetricLcp takes: to 1e-2, since measured matrices are printed with few
/// digits. The order is by factorisations counted (real problems and generated families, to 1e-8):
///
/// - symmetric M given whole, 9 real LCPs with n > 100: block-pivoting 5 to 18, interior-point 4
///   to 25, alart-curnier 5 to 37;
/// - not symmetric, 7 circuits: interior-point 2 to 32, alart-curnier 4 to 222; LCPs of pyramid
///   friction up to 1000 rows: interior-point all, alart-curnier those of towers;
/// - factored M, up to 100 rows, by time (families, mass ratios 1 to 1e6): from no start
///   interior-point takes 1.2 times dantzig's at 40 rows, the same at 48, 0.7 at 64, 0.4 at 100;
///   from a near one 1.7, 1.3, 1.2 and 0.6. Plane pyramids with mass ratios of 1e3 and more: 1.0 to
///   1.4 at 64, 0.4 to 0.7 at 100; towers 0.3 to 1.2;
/// - one contact a pair of bodies (piles of spheres, mass ratios 1 to 1e6), by time: the guess of
///   structured-lemke's sweeps is 2 to 60 pivots off up to 160 rows; it takes 0.4 to 0.8 of
///   interior-point's time at 64 and 100 rows, 0.7 to 1.1 at 160, 0.5 to 1.4 at 200; where the
///   pattern is new (mass ratio 1) 0.8, 0.9 and 1 of it at 64, 100 and 160;
/// - factored M: interior-point 2 to 24; block-pivoting 7 to 83 and with mass ratios of 1e6 up to
///   2205, so it is not tried;
/// - associated law, M given whole, 8 real problems with n > 600: cone-interior-point 19 to 43,
///   alart-curnier 12 to 31, but of the two hardest 92 and 372. Coulomb's: alart-curnier 9 to 153
///   (RockPile 344), but smaller ones, as open contacts drop out of its systems;
///   cone-interior-point 20 to 165, and it does not end on RockPile nor on the largest. So it is
///   not tried there. cone-smoothing takes 6 to 58 of 31 of the 32 real ones, and does not end on
///   RockPile;
/// - Coulomb's law, factored M, from no start, 90 families of 444 to 864 rows (mass ratios 1 to
///   1e6): cone-smoothing solves 56 in 100 steps, alart-curnier 77 in 2000, one or the other 84,
///   with a third less steps where cone-smoothing goes first; 15 of 18 piles of spheres in 24 to
///   79, 8 of them in 101 to 1009 by alart-curnier.
///
/// What another solver solved to rounding only, sticking is given to find the last digits of.
/// A proof that there is no solution ends it. Where there is none below a Z so far off that M,
/// changed by its own rounding, has none at all (RayVerdict::defect), only pivoting solvers are
/// tried further, and the detail says so: no iteration gets there, and no certificate could tell.
///
/// Solvers that refuse a problem are passed over; lemke only up to 1000 rows, structured-lemke up
/// to 2000. Each starts from the best iterate so far (the paths,
/// interior-point and cone-smoothing, only from one with residuals below 1e-4, being slower from a
/// worse one than from none).
/// result.attempts lists every one tried, with the reason, status, residuals, cost and time;
/// result.solver names the one whose iterate is returned ("auto: pgs"), and the statistics are sums
/// over the attempts (factor_bytes the largest). If none solves, z is the best iterate, and a ray
/// that any of them proved is kept.
class AutoSolver : public Solver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit AutoSolver(const AutoSettings& settings = {});

  [[nodiscard]] std::string_view name() const override { return "auto"; }
  /// Every problem of problem.h is taken.
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;
  void certify(const Problem& problem, Result& result) override;
  void recycle(std::vector<Attempt>& attempts) override;

 private:
  struct Made {
    std::string_view name;
    int max_iterations;
    std::unique_ptr<Solver> solver;
  };
  struct Step {
    std::string_view solver;
    std::string_view reason;
    int most = -1;  ///< iterations, where the settings do not say
    bool pivots = false;
  };
  void choose(const Problem& problem);
  void choose_for_cones(const Problem& problem);
  Solver& solver(std::string_view name, int max_iterations);
  /// @return true if nothing more need be tried.
  bool attempt(const Problem& problem, const Step& step, int max_iterations,
               const Deadline& deadline, Result& result);
  bool sweep(const Problem& problem, const Deadline& deadline, Result& result);
  void note_attempt(const Step& step, Result& result);

  AutoSettings settings_;
  std::vector<Made> made_;
  std::vector<Step> chain_;
  std::vector<Attempt> old_attempts_;  // memory for new ones
  bool sweeps_first_ = false;
  bool is_out_of_reach_ = false;  // no solution below a Z that no iteration reaches
  Result one_;                    // of the attempt
  Vector start_;                  // the best iterate so far, or the warm start
  bool has_start_ = false;
  double best_merit_ = 0.0;
  Certificate best_certificate_;
  Status best_status_ = Status::kNotRun;
  std::string_view best_solver_;
};

}  // namespace signorini::lcp
