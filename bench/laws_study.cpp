#include "bench/laws_study.h"

#include <signorini/core/response/assembly.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <numeric>
#include <stdexcept>

namespace signorini::bench {
namespace {

constexpr double kSpeed = 1.0;  // of the strikers, m/s

Body ball() {
  Body body;
  body.inertia = 0.1 * Mat3::Identity();  // 2/5 m r^2, r = 1/2
  return body;
}

Body brick(const Vec3& size) {
  Body body;
  const Vec3 squares = size.cwiseAbs2() / 12.0;
  body.inertia = (Vec3::Constant(squares.sum()) - squares).asDiagonal();
  return body;
}

int add(RandomImpact& impact, const Body& body, const Vec3& x, const Vec3& v = Vec3::Zero()) {
  impact.bodies.push_back(body);
  impact.state.emplace_back();
  impact.state.back().x = x;
  set_velocity(body, {v, Vec3::Zero()}, impact.state.back());
  return static_cast<int>(impact.bodies.size()) - 1;
}

void touch(RandomImpact& impact, int a, int b, const Vec3& point, const Vec3& normal) {
  Contact contact;
  contact.body_a = a;
  contact.body_b = b;
  contact.point_a = contact.point_b = point;
  contact.normal = normal;
  contact.gap = 0.0;
  contact.material.restitution = 1.0;
  impact.contacts.push_back(contact);
}

/// A touching row of balls with these speeds.
RandomImpact row_of_balls(const std::vector<double>& speeds) {
  RandomImpact impact;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    add(impact, ball(), Vec3(static_cast<double>(i), 0, 0), Vec3(speeds[i], 0, 0));
  }
  for (int i = 0; i + 1 < static_cast<int>(speeds.size()); ++i) {
    touch(impact, i + 1, i, Vec3(i + 0.5, 0, 0), Vec3::UnitX());
  }
  return impact;
}

/// A scene that is its own mirror image in y: partner[k] is the body that body k becomes.
struct MirrorScene {
  RandomImpact impact;
  std::vector<int> partner;
};

std::vector<MirrorScene> mirror_scenes() {
  std::vector<MirrorScene> scenes(3);
  RandomImpact& triangle = scenes[0].impact;
  add(triangle, ball(), Vec3::Zero(), Vec3(kSpeed, 0, 0));
  const Vec3 up(0.5 * std::sqrt(3.0), 0.5, 0);
  const Vec3 down(up.x(), -0.5, 0);
  add(triangle, ball(), up);
  add(triangle, ball(), down);
  touch(triangle, 1, 0, 0.5 * up, up);
  touch(triangle, 2, 0, 0.5 * down, down);
  touch(triangle, 1, 2, Vec3(up.x(), 0, 0), Vec3::UnitY());
  scenes[0].partner = {0, 2, 1};

  Body ground;
  ground.kind = BodyKind::kFixed;
  RandomImpact& landing = scenes[1].impact;
  add(landing, brick(Vec3(1, 0.6, 0.4)), Vec3(0, 0, 0.2), Vec3(0, 0, -kSpeed));
  add(landing, ground, Vec3::Zero());
  for (const auto& [i, j] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    touch(landing, 0, 1, Vec3(0.5 * i, 0.3 * j, 0), Vec3::UnitZ());
  }
  scenes[1].partner = {0, 1};

  RandomImpact& rod = scenes[2].impact;
  add(rod, brick(Vec3(0.1, 4, 0.1)), Vec3::Zero());
  add(rod, ground, Vec3::Zero());
  add(rod, ball(), Vec3(0, 0, 0.55), Vec3(0, 0, -kSpeed));
  touch(rod, 0, 1, Vec3(0, -1, -0.05), Vec3::UnitZ());
  touch(rod, 0, 1, Vec3(0, 1, -0.05), Vec3::UnitZ());
  touch(rod, 2, 0, Vec3(0, 0, 0.05), Vec3::UnitZ());
  scenes[2].partner = {0, 1, 2};
  return scenes;
}

/// How far velocities are from their mirror image in y.
double asymmetry(const MirrorScene& scene, const State& after) {
  double most = 0.0;
  for (std::size_t k = 0; k < after.size(); ++k) {
    const int other = scene.partner[k];
    const Velocity a = velocity(scene.impact.bodies[k], after[k]);
    const Velocity b = velocity(scene.impact.bodies[other], after[other]);
    const Vec3 linear(b.linear.x(), -b.linear.y(), b.linear.z());
    const Vec3 angular(-b.angular.x(), b.angular.y(), -b.angular.z());  // an axial vector
    most = std::max({most, (a.linear - linear).cwiseAbs().maxCoeff(),
                     (a.angular - angular).cwiseAbs().maxCoeff()});
  }
  return most / kSpeed;
}

RandomImpact in_order(const RandomImpact& impact, const std::vector<int>& order) {
  RandomImpact other = impact;
  for (std::size_t i = 0; i < order.size(); ++i) {
    other.contacts[i] = impact.contacts[order[i]];
  }
  return other;
}

/// The random impact with e = 1; what was driven is fixed, or, if asked, everything is free.
RandomImpact elastic_impact(std::uint64_t seed, int index, bool all_free) {
  RandomImpact impact = draw_random_impact(seed, index);
  for (std::size_t k = 0; k < impact.bodies.size(); ++k) {
    if (!impact.bodies[k].is_dynamic()) {
      impact.bodies[k].kind = all_free ? BodyKind::kDynamic : BodyKind::kFixed;
      impact.state[k].p.setZero();
      impact.state[k].L.setZero();
    }
  }
  for (Contact& contact : impact.contacts) {
    contact.material.restitution = 1.0;
  }
  return impact;
}

struct Momenta {
  Vec3 linear = Vec3::Zero();
  Vec3 angular = Vec3::Zero();  // about the origin
  double linear_size = 0.0;
  double angular_size = 0.0;
};

Momenta momenta_of(const State& state) {
  Momenta sum;
  for (const BodyState& body : state) {
    const Vec3 angular = body.x.cross(body.p) + body.L;
    sum.linear += body.p;
    sum.angular += angular;
    sum.linear_size += body.p.norm();
    sum.angular_size += angular.norm();
  }
  return sum;
}

class Measure {
 public:
  explicit Measure(const LawContestant& law) : law_(law) { row_.name = law.name; }

  void break_away() {
    const std::vector<std::pair<std::vector<double>, std::vector<double>>> cases{
        {{1, 0, 0, 0, 0}, {0, 0, 0, 0, 1}},
        {{1, 1, 0, 0, 0}, {0, 0, 0, 1, 1}},
        {{1, 0, 0, 0, -1}, {-1, 0, 0, 0, 1}}};
    for (const auto& [before, expected] : cases) {
      const RandomImpact impact = row_of_balls(before);
      const LawAnswer answer = law_.resolve(impact);
      for (std::size_t i = 0; i < before.size(); ++i) {
        const double v = velocity(impact.bodies[i], answer.after[i]).linear.x();
        row_.break_away = std::max(row_.break_away, std::abs(v - expected[i]) / kSpeed);
      }
    }
  }

  void symmetry() {
    for (const MirrorScene& scene : mirror_scenes()) {
      std::vector<int> order(scene.impact.contacts.size());
      std::iota(order.begin(), order.end(), 0);
      do {
        const LawAnswer answer = law_.resolve(in_order(scene.impact, order));
        row_.symmetry = std::max(row_.symmetry, asymmetry(scene, answer.after));
      } while (std::next_permutation(order.begin(), order.end()));
    }
  }

  void random(std::uint64_t seed, int index) {
    ++row_.impacts;
    const RandomImpact impact = elastic_impact(seed, index, false);
    const LawAnswer answer = law_.resolve(impact);
    if (!answer.answered) {
      ++row_.unanswered;
    } else {
      energy(impact, answer);
      impulses(impact, answer);
    }
    const RandomImpact free = elastic_impact(seed, index, true);
    const LawAnswer kept = law_.resolve(free);
    if (kept.answered) {
      momentum(free, kept);
    }
  }

  [[nodiscard]] const LawRow& row() const { return row_; }

 private:
  void energy(const RandomImpact& impact, const LawAnswer& answer) {
    const double before = kinetic_energy(impact.bodies, impact.state);
    if (before > 0.0) {
      const double change = kinetic_energy(impact.bodies, answer.after) / before - 1.0;
      row_.energy_gain = std::max(row_.energy_gain, change);
      row_.energy_loss = std::max(row_.energy_loss, -change);
    }
  }

  void impulses(const RandomImpact& impact, const LawAnswer& answer) {
    NormalRows rows;
    assemble_normals(impact.bodies, impact.state, impact.contacts, rows);
    const double speed = rows.d_dot.cwiseAbs().maxCoeff();
    if (speed > 0.0) {
      lcp::Vector diagonal;
      rows.A.diagonal(diagonal);
      const double pull = -answer.impulses.cwiseProduct(diagonal).minCoeff();
      const lcp::Vector after = gap_velocities(impact.bodies, answer.after, impact.contacts);
      row_.one_sided = std::max(row_.one_sided, pull / speed);
      row_.approach = std::max(row_.approach, -after.minCoeff() / speed);
    }
  }

  void momentum(const RandomImpact& impact, const LawAnswer& answer) {
    const Momenta before = momenta_of(impact.state);
    const Momenta after = momenta_of(answer.after);
    const double linear = std::max(before.linear_size, after.linear_size);
    const double angular = std::max(before.angular_size, after.angular_size);
    if (linear > 0.0) {
      row_.momentum = std::max(row_.momentum, (after.linear - before.linear).norm() / linear);
    }
    if (angular > 0.0) {
      row_.momentum = std::max(row_.momentum, (after.angular - before.angular).norm() / angular);
    }
  }

  const LawContestant& law_;
  LawRow row_;
};

LawContestant our_law(ImpactLaw law, bool energy_safe) {
  const bool sequential =
      law == ImpactLaw::kSequentialOnce || law == ImpactLaw::kSequentialRepeated;
  std::string name(to_string(law));
  if (!sequential && energy_safe) {
    name += ", energy-safe";
  }
  return {name, [law, energy_safe](const RandomImpact& impact) {
            ImpactSettings settings{.law = law, .energy_safe = energy_safe};
            settings.max_passes = 2000;
            LawAnswer answer;
            answer.after = impact.state;
            ImpactReport report;
            resolve_impact(impact.bodies, impact.contacts, settings, answer.after, report);
            answer.answered = lcp::is_solved(report.status) && lcp::is_solved(report.law_status);
            answer.impulses = report.impulses;
            return answer;
          }};
}

void print_table(const std::vector<LawRow>& rows, std::ostream& out) {
  fmt::print(out, "{:<26} {:>6} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10}\n", "law", "has",
             "break-away", "symmetry", "gain", "loss", "momentum", "one-sided", "approach",
             "no answer");
  for (const LawRow& row : rows) {
    fmt::print(out,
               "{:<26} {:>6} {:>10.2g} {:>9.2g} {:>9.2g} {:>9.2g} {:>9.2g} {:>9.2g} {:>9.2g} "
               "{:>10}\n",
               row.name, row.letters(), row.break_away, row.symmetry, row.energy_gain,
               row.energy_loss, row.momentum, row.one_sided, row.approach,
               fmt::format("{}/{}", row.unanswered, row.impacts));
  }
  fmt::print(out,
             "\nhas: B break-away, S symmetry, E energy, M momentum, O one-sided impulses, each "
             "within {:g};\nall impacts with e = 1, without friction\n",
             kDesideratum);
}

}  // namespace

std::vector<LawContestant> our_laws() {
  return {
      our_law(ImpactLaw::kSequentialOnce, false), our_law(ImpactLaw::kSequentialRepeated, false),
      our_law(ImpactLaw::kNewton, false),         our_law(ImpactLaw::kNewton, true),
      our_law(ImpactLaw::kNotes, false),          our_law(ImpactLaw::kNotes, true),
      our_law(ImpactLaw::kPoisson, false),        our_law(ImpactLaw::kPoisson, true),
      our_law(ImpactLaw::kReflections, false),    our_law(ImpactLaw::kReflections, true)};
}

std::string LawRow::letters() const {
  const auto letter = [](char initial, double value) {
    return value <= kDesideratum ? initial : '-';
  };
  return {letter('B', break_away), letter('S', symmetry),
          letter('E', std::max(energy_gain, energy_loss)), letter('M', momentum),
          letter('O', one_sided)};
}

std::vector<LawRow> run_laws_study(const LawsOptions& options,
                                   const std::vector<LawContestant>& contestants,
                                   std::ostream& out) {
  if (options.impacts < 0) {
    throw std::invalid_argument("impacts: must be >= 0, got " + std::to_string(options.impacts));
  }
  std::vector<LawRow> rows;
  for (const LawContestant& law : contestants) {
    Measure measure(law);
    measure.break_away();
    measure.symmetry();
    for (int index = 0; index < options.impacts; ++index) {
      measure.random(options.seed, index);
    }
    rows.push_back(measure.row());
  }
  print_table(rows, out);
  return rows;
}

std::string laws_csv(const std::vector<LawRow>& rows) {
  std::string csv =
      "law,has,break_away,symmetry,energy_gain,energy_loss,momentum,one_sided,approach,impacts,"
      "unanswered\r\n";
  for (const LawRow& row : rows) {
    csv += fmt::format("\"{}\",{},{},{},{},{},{},{},{},{},{}\r\n", row.name, row.letters(),
                       row.break_away, row.symmetry, row.energy_gain, row.energy_loss, row.momentum,
                       row.one_sided, row.approach, row.impacts, row.unanswered);
  }
  return csv;
}

}  // namespace signorini::bench
