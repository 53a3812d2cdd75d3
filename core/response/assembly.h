#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/lcp/factored_matrix.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace signorini {

/// Two bodies each: what connects bodies, contact or joint.
using BodyPairs = std::vector<std::pair<int, int>>;

/// How many columns of J a body has: its block in M^-1.
enum class BodyColumns : std::uint8_t {
  kSix,
  /// 3, of v alone, where no contact can turn it: where each of the body's has no friction and acts
  /// along a line through its centre of mass, as far as rounding tells: what
  /// (r x N).J^-1 (r x N) adds to 1/m is lost in it. Else 6, and for every body that is joined.
  kThatForcesReach,
};

/// The normal rows of a contact set: d'+ = A f + d'-, A = J M^-1 J^T with row i of J
/// [N, r_A x N, -N, -(r_B x N)] over the dynamic bodies (r_A = P_A - x_A, r_B = P_B - x_B).
/// Immovable and driven bodies have no block; their velocity is in d'-.
struct NormalRows {
  lcp::FactoredMatrix A;           ///< 1/kg; one block a dynamic body that has a contact
  lcp::Vector d_dot;               ///< d'-, m/s
  std::vector<int> block_of_body;  ///< -1 for bodies without a row
};

// Functions that write into a vector of the caller's allocate nothing once its capacity suffices.

/// velocity() of every body: J^-1 is worth computing once a body, not once a contact.
void velocities_of(const Bodies& bodies, const State& state, std::vector<Velocity>& velocities);
[[nodiscard]] std::vector<Velocity> velocities_of(const Bodies& bodies, const State& state);

/// d' = N.(u_A - u_B) of one contact, with N as it is now; m/s, < 0 approaching.
[[nodiscard]] double gap_velocity(const std::vector<Velocity>& velocities, const State& state,
                                  const Contact& contact);
[[nodiscard]] double gap_velocity(const Bodies& bodies, const State& state, const Contact& contact);
/// The same for every contact of a set.
[[nodiscard]] lcp::Vector gap_velocities(const Bodies& bodies, const State& state,
                                         const ContactSet& contacts);
/// @param velocities of the bodies
void gap_velocities(const std::vector<Velocity>& velocities, const State& state,
                    const ContactSet& contacts, std::vector<double>& d_dot);

/// @throws std::invalid_argument naming the contact if neither of its bodies is dynamic.
void check_dynamic(const Bodies& bodies, const ContactSet& contacts);

/// Forgets what rows held and adds a block for every dynamic body of the contacts and of the pairs
/// `joined`; no rows.
/// @throws std::invalid_argument as check_dynamic(); rows is then untouched.
void start_rows(const Bodies& bodies, const State& state, const ContactSet& contacts,
                NormalRows& rows, const BodyPairs& joined = {},
                BodyColumns columns = BodyColumns::kSix);
/// Adds the row [t, r_A x t, -t, -(r_B x t)] of one contact, r_A = point_a - x_A, to A.
/// @param direction t, unit; of a body of 3 columns, as above. d_dot is left alone
void add_row(const State& state, const Contact& contact, const Vec3& direction, const Vec3& point_a,
             const Vec3& point_b, NormalRows& rows);

/// Assembles the rows of all contacts. Cost: O(bodies + contacts).
/// @param bodies, state, contacts valid: see validate() of each
/// @param joined, columns as start_rows()
/// @throws std::invalid_argument if a contact joins two bodies of which neither is dynamic; rows is
/// then untouched.
void assemble_normals(const Bodies& bodies, const State& state, const ContactSet& contacts,
                      NormalRows& rows, const BodyPairs& joined = {},
                      BodyColumns columns = BodyColumns::kSix);

/// d'+ = A f + d'-, in m/s, for f in N s (with d'' and N: the same).
[[nodiscard]] lcp::Vector gap_velocities_after(const NormalRows& rows, const lcp::VectorRef& f);

/// p += J^T f for every dynamic body. @param f N s, one a contact
void apply_impulses(const Bodies& bodies, const ContactSet& contacts, const lcp::VectorRef& f,
                    State& state);

/// The connected sets of contacts: two contacts belong together if they share a dynamic body.
/// @return the set's number of each contact, numbered in the order of their first contact.
[[nodiscard]] std::vector<int> connected_sets(const Bodies& bodies, const ContactSet& contacts);
/// The same of any links between bodies, each with a dynamic body; keeps its memory.
class LinkedSets {
 public:
  /// Valid until the next call.
  [[nodiscard]] const std::vector<int>& find(const Bodies& bodies, const BodyPairs& links);

 private:
  std::vector<int> parent_;
  std::vector<int> number_of_root_;
  std::vector<int> set_of_link_;
};

/// Adds the two bodies of every contact.
void add_body_pairs(const ContactSet& contacts, BodyPairs& pairs);

}  // namespace signorini
