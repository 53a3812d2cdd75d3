#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <string>
#include <vector>

namespace signorini {

/// How the impulses of several touching contacts follow from d'+ = A f + d'-.
enum class ImpactLaw : std::uint8_t {
  /// Each colliding contact once, in order, by the closed form. Leaves contacts approaching.
  kSequentialOnce,
  /// The same, passes repeated until no contact approaches. Valid, but the order decides the
  /// answer.
  kSequentialRepeated,
  /// Newton LCP: 0 <= f ⊥ A f + d'- + e_i d_i'- >= 0 (the e term for colliding contacts only). Can
  /// be
  /// infeasible (a ball between two opposite walls, e > 0) and can gain energy.
  kNewton,
  /// The notes' form: min |A f + d'- - t|^2, t_i = -e_i d_i'- if colliding, else d_i'-, subject to
  /// f >= 0, A f + d'- >= 0, and A f + d'- <= |d'-| at colliding contacts; its KKT conditions are
  /// solved as an LCP in f and v+. Can gain energy.
  kNotes,
};

struct ImpactSettings {
  ImpactLaw law = ImpactLaw::kNewton;
  /// f = f_c + theta (f_e - f_c): f_e the law's impulses, f_c the plastic ones (e = 0), with the
  /// largest theta in [0, 1] in each connected set that gains no kinetic energy; theta = 0 where
  /// f_e does not exist or is not admissible. Design, section 4.4. Not for the sequential laws.
  bool energy_safe = true;
  /// Contacts with d'- < -threshold are colliding (restitution acts), m/s, >= 0.
  double colliding_threshold = 0.0;
  /// The LCP solver, a name that lcp::make_solver() knows, and what it is told.
  std::string solver = "lemke";
  lcp::SolverSettings lcp = {.tolerance = 1e-12};
  /// Sequential laws: the order of the contacts (indices; empty: as given), and the most passes.
  std::vector<int> order;
  int max_passes = 10000;

  /// @throws std::invalid_argument naming field, value and bound.
  void validate(int contact_count) const;
};

/// What an impact did. Kinetic energies are of the dynamic bodies, J. With driven bodies the
/// balance that must not rise is energy_after - energy_before - driver_work.
struct ImpactReport {
  /// Solved (or to rounding) only if f satisfies the law: its LCPs are certified, or the sequential
  /// passes ended with no contact approaching (kSequentialOnce: always kSolved after its one pass).
  /// If the law's LCP failed and energy_safe let f = f_c stand in, this is the plastic LCP's
  /// status, and law_status says what happened to the law.
  lcp::Status status = lcp::Status::kNotRun;
  lcp::Status law_status = lcp::Status::kNotRun;
  lcp::Vector impulses;      ///< f, N s, one a contact
  lcp::Vector d_dot_before;  ///< d'-, m/s
  lcp::Vector d_dot_after;   ///< d'+, m/s, from the new state
  double energy_before = 0.0;
  double energy_after = 0.0;
  double driver_work = 0.0;         ///< work done by driven bodies through the impulses, J
  std::vector<int> set_of_contact;  ///< connected sets
  lcp::Vector theta;                ///< one a connected set; 1 for every set when not energy_safe
  lcp::Result law_result;      ///< the law's LCP (not for the sequential laws); ray_bound has Z
  lcp::Result plastic_result;  ///< the plastic LCP (energy_safe only)
  int passes = 0;              ///< sequential laws
  std::string detail;          ///< one line: what was done beyond the plain law
};

/// Resolves the impact of a contact set: all contacts at once (or in sequence, by law), new momenta
/// into state. Where status is not solved, state is unchanged and report.impulses is the best
/// iterate.
/// @throws std::invalid_argument for bad settings, bodies or contacts; state is then unchanged.
void resolve_impact(const Bodies& bodies, const ContactSet& contacts,
                    const ImpactSettings& settings, State& state, ImpactReport& report);

}  // namespace signorini
