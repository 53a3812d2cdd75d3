#include <signorini/validation/builtin_scenes.h>
#include <signorini/validation/checks.h>
#include <signorini/validation/impact_cases.h>
#include <signorini/validation/signorini_runner.h>

#include <algorithm>
#include <cmath>

namespace signorini::validation {
namespace {

constexpr int kRod = 0;

/// The two contacts by place: the first support's, which the blow lifts off, then the second's.
ContactSet by_place(ContactSet contacts) {
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& a, const Contact& b) { return a.point_a.x() < b.point_a.x(); });
  return contacts;
}

/// Rod: 1/m and the arms of both contacts about the y axis give A in closed form.
struct RodAnswer {
  double a11, a12, a22;   ///< A, 1/kg
  double d1, d2;          ///< d'-, m/s
  double f2;              ///< Newton: the second support's impulse, N s
  double after1, after2;  ///< d'+
};

RodAnswer closed_form(const Scene& scene, const ContactSet& contacts, double e) {
  const Body& rod = scene.bodies[kRod];
  const Velocity v = velocity(rod, scene.state[kRod]);
  const double x1 = contacts[0].point_a.x();
  const double x2 = contacts[1].point_a.x();
  const double J = rod.inertia(1, 1);
  RodAnswer answer{};
  answer.a11 = 1.0 / rod.mass + x1 * x1 / J;
  answer.a12 = 1.0 / rod.mass + x1 * x2 / J;
  answer.a22 = 1.0 / rod.mass + x2 * x2 / J;
  answer.d1 = v.linear.z() - v.angular.y() * x1;
  answer.d2 = v.linear.z() - v.angular.y() * x2;
  answer.f2 = -(1.0 + e) * answer.d2 / answer.a22;
  answer.after1 = answer.d1 + answer.a12 * answer.f2;
  answer.after2 = -e * answer.d2;
  return answer;
}

void add_row(const std::string& how, const ImpactOutcome& outcome, Table& table) {
  const ImpactReport& impact = outcome.report;
  const bool solved = lcp::is_solved(impact.status);
  const auto pair_text = [](const lcp::Vector& v) {
    return v.size() == 2 ? text(v[0]) + ", " + text(v[1]) : std::string("-");
  };
  table.rows.push_back({how, describe_status(impact), pair_text(impact.impulses),
                        solved ? pair_text(impact.d_dot_after) : "state unchanged",
                        solved ? text(outcome.energy_gain()) : "-"});
}

void check_impact(const Scene& scene, SceneReport& report) {
  const ContactSet contacts = by_place(touching_contacts(scene));
  const double e = contacts.front().material.restitution;
  const RodAnswer exact = closed_form(scene, contacts, e);
  const ImpactOutcome newton =
      impact(scene, contacts, {.law = ImpactLaw::kNewton, .energy_safe = false});
  const ImpactOutcome notes =
      impact(scene, contacts, {.law = ImpactLaw::kNotes, .energy_safe = false});
  const ImpactOutcome everywhere =
      impact(scene, contacts,
             {.law = ImpactLaw::kNotes, .energy_safe = false, .bound_every_contact = true});
  Table table;
  table.title = "The blow, d'- = (" + text(exact.d1) + ", " + text(exact.d2) + ") m/s";
  table.header = {"law", "status", "impulses [N s]", "d'+ [m/s]", "(T+ - T-) / T-"};
  table.rows.push_back({"Newton, closed form", "", "0, " + text(exact.f2),
                        text(exact.after1) + ", " + text(exact.after2), ""});
  add_row("Newton", newton, table);
  add_row("the notes' form, bound on colliding contacts", notes, table);
  add_row("the notes' form, bound on every contact", everywhere, table);
  add_row("the notes' form, energy-safe", impact(scene, contacts, {.law = ImpactLaw::kNotes}),
          table);
  report.tables.push_back(table);

  report.checks.push_back(absolute(
      {.name = "Newton: distance of d'+ from the closed form",
       .unit = "m/s",
       .reason = "one impulse, f2 = -(1 + e) d2'-/A22; solved to 1e-12 (1 + |q|), |q| < 4"},
      std::hypot(newton.report.d_dot_after[0] - exact.after1,
                 newton.report.d_dot_after[1] - exact.after2),
      0.0, 5e-12));
  report.checks.push_back(absolute(
      {.name = "bound on every contact: proven to have no solution",
       .reference = "ray, exact arithmetic",
       .unit = "1",
       .reason = "d1'+ = d1'- + A12 f2 + A11 f1 > d1'- = |d1'-| for every f2 > 0, which d2'+ >= 0 "
                 "needs; status: " +
                 std::string(lcp::to_string(everywhere.report.law_status))},
      everywhere.report.law_status == lcp::Status::kInfeasible ||
              everywhere.report.law_status == lcp::Status::kNoSolutionBelow
          ? 1.0
          : 0.0,
      1.0, 0.0));
  report.checks.push_back(absolute({.name = "bound on colliding contacts: solved",
                                    .reference = "certificate",
                                    .unit = "1",
                                    .reason = "the bound binds the second support alone"},
                                   lcp::is_solved(notes.report.status) ? 1.0 : 0.0, 1.0, 0.0));
  const double beyond = notes.report.d_dot_after[1] - std::abs(exact.d2);
  report.checks.push_back(at_most({.name = "bound on colliding contacts: d2'+ beyond |d2'-|",
                                   .unit = "m/s",
                                   .reason = "the bound itself, solved to 1e-12 (1 + |q|)"},
                                  beyond, 5e-12));
}

}  // namespace

/// f1 = 0, f2 = -(1 + e) d2'-/A22 under Newton's law.
void check_rod_on_supports(const Scene& scene, const RunOptions& options, SceneReport& report) {
  if (options.signorini) check_impact(scene, report);
  const Runs runs = run_engines(scene, options, report);
  const RodAnswer exact = closed_form(scene, by_place(touching_contacts(scene)),
                                      scene.colliders.front().material.restitution);
  runs.for_each([&](const Track& track) {
    const Velocity v = track.bodies[1][kRod].velocity;
    const ContactSet contacts = by_place(touching_contacts(scene));
    const double d1 = v.linear.z() - v.angular.y() * contacts[0].point_a.x();
    const double d2 = v.linear.z() - v.angular.y() * contacts[1].point_a.x();
    const CheckText text{
        .name = "stepped: distance of d'+ from the Newton closed form",
        .engine = track.engine,
        .unit = "m/s",
        .reason =
            "the same law inside a time step: its tolerance times (1 + |q|), and w follows "
            "the turned inertia by at most 2 |w| (w h)"};
    const double error = std::hypot(d1 - exact.after1, d2 - exact.after2);
    const double turned = 2.0 * v.angular.norm() * v.angular.norm() * track.step;
    report.checks.push_back(
        track.engine == "signorini"
            ? absolute(text, error, 0.0, 5.0 * step_settings(scene).lcp.tolerance + turned)
            : shown(text, error, 0.0));
  });
  report.plots.push_back(plot_over_time(
      "Height of the rod's middle", "height [m]", runs,
      [](const Track& track, std::size_t k) { return track.bodies[k][kRod].pose.position.z(); }));
  add_energy_and_overlap_plots(runs, report);
}

}  // namespace signorini::validation
