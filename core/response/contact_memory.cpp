#include <signorini/core/response/contact_memory.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace signorini {
namespace {

template <typename Keyed>
auto key(const Keyed& keyed) {
  return std::tie(keyed.body_a, keyed.body_b, keyed.feature_id);
}

/// The z of z t = the part of an impulse along t.
double along(const Vec3& t, const Vec3& impulse) {
  const double square = t.squaredNorm();
  const bool is_unit = std::abs(square - 1.0) < 1e-12;  // the same bits as without a scale
  return is_unit ? t.dot(impulse) : t.dot(impulse) / square;
}

/// beta of the two directions j, j + 1 between which the impulse (a, b) along (t1, t2) lies: the
/// directions are at 2 pi j / k, and sin(d) beta_j = |(a, b)| sin(of the angle to the other one).
void split(double a, double b, int sides, double* beta) {
  const double size = std::hypot(a, b);
  if (size == 0.0) {
    return;
  }
  const double step = 2.0 * std::numbers::pi / sides;
  double angle = std::atan2(b, a);
  angle += angle < 0.0 ? 2.0 * std::numbers::pi : 0.0;
  const int first = std::min(static_cast<int>(angle / step), sides - 1);
  const double beyond = std::clamp(angle - first * step, 0.0, step);
  beta[first] = size * std::sin(step - beyond) / std::sin(step);
  beta[(first + 1) % sides] = size * std::sin(beyond) / std::sin(step);
}

}  // namespace

void ContactMemory::remember(const PyramidProblem& pyramid, const ContactSet& contacts,
                             const lcp::VectorRef& z) {
  forget();
  add(pyramid, contacts, z);
  sort();
}

void ContactMemory::remember(const ConeProblem& cones, const ContactSet& contacts,
                             const lcp::VectorRef& z) {
  forget();
  add(cones, contacts, z);
  sort();
}

void ContactMemory::add(const PyramidProblem& pyramid, const ContactSet& contacts,
                        const lcp::VectorRef& z, bool corrected) {
  const int normals = static_cast<int>(contacts.size());
  const int frictional = static_cast<int>(pyramid.frictional.size());
  contact_impulses(pyramid, contacts, z, impulses_);
  const std::size_t first = entries_.size();
  for (int i = 0; i < normals; ++i) {
    add_entry(contacts[i], z[i], impulses_[i], corrected);
  }
  for (int c = 0; c < frictional; ++c) {
    entries_[first + pyramid.frictional[c]].slip = z[normals + pyramid.sides * frictional + c];
  }
}

void ContactMemory::add(const ConeProblem& cones, const ContactSet& contacts,
                        const lcp::VectorRef& z, bool corrected) {
  contact_impulses(cones, contacts, z, impulses_);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    add_entry(contacts[i], z[cones.normal_row[i]], impulses_[i], corrected);
  }
}

void ContactMemory::add_entry(const Contact& contact, double normal, const Vec3& whole,
                              bool corrected) {
  entries_.push_back({contact.body_a, contact.body_b, contact.feature_id, normal,
                      whole - normal * contact.normal, whole, 0.0,
                      static_cast<int>(entries_.size()), corrected});
}

void ContactMemory::sort() {  // std::stable_sort allocates
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return std::tuple_cat(key(a), std::tie(a.order)) < std::tuple_cat(key(b), std::tie(b.order));
  });
}

const ContactMemory::Entry* ContactMemory::find(const Contact& contact) const {
  const auto found =
      std::lower_bound(entries_.begin(), entries_.end(), contact,
                       [](const Entry& a, const Contact& b) { return key(a) < key(b); });
  return found != entries_.end() && key(*found) == key(contact) ? &*found : nullptr;
}

ContactMemory::Recalled ContactMemory::recall(const PyramidProblem& pyramid,
                                              const ContactSet& contacts, lcp::Vector& z) const {
  const int normals = static_cast<int>(contacts.size());
  const int frictional = static_cast<int>(pyramid.frictional.size());
  z.setZero(pyramid.problem.size());
  Recalled recalled;
  for (int i = 0; i < normals; ++i) {
    if (const Entry* entry = find(contacts[i])) {
      z[i] = std::max(entry->normal, 0.0);
      ++recalled.known;
      recalled.corrected |= entry->corrected;
    }
  }
  for (int c = 0; c < frictional; ++c) {
    if (const Entry* entry = find(contacts[pyramid.frictional[c]])) {
      const TangentFrame& frame = pyramid.frames[c];
      split(along(frame.t1, entry->friction), along(frame.t2, entry->friction), pyramid.sides,
            z.data() + normals + pyramid.sides * c);
      z[normals + pyramid.sides * frictional + c] = std::max(entry->slip, 0.0);
    }
  }
  return recalled;
}

ContactMemory::Recalled ContactMemory::recall(const ConeProblem& cones, const ContactSet& contacts,
                                              lcp::Vector& z) const {
  z.setZero(cones.problem.size());
  Recalled recalled;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Entry* entry = find(contacts[i]);
    if (entry == nullptr) {
      continue;
    }
    ++recalled.known;
    recalled.corrected |= entry->corrected;
    const int row = cones.normal_row[i];
    z[row] = std::max(entry->whole.dot(contacts[i].normal), 0.0);
    if (cones.friction[i] > 0.0) {
      z[row + 1] = along(cones.frames[i].t1, entry->whole);
      z[row + 2] = along(cones.frames[i].t2, entry->whole);
    }
  }
  return recalled;
}

}  // namespace signorini
