#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/impact_cases.h>
#include <signorini/validation/scene_contacts.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace signorini::validation {
namespace {

constexpr int kBody = 0;
constexpr double kSpin = 1e-12;  ///< rad/s

/// How far the body's shape reaches below its centre, m.
double depth(const Scene& scene) {
  const collision::Collider& collider = scene.colliders[0];
  const Pose about_centre{Vec3::Zero(), scene.state[kBody].q};
  return collision::support(collider.shape, about_centre * collider.local, -Vec3::UnitZ());
}

/// The body already on the plane, moving down with the speed of its fall, no gravity; turned about
/// the vertical so that no coordinate of a contact is round.
Scene at_touch_down(const Scene& scene) {
  Scene landed = scene;
  const double below = depth(scene);
  const double fall = scene.state[kBody].x.z() - below;
  landed.state[kBody].x.z() = below;
  landed.state[kBody].q = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ())) * scene.state[kBody].q;
  const double speed = std::sqrt(2.0 * scene.gravity.norm() * fall);
  set_velocity(landed.bodies[kBody], {Vec3(0.0, 0.0, -speed), Vec3::Zero()}, landed.state[kBody]);
  landed.gravity = Vec3::Zero();
  return landed;
}

/// Hands on a scene's contacts in another order and with another material.
class ReorderedContacts final : public ContactFinder {
 public:
  ReorderedContacts(const Scene& scene, std::vector<int> order, Material material)
      : contacts_(scene), order_(std::move(order)), material_(material) {}

  void find(const State& state, double margin, ContactSet& contacts) override {
    ContactSet found;
    contacts_.find(state, margin, found);
    contacts.clear();
    for (const int i : order_) {
      if (i < static_cast<int>(found.size())) contacts.push_back(found[i]);
    }
    for (Contact& contact : contacts) contact.material = material_;
  }
  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const Motion* const> motions,
                                                          double duration,
                                                          RestingPairs resting) override {
    return contacts_.first_contact(motions, duration, resting);
  }

 private:
  SceneContacts contacts_;
  std::vector<int> order_;
  Material material_;
};

/// Calls f with every order of n contacts.
template <typename F>
void for_each_order(std::size_t n, const F& f) {
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  do {
    f(order);
  } while (std::next_permutation(order.begin(), order.end()));
}

struct Worst {
  double spin = 0.0;   ///< |w|, rad/s
  double speed = 0.0;  ///< |v - (0, 0, e s)|, m/s
  int cases = 0;
  int unsolved = 0;

  void see(const Vec3& w, const Vec3& v, double expected_speed) {
    ++cases;
    spin = std::max(spin, w.norm());
    speed = std::max(speed, (v - Vec3(0.0, 0.0, expected_speed)).norm());
  }
};

Worst worst_impact(const Scene& landed, double e, ImpactLaw law) {
  const double s = -velocity(landed.bodies[kBody], landed.state[kBody]).linear.z();
  const ContactSet contacts = with_restitution(touching_contacts(landed), e);
  Worst worst;
  for_each_order(contacts.size(), [&](const std::vector<int>& order) {
    ContactSet reordered;
    for (const int i : order) reordered.push_back(contacts[i]);
    const ImpactOutcome outcome = impact(landed, reordered, {.law = law});
    worst.see(outcome.angular(landed, kBody), outcome.linear(landed, kBody), e * s);
    worst.unsolved += lcp::is_solved(outcome.report.status) ? 0 : 1;
  });
  return worst;
}

Worst worst_step(const Scene& landed, const Material& material) {
  const double s = -velocity(landed.bodies[kBody], landed.state[kBody]).linear.z();
  Worst worst;
  for_each_order(touching_contacts(landed).size(), [&](const std::vector<int>& order) {
    ReorderedContacts contacts(landed, order, material);
    TimeStepper stepper(landed.bodies, contacts, step_settings(landed));
    State state = landed.state;
    StepReport step;
    stepper.step(state, step);
    const Velocity after = velocity(landed.bodies[kBody], state[kBody]);
    worst.see(after.angular, after.linear, material.restitution * s);
    worst.unsolved += lcp::is_solved(step.status) ? 0 : 1;
  });
  return worst;
}

void add_row(const std::string& how, double e, const std::string& mu, const Worst& worst,
             Table& table) {
  table.rows.push_back({how, fmt::format("{:g}", e), mu, fmt::format("{}", worst.cases),
                        text(worst.spin), text(worst.speed), fmt::format("{}", worst.unsolved)});
}

void check_all_orders(const Scene& landed, SceneReport& report) {
  Table table;
  table.title = "Landing, every order of the four contacts";
  table.header = {
      "how",       "e", "mu", "orders", "greatest |w| after [rad/s]", "greatest |v - e s| [m/s]",
      "not solved"};
  Worst all_impacts;
  Worst all_steps;
  const auto merge = [](const Worst& from, Worst& into) {
    into.spin = std::max(into.spin, from.spin);
    into.speed = std::max(into.speed, from.speed);
    into.cases += from.cases;
    into.unsolved += from.unsolved;
  };
  for (const double e : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    for (const ImpactLaw law : {ImpactLaw::kNewton, ImpactLaw::kNotes}) {
      const Worst worst = worst_impact(landed, e, law);
      add_row(law == ImpactLaw::kNewton ? "impact, Newton" : "impact, the notes' form", e, "-",
              worst, table);
      merge(worst, all_impacts);
    }
    for (const double mu : {0.0, 0.3, 1.0}) {
      const Worst worst = worst_step(landed, {mu, e});
      add_row("one time step", e, fmt::format("{:g}", mu), worst, table);
      merge(worst, all_steps);
    }
  }
  report.tables.push_back(table);
  report.checks.push_back(absolute(
      {.name = fmt::format("impacts: greatest |w| after the landing ({} cases)", all_impacts.cases),
       .unit = "rad/s",
       .reason = "one speed of the whole face: w = 0; rounding of the impulses, a few m/s "
                 "of the mass, over the inertia"},
      all_impacts.spin, 0.0, kSpin));
  report.checks.push_back(absolute(
      {.name =
           fmt::format("time steps: greatest |w| after the landing ({} cases)", all_steps.cases),
       .unit = "rad/s",
       .reason = "w = 0, with every e, mu and contact order; rounding"},
      all_steps.spin, 0.0, kSpin));
  report.checks.push_back(absolute({.name = "impacts: greatest |v - e s|",
                                    .unit = "m/s",
                                    .reason = "one speed for the whole face; solved to 1e-12 "
                                              "(1 + |q|), |q| < 7"},
                                   all_impacts.speed, 0.0, 1e-11));
  report.checks.push_back(at_most(
      {.name = "landings not solved", .unit = "1", .reason = "every landing has a solution"},
      all_impacts.unsolved + all_steps.unsolved, 0.0));
}

double greatest_spin(const Track& track) {
  double most = 0.0;
  for (const std::vector<BodySample>& sample : track.bodies) {
    most = std::max(most, sample[kBody].velocity.angular.norm());
  }
  return most;
}

/// Bullet's spin after the same landing, by iterations.
void show_bullet_landing(const Scene& landed, const RunOptions& options, SceneReport& report) {
  Table table;
  table.title = "Bullet's landing of the same body, by iterations of its solver";
  table.header = {"iterations", "greatest |w| [rad/s]"};
  Scene short_scene = landed;
  short_scene.duration = 0.1;
  for (const int iterations : {1, 2, 4, 10, 50}) {
    BulletProfile profile = options.profile;
    profile.iterations = iterations;
    table.rows.push_back({fmt::format("{}", iterations),
                          text(greatest_spin(run_theirs(short_scene, profile, options)))});
  }
  report.tables.push_back(table);
}

}  // namespace

/// w = 0 before, during and after a flat landing; v+ = e s.
void check_flat_landing(const Scene& scene, const RunOptions& options, SceneReport& report) {
  if (options.signorini && options.studies) check_all_orders(at_touch_down(scene), report);
  if (options.bullet && options.studies) show_bullet_landing(at_touch_down(scene), options, report);
  const Runs runs = run_engines(scene, options, report);
  runs.for_each([&](const Track& track) {
    const CheckText text{.name = "stepped: greatest |w| of the whole run",
                         .engine = track.engine,
                         .unit = "rad/s",
                         .reason =
                             "w = 0; at each of the landings and resting steps the rounding of "
                             "impulses over the inertia"};
    report.checks.push_back(track.engine == "signorini"
                                ? absolute(text, greatest_spin(track), 0.0, kSpin)
                                : shown(text, greatest_spin(track), 0.0));
  });
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  report.plots.push_back(plot_over_time(
      "Height", "height of the centre of mass [m]", runs,
      [](const Track& track, std::size_t k) { return track.bodies[k][kBody].pose.position.z(); }));
  report.plots.push_back(plot_over_time(
      "Spin", "|w| [rad/s]", runs,
      [](const Track& track, std::size_t k) {
        return track.bodies[k][kBody].velocity.angular.norm();
      },
      [](double) { return 0.0; }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
