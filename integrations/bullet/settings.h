#pragma once

#include <signorini/lcp/solve_recorder.h>

#include <cstdint>
#include <limits>

namespace signorini::bullet {

/// How the friction impulses (f1, f2) of a contact are bound to its normal impulse f_n. mu is
/// Bullet's m_combinedFriction (the product of both bodies' friction, unless a callback set it).
/// Contacts with rolling friction have boxes either way.
enum class FrictionModel : std::uint8_t {
  kCone,  ///< Coulomb: |(f1, f2)| <= mu f_n, opposite to the slip where it slips; no direction is
          ///< preferred
  kBox,   ///< |f1| <= mu f_n, |f2| <= mu f_n, as Bullet's own solver bounds them
};

/// What a solver of this folder is told.
struct Settings {
  FrictionModel friction = FrictionModel::kCone;
  /// Both residuals of the certificate must be at most this: dimensionless, in (0, 1).
  /// (lcp::SolverSettings)
  double tolerance = 1e-8;
  /// Seconds of wall time that one island may take, > 0. A run limited by time does not give the
  /// same answer twice.
  double time_limit = std::numeric_limits<double>::infinity();
  /// Is told of every problem solved, with its friction; null: nobody. Not owned: it must outlive
  /// the solver. lcp/io/dump_recorder.h writes files with it.
  lcp::SolveRecorder* recorder = nullptr;

  /// @throws std::invalid_argument that names the setting, its value and the bound.
  void validate() const;
};

}  // namespace signorini::bullet
