#include <signorini/core/response/tangent_rows.h>
#include <signorini/core/response/turning_rows.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace signorini {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double arm(const Bodies& bodies, const State& state, const Contact& contact) {
  double longest = 0.0;
  for (const int body : {contact.body_a, contact.body_b}) {
    if (bodies[body].is_dynamic()) {
      longest = std::max(longest, (friction_point(contact) - state[body].x).norm());
    }
  }
  return longest;
}

}  // namespace

void turning_rows(const Bodies& bodies, const State& free_state, const ContactSet& contacts,
                  std::vector<TurningRow>& rows) {
  rows.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    if (!contact.material.resists_turning()) {
      continue;
    }
    const double distance = arm(bodies, free_state, contact);
    const auto add = [&](const Vec3& axis, double friction) {
      if (friction > 0.0) {
        const double length = std::max(distance, friction);
        rows.push_back({.contact = static_cast<int>(i),
                        .limit = friction / length,
                        .row = {.body_a = contact.body_a,
                                .body_b = contact.body_b,
                                .angular_a = length * axis,
                                .angular_b = length * axis,
                                .lower = -kInfinity,
                                .upper = kInfinity}});
      }
    };
    const Vec3 turning = velocity(bodies[contact.body_a], free_state[contact.body_a]).angular -
                         velocity(bodies[contact.body_b], free_state[contact.body_b]).angular;
    const TangentFrame axes = tangent_frame(contact.normal, distance * turning);
    add(contact.normal, contact.material.spinning_friction);
    add(axes.t1, contact.material.rolling_friction);
    add(axes.t2, contact.material.rolling_friction);
  }
}

void add_contact_moments(const std::vector<TurningRow>& rows, const lcp::VectorRef& z,
                         std::vector<Vec3>& moments) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    moments[rows[k].contact] += z[static_cast<lcp::Index>(k)] * rows[k].row.angular_a;
  }
}

void apply_contact_moments(const Bodies& bodies, const ContactSet& contacts,
                           const std::vector<Vec3>& moments, State& state) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (const auto& [body, sign] :
         {std::pair{contacts[i].body_a, 1.0}, {contacts[i].body_b, -1.0}}) {
      if (bodies[body].is_dynamic()) {
        state[body].L += sign * moments[i];
      }
    }
  }
}

}  // namespace signorini
