#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/impact_cases.h>

#include <algorithm>
#include <cmath>

namespace signorini::validation {
namespace {

constexpr int kBall = 0;

void add_row(const std::string& how, const Scene& scene, const ImpactOutcome& outcome,
             Table& table) {
  const ImpactReport& impact = outcome.report;
  const bool solved = lcp::is_solved(impact.status);
  table.rows.push_back({how, describe_status(impact),
                        impact.law_result.ray_bound > 0.0 ? text(impact.law_result.ray_bound) : "-",
                        solved ? text(outcome.linear(scene, kBall)) : "state unchanged",
                        solved ? text(outcome.energy_gain()) : "-",
                        impact.theta.size() > 0 ? text(impact.theta[0]) : "-"});
}

void check_impact(const Scene& scene, SceneReport& report) {
  const ContactSet contacts = touching_contacts(scene);
  const ImpactOutcome newton =
      impact(scene, contacts, {.law = ImpactLaw::kNewton, .energy_safe = false});
  const ImpactOutcome safe = impact(scene, contacts, {.law = ImpactLaw::kNewton});
  Table table;
  table.title = "The impact between the walls";
  table.header = {"law",           "status",         "Z: every solution has |f|_1 >= Z [N s]",
                  "v after [m/s]", "(T+ - T-) / T-", "theta"};
  add_row("Newton LCP", scene, newton, table);
  add_row("Newton LCP, energy-safe", scene, safe, table);
  add_row("the notes' form, energy-safe", scene,
          impact(scene, contacts, {.law = ImpactLaw::kNotes}), table);
  report.tables.push_back(table);

  const lcp::Status law = newton.report.law_status;
  const bool proven = law == lcp::Status::kInfeasible || law == lcp::Status::kNoSolutionBelow;
  const double bound = newton.report.law_result.ray_bound;
  report.checks.push_back(
      absolute({.name = "Newton LCP: proven to have no solution (or none below Z)",
                .reference = "ray, exact arithmetic",
                .unit = "1",
                .reason = "f0 - f1 >= (1 + e) m s and f0 - f1 <= m s cannot both hold; status: " +
                          std::string(lcp::to_string(law))},
               proven ? 1.0 : 0.0, 1.0, 0.0));
  const double momentum =
      scene.bodies[kBall].mass * velocity(scene.bodies[kBall], scene.state[kBall]).linear.norm();
  report.checks.push_back(absolute(
      {.name = "1 / Z in units of 1 / (m |v|)",
       .reference = "ray, exact arithmetic",
       .unit = "1",
       .reason = "exact normals: Z is infinite. Rounded normals: the ray misses M^T y = 0 by a few "
                 "roundings, so Z is at least m |v| / (100 eps); Z = " +
                 text(bound) + " N s"},
      bound > 0.0 ? momentum / bound : std::numeric_limits<double>::quiet_NaN(), 0.0,
      100.0 * std::numeric_limits<double>::epsilon()));

  const Vec3 before = velocity(scene.bodies[kBall], scene.state[kBall]).linear;
  const Vec3 normal = contacts.front().normal;
  const Vec3 plastic = before - normal.dot(before) * normal;
  report.checks.push_back(
      absolute({.name = "energy-safe: distance of v from the plastic closed form",
                .unit = "m/s",
                .reason = "the ball stops between the walls and keeps its tangential velocity; "
                          "solved to 1e-12 (1 + |q|)"},
               lcp::is_solved(safe.report.status) ? (safe.linear(scene, kBall) - plastic).norm()
                                                  : std::numeric_limits<double>::quiet_NaN(),
               0.0, 3e-12));
  report.checks.push_back(at_most({.name = "energy-safe: relative energy gain",
                                   .reference = "conservation law",
                                   .unit = "1",
                                   .reason = "promised by the form, to rounding"},
                                  safe.energy_gain(), 1e-12));
}

}  // namespace

/// Newton's LCP has no solution; the plastic answer keeps the tangential velocity alone.
void check_ball_between_walls(const Scene& scene, const RunOptions& options, SceneReport& report) {
  if (options.signorini) check_impact(scene, report);
  const Runs runs = run_engines(scene, options, report, UnsolvedSteps::kShow);
  if (options.signorini) {
    report.notices.push_back(
        "the time stepper uses Newton's law without the energy-safe form: its first step has no "
        "solution, is counted as not solved, and goes on with the best iterate");
  }
  runs.for_each([&](const Track& track) {
    report.checks.push_back(shown({.name = "stepped: relative change of the energy by the end",
                                   .engine = track.engine,
                                   .reference = "conservation law",
                                   .unit = "1",
                                   .reason = "no law has an answer here that both engines must "
                                             "give: shown, not judged"},
                                  track.kinetic.back() / track.kinetic[0] - 1.0, 0.0));
  });
  const Vec3 start = scene.state[kBall].x;
  report.plots.push_back(
      plot_over_time("Distance of the ball from the middle", "distance [m]", runs,
                     [start](const Track& track, std::size_t k) {
                       return (track.bodies[k][kBall].pose.position - start).norm();
                     }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
