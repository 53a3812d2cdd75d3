#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace signorini {

/// How the impulses of several touching contacts follow from d'+ = A f + d'-.
enum class ImpactLaw : std::uint8_t {
  /// Each contact once, in order: the closed form if it approaches when its turn comes. Leaves
  /// contacts approaching.
  kSequentialOnce,
  /// The same, passes repeated until no contact approaches. Valid, but the order decides the
  /// answer. sequential_impulses.h.
  kSequentialRepeated,
  /// Newton LCP: 0 <= f ⊥ A f + d'- + e_i d_i'- >= 0 (the e term for colliding contacts only). Can
  /// be infeasible (a ball between two opposite walls, e > 0) and can gain energy.
  /// newton_impulse.h.
  kNewton,
  /// The notes' form: min |A f + d'- - t|^2, t_i = -e_i d_i'- if colliding, else d_i'-, subject to
  /// f >= 0, A f + d'- >= 0, and A f + d'- <= |d'-| at colliding contacts; its KKT conditions are
  /// solved as an LCP in f and d'+. Can be infeasible and can gain energy. notes_impulse.h.
  kNotes,
  /// Poisson: compression and expansion, e_i of what compression took in given back by expansion.
  /// Exists where the plastic impulses do; gains no energy for a common e, can for different ones.
  /// poisson_impulse.h.
  kPoisson,
  /// Generalized reflections: break-away (a touching cradle works), energy kept for e = 1. For e <
  /// 1 f = f_c + e (f_1 - f_c) with f_1 the reflections for e = 1, f_c the plastic impulses and one
  /// e a connected set (common_restitution()); break-away is then partial. Never gains energy; may
  /// need more reflections than max_passes (kIterationLimit). reflections.h.
  kReflections,
};

/// The text of a law, for example "sequential, repeated".
[[nodiscard]] std::string_view to_string(ImpactLaw law);

/// How resolve_impact() resolves.
struct ImpactSettings {
  /// The only law with all five of break-away, symmetry, energy, momentum and one-sided impulses:
  /// docs/impact-laws.md has the table (`signorini-bench laws`). Where only the cost counts kNewton
  /// is one LCP.
  ImpactLaw law = ImpactLaw::kReflections;
  /// f = f_c + theta (f_e - f_c): f_e the law's impulses, f_c the plastic ones (e = 0), with the
  /// largest theta in [0, 1] in each connected set that gains no kinetic energy; theta = 0 where
  /// f_e does not exist or is not admissible. energy_safe.h. Not for the sequential laws, which
  /// never gain energy.
  bool energy_safe = true;
  /// Contacts with d'- < -threshold are colliding (restitution acts; others that approach just
  /// stop), m/s, finite, >= 0.
  double colliding_threshold = 0.0;
  /// kNotes only: A f + d'- <= |d'-| at every contact, as the notes have it, not at the colliding
  /// ones alone. Then a rod on two supports that is hit beyond one of them has no solution: the
  /// far support must lift, and it had d'- = 0.
  bool bound_every_contact = false;
  /// The LCP solver, a name that lcp::make_solver() knows, and what it is told. The sequential laws
  /// use lcp.tolerance alone: no contact may approach faster than tolerance |d'-|_inf in the end.
  std::string solver = "lemke";
  lcp::SolverSettings lcp = {.tolerance = 1e-12};
  /// Coulomb's friction acts in the impact with the contacts' mu: kNewton and kReflections alone.
  /// friction_impact.h. Contacts that resist turning are refused.
  bool friction = false;
  /// Its solver, a name that lcp::make_solver() knows, that takes cones.
  std::string friction_solver = "auto";
  /// Sequential laws: the order of the contacts, a permutation of 0 .. n-1; empty: as given.
  std::vector<int> order = {};
  /// Sequential laws, repeated: the most passes, >= 1; kReflections: the most reflections. Between
  /// two opposite walls with e = 1 the passes never end; with e < 1 they need about log(tolerance)
  /// / log(e).
  int max_passes = 10000;

  /// @throws std::invalid_argument naming field, value and bound.
  void validate(int contact_count) const;
};

/// What an impact did. Kinetic energies are of the dynamic bodies, J. With driven bodies the
/// balance that must not rise is energy_after - energy_before - driver_work = energy_gain().
struct ImpactReport {
  /// Solved (or to rounding) only if f satisfies the law: its LCPs are certified, or the sequential
  /// passes ended with no contact approaching (kSequentialOnce: always kSolved after its one pass).
  /// If the law's LCP failed and energy_safe let f = f_c stand in, this is the plastic LCP's
  /// status, and law_status says what happened to the law. Of several connected sets: the first
  /// that is not solved, else solved to rounding if one is.
  lcp::Status status = lcp::Status::kNotRun;
  lcp::Status law_status = lcp::Status::kNotRun;
  lcp::Vector impulses;  ///< f, N s, one a contact
  /// f N and, with friction, the tangential impulse: on A, world axes, N s, one a contact.
  std::vector<Vec3> contact_impulses;
  lcp::Vector d_dot_before;  ///< d'-, m/s
  lcp::Vector d_dot_after;   ///< d'+, m/s, from the new state
  double energy_before = 0.0;
  double energy_after = 0.0;
  double driver_work = 0.0;  ///< work done by driven bodies through the impulses, J
  /// 1/2 f.(d'+ + d'-), with friction 1/2 sum f_i.(u_i+ + u_i-), J: what energy_gain() must be. The
  /// two are computed apart (this from the impulses, that from the momenta), so that their
  /// difference shows a wrong sum.
  double gain_from_impulses = 0.0;
  std::vector<int> set_of_contact;  ///< connected sets
  lcp::Vector
      theta;  ///< one a connected set; 1 for every set when not energy_safe; NaN: not solved
  std::vector<lcp::Status> law_status_of_set;  ///< (not for the sequential laws)
  /// The law's LCP, of the connected set where it ended worst (not solved before solved, then by
  /// the unit-free residual); kPoisson: the expansion's; kReflections: the reflection's that ended
  /// worst. ray_bound has Z. A set of a single contact is answered in closed form
  /// and certified as the Newton LCP it solves. Not for the sequential laws.
  lcp::Result law_result;
  /// The plastic LCP, of the set where it ended worst. Solved only where theta < 1 (energy_safe):
  /// kNotRun where f_e itself gains no energy in every set.
  lcp::Result plastic_result;
  /// Sequential laws: passes that changed something; kReflections: the most in a connected set.
  int passes = 0;
  std::string detail;  ///< one line: what was done beyond the plain law

  /// T+ - T- - driver work, J, from the momenta.
  [[nodiscard]] double energy_gain() const { return energy_after - energy_before - driver_work; }
  /// energy_gain() / (T- + |driver work|), dimensionless; 0 where both are 0. The driver's work is
  /// in the scale because bodies at rest that are struck by a driven one have T- = 0.
  [[nodiscard]] double relative_energy_gain() const;
};

/// Resolves the impact of a contact set: all contacts at once (or in sequence, by law), new momenta
/// into state. Each connected set of contacts is a problem of its own; a set of one contact is
/// answered in closed form. Where status is not solved, state is unchanged and report.impulses is
/// the best iterate.
///
/// energy_safe promises for every connected set: f >= 0, d'+ >= 0 (both to lcp.tolerance) and
/// energy_gain() <= 1e-12 (T- + |driver work|), recomputed from the new momenta. Where that fails
/// even for the plastic impulses the status is kNumericalBreakdown.
///
/// @throws std::invalid_argument for bad settings, bodies, states or contacts; state and report are
/// then unchanged.
void resolve_impact(const Bodies& bodies, const ContactSet& contacts,
                    const ImpactSettings& settings, State& state, ImpactReport& report);

}  // namespace signorini
