#include <signorini/core/model/number_text.h>
#include <signorini/core/response/energy_safe.h>
#include <signorini/core/response/friction_cones.h>
#include <signorini/core/response/friction_impact.h>
#include <signorini/core/response/impact_energy.h>
#include <signorini/core/response/reflections.h>
#include <signorini/lcp/friction_cone.h>

#include <algorithm>
#include <string>
#include <utility>

namespace signorini {
namespace {

class FrictionImpact {
 public:
  FrictionImpact(const Bodies& bodies, const ContactSet& contacts, const ImpactSettings& settings,
                 lcp::Solver& solver, const State& before, State& after)
      : bodies_(bodies),
        contacts_(contacts),
        settings_(settings),
        solver_(solver),
        before_(before),
        after_(after) {
    const lcp::Vector none = lcp::Vector::Zero(static_cast<lcp::Index>(contacts.size()));
    assemble_cones(bodies, before, contacts, none, cones_);
    before_rows_ = cones_.problem.q;
    d_dot_ = normal_impulses(cones_, before_rows_);  // the normal rows of q
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const bool touched = std::any_of(contacts.begin(), contacts.end(), [&](const Contact& one) {
        return one.body_a == static_cast<int>(k) || one.body_b == static_cast<int>(k);
      });
      if (touched && bodies[k].is_dynamic()) {
        members_.push_back(static_cast<int>(k));
      }
    }
  }

  SetOutcome resolve() {
    const lcp::Vector wish =
        settings_.law == ImpactLaw::kReflections ? solve_reflections() : solve_newton();
    if (!settings_.energy_safe) {
      accept(out_.law.status, wish, 1.0);
      return std::move(out_);
    }
    const bool exists = lcp::is_solved(out_.law.status) && is_in_cones(wish);
    if (exists && gains_nothing(wish)) {
      accept(out_.law.status, wish, 1.0);
    } else if (!solve_plastic()) {
      accept(out_.plastic.status, plastic_, kNaN);
    } else if (exists) {
      blend(wish);
    } else {
      out_.detail = "the law: " + std::string(lcp::to_string(out_.law.status)) +
                    (lcp::is_solved(out_.law.status) ? " but outside the cones" : "") +
                    ", plastic impulses used";
      accept_plastic();
    }
    return std::move(out_);
  }

 private:
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  lcp::Vector solve_newton() {
    lcp::Problem problem = cones_.problem;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const double d_dot = d_dot_[static_cast<lcp::Index>(i)];
      if (d_dot < -settings_.colliding_threshold) {
        problem.q[cones_.normal_row[i]] += contacts_[i].material.restitution * d_dot;
      }
    }
    solver_.solve(problem, out_.law);
    return out_.law.z;
  }

  lcp::Vector solve_reflections() {
    const double tolerance = settings_.lcp.tolerance;
    const lcp::Vector ones = lcp::Vector::Ones(d_dot_.size());
    if (common_restitution(contacts_, d_dot_, ones, settings_.colliding_threshold) > 0.0) {
      ReflectionOutcome outcome = generalized_reflections(bodies_, before_, contacts_, cones_,
                                                          tolerance, settings_.max_passes, solver_);
      out_.law = std::move(outcome.worst);
      out_.law.solver = "reflections over " + out_.law.solver;
      out_.reflections = outcome.reflections;
      out_.law.status = outcome.status;
      if (!lcp::is_solved(outcome.status)) {
        return outcome.z;
      }
      const double e = common_restitution(contacts_, d_dot_, normal_impulses(cones_, outcome.z),
                                          settings_.colliding_threshold);
      if (e == 1.0) {
        return outcome.z;
      }
      if (solve_plastic()) {
        return plastic_ + e * (outcome.z - plastic_);
      }
    } else {
      solve_plastic();
    }
    out_.law = out_.plastic;
    return plastic_;
  }

  bool solve_plastic() {
    if (out_.plastic.status == lcp::Status::kNotRun) {
      solver_.solve(cones_.problem, out_.plastic);
      plastic_ = out_.plastic.z;
    }
    return lcp::is_solved(out_.plastic.status);
  }

  /// In K and not approaching, to the tolerance or the rounding, both in m/s.
  [[nodiscard]] bool is_in_cones(const lcp::Vector& z) const {
    const lcp::Vector after = velocity_after(z);
    const double allowed = velocity_allowed(cones_, z, settings_.lcp.tolerance);
    lcp::Vector diagonal;
    cones_.A().diagonal(diagonal);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const int row = cones_.normal_row[i];
      const int height = cones_.friction[i] > 0.0 ? 3 : 1;
      const double outside =
          height == 1 ? -z[row] : lcp::cone_violation(cones_.friction[i], 3, z.data() + row);
      const double scale = diagonal.segment(row, height).maxCoeff();
      if (after[row] < -allowed || scale * outside > allowed) {
        return false;
      }
    }
    return true;
  }

  void blend(const lcp::Vector& wish) {
    const double theta = largest_theta(energy_line(cones_.A(), before_rows_, plastic_, wish));
    const lcp::Vector z = plastic_ + theta * (wish - plastic_);
    if (gains_nothing(z)) {
      accept(worse(out_.law.status, out_.plastic.status), z, theta);
    } else {
      out_.detail = "rounding of the law's impulses gains energy, plastic impulses used";
      accept_plastic();
    }
  }

  void accept_plastic() {
    if (gains_nothing(plastic_)) {
      accept(out_.plastic.status, plastic_, 0.0);
    } else {
      out_.detail += "; rounding of the plastic impulses gains energy too";
      accept(lcp::Status::kNumericalBreakdown, plastic_, kNaN);
    }
  }

  /// By the rows, and by the momenta that z gives (as SetImpact promises).
  bool gains_nothing(const lcp::Vector& z) {
    const ImpulseEnergy energy = impulse_energy(z, before_rows_, velocity_after(z));
    if (!(energy.gain <= energy.rounding)) {
      return false;
    }
    apply(z);
    double before = 0.0;
    double after = 0.0;
    for (const int k : members_) {
      before += kinetic_energy(bodies_[k], before_[k]);
      after += kinetic_energy(bodies_[k], after_[k]);
    }
    const double work =
        driver_work(bodies_, before_, contacts_, contact_impulses(cones_, contacts_, z));
    return relative_energy_gain(after - before - work, before, work) <= kMostEnergyGain;
  }

  [[nodiscard]] lcp::Vector velocity_after(const lcp::Vector& z) const {
    lcp::Vector after(z.size());
    cones_.A().multiply(z.data(), after.data());
    return after + before_rows_;
  }

  void apply(const lcp::Vector& z) {
    for (const int k : members_) {
      after_[k] = before_[k];
    }
    apply_contact_impulses(bodies_, contacts_, contact_impulses(cones_, contacts_, z), after_);
  }

  void accept(lcp::Status status, const lcp::Vector& z, double theta) {
    out_.status = status;
    out_.theta = lcp::is_solved(status) ? theta : kNaN;
    out_.impulses = normal_impulses(cones_, z);
    out_.contact_impulses = contact_impulses(cones_, contacts_, z);
    if (lcp::is_solved(status)) {
      apply(z);
    }
  }

  const Bodies& bodies_;
  const ContactSet& contacts_;
  const ImpactSettings& settings_;
  lcp::Solver& solver_;
  const State& before_;
  State& after_;
  ConeProblem cones_;
  lcp::Vector before_rows_;   // u-
  lcp::Vector d_dot_;         // d'-
  lcp::Vector plastic_;       // z_c
  std::vector<int> members_;  // the dynamic bodies of the set
  SetOutcome out_;
};

}  // namespace

SetOutcome resolve_set_with_friction(const Bodies& bodies, const ContactSet& contacts,
                                     const ImpactSettings& settings, lcp::Solver& solver,
                                     const State& before, State& after) {
  return FrictionImpact(bodies, contacts, settings, solver, before, after).resolve();
}

}  // namespace signorini
