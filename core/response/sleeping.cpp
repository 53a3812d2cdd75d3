#include <signorini/core/model/number_text.h>
#include <signorini/core/response/sleeping.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace signorini {
namespace {

void require(bool good, const char* field, const char* bound, double value, const char* unit) {
  if (!good) {
    throw std::invalid_argument(std::string("sleep settings: ") + field + ": must be " + bound +
                                ", got " + number_text(value) + " " + unit);
  }
}

bool same_pose(const BodyState& a, const BodyState& b) {
  return a.x == b.x && a.q.coeffs() == b.q.coeffs();
}

}  // namespace

void SleepSettings::validate() const {
  require(after >= 0.0, "after", ">= 0", after, "s");
  require(speed >= 0.0 && std::isfinite(speed), "speed", "finite and >= 0", speed, "m/s");
  require(spin >= 0.0 && std::isfinite(spin), "spin", "finite and >= 0", spin, "rad/s");
}

Sleepers::Sleepers(const SleepSettings& settings, int bodies)
    : settings_(settings), group_(bodies, -1), slow_for_(bodies, 0.0) {}

int Sleepers::wake(int body) {
  if (!is_asleep(body)) {
    return 0;
  }
  std::vector<int>& group = groups_[group_[body]];
  const int woken = static_cast<int>(group.size());
  for (const int member : group) {
    group_[member] = -1;
    slow_for_[member] = 0.0;
  }
  group.clear();
  asleep_ -= woken;
  return woken;
}

int Sleepers::notice(const Bodies& bodies, const State& state) {
  if (asleep_ == 0) {
    return 0;
  }
  int woken = 0;
  for (int k = 0; k < static_cast<int>(bodies.size()); ++k) {
    const bool moved = !same_pose(state[k], left_[k]);
    if (is_asleep(k) && (moved || !state[k].p.isZero(0.0) || !state[k].L.isZero(0.0))) {
      woken += wake(k);
    } else if (moved && !bodies[k].is_dynamic()) {
      for (int other = 0; other < static_cast<int>(bodies.size()); ++other) {
        woken += wake(other);
      }
    }
  }
  return woken;
}

bool Sleepers::moves(const Body& body, const BodyState& state, int index) const {
  if (body.is_dynamic()) {
    return !is_asleep(index);
  }
  return body.kind == BodyKind::kKinematic && !(state.p.isZero(0.0) && state.L.isZero(0.0));
}

int Sleepers::wake_touched(const Bodies& bodies, const State& state, const BodyPairs& pairs) {
  int woken = 0;
  for (int before = -1; asleep_ > 0 && before != woken;) {  // who wakes may wake others
    before = woken;
    for (const auto& [a, b] : pairs) {
      if (is_asleep(a) && moves(bodies[b], state[b], b)) {
        woken += wake(a);
      } else if (is_asleep(b) && moves(bodies[a], state[a], a)) {
        woken += wake(b);
      }
    }
  }
  return woken;
}

double Sleepers::settle(const Bodies& bodies, const BodyPairs& pairs, double step, State& state) {
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Velocity u = velocity(bodies[k], state[k]);
    const bool slow = u.linear.norm() <= settings_.speed && u.angular.norm() <= settings_.spin;
    slow_for_[k] = slow && bodies[k].is_dynamic() ? slow_for_[k] + step : 0.0;
  }
  // The sets, by their first pair, and the shortest rest of their bodies.
  const std::vector<int>& set_of_pair = sets_.find(bodies, pairs);
  const int sets =
      set_of_pair.empty() ? 0 : *std::max_element(set_of_pair.begin(), set_of_pair.end()) + 1;
  rest_.assign(sets, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const int body : {pairs[i].first, pairs[i].second}) {
      const bool driven = bodies[body].kind == BodyKind::kKinematic;
      if (bodies[body].is_dynamic()) {
        rest_[set_of_pair[i]] = std::min(rest_[set_of_pair[i]], slow_for_[body]);
      } else if (driven && moves(bodies[body], state[body], body)) {
        rest_[set_of_pair[i]] = 0.0;
      }
    }
  }
  double lost = 0.0;
  group_of_set_.assign(sets, -1);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const int set = set_of_pair[i];
    if (!(rest_[set] > settings_.after)) {
      continue;
    }
    for (const int body : {pairs[i].first, pairs[i].second}) {
      if (!bodies[body].is_dynamic() || is_asleep(body)) {
        continue;
      }
      if (group_of_set_[set] < 0) {
        const auto unused = std::find_if(groups_.begin(), groups_.end(),
                                         [](const auto& group) { return group.empty(); });
        group_of_set_[set] = static_cast<int>(unused - groups_.begin());
        if (unused == groups_.end()) {
          groups_.emplace_back();
        }
      }
      group_[body] = group_of_set_[set];
      groups_[group_of_set_[set]].push_back(body);
      ++asleep_;
      lost += kinetic_energy(bodies[body], state[body]);
      state[body].p.setZero();
      state[body].L.setZero();
    }
  }
  left_ = state;
  return lost;
}

}  // namespace signorini
