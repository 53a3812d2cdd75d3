#pragma once

#include <signorini/core/response/impact.h>

#include "bench/random_impact.h"

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

/// What a law made of an impact.
struct LawAnswer {
  bool answered = false;  ///< the law itself, nothing that stood in for it
  State after;
  lcp::Vector impulses;  ///< normal, N s, one a contact
};

/// An impact law, ours or another engine's.
struct LawContestant {
  std::string name;
  std::function<LawAnswer(const RandomImpact& impact)> resolve;
};

/// All of our laws, the simultaneous ones plain and energy-safe.
[[nodiscard]] std::vector<LawContestant> our_laws();

/// The five desiderata of Smith, Kaufman, Vouga, Tamstorf, Grinspun (Reflections on Simultaneous
/// Impact, 2012) as numbers; each is 0 for a law that has the property. All impacts have e = 1, no
/// friction and no driven body.
struct LawRow {
  std::string name;
  /// Touching row of 5 equal balls struck by one, by two, and from both ends: the largest |v_i -
  /// v_i'| from what a row with hair gaps does, over the speed of the strikers.
  double break_away = 0.0;
  /// Mirror-symmetric scenes in all orders of their contacts (a ball that breaks two, a box that
  /// lands flat, a rod hit in its middle): the largest asymmetry of the answer, over the speed.
  double symmetry = 0.0;
  double energy_gain = 0.0;  ///< random impacts: the largest T+/T- - 1, at least 0
  double energy_loss = 0.0;  ///< random impacts: the largest 1 - T+/T-, at least 0
  /// Random impacts of free bodies: the largest change of the total p over sum |p|, and of the
  /// total angular momentum about the origin over sum |x x p + L|.
  double momentum = 0.0;
  /// Random impacts: the largest -A_ii f_i / |d'-|_inf, at least 0.
  double one_sided = 0.0;
  /// Random impacts: the largest -d_i'+ / |d'-|_inf, at least 0: the approach that is left.
  double approach = 0.0;
  int impacts = 0;     ///< random
  int unanswered = 0;  ///< of these: the law has no answer; not in the figures above

  /// Letters of the desiderata it has, each within kDesideratum: B, S, E, M, O; "-" where not.
  [[nodiscard]] std::string letters() const;
};

/// What counts as having a property: 1e-9 (dimensionless), some thousand times the rounding of the
/// worst random impact's sums.
inline constexpr double kDesideratum = 1e-9;

struct LawsOptions {
  int impacts = 1000;      ///< random ones, >= 0
  std::uint64_t seed = 1;  ///< as in random_impact.h
};

/// Measures every contestant and prints the table to out.
/// @throws std::invalid_argument for impacts < 0
[[nodiscard]] std::vector<LawRow> run_laws_study(const LawsOptions& options,
                                                 const std::vector<LawContestant>& contestants,
                                                 std::ostream& out);
/// One line a row, with a header line; RFC 4180.
[[nodiscard]] std::string laws_csv(const std::vector<LawRow>& rows);

}  // namespace signorini::bench
