#pragma once

#include <signorini/core/response/impact.h>

namespace signorini {

/// How a sequence of single impulses ended.
struct SequentialOutcome {
  lcp::Status status = lcp::Status::kNotRun;  ///< kSolved or kIterationLimit
  lcp::Vector impulses;                       ///< f, N s, the sum over the passes, one a contact
  int passes = 0;                             ///< passes that applied an impulse
};

/// Single impulses one after the other (notes, section 4; design, section 4.6). A pass goes through
/// the contacts in settings.order; a contact that approaches at its turn gets f = (1 + e) f_min
/// (e = 0 if it is slower than the colliding threshold). kSequentialOnce is one pass, whatever it
/// leaves. kSequentialRepeated makes passes until no contact approaches faster than
/// settings.lcp.tolerance |d'-|_inf, at most settings.max_passes.
///
/// Every impulse is admissible alone and gains no energy, so the whole gains none. The order
/// decides the answer. Cost: O(contacts) a pass.
/// @param bodies, contacts, settings valid
/// @param state the momenta of the last pass, whatever the status
[[nodiscard]] SequentialOutcome sequential_impulses(const Bodies& bodies,
                                                    const ContactSet& contacts,
                                                    const ImpactSettings& settings, State& state);

}  // namespace signorini
