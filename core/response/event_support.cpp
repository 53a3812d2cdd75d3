#include <signorini/core/response/assembly.h>
#include <signorini/core/response/event_support.h>
#include <signorini/core/response/set_impact.h>
#include <signorini/core/response/tangent_rows.h>

#include <algorithm>

namespace signorini {
namespace {

bool has_friction(const Contact& contact) {
  return contact.material.friction > 0.0;
}

class SupportFinder {
 public:
  SupportFinder(const Bodies& bodies, const State& state, const RestingContacts& held,
                const EventSettings& settings)
      : bodies_(bodies),
        state_(state),
        held_(held),
        settings_(settings),
        gravity_(gravity_loads(bodies, settings.gravity)) {}

  Support find(const ContactSet& touching) {
    const ContactSet resting = those_that_rest(touching);
    const std::vector<int> set_of_contact = connected_sets(bodies_, resting);
    const auto last = std::max_element(set_of_contact.begin(), set_of_contact.end());
    const int sets = last == set_of_contact.end() ? 0 : *last + 1;
    for (int k = 0; k < sets; ++k) {
      ContactSet set;
      for (std::size_t i = 0; i < resting.size(); ++i) {
        if (set_of_contact[i] == k) {
          set.push_back(resting[i]);
        }
      }
      add(std::any_of(set.begin(), set.end(), has_friction) ? with_friction(set)
                                                            : without_friction(set));
    }
    out_.loads = gravity_;
    for (const RestingContact& resting_contact : out_.contacts) {
      push(resting_contact);
    }
    return std::move(out_);
  }

 private:
  /// One connected set.
  struct Set {
    lcp::Status status = lcp::Status::kNotRun;
    RestingContacts contacts;
  };

  [[nodiscard]] ContactSet those_that_rest(const ContactSet& touching) const {
    const lcp::Vector d_dot = gap_velocities(bodies_, state_, touching);
    ContactSet resting;
    for (std::size_t i = 0; i < touching.size(); ++i) {
      const double most = signorini::find(held_, touching[i]) != nullptr
                              ? settings_.resting_speed
                              : settings_.separating_speed;
      if (d_dot[static_cast<lcp::Index>(i)] <= most) {
        resting.push_back(touching[i]);
      }
    }
    return resting;
  }

  Set without_friction(const ContactSet& set) {
    RestingReport report;
    resting_forces(bodies_, state_, set, gravity_, {}, settings_.resting, report);
    out_.redundancy += report.redundancy;
    Set made{report.status, {}};
    for (std::size_t i = 0; i < set.size(); ++i) {
      const auto row = static_cast<lcp::Index>(i);
      const double f = report.forces[row];
      made.contacts.push_back({.contact = set[i],
                               .normal_force = f,
                               .force = f * set[i].normal,
                               .b = report.b[row],
                               .mode = f > 0.0 ? ContactMode::kCloses : ContactMode::kOpens});
    }
    return made;
  }

  Set with_friction(const ContactSet& set) {
    const bool settles = std::any_of(set.begin(), set.end(), [this](const Contact& contact) {
      return stuck_or_turned_back(contact);
    });
    std::vector<bool> slides;
    for (const Contact& contact : set) {
      slides.push_back(has_friction(contact) && !may_stick(contact, settles));
    }
    CoulombReport report;
    coulomb_forces(bodies_, state_, set, slides, gravity_, {}, settings_.resting, report);
    Set made{report.status, {}};
    for (std::size_t i = 0; i < set.size(); ++i) {
      const auto row = static_cast<lcp::Index>(i);
      made.contacts.push_back({.contact = set[i],
                               .normal_force = report.normal_forces[row],
                               .force = report.forces[i],
                               .b = report.b[row],
                               .may_stick = !slides[i]});
      if (lcp::is_solved(report.status)) {
        made.contacts.back().mode = report.modes[i];
        made.contacts.back().direction = report.directions[i];
      }
    }
    return made;
  }

  [[nodiscard]] bool stuck_or_turned_back(const Contact& contact) const {
    const RestingContact* before = signorini::find(held_, contact);
    return before != nullptr && (before->mode == ContactMode::kSticks || before->turned_back);
  }

  /// @param settles its set has a contact that stuck or turned back
  [[nodiscard]] bool may_stick(const Contact& contact, bool settles) const {
    return stuck_or_turned_back(contact) ||
           tangential_slip(bodies_, state_, contact).norm() <=
               (settles ? settings_.resting_speed : settings_.sticking_speed);
  }

  void add(const Set& set) {
    if (lcp::is_solved(out_.status) && !lcp::is_solved(set.status)) {
      out_.unsolved = set.contacts;
    }
    out_.status = worse(out_.status, set.status);
    out_.contacts.insert(out_.contacts.end(), set.contacts.begin(), set.contacts.end());
  }

  void push(const RestingContact& one) {
    const Contact& contact = one.contact;
    push(contact.body_a, friction_point(contact), one.force);
    push(contact.body_b, friction_point(contact), -one.force);
  }

  void push(int body, const Vec3& point, const Vec3& force) {
    if (bodies_[body].is_dynamic()) {
      out_.loads[body].force += force;
      out_.loads[body].torque += (point - state_[body].x).cross(force);
    }
  }

  const Bodies& bodies_;
  const State& state_;
  const RestingContacts& held_;
  const EventSettings& settings_;
  std::vector<Wrench> gravity_;
  Support out_;
};

}  // namespace

bool same_features(const Contact& a, const Contact& b) {
  return a.body_a == b.body_a && a.body_b == b.body_b && a.feature_id == b.feature_id;
}

const RestingContact* find(const RestingContacts& contacts, const Contact& contact) {
  const auto found = std::find_if(contacts.begin(), contacts.end(), [&](const RestingContact& one) {
    return same_features(one.contact, contact);
  });
  return found == contacts.end() ? nullptr : &*found;
}

Support find_support(const Bodies& bodies, const State& state, const ContactSet& touching,
                     const RestingContacts& held, const EventSettings& settings) {
  return SupportFinder(bodies, state, held, settings).find(touching);
}

Vec3 tangential_slip(const Bodies& bodies, const State& state, const Contact& contact) {
  const Vec3 slip = slip_velocity(bodies, state, contact);
  return slip - slip.dot(contact.normal) * contact.normal;
}

}  // namespace signorini
