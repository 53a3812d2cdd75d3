#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/generic_checks.h>
#include <signorini/validation/scene_contacts.h>

#ifdef SIGNORINI_HAS_CLP
#include "tools/limit_analysis.h"
#endif

#include <algorithm>
#include <fmt/format.h>

namespace signorini::validation {
namespace {

constexpr double kFallen = 0.01;  ///< m

/// mu of the file over mu_c of its contacts, by limit analysis in the plane of x and z.
void check_friction(const Scene& scene, const RunOptions& options, double factor,
                    SceneReport& report) {
  if (!options.studies || !options.signorini) return;
#ifdef SIGNORINI_HAS_CLP
  SceneContacts finder(scene);
  ContactSet contacts;
  finder.find(scene.state, 1e-6, contacts);
  const LimitAnalysis limit =
      critical_friction(scene.bodies, scene.state, contacts, scene.gravity, Vec3::UnitY());
  report.settings.push_back(fmt::format("limit analysis: mu_c = {:.9g}, {} contacts, {} programmes",
                                        limit.friction, contacts.size(), limit.programmes));
  report.checks.push_back(relative({.name = "friction of the file over mu_c",
                                    .reference = "closed form: limit analysis",
                                    .unit = "1",
                                    .reason = "the file's mu has 9 digits of mu_c"},
                                   contacts.front().material.friction / limit.friction, factor,
                                   1e-6));
#else
  (void)scene;
  (void)factor;
  report.notices.emplace_back(
      "mu_c is the file's word: this build has no limit analysis (Clp, coinor-libclp-dev)");
#endif
}

}  // namespace

/// 1.05 mu_c: nothing moves.
void check_masonry_stands(const Scene& scene, const RunOptions& options, SceneReport& report) {
  check_friction(scene, options, 1.05, report);
  check_resting_shapes(scene, options, report);
}

/// 0.9 mu_c: it must move.
void check_masonry_falls(const Scene& scene, const RunOptions& options, SceneReport& report) {
  check_friction(scene, options, 0.9, report);
  const Runs runs = run_engines(scene, options, report);
  const auto farthest = [&scene](const Track& track, std::size_t k) {
    double way = 0.0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      way = std::max(way, (track.bodies[k][i].pose.position - scene.state[i].x).norm());
    }
    return way;
  };
  runs.for_each([&](const Track& track) {
    double way = 0.0;
    for (std::size_t k = 0; k < track.size(); ++k) way = std::max(way, farthest(track, k));
    const CheckText text{.name = "what the way of the farthest body lacks of 1 cm",
                         .engine = track.engine,
                         .reference = "closed form: limit analysis",
                         .unit = "m",
                         .reason = "no forces carry it"};
    const double lacks = std::max(0.0, kFallen - way);
    report.checks.push_back(track.engine == "signorini" ? absolute(text, lacks, 0.0, 0.0)
                                                        : shown(text, lacks, 0.0));
  });
  add_energy_check(scene, runs, report);
  add_overlap_check(scene, runs, report);
  report.plots.push_back(
      plot_over_time("Way of the farthest body", "distance [m]", runs, farthest));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
