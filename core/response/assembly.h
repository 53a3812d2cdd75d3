#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/lcp/factored_matrix.h>

#include <vector>

namespace signorini {

/// The normal rows of a contact set: d'+ = A f + d'-, A = J M^-1 J^T with row i of J
/// [N, r_A x N, -N, -(r_B x N)] over the dynamic bodies. Immovable and driven bodies have no block;
/// their velocity is in d'-.
struct NormalRows {
  lcp::FactoredMatrix A;           ///< 1/kg
  lcp::Vector d_dot;               ///< d'-, m/s
  std::vector<int> block_of_body;  ///< -1 for bodies without a row
};

/// @throws std::invalid_argument if a contact joins two bodies of which neither is dynamic.
void assemble_normals(const Bodies& bodies, const State& state, const ContactSet& contacts,
                      NormalRows& rows);

/// p += J^T f for every dynamic body.
void apply_impulses(const Bodies& bodies, const ContactSet& contacts, const lcp::VectorRef& f,
                    State& state);

/// The connected sets of contacts: two contacts belong together if they share a dynamic body.
/// @return the set's number of each contact, numbered in the order of their first contact.
[[nodiscard]] std::vector<int> connected_sets(const Bodies& bodies, const ContactSet& contacts);

}  // namespace signorini
