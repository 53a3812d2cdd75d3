#include <signorini/core/response/energy_safe.h>
#include <signorini/core/response/impact_energy.h>
#include <signorini/core/response/reflections.h>
#include <signorini/lcp/certificate.h>

#include <algorithm>
#include <cmath>

namespace signorini {
namespace {

constexpr double kFloors = 4.0;  // as lcp::judge() allows

/// Keeps the result that is less solved, then of the larger residual.
void keep_worse(lcp::Result& candidate, lcp::Result& worst) {
  const auto rank = [](const lcp::Result& result) {
    if (result.status == lcp::Status::kNotRun) {
      return -1.0;
    }
    return lcp::is_solved(result.status) ? result.certificate.unit_free_residual
                                         : std::numeric_limits<double>::infinity();
  };
  if (rank(candidate) > rank(worst)) {
    std::swap(candidate, worst);
  }
}

class Reflections {
 public:
  Reflections(const Bodies& bodies, const State& before, const ContactSet& contacts,
              const ConeProblem& cones, double tolerance, lcp::Solver& solver)
      : bodies_(bodies),
        before_(before),
        contacts_(contacts),
        cones_(cones),
        tolerance_(tolerance),
        solver_(solver) {
    out_.z.setZero(cones.problem.size());
    velocity_ = cones.problem.q;
  }

  ReflectionOutcome run(int most) {
    while (find_approaching()) {
      if (out_.reflections == most) {
        out_.status = lcp::Status::kIterationLimit;
        return std::move(out_);
      }
      assemble_approaching();
      if ((out_.reflections == kReflectionsAtEase && leaves_no_room()) || !reflect()) {
        return std::move(out_);
      }
      ++out_.reflections;
      cones_.A().multiply(out_.z.data(), velocity_.data());
      velocity_ += cones_.problem.q;
    }
    out_.status = lcp::Status::kSolved;
    return std::move(out_);
  }

 private:
  bool find_approaching() {
    const double allowed = velocity_allowed(cones_, out_.z, tolerance_);
    approaching_.clear();
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (velocity_[cones_.normal_row[i]] < -allowed) {
        approaching_.push_back(static_cast<int>(i));
      }
    }
    return !approaching_.empty();
  }

  /// True, with the status set, if no velocity opens every contact.
  bool leaves_no_room() {
    NormalRows rows;
    assemble_normals(bodies_, before_, contacts_, rows);
    lcp::Problem problem;
    problem.M = rows.A;
    problem.q = -lcp::Vector::Ones(rows.d_dot.size());
    lcp::Result result;
    solver_.solve(problem, result);
    if (result.status != lcp::Status::kInfeasible &&
        result.status != lcp::Status::kNoSolutionBelow) {
      return false;
    }
    out_.status = result.status;
    keep_worse(result, out_.worst);
    return true;
  }

  /// The rows of V with the velocities that they have now.
  void assemble_approaching() {
    ContactSet chosen;
    for (const int i : approaching_) {
      chosen.push_back(contacts_[i]);
    }
    const lcp::Vector none = lcp::Vector::Zero(static_cast<lcp::Index>(chosen.size()));
    assemble_cones(bodies_, before_, chosen, none, part_);
    rows_.clear();
    for (const int i : approaching_) {
      const int height = cones_.friction[i] > 0.0 ? 3 : 1;
      for (int k = 0; k < height; ++k) {
        rows_.push_back(cones_.normal_row[i] + k);
      }
    }
    now_ = velocity_(rows_);
  }

  /// One reflection of V. @return false if its problem was not solved.
  bool reflect() {
    part_.problem.q = now_;
    for (const int row : part_.normal_row) {
      part_.problem.q[row] *= 2.0;
    }
    lcp::Vector z;
    if (!solve(z)) {
      return false;
    }
    if (!part_.problem.cones.empty() && gains(z)) {
      lcp::Vector plastic;
      part_.problem.q = now_;
      if (!solve(plastic)) {
        return false;
      }
      const double theta = largest_theta(energy_line(part_.A(), now_, plastic, z));
      z = plastic + theta * (z - plastic);
      ++out_.reduced;
    }
    out_.z(rows_) += z;
    return true;
  }

  bool solve(lcp::Vector& z) {
    lcp::Result result;
    solve_rows(result);
    z = result.z;
    const lcp::Status status = result.status;
    keep_worse(result, out_.worst);
    if (!lcp::is_solved(status)) {
      out_.status = status;
      return false;
    }
    return true;
  }

  void solve_rows(lcp::Result& result) {
    const lcp::Problem& problem = part_.problem;
    if (problem.size() != 1) {
      solver_.solve(problem, result);
      return;
    }
    lcp::Vector diagonal;
    part_.A().diagonal(diagonal);
    result.solver = "closed form";
    result.z = (-problem.q.array() / diagonal.array()).max(0.0);
    result.certificate = lcp::certify(problem, result.z, &result.w);
    result.status = lcp::judge(result.certificate, tolerance_, lcp::Status::kNumericalBreakdown);
  }

  [[nodiscard]] bool gains(const lcp::Vector& z) const {
    lcp::Vector after(now_.size());
    part_.A().multiply(z.data(), after.data());
    after += now_;
    const ImpulseEnergy energy = impulse_energy(z, now_, after);
    return energy.gain > energy.rounding;
  }

  const Bodies& bodies_;
  const State& before_;
  const ContactSet& contacts_;
  const ConeProblem& cones_;
  double tolerance_;
  lcp::Solver& solver_;
  lcp::Vector velocity_;          // u after the reflections so far
  std::vector<int> approaching_;  // V
  ConeProblem part_;              // the rows of V
  std::vector<int> rows_;         // of V, in the whole
  lcp::Vector now_;               // their velocities
  ReflectionOutcome out_;
};

}  // namespace

ReflectionOutcome generalized_reflections(const Bodies& bodies, const State& before,
                                          const ContactSet& contacts, const ConeProblem& cones,
                                          double tolerance, int most, lcp::Solver& solver) {
  return Reflections(bodies, before, contacts, cones, tolerance, solver).run(most);
}

double common_restitution(const ContactSet& contacts, const lcp::VectorRef& d_dot,
                          const lcp::VectorRef& f, double threshold) {
  double least = 1.0;
  double most = 0.0;
  double sum = 0.0;
  double weight = 0.0;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const auto i = static_cast<lcp::Index>(k);
    if (d_dot[i] < -threshold) {
      const double e = contacts[k].material.restitution;
      least = std::min(least, e);
      most = std::max(most, e);
      sum += f[i] * -d_dot[i] * e;
      weight += f[i] * -d_dot[i];
    }
  }
  return least >= most || weight <= 0.0 ? most : std::clamp(sum / weight, least, most);
}

double velocity_allowed(const ConeProblem& cones, const lcp::VectorRef& z, double tolerance) {
  if (z.size() == 0) {
    return 0.0;
  }
  const double floor = lcp::certify(cones.problem, z).rounding_floor;
  return std::max(tolerance, kFloors * floor) * cones.problem.q.cwiseAbs().maxCoeff();
}

}  // namespace signorini
