#include <signorini/core/model/number_text.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/energy_safe.h>
#include <signorini/core/response/friction_cones.h>
#include <signorini/core/response/impact_energy.h>
#include <signorini/core/response/least_norm.h>
#include <signorini/core/response/newton_impulse.h>
#include <signorini/core/response/notes_impulse.h>
#include <signorini/core/response/poisson_impulse.h>
#include <signorini/core/response/reflections.h>
#include <signorini/core/response/set_impact.h>
#include <signorini/core/response/single_impulse.h>

#include <algorithm>
#include <utility>

namespace signorini {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class SetImpact {
 public:
  SetImpact(const Bodies& bodies, const ContactSet& contacts, const ImpactSettings& settings,
            lcp::Solver& solver, const State& before, State& after)
      : bodies_(bodies),
        contacts_(contacts),
        settings_(settings),
        solver_(solver),
        before_(before),
        after_(after) {
    assemble_normals(bodies, before, contacts, rows_);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (rows_.block_of_body[k] >= 0) {
        members_.push_back(static_cast<int>(k));
      }
    }
  }

  SetOutcome resolve() {
    lcp::Vector f_e = contacts_.size() == 1 ? solve_single() : solve_law();
    if (!settings_.energy_safe) {
      accept(out_.law.status, std::move(f_e), 1.0);
    } else {
      make_energy_safe(f_e);
    }
    return std::move(out_);
  }

 private:
  lcp::Vector solve_law() {
    switch (settings_.law) {
      case ImpactLaw::kNotes: return solve_notes();
      case ImpactLaw::kPoisson: return solve_poisson();
      case ImpactLaw::kReflections: return solve_reflections();
      default: return solve_newton();
    }
  }

  /// The law in closed form; certified as the Newton LCP of one row.
  lcp::Vector solve_single() {
    const Contact& contact = contacts_.front();
    const SingleImpulse single = single_impulse(bodies_, before_, contact);
    const bool colliding = single.d_dot < -settings_.colliding_threshold;
    const double e = colliding ? contact.material.restitution : 0.0;
    const lcp::Problem problem = newton_problem(rows_, contacts_, settings_.colliding_threshold);
    out_.law.solver = "closed form";
    out_.law.z.setConstant(1, single.with_restitution(e));
    out_.law.certificate = lcp::certify(problem, out_.law.z, &out_.law.w);
    out_.law.status =
        lcp::judge(out_.law.certificate, settings_.lcp.tolerance, lcp::Status::kNumericalBreakdown);
    return out_.law.z;
  }

  lcp::Vector solve_newton() {
    solver_.solve(newton_problem(rows_, contacts_, settings_.colliding_threshold), out_.law);
    return out_.law.z;
  }

  /// Compression and expansion. out_.law is the expansion's LCP, or the compression's where that
  /// was not solved or nothing is given back.
  lcp::Vector solve_poisson() {
    if (!solve_plastic() || !is_colliding()) {
      out_.law = out_.plastic;
      return out_.plastic.z;
    }
    const lcp::Vector compression = compression_of_least_norm();
    solver_.solve(expansion_problem(rows_, contacts_, compression), out_.law);
    return poisson_impulses(contacts_, compression, out_.law.z);
  }

  /// Which f_c is given back matters where the contacts' e differ.
  lcp::Vector compression_of_least_norm() {
    const double e = contacts_.front().material.restitution;
    const bool common = std::all_of(contacts_.begin(), contacts_.end(), [e](const Contact& one) {
      return one.material.restitution == e;
    });
    const lcp::Vector& f_c = out_.plastic.z;
    if (common) {
      return f_c;
    }
    const double closed = residual_allowed(rows_, f_c, settings_.lcp.tolerance);
    const lcp::Vector d_dot = gap_velocities_after(rows_, f_c);
    std::vector<bool> active(contacts_.size());
    for (std::size_t i = 0; i < active.size(); ++i) {
      const auto row = static_cast<lcp::Index>(i);
      active[i] = f_c[row] > 0.0 || d_dot[row] <= closed;
    }
    const LeastNorm least = least_norm(rows_, f_c, active, solver_);
    if (!lcp::is_solved(least.status)) {
      out_.detail = "compression impulses of least norm not found: " +
                    std::string(lcp::to_string(least.status));
    }
    return least.forces;
  }

  /// Elastic reflections, drawn towards the plastic impulses by 1 - e.
  lcp::Vector solve_reflections() {
    if (!is_colliding() || !has_restitution()) {
      solve_plastic();
      out_.law = out_.plastic;
      return out_.plastic.z;
    }
    ConeProblem cones;
    ContactSet smooth = contacts_;
    for (Contact& contact : smooth) {
      contact.material.friction = 0.0;
    }
    assemble_cones(bodies_, before_, smooth, lcp::Vector::Zero(rows_.d_dot.size()), cones);
    ReflectionOutcome outcome = generalized_reflections(
        bodies_, before_, smooth, cones, settings_.lcp.tolerance, settings_.max_passes, solver_);
    out_.law = std::move(outcome.worst);
    out_.law.solver = "reflections over " + out_.law.solver;
    out_.law.status = outcome.status;
    out_.reflections = outcome.reflections;
    const double e =
        common_restitution(contacts_, rows_.d_dot, outcome.z, settings_.colliding_threshold);
    if (!lcp::is_solved(outcome.status) || e == 1.0) {
      return outcome.z;
    }
    if (!solve_plastic()) {
      out_.law.status = out_.plastic.status;
      return outcome.z;
    }
    return out_.plastic.z + e * (outcome.z - out_.plastic.z);
  }

  [[nodiscard]] bool is_colliding() const {
    return (rows_.d_dot.array() < -settings_.colliding_threshold).any();
  }

  [[nodiscard]] bool has_restitution() const {
    return std::any_of(contacts_.begin(), contacts_.end(),
                       [](const Contact& one) { return one.material.restitution > 0.0; });
  }

  bool solve_plastic() {
    if (out_.plastic.status == lcp::Status::kNotRun) {
      solver_.solve(plastic_problem(rows_), out_.plastic);
    }
    return lcp::is_solved(out_.plastic.status);
  }

  lcp::Vector solve_notes() {
    const NotesProblem notes = notes_problem(rows_, contacts_, settings_.colliding_threshold,
                                             settings_.bound_every_contact);
    solver_.solve(notes.problem, out_.law);
    lcp::Vector f = notes_impulses(notes, out_.law.z);
    if (lcp::is_solved(out_.law.status)) {
      check_notes(notes, f);
    }
    return f;
  }

  /// The certificate is about the LCP, whose multipliers may be so large (normals that differ by
  /// little) that its rounding says nothing about f. So the notes' conditions are checked on f
  /// alone, with the rounding of A f: twice n residuals, since tau's row bounds a mean.
  void check_notes(const NotesProblem& notes, const lcp::Vector& f) {
    const double n = static_cast<double>(f.size());
    const double allowed = 2.0 * n * residual_allowed(rows_, f, settings_.lcp.tolerance);
    const double violation = notes_violation(notes, rows_, f);
    if (!(violation <= allowed)) {
      out_.law.status = lcp::Status::kNumericalBreakdown;
      out_.law.detail += (out_.law.detail.empty() ? "" : "; ") +
                         ("the notes' conditions are violated by " + number_text(violation) +
                          " m/s although the LCP is certified");
    }
  }

  /// theta = 1 if f_e itself gains no energy; else the plastic impulses come in.
  void make_energy_safe(const lcp::Vector& f_e) {
    const bool exists = lcp::is_solved(out_.law.status);
    const bool admissible = exists && is_admissible(rows_, f_e, settings_.lcp.tolerance);
    if (admissible) {
      const ImpulseEnergy energy =
          impulse_energy(f_e, rows_.d_dot, gap_velocities_after(rows_, f_e));
      if (energy.gain <= energy.rounding && gains_nothing(f_e)) {
        accept(out_.law.status, f_e, 1.0);
        return;
      }
    }
    const bool plastic_exists = solve_plastic();
    const lcp::Vector& f_c = out_.plastic.z;
    if (!plastic_exists) {
      accept(out_.plastic.status, f_c, kNaN);
    } else if (admissible) {
      blend(f_c, f_e);
    } else {
      out_.detail = exists ? "the law's impulses are not admissible, plastic impulses used"
                           : "the law's LCP: " + std::string(lcp::to_string(out_.law.status)) +
                                 ", plastic impulses used";
      accept_plastic();
    }
  }

  void blend(const lcp::Vector& f_c, const lcp::Vector& f_e) {
    const double theta = largest_theta(energy_line(rows_, f_c, f_e));
    const lcp::Vector f = f_c + theta * (f_e - f_c);
    if (gains_nothing(f)) {
      accept(worse(out_.law.status, out_.plastic.status), f, theta);
    } else {
      out_.detail = "rounding of the law's impulses gains energy, plastic impulses used";
      accept_plastic();
    }
  }

  void accept_plastic() {
    if (gains_nothing(out_.plastic.z)) {
      accept(out_.plastic.status, out_.plastic.z, 0.0);
    } else {
      out_.detail += "; rounding of the plastic impulses gains energy too";
      accept(lcp::Status::kNumericalBreakdown, out_.plastic.z, kNaN);
    }
  }

  /// The promise of energy_safe, from the momenta that f gives.
  bool gains_nothing(const lcp::Vector& f) {
    apply(f);
    double before = 0.0;
    double after = 0.0;
    for (const int k : members_) {
      before += kinetic_energy(bodies_[k], before_[k]);
      after += kinetic_energy(bodies_[k], after_[k]);
    }
    const double work = driver_work(bodies_, before_, contacts_, f);
    return relative_energy_gain(after - before - work, before, work) <= kMostEnergyGain;
  }

  void apply(const lcp::Vector& f) {
    for (const int k : members_) {
      after_[k] = before_[k];
    }
    apply_impulses(bodies_, contacts_, f, after_);
  }

  void accept(lcp::Status status, lcp::Vector f, double theta) {
    out_.status = status;
    out_.theta = lcp::is_solved(status) ? theta : kNaN;
    out_.impulses = std::move(f);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      out_.contact_impulses.emplace_back(out_.impulses[static_cast<lcp::Index>(i)] *
                                         contacts_[i].normal);
    }
    if (lcp::is_solved(status)) {
      apply(out_.impulses);
    }
  }

  const Bodies& bodies_;
  const ContactSet& contacts_;
  const ImpactSettings& settings_;
  lcp::Solver& solver_;
  const State& before_;
  State& after_;
  NormalRows rows_;
  std::vector<int> members_;  // the dynamic bodies of the set
  SetOutcome out_;
};

}  // namespace

SetOutcome resolve_set(const Bodies& bodies, const ContactSet& contacts,
                       const ImpactSettings& settings, lcp::Solver& solver, const State& before,
                       State& after) {
  return SetImpact(bodies, contacts, settings, solver, before, after).resolve();
}

}  // namespace signorini
