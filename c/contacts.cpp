#include <signorini/core/response/contact_solver.h>
#include <signorini/lcp/number_text.h>

#include "guard.h"
#include "handles.h"
#include "settings.h"

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace signorini::c {
namespace {

constexpr int kMostSides = 256;
// The rows' numbers are counted by int: a contact has at most 258 rows of 12.
constexpr std::int64_t kMostContacts = std::numeric_limits<std::int32_t>::max() / (258 * 12);
constexpr std::int64_t kMostBodies = std::numeric_limits<std::int32_t>::max() / 36;

struct ContactSettings {
  NamedSettings named{.lcp = ContactSolverSettings{}.lcp, .recorder = {}};
  ContactSolverSettings solver;  // its lcp is named.lcp
  double touching_tolerance = 1e-6;
  double restitution_threshold = 0.0;

  void set_number(std::string_view name, double value);
  void set_text(std::string_view name, const std::string& value);
};

double not_negative(std::string_view name, double value) {
  if (!(value >= 0.0) || !std::isfinite(value)) {
    refuse("settings: " + std::string(name) + ": must be finite and >= 0, got " +
           lcp::number_text(value));
  }
  return value;
}

void ContactSettings::set_number(std::string_view name, double value) {
  if (name == "friction_model") {
    const int model = whole_number(name, value);
    if (model < SIGNORINI_PYRAMID || model > SIGNORINI_BOX) {
      refuse("settings: friction_model: must be 0, 1 or 2, got " + std::to_string(model));
    }
    solver.friction_model = static_cast<FrictionModel>(model);
  } else if (name == "pyramid_sides") {
    solver.pyramid_sides = whole_number(name, value);
    if (solver.pyramid_sides > kMostSides) {
      refuse("settings: pyramid_sides: must be at most 256, got " +
             std::to_string(solver.pyramid_sides));
    }
  } else if (name == "warm_start") {
    solver.warm_start = flag(name, value);
  } else if (name == "touching_tolerance") {
    touching_tolerance = not_negative(name, value);
  } else if (name == "restitution_threshold") {
    restitution_threshold = not_negative(name, value);
  } else if (name == "budget_work") {
    solver.budget.work = value;
  } else if (name == "budget_seconds") {
    solver.budget.seconds = value;
  } else if (name == "tolerance" || name == "max_iterations" || name == "time_limit" ||
             name == "quick_certificate") {
    named.set_number(name, value);
  } else {
    refuse("setting: \"" + std::string(name) +
           "\" is not known; known: tolerance, max_iterations, time_limit, quick_certificate, "
           "friction_model, pyramid_sides, warm_start, touching_tolerance, restitution_threshold, "
           "budget_work, budget_seconds");
  }
}

void ContactSettings::set_text(std::string_view name, const std::string& value) {
  if (name == "solver") {
    solver.solver = value;
  } else if (name == "dump") {
    named.set_text(name, value);
  } else if (name == "accuracy") {
    solver.accuracy = value.empty() ? std::nullopt : std::optional(Accuracy::named(value));
  } else {
    refuse("setting: \"" + std::string(name) + "\" is not known; known: solver, dump, accuracy");
  }
}

Vec3 vec3(const double* values) {
  return {values[0], values[1], values[2]};
}

static_assert(static_cast<int>(BodyKind::kDynamic) == SIGNORINI_DYNAMIC &&
              static_cast<int>(BodyKind::kKinematic) == SIGNORINI_KINEMATIC &&
              static_cast<int>(BodyKind::kFixed) == SIGNORINI_FIXED);
static_assert(static_cast<int>(FrictionModel::kPyramid) == SIGNORINI_PYRAMID &&
              static_cast<int>(FrictionModel::kCone) == SIGNORINI_CONE &&
              static_cast<int>(FrictionModel::kBox) == SIGNORINI_BOX);
static_assert(sizeof(signorini_body) == 192 && sizeof(signorini_contact) == 120 &&
              sizeof(signorini_island) == 40);

/// The caller's bodies as ours. Momenta follow from the velocities, so the bodies are checked
/// first.
void read_bodies(std::int64_t count, const signorini_body* given, Bodies& bodies, State& state) {
  bodies.reserve(count);
  state.reserve(count);
  for (std::int64_t k = 0; k < count; ++k) {
    const signorini_body& from = given[k];
    const std::string number = "bodies[" + std::to_string(k) + "]";
    if (from.kind < SIGNORINI_DYNAMIC || from.kind > SIGNORINI_FIXED) {
      refuse(number + ": kind: must be 0, 1 or 2, got " + std::to_string(from.kind));
    }
    Body body;
    body.kind = static_cast<BodyKind>(from.kind);
    body.mass = from.mass;
    body.inertia = Eigen::Map<const Mat3>(from.inertia);
    body.name = number;
    validate(body);
    BodyState at;
    at.x = vec3(from.position);
    at.q = Quat(from.orientation[0], from.orientation[1], from.orientation[2], from.orientation[3]);
    const Velocity velocity{vec3(from.linear_velocity), vec3(from.angular_velocity)};
    if (body.kind == BodyKind::kFixed &&
        !(velocity.linear.isZero(0.0) && velocity.angular.isZero(0.0))) {
      refuse(number + ": a fixed body must have velocity 0");
    }
    set_velocity(body, velocity, at);
    bodies.push_back(std::move(body));
    state.push_back(at);
  }
}

ContactSet read_contacts(std::int64_t count, const signorini_contact* given) {
  ContactSet contacts(count);
  for (std::int64_t k = 0; k < count; ++k) {
    const signorini_contact& from = given[k];
    Contact& contact = contacts[k];
    contact.body_a = from.body_a;
    contact.body_b = from.body_b;
    contact.point_a = vec3(from.point_a);
    contact.point_b = vec3(from.point_b);
    contact.normal = vec3(from.normal);
    contact.gap = from.gap;
    contact.material = {.friction = from.friction, .restitution = from.restitution};
    contact.feature_id = from.feature_id;
  }
  return contacts;
}

}  // namespace
}  // namespace signorini::c

struct signorini_contact_solver {
  signorini::c::ContactSettings settings;
  std::unique_ptr<signorini::ContactSolver> solver;  // null: to be made
};

struct signorini_contact_result {
  signorini::ContactSolution solution;
  std::vector<double> velocities;  // 6 a body
  std::vector<double> impulses;    // 3 a contact
};

using namespace signorini::c;
namespace lcp = signorini::lcp;

namespace {

const signorini_contact_result kNone;  // what getters answer to null

const signorini_contact_result& result_of(const signorini_contact_result* handle) {
  return handle == nullptr ? kNone : *handle;
}

std::unique_ptr<signorini::ContactSolver> make(const ContactSettings& settings) {
  signorini::ContactSolverSettings told = settings.solver;
  told.lcp = settings.named.lcp;
  return std::make_unique<signorini::ContactSolver>(told);
}

/// The settings with one of them changed. What was remembered for a warm start is forgotten.
template <typename Change>
signorini_error change_settings(signorini_contact_solver* solver, const char* setting,
                                Change change) noexcept {
  return guard([&] {
    require(solver, "solver");
    require(setting, "setting");
    ContactSettings changed = solver->settings;
    change(changed);
    std::unique_ptr<signorini::ContactSolver> made = make(changed);
    solver->solver = std::move(made);
    solver->settings = std::move(changed);
  });
}

void solve(signorini_contact_solver& solver, double step, std::int64_t body_count,
           const signorini_body* given_bodies, std::int64_t contact_count,
           const signorini_contact* given_contacts, signorini_contact_result& result) {
  signorini::Bodies bodies;
  signorini::State state;
  read_bodies(body_count, given_bodies, bodies, state);
  validate(bodies, state);
  const signorini::ContactSet contacts = read_contacts(contact_count, given_contacts);
  validate(contacts, static_cast<int>(bodies.size()));
  check_dynamic(bodies, contacts);
  lcp::Vector allowance =
      allowances(bodies, state, contacts, step, solver.settings.touching_tolerance,
                 solver.settings.restitution_threshold);
  for (std::int64_t k = 0; k < contact_count; ++k) {
    if (!std::isnan(given_contacts[k].allowance)) {
      allowance[k] = given_contacts[k].allowance;
    }
  }

  signorini_contact_result fresh;
  solver.solver->solve(bodies, contacts, allowance, state, fresh.solution);
  fresh.velocities.reserve(6 * bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const signorini::Velocity v = velocity(bodies[k], state[k]);
    fresh.velocities.insert(fresh.velocities.end(), v.linear.begin(), v.linear.end());
    fresh.velocities.insert(fresh.velocities.end(), v.angular.begin(), v.angular.end());
  }
  fresh.impulses.reserve(3 * contacts.size());
  for (const signorini::Vec3& impulse : fresh.solution.impulses) {
    fresh.impulses.insert(fresh.impulses.end(), impulse.begin(), impulse.end());
  }
  result = std::move(fresh);
}

}  // namespace

signorini_error signorini_contact_solver_create(signorini_contact_solver** solver) {
  return guard([&] {
    require(solver, "solver");
    *solver = nullptr;
    auto made = std::make_unique<signorini_contact_solver>();
    made->solver = make(made->settings);
    *solver = made.release();
  });
}

void signorini_contact_solver_destroy(signorini_contact_solver* solver) {
  delete solver;
}

signorini_error signorini_contact_solver_set_number(signorini_contact_solver* solver,
                                                    const char* setting, double value) {
  return change_settings(solver, setting,
                         [&](ContactSettings& settings) { settings.set_number(setting, value); });
}

signorini_error signorini_contact_solver_set_text(signorini_contact_solver* solver,
                                                  const char* setting, const char* value) {
  return change_settings(solver, setting, [&](ContactSettings& settings) {
    require(value, "value");
    settings.set_text(setting, value);
  });
}

signorini_error signorini_contact_result_create(signorini_contact_result** result) {
  return guard([&] {
    require(result, "result");
    *result = nullptr;
    *result = new signorini_contact_result;
  });
}

void signorini_contact_result_destroy(signorini_contact_result* result) {
  delete result;
}

signorini_error signorini_contact_solver_solve(signorini_contact_solver* solver, double step,
                                               int64_t body_count, const signorini_body* bodies,
                                               int64_t contact_count,
                                               const signorini_contact* contacts,
                                               signorini_contact_result* result) {
  return guard([&] {
    require(solver, "solver");
    require(result, "result");
    if (!(step > 0.0) || !std::isfinite(step)) {
      refuse("step: must be finite and > 0, got " + lcp::number_text(step) + " s");
    }
    require_count(body_count, kMostBodies, "body_count");
    require_count(contact_count, kMostContacts, "contact_count");
    require_array(bodies, body_count, "bodies");
    require_array(contacts, contact_count, "contacts");
    try {
      if (solver->solver == nullptr) {
        solver->solver = make(solver->settings);
      }
      solve(*solver, step, body_count, bodies, contact_count, contacts, *result);
    } catch (const std::invalid_argument&) {
      throw;  // thrown before anything was changed
    } catch (...) {
      solver->solver.reset();  // whatever state its workspace was left in
      *result = {};
      throw;
    }
  });
}

signorini_status signorini_contact_result_status(const signorini_contact_result* result) {
  return to_c(result_of(result).solution.status);
}

const char* signorini_contact_result_detail(const signorini_contact_result* result) {
  return result_of(result).solution.detail.c_str();
}

int64_t signorini_contact_result_body_count(const signorini_contact_result* result) {
  return static_cast<std::int64_t>(result_of(result).velocities.size() / 6);
}

int64_t signorini_contact_result_contact_count(const signorini_contact_result* result) {
  return static_cast<std::int64_t>(result_of(result).solution.impulses.size());
}

const double* signorini_contact_result_velocities(const signorini_contact_result* result) {
  return result_of(result).velocities.data();
}

const double* signorini_contact_result_impulses(const signorini_contact_result* result) {
  return result_of(result).impulses.data();
}

const double* signorini_contact_result_normal_impulses(const signorini_contact_result* result) {
  return result_of(result).solution.normal_impulses.data();
}

double signorini_contact_result_energy_change(const signorini_contact_result* result) {
  return result_of(result).solution.energy_change;
}

signorini_error signorini_contact_result_certificate(const signorini_contact_result* result,
                                                     signorini_certificate* certificate,
                                                     size_t bytes) {
  return guard([&] {
    require(result, "result");
    copy_out(to_c(result->solution.result.certificate), certificate, bytes);
  });
}

signorini_error signorini_contact_result_statistics(const signorini_contact_result* result,
                                                    signorini_statistics* statistics,
                                                    size_t bytes) {
  return guard([&] {
    require(result, "result");
    copy_out(to_c(result->solution.result.statistics), statistics, bytes);
  });
}

const char* signorini_contact_result_accuracy(const signorini_contact_result* result) {
  return result_of(result).solution.accuracy.c_str();
}

double signorini_contact_result_work(const signorini_contact_result* result) {
  return result_of(result).solution.work;
}

int signorini_contact_result_is_deterministic(const signorini_contact_result* result) {
  return result_of(result).solution.is_deterministic ? 1 : 0;
}

int64_t signorini_contact_result_island_count(const signorini_contact_result* result) {
  return static_cast<std::int64_t>(result_of(result).solution.islands.size());
}

const int32_t* signorini_contact_result_island_of_contact(const signorini_contact_result* result) {
  return result_of(result).solution.island_of.data();
}

signorini_error signorini_contact_result_island(const signorini_contact_result* result,
                                                int64_t number, signorini_island* island,
                                                size_t bytes) {
  return guard([&] {
    require(result, "result");
    const auto& islands = result->solution.islands;
    const signorini::IslandReport& one = islands[checked_place(islands, number, "number")];
    copy_out(signorini_island{.unit_free_residual = one.unit_free_residual,
                              .bodies = one.bodies,
                              .contacts = one.contacts,
                              .rows = one.rows,
                              .status = to_c(one.status),
                              .residual = one.residual,
                              .work = one.work},
             island, bytes);
  });
}
