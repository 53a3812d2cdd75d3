#include <signorini/core/model/number_text.h>
#include <signorini/core/response/coulomb_forces.h>
#include <signorini/core/response/friction_cones.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace signorini {
namespace {

/// Accelerations up to this many tolerances of |q|_inf count as zero.
constexpr double kStill = 100.0;

/// The problem over normal rows and the tangents of contacts that do not slide: z of all rows of
/// the cones = expansion * z.
class AccelerationProblem {
 public:
  AccelerationProblem(const Bodies& bodies, const State& state, const ContactSet& contacts,
                      const std::vector<bool>& slides,
                      const std::vector<BodyAcceleration>& accelerations,
                      const RestingSettings& settings)
      : contacts_(contacts), slides_(slides) {
    const double T = settings.stabilization_time;
    const auto count = static_cast<lcp::Index>(contacts.size());
    assemble_cones(bodies, state, contacts, lcp::Vector::Zero(count), cones_);
    velocity_ = cones_.problem.q;
    for (lcp::Index i = 0; i < count; ++i) {
      const ContactAcceleration free =
          contact_acceleration(bodies, state, contacts[i], accelerations);
      if (free.degenerate) {
        degenerate_.push_back(static_cast<int>(i));
      }
      const int row = cones_.normal_row[i];
      lcp::Vector& q = cones_.problem.q;
      q[row] = free.normal + (2.0 * velocity_[row] + contacts[i].gap / T) / T;
      if (has_tangents(i)) {
        const TangentFrame& frame = cones_.frames[i];
        q[row + 1] = frame.t1.dot(free.slip) + velocity_[row + 1] / settings.slip_time;
        q[row + 2] = frame.t2.dot(free.slip) + velocity_[row + 2] / settings.slip_time;
      }
    }
    check_slips();
    choose_rows();
    if (some_slide_) {
      reduce();
    }
  }

  [[nodiscard]] const lcp::Problem& problem() const {
    return some_slide_ ? reduced_ : cones_.problem;
  }
  [[nodiscard]] const std::vector<int>& degenerate() const { return degenerate_; }

  /// @param relative accelerations up to this much of |q|_inf count as zero
  void read(const lcp::Result& result, double relative, CoulombReport& report) const {
    const lcp::Vector z = some_slide_ ? lcp::Vector(expansion_ * result.z) : result.z;
    report.normal_forces = normal_impulses(cones_, z);
    report.forces = contact_impulses(cones_, contacts_, z);
    const auto count = static_cast<lcp::Index>(contacts_.size());
    const double still = relative * (count > 0 ? problem().q.cwiseAbs().maxCoeff() : 0.0);
    report.b.resize(count);
    report.d_ddot.resize(count);
    for (lcp::Index i = 0; i < count; ++i) {
      const lcp::Index row = new_row_[cones_.normal_row[i]];
      report.b[i] = problem().q[row];
      report.d_ddot[i] = result.w[row];
      if (!lcp::is_solved(result.status)) {
        continue;
      }
      report.directions.emplace_back(Vec3::Zero());
      report.modes.push_back(ContactMode::kCloses);
      if (report.d_ddot[i] > still) {
        report.modes.back() = ContactMode::kOpens;
      } else if (slides_[i] && has_tangents(i)) {
        report.modes.back() = ContactMode::kSlides;
        report.directions.back() = direction(i, velocity_.segment<2>(cones_.normal_row[i] + 1));
      } else if (has_tangents(i)) {
        const Eigen::Vector2d slip = result.w.segment<2>(row + 1);
        const bool begins = slip.norm() > still;
        report.modes.back() = begins ? ContactMode::kSlides : ContactMode::kSticks;
        report.directions.back() = begins ? direction(i, slip) : Vec3(Vec3::Zero());
      }
    }
  }

 private:
  [[nodiscard]] bool has_tangents(lcp::Index i) const { return cones_.friction[i] > 0.0; }

  /// Of the slip whose parts along the frame's tangents these are.
  [[nodiscard]] Vec3 direction(lcp::Index i, const Eigen::Vector2d& slip) const {
    const TangentFrame& frame = cones_.frames[i];
    const Vec3 t2 = frame.t2 / frame.t2.squaredNorm();  // the frame may be scaled
    return (slip[0] * frame.t1 + slip[1] * t2).normalized();
  }

  void check_slips() const {
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (slides_[i] && has_tangents(i) &&
          velocity_.segment<2>(cones_.normal_row[i] + 1).norm() == 0.0) {
        throw std::invalid_argument("slides: contact " + std::to_string(i) + ": has no slip");
      }
    }
  }

  void choose_rows() {
    new_row_.assign(cones_.problem.q.size(), -1);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const int first = cones_.normal_row[i];
      const bool slides = has_tangents(i) && slides_[i];
      const int last = first + (has_tangents(i) && !slides ? 2 : 0);
      some_slide_ = some_slide_ || slides;
      for (int row = first; row <= last; ++row) {
        new_row_[row] = static_cast<lcp::Index>(kept_.size());
        kept_.push_back(row);
      }
    }
  }

  /// M = A(kept rows, all) * expansion.
  void reduce() {
    expansion_ = lcp::Matrix::Zero(cones_.problem.q.size(), kept_.size());
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      expansion_(kept_[k], k) = 1.0;
    }
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const int row = cones_.normal_row[i];
      if (!has_tangents(i)) {
        continue;
      }
      if (slides_[i]) {
        expansion_.block<2, 1>(row + 1, new_row_[row]) =
            -cones_.friction[i] * velocity_.segment<2>(row + 1).normalized();
      } else {
        reduced_.cones.push_back({.normal_row = static_cast<int>(new_row_[row]),
                                  .dimension = 3,
                                  .coefficient = cones_.friction[i]});
      }
    }
    reduced_.M = lcp::Matrix(lcp::to_dense(cones_.problem.M)(kept_, Eigen::all) * expansion_);
    reduced_.q = cones_.problem.q(kept_);
  }

  const ContactSet& contacts_;
  const std::vector<bool>& slides_;
  ConeProblem cones_;
  lcp::Vector velocity_;  // of the cones' rows, m/s
  std::vector<int> kept_;
  std::vector<lcp::Index> new_row_;  // of each row of the cones, -1: left out
  bool some_slide_ = false;
  lcp::Matrix expansion_;
  lcp::Problem reduced_;
  std::vector<int> degenerate_;
};

void validate_slides(const std::vector<bool>& slides, const ContactSet& contacts) {
  if (slides.size() != contacts.size()) {
    throw std::invalid_argument("slides: must have one entry a contact (" +
                                std::to_string(contacts.size()) + "), got " +
                                std::to_string(slides.size()));
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].material.resists_turning()) {
      throw std::invalid_argument("contact " + std::to_string(i) +
                                  ": rolling and spinning friction must be 0, got " +
                                  number_text(contacts[i].material.rolling_friction) + " and " +
                                  number_text(contacts[i].material.spinning_friction) + " m");
    }
  }
}

}  // namespace

std::string_view to_string(ContactMode mode) {
  switch (mode) {
    case ContactMode::kOpens: return "opens";
    case ContactMode::kCloses: return "closes";
    case ContactMode::kSticks: return "sticks";
    case ContactMode::kSlides: return "slides";
  }
  return "unknown mode";
}

void coulomb_forces(const Bodies& bodies, const State& state, const ContactSet& contacts,
                    const std::vector<bool>& slides, const std::vector<Wrench>& loads,
                    const std::vector<Wrench>& driven_acceleration, const RestingSettings& settings,
                    CoulombReport& report) {
  for (const Body& body : bodies) {
    validate(body);
  }
  validate(bodies, state);
  validate(contacts, static_cast<int>(bodies.size()));
  validate_slides(slides, contacts);
  settings.validate();
  const AccelerationProblem accelerations(
      bodies, state, contacts, slides,
      free_accelerations(bodies, state, loads, driven_acceleration), settings);
  const lcp::Problem& problem = accelerations.problem();
  const bool is_lcp = problem.cones.empty();
  const lcp::SolverSettings& told = is_lcp ? settings.lcp : settings.friction_lcp;
  const std::unique_ptr<lcp::Solver> solver =
      lcp::make_solver(is_lcp ? settings.solver : settings.friction_solver, told);
  CoulombReport fresh;
  solver->solve(problem, fresh.result);
  fresh.status = fresh.result.status;
  fresh.degenerate_contacts = accelerations.degenerate();
  accelerations.read(fresh.result, kStill * told.tolerance, fresh);
  report = std::move(fresh);
}

}  // namespace signorini
