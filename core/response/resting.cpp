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

void note(const std::string& text, std::string& detail) {
  detail += (detail.empty() ? "" : "; ") + text;
}

/// report.b, and the contacts where it is not determined.
void assemble_gap_accelerations(const Bodies& bodies, const State& state,
                                const ContactSet& contacts,
                                const std::vector<BodyAcceleration>& accelerations,
                                RestingReport& report) {
  report.b.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactAcceleration free =
        contact_acceleration(bodies, state, contacts[i], accelerations);
    report.b[i] = free.normal;
    if (free.degenerate) {
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

void RestingSettings::validate() const {
  lcp.validate();
  friction_lcp.validate();
  for (const auto& [field, value] :
       {std::pair{"stabilization_time", stabilization_time}, {"slip_time", slip_time}}) {
    if (!(value > 0.0)) {
      throw std::invalid_argument("resting settings: " + std::string(field) +
                                  ": must be > 0, got " + number_text(value) + " s");
    }
  }
}

void resting_forces(const Bodies& bodies, const State& state, const ContactSet& contacts,
                    const std::vector<Wrench>& loads,
                    const std::vector<Wrench>& driven_acceleration, const RestingSettings& settings,
                    RestingReport& report) {
  for (const Body& body : bodies) {
    validate(body);
  }
  validate(bodies, state);
  validate(contacts, static_cast<int>(bodies.size()));
  const std::vector<BodyAcceleration> accelerations =
      free_accelerations(bodies, state, loads, driven_acceleration);
  settings.validate();
  const std::unique_ptr<lcp::Solver> solver = lcp::make_solver(settings.solver, settings.lcp);
  NormalRows rows;
  assemble_normals(bodies, state, contacts, rows);

  RestingReport fresh;
  assemble_gap_accelerations(bodies, state, contacts, accelerations, fresh);
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

}  // namespace signorini
