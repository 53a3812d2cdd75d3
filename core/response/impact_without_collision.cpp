#include <signorini/core/response/friction_cones.h>
#include <signorini/core/response/impact_energy.h>
#include <signorini/core/response/impact_without_collision.h>

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>
#include <string>

namespace signorini {
namespace {

constexpr double kPushed = 1e-8;     // h |b|_inf over the fastest slip
constexpr double kVanishing = 1e-3;  // of it; a change of velocity below has not jumped

/// All contacts closed and without slip, as far as they can be.
lcp::Vector sticking_impulses(const lcp::Problem& problem) {
  const lcp::Matrix A = lcp::to_dense(problem.M);
  return A.completeOrthogonalDecomposition().solve(-problem.q);
}

}  // namespace

ShockReport impact_without_collision(const Bodies& bodies, const ContactSet& contacts,
                                     const lcp::VectorRef& b, const RestingSettings& settings,
                                     State& state) {
  if (b.size() != static_cast<lcp::Index>(contacts.size()) || !b.allFinite()) {
    throw std::invalid_argument("impact without collision: b: must be finite and one a contact, " +
                                std::to_string(contacts.size()) + ", got " +
                                std::to_string(b.size()));
  }
  ShockReport shock;
  ConeProblem cones;
  assemble_cones(bodies, state, contacts, lcp::Vector::Zero(b.size()), cones);
  for (lcp::Index i = 0; i < b.size(); ++i) {
    cones.problem.q[cones.normal_row[i]] = 0.0;  // they rest: d' = 0
  }
  const double fastest = cones.problem.q.size() == 0 ? 0.0 : cones.problem.q.cwiseAbs().maxCoeff();
  if (fastest == 0.0 || b.isZero(0.0)) {
    shock.status = lcp::Status::kStalled;
    shock.detail = "nothing slips, or nothing pushes the contacts: no impact";
    return shock;
  }
  const double h = kPushed * fastest / b.cwiseAbs().maxCoeff();
  for (lcp::Index i = 0; i < b.size(); ++i) {
    cones.problem.q[cones.normal_row[i]] = h * b[i];
  }
  const std::unique_ptr<lcp::Solver> solver =
      lcp::make_solver(settings.friction_solver, settings.friction_lcp);
  const lcp::Vector start = sticking_impulses(cones.problem);
  solver->solve(cones.problem, shock.result, &start);
  shock.status = shock.result.status;
  shock.contact_impulses = contact_impulses(cones, contacts, shock.result.z);
  if (!lcp::is_solved(shock.status)) {
    return shock;
  }
  const double jump = (shock.result.w - cones.problem.q).cwiseAbs().maxCoeff();
  if (!(jump > kVanishing * fastest)) {
    shock.status = lcp::Status::kStalled;
    shock.detail = "the impulses vanish with the time in which they act: no impact";
    return shock;
  }
  State after = state;
  apply_contact_impulses(bodies, contacts, shock.contact_impulses, after);
  shock.energy_change = kinetic_energy(bodies, after) - kinetic_energy(bodies, state) -
                        driver_work(bodies, state, contacts, shock.contact_impulses);
  if (!(shock.energy_change <= 0.0)) {
    shock.status = lcp::Status::kNumericalBreakdown;
    shock.detail = "the impulses would gain energy";
    return shock;
  }
  state = std::move(after);
  return shock;
}

}  // namespace signorini
