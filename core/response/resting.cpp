#include <signorini/core/model/contact_kinematics.h>
#include <signorini/core/model/number_text.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/least_norm.h>
#include <signorini/core/response/resting.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace signorini {
namespace {

constexpr double kFloors = 4.0;  // as lcp::judge() allows

void validate_wrenches(const char* field, const std::vector<Wrench>& wrenches,
                       std::size_t body_count) {
  if (wrenches.size() != body_count) {
    throw std::invalid_argument(std::string(field) + ": must have one entry a body (" +
                                std::to_string(body_count) + "), got " +
                                std::to_string(wrenches.size()));
  }
  for (std::size_t i = 0; i < wrenches.size(); ++i) {
    for (const auto& [part, value] :
         {std::pair{"force", &wrenches[i].force}, std::pair{"torque", &wrenches[i].torque}}) {
      if (!value->allFinite()) {
        throw std::invalid_argument(std::string(field) + ": body " + std::to_string(i) + ": " +
                                    part + ": must be finite, got " + number_text(*value));
      }
    }
  }
}

/// v' and w' of a body without contact forces, and its w.
struct Acceleration {
  Vec3 linear = Vec3::Zero();
  Vec3 angular = Vec3::Zero();
  Vec3 spin = Vec3::Zero();

  /// a = v' + w' x r + w x (w x r)
  [[nodiscard]] Vec3 at(const Vec3& r) const {
    return linear + angular.cross(r) + spin.cross(spin.cross(r));
  }
};

Acceleration acceleration(const Body& body, const BodyState& state, const Wrench& load,
                          const Wrench& driven) {
  const Vec3 w = velocity(body, state).angular;
  switch (body.kind) {
    case BodyKind::kDynamic: {
      const Vec3 torque = load.torque - w.cross(state.L);
      return {load.force / body.mass, inverse_inertia_world(body, state) * torque, w};
    }
    case BodyKind::kKinematic: return {driven.force, driven.torque, w};
    case BodyKind::kFixed: break;
  }
  return {};
}

void note(const std::string& text, std::string& detail) {
  detail += (detail.empty() ? "" : "; ") + text;
}

/// report.b, and the contacts where it is not determined.
void assemble_gap_accelerations(const Bodies& bodies, const State& state,
                                const ContactSet& contacts, const std::vector<Wrench>& loads,
                                const std::vector<Wrench>& driven_acceleration,
                                RestingReport& report) {
  std::vector<Acceleration> accelerations;
  accelerations.reserve(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Wrench driven = driven_acceleration.empty() ? Wrench{} : driven_acceleration[k];
    accelerations.push_back(acceleration(bodies[k], state[k], loads[k], driven));
  }
  report.b.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const BodyState& state_a = state[contact.body_a];
    const BodyState& state_b = state[contact.body_b];
    const GapKinematics gap =
        gap_kinematics(contact, state_a, velocity(bodies[contact.body_a], state_a), state_b,
                       velocity(bodies[contact.body_b], state_b));
    const Vec3 a_a = accelerations[contact.body_a].at(contact.point_a - state_a.x);
    const Vec3 a_b = accelerations[contact.body_b].at(contact.point_b - state_b.x);
    report.b[i] = contact.normal.dot(a_a - a_b) + gap.curvature_acceleration;
    if (gap.degenerate) {
      report.degenerate_contacts.push_back(static_cast<int>(i));
      note("contact " + std::to_string(i) + ": its features do not determine N'", report.detail);
    }
  }
}

/// Where forces may act: d'' is zero up to what the certificate allows.
std::vector<bool> closed_contacts(const lcp::Result& result, const lcp::Vector& b,
                                  double tolerance) {
  const double slack =
      std::max(tolerance, kFloors * result.certificate.rounding_floor) * b.cwiseAbs().maxCoeff();
  std::vector<bool> closed(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    closed[i] = result.z[i] > 0.0 || result.w[i] <= slack;
  }
  return closed;
}

/// Replaces the LCP's forces by those of least norm, if these are certified as well.
void choose_least_norm(const lcp::Problem& problem, const NormalRows& rows, double tolerance,
                       lcp::Solver& solver, RestingReport& report) {
  const LeastNorm least = least_norm(rows, report.result.z,
                                     closed_contacts(report.result, problem.q, tolerance), solver);
  report.redundancy = least.redundancy;
  report.least_norm_status = least.status;
  if (least.redundancy == 0) {
    return;
  }
  const std::string many = std::to_string(least.redundancy) + " force(s) statically indeterminate";
  lcp::Vector w;
  const lcp::Certificate certificate = lcp::certify(problem, least.forces, &w);
  const lcp::Status judged = lcp::judge(certificate, tolerance, lcp::Status::kNumericalBreakdown);
  if (!lcp::is_solved(least.status) || !lcp::is_solved(judged)) {
    report.least_norm_status = lcp::is_solved(least.status) ? judged : least.status;
    note(many + ", the least-norm ones were not found", report.detail);
    return;
  }
  report.forces = least.forces;
  report.result.w = w;
  report.result.certificate = certificate;
  report.result.status = judged;
  note(many + ", the least-norm ones are given", report.detail);
}

}  // namespace

void resting_forces(const Bodies& bodies, const State& state, const ContactSet& contacts,
                    const std::vector<Wrench>& loads,
                    const std::vector<Wrench>& driven_acceleration, const RestingSettings& settings,
                    RestingReport& report) {
  for (const Body& body : bodies) {
    validate(body);
  }
  validate(bodies, state);
  validate(contacts, static_cast<int>(bodies.size()));
  validate_wrenches("loads", loads, bodies.size());
  if (!driven_acceleration.empty()) {
    validate_wrenches("driven_acceleration", driven_acceleration, bodies.size());
  }
  settings.lcp.validate();
  if (!(settings.stabilization_time > 0.0)) {
    throw std::invalid_argument("resting settings: stabilization_time: must be > 0, got " +
                                number_text(settings.stabilization_time) + " s");
  }
  const std::unique_ptr<lcp::Solver> solver = lcp::make_solver(settings.solver, settings.lcp);
  NormalRows rows;
  assemble_normals(bodies, state, contacts, rows);

  RestingReport fresh;
  assemble_gap_accelerations(bodies, state, contacts, loads, driven_acceleration, fresh);
  const double T = settings.stabilization_time;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto row = static_cast<lcp::Index>(i);
    fresh.b[row] += (2.0 * rows.d_dot[row] + contacts[i].gap / T) / T;
  }
  lcp::Problem problem;
  problem.M = rows.A;
  problem.q = fresh.b;
  solver->solve(problem, fresh.result);
  fresh.forces = fresh.result.z;
  if (lcp::is_solved(fresh.result.status) && !contacts.empty()) {
    choose_least_norm(problem, rows, settings.lcp.tolerance, *solver, fresh);
  }
  fresh.status = fresh.result.status;
  fresh.d_ddot = fresh.result.w;
  report = std::move(fresh);
}

std::vector<Wrench> gravity_loads(const Bodies& bodies, const Vec3& gravity) {
  std::vector<Wrench> loads(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (bodies[k].is_dynamic()) {
      loads[k].force = bodies[k].mass * bodies[k].gravity_scale * gravity;
    }
  }
  return loads;
}

}  // namespace signorini
