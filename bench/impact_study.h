#pragma once

#include <cstdint>
#include <iosfwd>

namespace signorini::bench {

/// Random multi-contact impacts: 2..20 bodies, mass ratios to 1e3, redundant contacts, at least 30 % of
/// the contacts touching and separating. For each impact law, plain and energy-safe: how often and by how
/// much kinetic energy is gained.
struct ImpactOptions {
  int impacts = 10000;
  std::uint64_t seed = 1;
};

struct ImpactCounts {
  int impacts = 0;
  double separating_share = 0.0;        ///< of the contacts, before the impact
  double worst_safe_gain = 0.0;         ///< (T+ - T- - driver work) / T-, energy-safe form: <= 1e-12
  int newton_gains = 0;                 ///< impacts whose plain Newton form gained more than 1e-12
  int notes_gains = 0;
};

/// Prints a table (law, plain or safe: solved, gained, worst and median gain) to out.
ImpactCounts run_impact_study(const ImpactOptions& options, std::ostream& out);

}  // namespace signorini::bench
