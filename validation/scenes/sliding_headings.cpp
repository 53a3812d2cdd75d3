#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace signorini::validation {
namespace {

/// How far a block slid along its heading and across it, m.
struct Slide {
  double along;
  double across;
};

class Headings {
 public:
  explicit Headings(const Scene& scene) : scene_(scene) {
    const double mu =
        pair(scene.colliders.front().material, scene.colliders.back().material, scene.rule)
            .friction;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (!scene.bodies[i].is_dynamic()) continue;
      const Vec3 v = velocity(scene.bodies[i], scene.state[i]).linear;
      directions_.push_back(v.normalized());
      speed_ = v.norm();
    }
    distance_ = speed_ * speed_ / (2.0 * mu * scene.gravity.norm());
  }

  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] double distance() const { return distance_; }
  [[nodiscard]] std::size_t count() const { return directions_.size(); }
  [[nodiscard]] double degrees(std::size_t i) const {
    return std::atan2(directions_[i].y(), directions_[i].x()) * 180.0 / std::numbers::pi;
  }
  /// The blocks are the first bodies.
  [[nodiscard]] Slide slide(const Track& track, std::size_t i) const {
    const Vec3 moved = track.bodies.back()[i].pose.position - scene_.state[i].x;
    const double along = directions_[i].dot(moved);
    Vec3 rest = moved - along * directions_[i];
    rest.z() = 0.0;
    return {along, rest.norm()};
  }

 private:
  const Scene& scene_;
  std::vector<Vec3> directions_;
  double speed_ = 0.0;
  double distance_ = 0.0;
};

/// Every block stops at v^2/(2 mu g) on its heading.
void judge_cone(const Headings& headings, const Track& track, double h, SceneReport& report) {
  double longest = 0.0;
  double drift = 0.0;
  for (std::size_t i = 0; i < headings.count(); ++i) {
    const Slide slide = headings.slide(track, i);
    longest = std::max(longest, std::abs(slide.along - headings.distance()));
    drift = std::max(drift, slide.across);
  }
  report.checks.push_back(
      absolute({.name = "exact cone: greatest error of a distance",
                .unit = "m",
                .reason = "v^2/(2 mu g); first order: the speed's start times the step"},
               longest, 0.0, headings.speed() * h));
  report.checks.push_back(absolute(
      {.name = "exact cone: greatest drift across the heading",
       .unit = "m",
       .reason = "friction acts against the motion: 0 in closed form; errors of the solver's "
                 "tolerance of 1e-8 (1 + |q|) a step, added up"},
      drift, 0.0,
      1e-8 * (1.0 + headings.speed()) * static_cast<double>(track.steps) * track.time.back()));
}

/// A pyramid of k sides pulls with mu N along its nearest side, which takes between cos(pi/k) and 1
/// of mu N out of the motion and turns it by at most pi/k.
void judge_pyramid(const Headings& headings, const Track& track, int sides, double h,
                   SceneReport& report) {
  const double angle = std::numbers::pi / sides;
  const double slack = headings.speed() * h;
  double too_short = 0.0;
  double too_long = 0.0;
  double turned = 0.0;
  for (std::size_t i = 0; i < headings.count(); ++i) {
    const Slide slide = headings.slide(track, i);
    const double whole = std::hypot(slide.along, slide.across);
    too_short = std::max(too_short, headings.distance() - whole);
    too_long = std::max(too_long, whole - headings.distance() / std::cos(angle));
    turned = std::max(turned, std::atan2(slide.across, slide.along));
  }
  const std::string pyramid = fmt::format("pyramid of {} sides: ", sides);
  report.checks.push_back(at_most({.name = pyramid + "shorter than Coulomb's distance by",
                                   .unit = "m",
                                   .reason = "a pyramid inside the cone never pulls harder; first "
                                             "order: the speed's start times the step"},
                                  too_short, slack));
  report.checks.push_back(
      at_most({.name = pyramid + "longer than the distance over cos(pi/k) by",
               .unit = "m",
               .reason = "between two sides cos(pi/k) of mu N acts; first order as above"},
              too_long, slack));
  report.checks.push_back(at_most({.name = pyramid + "greatest turn off the heading",
                                   .unit = "rad",
                                   .reason = "the motion turns towards the middle between two "
                                             "sides: at most pi/k"},
                                  turned, angle + slack / headings.distance()));
}

}  // namespace

/// Every block goes straight and stops after v^2/(2 mu g).
void check_headings(const Scene& scene, const RunOptions& options, SceneReport& report) {
  const Headings headings(scene);
  const Runs runs = run_engines(scene, options, report);
  Table table;
  table.title = fmt::format("Where the blocks stop; closed form: {:.6g} m along, 0 across",
                            headings.distance());
  table.header = {"heading [degrees]"};
  std::vector<const Track*> tracks;
  std::optional<Track> cone;
  const auto column = [&](const Track& track, const std::string& name) {
    tracks.push_back(&track);
    table.header.push_back(name + ": along [m]");
    table.header.push_back(name + ": across [m]");
  };
  if (runs.signorini) {
    TimeStepSettings settings = step_settings(scene);
    judge_pyramid(headings, *runs.signorini, settings.pyramid_sides, scene.step, report);
    column(*runs.signorini, "pyramid");
    settings.friction_model = FrictionModel::kCone;
    cone = run_ours(scene, settings, options);
    judge_cone(headings, *cone, scene.step, report);
    column(*cone, "exact cone");
  }
  if (runs.bullet) column(*runs.bullet, "Bullet");
  for (std::size_t i = 0; i < headings.count(); ++i) {
    table.rows.push_back({fmt::format("{:.0f}", headings.degrees(i))});
    for (const Track* track : tracks) {
      const Slide slide = headings.slide(*track, i);
      table.rows.back().push_back(text(slide.along));
      table.rows.back().push_back(text(slide.across));
    }
  }
  report.tables.push_back(std::move(table));
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
