#include <signorini/core/response/assembly.h>
#include <signorini/core/response/sequential_impulses.h>
#include <signorini/core/response/single_impulse.h>

#include <numeric>

namespace signorini {
namespace {

/// One contact's turn. @return the impulse applied, 0 if it does not approach.
double take_turn(const Bodies& bodies, const Contact& contact, double threshold, State& state) {
  const SingleImpulse single = single_impulse(bodies, state, contact);
  const bool colliding = single.d_dot < -threshold;
  const double f = single.with_restitution(colliding ? contact.material.restitution : 0.0);
  if (f > 0.0) {
    apply_impulse(bodies, contact, f, state);
  }
  return f;
}

}  // namespace

SequentialOutcome sequential_impulses(const Bodies& bodies, const ContactSet& contacts,
                                      const ImpactSettings& settings, State& state) {
  const lcp::Vector d_dot = gap_velocities(bodies, state, contacts);
  const double slack =
      contacts.empty() ? 0.0 : settings.lcp.tolerance * d_dot.cwiseAbs().maxCoeff();
  std::vector<int> order = settings.order;
  if (order.empty()) {
    order.resize(contacts.size());
    std::iota(order.begin(), order.end(), 0);
  }
  const auto approaching = [&] {
    return (gap_velocities(bodies, state, contacts).array() < -slack).any();
  };
  const bool once = settings.law == ImpactLaw::kSequentialOnce;
  const int most = once ? 1 : settings.max_passes;
  SequentialOutcome outcome;
  outcome.impulses.setZero(contacts.size());
  bool still_approaching = approaching();
  while (still_approaching && outcome.passes < most) {
    for (const int i : order) {
      outcome.impulses[i] += take_turn(bodies, contacts[i], settings.colliding_threshold, state);
    }
    ++outcome.passes;
    still_approaching = approaching();
  }
  outcome.status = once || !still_approaching ? lcp::Status::kSolved : lcp::Status::kIterationLimit;
  return outcome;
}

}  // namespace signorini
