#include <signorini/core/model/contact_kinematics.h>
#include <signorini/core/response/contact_selection.h>
#include <signorini/core/response/position_projection.h>

#include <algorithm>
#include <cmath>

namespace signorini {

void ContactSelection::choose(const ContactSet& found, const std::vector<double>& d_dot,
                              const std::vector<double>& d_dot_free,
                              const TimeStepSettings& settings, const Bodies& bodies,
                              const Sleepers& sleepers) {
  fate_.assign(found.size(), Fate::kInProblem);
  allowance_.resize(found.size());
  has_put_back_ = false;
  const double h = settings.step;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Contact& contact = found[i];
    const double e = contact.material.restitution;
    const bool touching = contact.gap <= settings.touching_tolerance;
    const double one_step = std::abs(d_dot_free[i] - d_dot[i]);
    const bool fast = d_dot[i] < -std::max(settings.restitution_threshold, one_step);
    const bool would_be_caught = contact.gap + h * d_dot_free[i] < 0.0;
    const bool bounces =
        touching && classify(d_dot[i], settings.restitution_threshold) == ContactClass::kColliding;
    allowance_[i] = bounces ? e * d_dot[i] : closable_gap(contact.gap) / h;
    const bool a_sleeps = sleepers.is_asleep(contact.body_a);
    const bool b_sleeps = sleepers.is_asleep(contact.body_b);
    const bool one_sleeps = a_sleeps || b_sleeps;  // does not act, or it would have woken it
    const bool keeps_apart = !settings.full_model && !touching && contact.gap > kToleratedOverlap &&
                             d_dot_free[i] + allowance_[i] > 0.0;
    if ((a_sleeps && (b_sleeps || !bodies[contact.body_b].is_dynamic())) ||
        (b_sleeps && !bodies[contact.body_a].is_dynamic())) {
      fate_[i] = Fate::kAsleep;
    } else if (!one_sleeps && e > 0.0 && !touching && fast && would_be_caught) {
      fate_[i] = Fate::kAboutToBounce;
    } else if (one_sleeps || keeps_apart) {
      fate_[i] = Fate::kApart;
    }
  }
}

void ContactSelection::fill(const ContactSet& found, ContactSet& contacts,
                            std::vector<double>& allowance) const {
  contacts.clear();
  allowance.clear();
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (fate_[i] == Fate::kInProblem) {
      contacts.push_back(found[i]);
      allowance.push_back(allowance_[i]);
    }
  }
}

void ContactSelection::mark_bodies(const ContactSet& found, std::vector<bool>& marked) const {
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (fate_[i] == Fate::kInProblem || fate_[i] == Fate::kApart) {
      marked[found[i].body_a] = true;
      marked[found[i].body_b] = true;
    }
  }
}

void ContactSelection::put_back(const ContactSet& found, const std::vector<Velocity>& velocities,
                                const State& state, const Sleepers& sleepers, BodyPairs& back) {
  constexpr double kRounding = 1e-13;  // m/s
  back.clear();
  closes_.resize(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    closes_[i] = fate_[i] == Fate::kApart &&
                 gap_velocity(velocities, state, found[i]) + allowance_[i] < -kRounding;
  }
  if (std::find(closes_.begin(), closes_.end(), true) == closes_.end()) {
    return;
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    const int a = found[i].body_a;
    const int b = found[i].body_b;
    const bool awake = !sleepers.is_asleep(a) && !sleepers.is_asleep(b);
    if (fate_[i] == Fate::kApart && (closes_[i] || (has_put_back_ && awake))) {
      fate_[i] = Fate::kInProblem;
      back.emplace_back(a, b);
    }
  }
  has_put_back_ = true;
}

int ContactSelection::count(Fate fate) const {
  return static_cast<int>(std::count(fate_.begin(), fate_.end(), fate));
}

}  // namespace signorini
