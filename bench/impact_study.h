#pragma once

#include <signorini/core/response/impact.h>

#include "bench/random_impact.h"

#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace signorini::bench {

/// Random multi-contact impacts (random_impact.h): 2..20 bodies, redundant contacts, at least 30 %
/// of the contacts touching and separating. For each impact law, plain and energy-safe: how often
/// and by how much kinetic energy is gained.
struct ImpactOptions {
  /// The simultaneous laws to run; with friction those that have it.
  std::vector<ImpactLaw> laws = {ImpactLaw::kNewton, ImpactLaw::kNotes, ImpactLaw::kPoisson,
                                 ImpactLaw::kReflections};
  RandomImpactOptions impact = {};         ///< most_friction > 0: friction acts
  bool plain_forms = true;                 ///< beside the energy-safe ones
  int first = 0;                           ///< number of the first impact, >= 0
  int impacts = 10000;                     ///< >= 0
  std::uint64_t seed = 1;                  ///< impact k of a seed is the same whatever `impacts` is
  lcp::SolveRecorder* recorder = nullptr;  ///< is told of every solve
};

/// One line of the table: a law, plain or energy-safe, over all impacts. Gains are
/// ImpactReport::relative_energy_gain(), dimensionless.
struct ImpactRow {
  ImpactLaw law = ImpactLaw::kNewton;
  bool energy_safe = false;
  std::map<lcp::Status, int> statuses;  ///< ImpactReport::status
  int gained = 0;                       ///< gain > 1e-12
  double worst_gain = 0.0;              ///< the largest gain, of all solved; below 0: none gains
  double median_gain = 0.0;             ///< of those that gained
  int reduced = 0;                      ///< 0 < theta < 1 in a connected set
  int replaced = 0;                     ///< theta = 0 in a connected set: the plastic impulses
  /// f < 0, outside its cone, or d'+ < 0 beyond the tolerance times |d'-|_inf and rounding
  int inadmissible = 0;
  double worst_approach = 0.0;  ///< max -d'+ / |d'-|_inf, d'+ from the new momenta
  /// max |energy_gain() - gain_from_impulses| / (T- + T+ + |driver work|)
  double worst_identity = 0.0;

  [[nodiscard]] int solved() const;  ///< or solved to rounding
};

struct ImpactCounts {
  int impacts = 0;
  int contacts = 0;
  double separating_share = 0.0;  ///< of the contacts, before the impact
  double worst_safe_gain = 0.0;   ///< (T+ - T- - W) / (T- + |W|), energy-safe form: <= 1e-12
  int newton_gains = 0;           ///< impacts whose plain Newton form gained more than 1e-12
  int notes_gains = 0;
  /// Energy-safe impacts without an answer although no driven body squeezes: must be 0. (With
  /// driven bodies the plastic LCP can be infeasible; then its status says so.)
  int unanswered = 0;
  /// With friction: energy-safe impacts whose Coulomb problem was not solved, their status says so.
  int unsolved_coulomb = 0;
  int squeezed = 0;  ///< plastic LCP shown infeasible in a scene with driven bodies
  std::vector<ImpactRow> rows;
  std::vector<std::string>
      complaints;  ///< the impacts by number that break the verdict; 20 at most

  /// Every energy-safe impact is answered (with friction: or its Coulomb problem unsolved),
  /// admissible, without gain, with its energy accounted for; and at least 30 % of the contacts
  /// were separating.
  [[nodiscard]] bool passed() const;
  /// The rows, one a line, with a header line; RFC 4180.
  [[nodiscard]] std::string to_csv() const;
};

/// Prints a table (law, plain or safe: solved, gained, worst and median gain) and a verdict to out;
/// progress to stderr when that is a terminal. @throws std::invalid_argument for impacts < 0 or
/// first < 0
ImpactCounts run_impact_study(const ImpactOptions& options, std::ostream& out);

}  // namespace signorini::bench
