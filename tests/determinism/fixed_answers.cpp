#include "fixed_answers.h"

#include <signorini/collision/collision_world.h>
#include <signorini/collision/contact_time.h>
#include <signorini/collision/pair_query.h>
#include <signorini/core/response/event_stepper.h>
#include <signorini/core/response/impact.h>
#include <signorini/core/response/time_stepper.h>
#include <signorini/lcp/pgs.h>
#include <signorini/lcp/solver.h>

#include "bench/contact_families.h"
#include "tests/collision/random_throws.h"
#include "tests/core/response_scenes.h"

#include <algorithm>
#include <optional>
#include <random>
#include <span>
#include <string_view>
#include <utility>

namespace signorini::testing {
namespace {

/// One solve, one impact, one query: nothing is passed on that could grow.
constexpr double kOfOneAnswer = 1e-12;
/// A second of motion passes its errors on; nothing here is chaotic.
constexpr double kOfASecond = 1e-9;

void add(const Vec3& vector, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), vector.begin(), vector.end());
}

void add(const lcp::Vector& vector, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), vector.begin(), vector.end());
}

void add(const State& state, std::vector<double>& numbers) {
  for (const BodyState& body : state) {
    add(body.x, numbers);
    add(lcp::Vector(body.q.coeffs()), numbers);
    add(body.p, numbers);
    add(body.L, numbers);
  }
}

// ---- lcp

/// A family with the normal rows alone, or with a cone a contact.
lcp::Problem contact_problem(const bench::FamilySpec& spec, bool cones) {
  if (!cones) {
    return bench::make_family(spec);
  }
  const bench::FamilyScene scene = bench::make_family_scene(spec);
  lcp::FactoredMatrix A = scene.inverse_mass();
  lcp::Problem problem;
  for (const bench::FamilyScene::Touch& touch : scene.touches) {
    problem.cones.push_back({.normal_row = A.rows(), .dimension = 3, .coefficient = 0.5});
    const Vec3 tangent = touch.normal.unitOrthogonal();
    for (const Vec3& direction : {touch.normal, tangent, touch.normal.cross(tangent).eval()}) {
      scene.add_row(touch, direction, A);
    }
  }
  problem.q = scene.free_row_velocities(A);
  problem.M = std::move(A);
  return problem;
}

/// M = B B^T + I / 10, dense, of any size.
lcp::Problem dense_problem(int size) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  lcp::Matrix B(size, size);
  lcp::Problem problem;
  problem.q.resize(size);
  for (int j = 0; j < size; ++j) {
    problem.q[j] = normal(random);
    for (int i = 0; i < size; ++i) {
      B(i, j) = normal(random);
    }
  }
  problem.M = lcp::Matrix(B * B.transpose() + 0.1 * lcp::Matrix::Identity(size, size));
  return problem;
}

FixedAnswers solver_answers(std::string_view name, std::span<const lcp::Problem> problems) {
  FixedAnswers answers{.part = "solver " + std::string(name), .bound = kOfOneAnswer};
  // An interior point ends between the iterates, wherever its residual is small enough: the
  // answer's digits beyond the tolerance are those of systems with a condition of one over it.
  const bool is_interior = name == "cone-interior-point" || name == "auto";
  const auto solver =
      lcp::make_solver(name, {.tolerance = is_interior ? 1e-13 : 1e-8, .max_iterations = 300});
  lcp::Result result;
  for (const lcp::Problem& problem : problems) {
    if (!solver->refuses(problem).empty() || (name == "exact" && problem.size() > 12)) {
      continue;
    }
    solver->solve(problem, result);
    answers.choices.push_back(static_cast<int>(result.status));
    add(result.w, is_solved(result.status) ? answers.numbers : answers.left_open);
    add(result.z, answers.left_open);
    answers.left_open.push_back(result.statistics.iterations);
  }
  return answers;
}

/// The two with cones have one w: of a wall that is thrown together Coulomb's law has many (two
/// solvers' differ by 3e-3 m/s, both certified to 1e-12), and rounding chooses.
void add_solvers(std::vector<FixedAnswers>& all) {
  const std::vector<lcp::Problem> problems = {
      dense_problem(8),
      dense_problem(30),
      contact_problem({.family = "tower4", .size = 6, .mass_ratio = 100.0}, false),
      contact_problem({.family = "spheres", .size = 60}, false),
      contact_problem({.family = "tower4", .size = 12}, true),
      contact_problem({.family = "spheres", .size = 40, .seed = 2}, true)};
  for (const std::string_view name : lcp::solver_names()) {
    all.push_back(solver_answers(name, problems));
  }
}

FixedAnswers sweeps_on_threads(int threads) {
  FixedAnswers answers{.part = "sweeps on threads", .bound = kOfOneAnswer};
  lcp::PgsSettings settings;
  settings.max_iterations = 50;
  settings.threads = threads;
  lcp::Pgs solver(settings);
  lcp::Result result;
  solver.solve(contact_problem({.family = "spheres", .size = 300}, false), result);
  add(result.w, answers.numbers);
  return answers;
}

// ---- core

/// @param mu of every contact; 0: an impact without friction
FixedAnswers impact_answers(ImpactLaw law, double mu) {
  FixedAnswers answers{
      .part = "impact " + std::string(to_string(law)) + (mu > 0.0 ? ", friction" : ""),
      .bound = kOfOneAnswer};
  std::mt19937_64 random(7);
  ImpactReport report;
  for (int k = 0; k < 10; ++k) {
    scenes::Scene scene = scenes::random_scene(random, 4, 6);
    for (Contact& contact : scene.contacts) {
      contact.material.friction = mu;
    }
    resolve_impact(scene.bodies, scene.contacts,
                   {.law = law, .friction = mu > 0.0, .max_passes = 200}, scene.state, report);
    answers.choices.push_back(static_cast<int>(report.status));
    add(report.impulses, answers.left_open);
    add(scene.state, answers.numbers);
  }
  return answers;
}

/// A ground, and what lies on it.
struct Yard {
  scenes::Scene scene;
  std::vector<collision::Collider> colliders;

  explicit Yard(const Material& material) : material_(material) {
    add(scenes::fixed_body(), collision::Box{Vec3::Constant(20.0)}, Vec3(0.0, 0.0, -20.0));
  }
  void add(const Body& body, const collision::Shape& shape, const Vec3& position,
           const Velocity& motion = {}) {
    const int index = scene.add(body, position, motion);
    colliders.push_back(
        {.body = index, .shape = shape, .local = {}, .material = material_, .name = {}});
  }
  [[nodiscard]] collision::CollisionWorld world() const {
    return {scene.bodies, colliders, PairingRule::kMinimum};
  }

 private:
  Material material_;
};

/// Stacks of four boxes, one of them pushed, and a ball that rolls and slips.
FixedAnswers step_answers(const Accuracy& accuracy, int threads) {
  // Below what the dial leaves open in a second, m of about 1 m, builds may differ too.
  FixedAnswers answers{.part = "time steps, " + accuracy.name(),
                       .bound = std::max(kOfASecond, accuracy.residual())};
  Yard yard({.friction = 0.5, .restitution = 0.0});
  for (int stack = 0; stack < 3; ++stack) {
    for (int floor = 0; floor < 4; ++floor) {
      const Vec3 push(floor == 3 ? 0.5 * stack : 0.0, 0.0, 0.0);
      yard.add(scenes::box(1.0 + floor, Vec3::Ones()), collision::Box{Vec3::Constant(0.5)},
               Vec3(2.5 * stack, 0.0, 0.5 + floor), {push, Vec3::Zero()});
    }
  }
  yard.add(scenes::ball(), collision::Sphere{0.5}, Vec3(0.0, 3.0, 0.5),
           {Vec3(2.0, 0.5, 0.0), Vec3(0.0, 0.0, 3.0)});
  collision::CollisionWorld world = yard.world();
  TimeStepSettings settings;
  settings.accuracy = accuracy;
  settings.threads = threads;
  TimeStepper stepper(yard.scene.bodies, world, settings);
  StepReport report;
  for (int k = 0; k < 60; ++k) {
    stepper.step(yard.scene.state, report);
    answers.choices.push_back(static_cast<int>(report.status));
    answers.choices.push_back(std::ssize(report.contacts));
  }
  for (const Contact& contact : report.contacts) {
    answers.choices.push_back(static_cast<std::int64_t>(contact.feature_id));
  }
  for (const Vec3& impulse : report.impulses) {
    add(impulse, answers.left_open);
  }
  add(yard.scene.state, answers.numbers);
  return answers;
}

void add(const EventReport& report, FixedAnswers& answers) {
  answers.choices.push_back(static_cast<int>(report.status));
  for (const Event& event : report.events) {
    answers.choices.push_back(static_cast<int>(event.kind));
    answers.choices.push_back(event.body_a);
    answers.choices.push_back(event.body_b);
    answers.numbers.push_back(event.time);
    answers.numbers.push_back(event.speed);
  }
}

/// A second of the event-driven stepper.
FixedAnswers event_answers(const std::string& part, Yard& yard) {
  FixedAnswers answers{.part = part, .bound = kOfASecond};
  collision::CollisionWorld world = yard.world();
  EventStepper stepper(yard.scene.bodies, world, {});
  EventReport report;
  stepper.advance(yard.scene.state, 1.0, report);
  add(report, answers);
  add(yard.scene.state, answers.numbers);
  return answers;
}

/// Balls and a box that bounce and come to rest.
FixedAnswers event_answers() {
  Yard yard({.friction = 0.0, .restitution = 0.5});
  yard.add(scenes::ball(), collision::Sphere{0.5}, Vec3(0.0, 0.0, 1.5));
  yard.add(scenes::ball(2.0), collision::Sphere{0.5}, Vec3(0.1, 0.0, 2.7));
  yard.add(scenes::box(1.0, Vec3::Ones()), collision::Box{Vec3::Constant(0.5)},
           Vec3(3.0, 0.0, 0.9));
  return event_answers("events", yard);
}

/// A ball that slips and then rolls, one that lands spinning, and a box that slides to rest.
FixedAnswers event_friction_answers() {
  Yard yard({.friction = 0.3, .restitution = 0.5});
  yard.add(scenes::ball(), collision::Sphere{0.5}, Vec3(0.0, 0.0, 0.5),
           {Vec3(1.0, 0.2, 0.0), Vec3::Zero()});
  yard.add(scenes::ball(2.0), collision::Sphere{0.5}, Vec3(0.0, 4.0, 1.2),
           {Vec3(0.5, 0.0, 0.0), Vec3(0.0, 6.0, 1.0)});
  yard.add(scenes::box(1.0, Vec3::Ones()), collision::Box{Vec3::Constant(0.5)},
           Vec3(0.0, -4.0, 0.5), {Vec3(1.0, 0.5, 0.0), Vec3::Zero()});
  return event_answers("events, friction", yard);
}

// ---- collision

using collision::testing::ShapeKind;

constexpr ShapeKind kShapes[] = {ShapeKind::kSphere,   ShapeKind::kBox,  ShapeKind::kCapsule,
                                 ShapeKind::kCylinder, ShapeKind::kCone, ShapeKind::kEllipsoid,
                                 ShapeKind::kHull};

FixedAnswers contact_answers() {
  FixedAnswers answers{.part = "contact sets", .bound = kOfOneAnswer};
  collision::testing::Random random(11);
  std::vector<Contact> contacts;
  for (const ShapeKind a : kShapes) {
    for (const ShapeKind b : kShapes) {
      for (int k = 0; k < 3; ++k) {
        const auto pair = collision::testing::random_pair(
            random, a, b, static_cast<collision::testing::Placement>(k));
        collision::find_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b, 0.1 * pair.size,
                                     contacts);
        answers.choices.push_back(std::ssize(contacts));
        for (const Contact& contact : contacts) {
          answers.choices.push_back(static_cast<std::int64_t>(contact.feature_id));
          add(contact.normal, answers.numbers);
          answers.numbers.push_back(contact.gap / pair.size);
        }
      }
    }
  }
  return answers;
}

FixedAnswers contact_time_answers() {
  FixedAnswers answers{.part = "contact times", .bound = kOfOneAnswer};
  collision::testing::Random random(13);
  for (const ShapeKind a : kShapes) {
    for (const ShapeKind b : kShapes) {
      for (int k = 0; k < 3; ++k) {
        const auto flight = collision::testing::random_throw(random, a, b, 1.0);
        const std::optional<double> time =
            collision::contact_time(flight.pair.a, flight.a, flight.pair.b, flight.b, 1.0);
        answers.choices.push_back(time.has_value() ? 1 : 0);
        answers.numbers.push_back(time.value_or(1.0));
      }
    }
  }
  return answers;
}

}  // namespace

std::vector<FixedAnswers> fixed_answers(int threads) {
  std::vector<FixedAnswers> all;
  add_solvers(all);
  all.push_back(sweeps_on_threads(threads));
  for (const ImpactLaw law :
       {ImpactLaw::kSequentialOnce, ImpactLaw::kSequentialRepeated, ImpactLaw::kNewton,
        ImpactLaw::kNotes, ImpactLaw::kPoisson, ImpactLaw::kReflections}) {
    all.push_back(impact_answers(law, 0.0));
  }
  for (const ImpactLaw law : {ImpactLaw::kNewton, ImpactLaw::kReflections}) {
    all.push_back(impact_answers(law, 0.4));
  }
  for (const Accuracy& accuracy :
       {Accuracy::preview(), Accuracy::game(), Accuracy::engineering(), Accuracy::reference()}) {
    all.push_back(step_answers(accuracy, threads));
  }
  all.push_back(event_answers());
  all.push_back(event_friction_answers());
  all.push_back(contact_answers());
  all.push_back(contact_time_answers());
  return all;
}

}  // namespace signorini::testing
