#pragma once

#include <signorini/core/model/contact.h>
#include <signorini/core/response/friction_cones.h>
#include <signorini/core/response/friction_pyramid.h>

#include <cstdint>
#include <vector>

namespace signorini {

/// What the contacts of one step carried, for the warm start of the next. A contact is known again
/// by its bodies and its feature id; of two with the same key the first counts.
class ContactMemory {
 public:
  struct Recalled {
    int known = 0;           ///< contacts
    bool corrected = false;  ///< whether an impulse of theirs also stopped what was left of before
  };
  /// Keeps normal impulse, friction impulse (world axes) and lambda of every contact, nothing else.
  /// @param z of the pyramid problem, finite
  void remember(const PyramidProblem& pyramid, const ContactSet& contacts, const lcp::VectorRef& z);
  /// The same of the cones (lambda: none). @param z of the cone problem, finite
  void remember(const ConeProblem& cones, const ContactSet& contacts, const lcp::VectorRef& z);
  /// Keeps what is known too, for a step in several parts; sort() after the last.
  /// @param corrected see Recalled
  void add(const PyramidProblem& pyramid, const ContactSet& contacts, const lcp::VectorRef& z,
           bool corrected = false);
  void add(const ConeProblem& cones, const ContactSet& contacts, const lcp::VectorRef& z,
           bool corrected = false);
  /// Makes what was added known.
  void sort();
  void forget() { entries_.clear(); }

  /// Writes the z of the pyramid problem that the remembered impulses amount to: f as it was; the
  /// friction impulse, without its part along the new normal, on the two directions of the new
  /// pyramid on either side of it, beta >= 0; lambda as it was; zero for contacts that are new.
  /// z is written in any case.
  Recalled recall(const PyramidProblem& pyramid, const ContactSet& contacts, lcp::Vector& z) const;
  /// The same for cones: the whole impulse in the new frame. Where a loaded contact's normal turns
  /// a little, its force stays as it was, and the bodies that it held in balance.
  Recalled recall(const ConeProblem& cones, const ContactSet& contacts, lcp::Vector& z) const;

 private:
  struct Entry {
    int body_a;
    int body_b;
    std::uint64_t feature_id;
    double normal;  // N s
    Vec3 friction;  // N s, on A
    Vec3 whole;     // N s, on A
    double slip;    // lambda, m/s
    int order;      // in which they were added
    bool corrected;
  };
  void add_entry(const Contact& contact, double normal, const Vec3& whole, bool corrected);
  [[nodiscard]] const Entry* find(const Contact& contact) const;

  std::vector<Entry> entries_;  // sorted by their keys
  std::vector<Vec3> impulses_;  // of add()
};

}  // namespace signorini
