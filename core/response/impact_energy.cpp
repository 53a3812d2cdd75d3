#include <signorini/core/response/impact_energy.h>
#include <signorini/core/response/tangent_rows.h>

#include <cmath>
#include <limits>

namespace signorini {

ImpulseEnergy impulse_energy(const lcp::VectorRef& f, const lcp::VectorRef& before,
                             const lcp::VectorRef& after) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const double terms = f.cwiseAbs().dot(after.cwiseAbs() + before.cwiseAbs());
  return {0.5 * f.dot(after + before), 4.0 * kEpsilon * terms};
}

double driver_work(const Bodies& bodies, const State& state, const ContactSet& contacts,
                   const lcp::VectorRef& f) {
  double work = 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    const auto work_of = [&](int body, const Vec3& point, double sign) {
      if (bodies[body].kind != BodyKind::kKinematic) {
        return 0.0;
      }
      const Vec3 u = velocity(bodies[body], state[body]).at(point - state[body].x);
      return sign * f[i] * contact.normal.dot(u);
    };
    work += work_of(contact.body_b, contact.point_b, 1.0);
    work += work_of(contact.body_a, contact.point_a, -1.0);
  }
  return work;
}

double driver_work(const Bodies& bodies, const State& state, const ContactSet& contacts,
                   const std::vector<Vec3>& impulses) {
  double work = 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3 point = friction_point(contacts[i]);
    const auto work_of = [&](int body, double sign) {
      if (bodies[body].kind != BodyKind::kKinematic) {
        return 0.0;
      }
      const Vec3 u = velocity(bodies[body], state[body]).at(point - state[body].x);
      return sign * impulses[i].dot(u);
    };
    work += work_of(contacts[i].body_b, 1.0);
    work += work_of(contacts[i].body_a, -1.0);
  }
  return work;
}

double relative_energy_gain(double gain, double before, double work) {
  return gain == 0.0 ? 0.0 : gain / (before + std::abs(work));
}

}  // namespace signorini
