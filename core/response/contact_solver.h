#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/response/accuracy.h>
#include <signorini/core/response/contact_islands.h>
#include <signorini/core/response/contact_memory.h>
#include <signorini/core/response/island_solver.h>
#include <signorini/core/response/step_report.h>
#include <signorini/core/response/velocity_problem.h>
#include <signorini/lcp/result.h>
#include <signorini/lcp/solver.h>

#include <optional>
#include <string>
#include <vector>

namespace signorini {

/// Settings of ContactSolver.
struct ContactSolverSettings {
  FrictionModel friction_model = FrictionModel::kCone;
  int pyramid_sides = 8;  ///< kPyramid: k, even, >= 4
  /// A name that lcp::make_solver() knows; with kCone it must take cones.
  std::string solver = "auto";
  lcp::SolverSettings lcp = {.tolerance = 1e-8, .quick_certificate = true};
  /// The dial, one setting for whoever wants no others: chooses model (Coulomb's cone), solvers and
  /// tolerance for each island (island_solver.h); friction_model, solver, lcp.tolerance and
  /// lcp.max_iterations then count for nothing.
  std::optional<Accuracy> accuracy = std::nullopt;
  StepBudget budget = {};  ///< of one solve; needs accuracy
  /// Starts from the impulses of the solve before: a contact is known again by its bodies and its
  /// feature_id.
  bool warm_start = true;

  /// @throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// What a contact solve found.
struct ContactSolution {
  /// Of the islands the first that is not solved, else solved to rounding if one is.
  lcp::Status status = lcp::Status::kNotRun;
  lcp::Vector normal_impulses;        ///< f, N s, one a contact
  std::vector<Vec3> impulses;         ///< on A (on B: minus that), world axes, N s, one a contact
  std::vector<Vec3> moments;          ///< of rolling and spinning friction, on A, N m s
  std::vector<int> island_of;         ///< of each contact, into `islands`
  std::vector<IslandReport> islands;  ///< solved apart, in the order of their first contact
  /// Of the island that ended worst (not solved before solved, then by the unit-free residual);
  /// statistics.solve_seconds: of all. Not run without contacts.
  lcp::Result result;
  /// Change of the kinetic energy by the impulses, J.
  double energy_change = 0.0;
  std::string accuracy;          ///< position of the dial, empty without
  double work = 0.0;             ///< of all islands, with the dial, units of StepBudget::work
  bool is_deterministic = true;  ///< false where a clock decides when a solver stops
  std::string detail;            ///< one line: anything beyond the plain scheme
};

/// The velocity-level contact problem for a host with its own bodies, its own collision detection
/// and its own integrator: all contacts at once,
///
///     M (v+ - v*) = J_n^T f + J_t^T beta,   0 <= f ⊥ J_n v+ + allowance >= 0,
///
/// and Coulomb's law (or the chosen model) for beta at the contacts with friction. v* are the
/// velocities after the host's forces; TimeStepper is the same with forces, motion and positions.
/// Islands are found and solved apart, to the same bits as each alone; a single contact has a
/// closed form where there is one. Positions are not corrected.
///
/// Not for two threads at once; two solvers share nothing. With kCone our own code allocates
/// nothing once no count of bodies, contacts or rows is other than in the solve before; hand in the
/// same solution again, for its memory.
class ContactSolver {
 public:
  /// @throws std::invalid_argument for bad settings
  explicit ContactSolver(const ContactSolverSettings& settings = {});

  /// Solves, and writes v+ into the momenta of `state`. If an island is not solved its best iterate
  /// is applied, and solution.status and detail say so; one that is not finite is not applied.
  ///
  /// @param allowance one a contact, m/s: how fast the gap may close, see allowances(); negative:
  /// how fast it must open
  /// @throws std::invalid_argument for bad bodies, states or contacts (validate() of each), a
  /// contact of which no body is dynamic, an allowance missing or not finite, or if the solver
  /// refuses this kind of problem; state and solution are then unchanged
  void solve(const Bodies& bodies, const ContactSet& contacts, const lcp::VectorRef& allowance,
             State& state, ContactSolution& solution);

  [[nodiscard]] const ContactSolverSettings& settings() const { return settings_; }

 private:
  [[nodiscard]] FrictionModel friction_model() const;
  void start(std::size_t contacts);
  void collect(std::size_t number, const ContactIsland& island);

  ContactSolverSettings settings_;
  std::string accuracy_name_;
  IslandSolver solver_;
  ContactMemory memory_;
  ContactMemory next_memory_;
  ContactIslands islands_;  // from here on kept for its memory
  std::vector<IslandAnswer> answers_;
  std::vector<Vec3> impulses_, moments_;
  ContactSolution fresh_;
};

/// The allowance of every contact for a step of h seconds (h > 0), m/s: gap/h, so that a gap may
/// just close (0 for gaps up to kToleratedOverlap of position_projection.h); e d' (negative: it
/// opens) at contacts with gap <= touching_tolerance that approach faster than
/// restitution_threshold. TimeStepper's rule, but that it leaves contacts out which are apart and
/// about to bounce.
/// @param state its velocities give d'; TimeStepper takes those before the step's forces
/// @param touching_tolerance m, >= 0. @param restitution_threshold m/s, >= 0; after the forces: at
/// least the speed that they give in a step, or resting contacts bounce
[[nodiscard]] lcp::Vector allowances(const Bodies& bodies, const State& state,
                                     const ContactSet& contacts, double h,
                                     double touching_tolerance, double restitution_threshold);

}  // namespace signorini
