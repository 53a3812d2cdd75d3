#include <signorini/c/signorini.h>

#include "byte_reader.h"
#include "lcp_bytes.h"
#include "plain_problem.h"
#include "stated_contacts.h"
#include "stated_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace signorini::testing {
namespace {

constexpr int kRoom = 64;  // numbers in every array: more than any plausible count reads

/// The handles, arrays to hand in, and what the handles were told.
struct Session {
  signorini_problem* problem = nullptr;
  signorini_solver* solver = nullptr;
  signorini_result* result = nullptr;
  signorini_contact_solver* contact_solver = nullptr;
  signorini_contact_result* contact_result = nullptr;
  std::array<double, kRoom> numbers{};
  std::array<double, kRoom> others{};
  std::array<std::int32_t, kRoom> indices{};
  std::array<std::int32_t, kRoom> starts{};
  PlainProblem stated;
  double tolerance = 1e-8;  // of the solver
  StatedContacts stated_contacts;

  Session() {
    require(signorini_problem_create(&problem) == 0 && signorini_result_create(&result) == 0 &&
                signorini_solver_create("auto", &solver) == 0 &&
                signorini_contact_solver_create(&contact_solver) == 0 &&
                signorini_contact_result_create(&contact_result) == 0,
            "handles are made");
    signorini_solver_set_number(solver, "max_iterations", 200);
    signorini_contact_solver_set_number(contact_solver, "max_iterations", 200);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() {
    signorini_contact_result_destroy(contact_result);
    signorini_contact_solver_destroy(contact_solver);
    signorini_result_destroy(result);
    signorini_solver_destroy(solver);
    signorini_problem_destroy(problem);
  }
};

void check(signorini_error error) {
  require(error != SIGNORINI_INTERNAL_ERROR, "no call ends in an internal error");
  require(error == SIGNORINI_OK || signorini_last_error()[0] != '\0', "an error has a text");
}

void fill(ByteReader& bytes, Session& s) {
  const int count = 1 + bytes.below(kRoom);
  int start = 0;
  for (int k = 0; k < kRoom; ++k) {
    s.numbers[k] = k < count ? bytes.number() : 1.0;
    s.others[k] = k < count ? bytes.number() : 0.0;
    s.indices[k] = bytes.byte() == 255 ? 1'000'000'000 : static_cast<int>(bytes.byte() % 8) - 1;
    s.starts[k] = bytes.byte() == 255 ? -1'000'000'000 : start;
    start += bytes.below(3);
  }
}

/// @return whether it was taken
bool taken(signorini_error error) {
  check(error);
  return error == SIGNORINI_OK;
}

void set_factored(ByteReader& bytes, std::int64_t n, std::int32_t kind, const double* q,
                  Session& s) {
  // Blocks of at most two rows: their numbers fit the room.
  std::array<std::int32_t, kRoom> sizes{};
  for (std::int32_t& size : sizes) {
    size = bytes.byte() >= 250 ? 1'000'000'000 : bytes.below(3);
  }
  const double* compliance = bytes.below(2) == 0 ? nullptr : s.others.data();
  const std::int64_t entries = bytes.count();
  const std::int64_t blocks = bytes.count();
  if (taken(signorini_problem_set_factored(s.problem, n, entries, s.starts.data(), s.indices.data(),
                                           s.numbers.data(), blocks, sizes.data(), kind,
                                           s.numbers.data(), compliance, q))) {
    s.stated =
        stated_factored(static_cast<int>(n), s.starts.data(), s.indices.data(), s.numbers.data(),
                        std::span(sizes).first(blocks), kind, s.numbers.data(), compliance, q);
  }
}

void set_problem(ByteReader& bytes, Session& s) {
  const std::int64_t n = bytes.count();
  const auto rows = static_cast<int>(n);
  const std::int32_t order = bytes.below(3);
  const double* q = bytes.byte() == 255 ? nullptr : s.others.data();
  switch (bytes.below(3)) {
    case 0:
      if (taken(signorini_problem_set_dense(s.problem, n, order, s.numbers.data(), q))) {
        s.stated = stated_dense(rows, order, s.numbers.data(), q);
      }
      break;
    case 1:
      if (taken(signorini_problem_set_sparse(s.problem, n, order, bytes.count(), s.starts.data(),
                                             s.indices.data(), s.numbers.data(), q))) {
        s.stated =
            stated_sparse(rows, order, s.starts.data(), s.indices.data(), s.numbers.data(), q);
      }
      break;
    default: set_factored(bytes, n, order, q, s); break;
  }
}

void set_bounds(ByteReader& bytes, Session& s) {
  const std::int64_t n = bytes.count();
  const double* lower = bytes.below(2) == 0 ? nullptr : s.others.data();
  const double* upper = bytes.below(2) == 0 ? nullptr : s.numbers.data();
  if (taken(signorini_problem_set_bounds(s.problem, n, lower, upper))) {
    for (int i = 0; i < s.stated.n; ++i) {
      s.stated.lower[i] = lower == nullptr ? 0.0 : lower[i];
      s.stated.upper[i] = upper == nullptr ? std::numeric_limits<double>::infinity() : upper[i];
    }
  }
}

void set_limits(ByteReader& bytes, Session& s) {
  const std::int64_t count = bytes.count();
  if (taken(signorini_problem_set_limits(s.problem, count, s.indices.data(), s.starts.data(),
                                         s.numbers.data()))) {
    s.stated.limits.clear();
    for (std::int64_t k = 0; k < count; ++k) {
      s.stated.limits.push_back({s.indices[k], s.starts[k], s.numbers[k]});
    }
  }
}

void set_cones(ByteReader& bytes, Session& s) {
  const std::int64_t count = bytes.count();
  const std::int32_t law = bytes.below(3);
  if (const int dimension = bytes.below(4); dimension >= 2) {  // cones that can be
    for (int k = 0; k < kRoom; ++k) {
      s.starts[k] = dimension * k;
      s.indices[k] = dimension;
    }
  }
  if (taken(signorini_problem_set_cones(s.problem, count, s.starts.data(), s.indices.data(),
                                        s.numbers.data(), law))) {
    s.stated.cones.clear();
    for (std::int64_t k = 0; k < count; ++k) {
      s.stated.cones.push_back({s.starts[k], s.indices[k], s.numbers[k]});
    }
    s.stated.is_coulomb = law == SIGNORINI_COULOMB;
  }
}

void set_rows(ByteReader& bytes, Session& s) {
  switch (bytes.below(3)) {
    case 0: set_bounds(bytes, s); break;
    case 1: set_limits(bytes, s); break;
    default: set_cones(bytes, s); break;
  }
}

void judge_proof(const Session& s) {
  const double* ray = signorini_result_ray(s.result);
  require(ray != nullptr, "a proof comes with its ray");
  s.stated.judge_ray(ray, signorini_result_ray_bound(s.result));
}

void judge_answer(const Session& s) {
  const signorini_status status = signorini_result_status(s.result);
  signorini_certificate certificate{};
  check(signorini_result_certificate(s.result, &certificate, sizeof certificate));
  if (status == SIGNORINI_INFEASIBLE || status == SIGNORINI_NO_SOLUTION_BELOW) {
    judge_proof(s);
  }
  if (status != SIGNORINI_NOT_RUN && status != SIGNORINI_INVALID_INPUT) {
    s.stated.judge(signorini_result_z(s.result),
                   {.natural_residual = certificate.natural_residual,
                    .unit_free_residual = certificate.unit_free_residual,
                    .is_solved = status == SIGNORINI_SOLVED,
                    .is_to_rounding = status == SIGNORINI_SOLVED_TO_ROUNDING,
                    .tolerance = s.tolerance});
  }
}

void solve(ByteReader& bytes, Session& s) {
  const bool warm = bytes.below(2) == 1 && signorini_problem_size(s.problem) <= kRoom;
  const signorini_error error =
      signorini_solver_solve(s.solver, s.problem, warm ? s.others.data() : nullptr, s.result);
  check(error);
  if (error != SIGNORINI_OK) {
    return;
  }
  const std::int64_t n = signorini_result_size(s.result);
  require(n == signorini_problem_size(s.problem) && n == s.stated.n, "z has a number a row");
  judge_answer(s);
  signorini_attempt attempt{};
  for (std::int64_t k = 0; k <= signorini_result_attempt_count(s.result); ++k) {
    check(signorini_result_attempt(s.result, k, &attempt, sizeof attempt));
  }
}

void set_dial(ByteReader& bytes, Session& s) {
  constexpr std::array kPositions = {"preview", "game", "engineering", "reference", "1e-6",
                                     "",        "x"};
  const std::array kResiduals = {1e-2, 1e-4, 1e-8, 1e-13, 1e-6, std::nan(""), std::nan("")};
  const int number = bytes.below(static_cast<int>(kPositions.size()));
  if (taken(signorini_contact_solver_set_text(s.contact_solver, "accuracy", kPositions[number]))) {
    s.stated_contacts.residual = kResiduals[number];
  }
  check(signorini_contact_solver_set_number(s.contact_solver, "budget_work", bytes.number()));
}

void note_setting(std::string_view name, double value, StatedContacts& stated) {
  if (name == "tolerance") {
    stated.tolerance = value;
  } else if (name == "friction_model") {
    stated.friction_model = static_cast<signorini_friction_model>(value);
  } else if (name == "touching_tolerance") {
    stated.touching_tolerance = value;
  } else if (name == "restitution_threshold") {
    stated.restitution_threshold = value;
  }
}

void set_setting(ByteReader& bytes, Session& s) {
  constexpr std::array kNames = {"tolerance",       "max_iterations",     "time_limit",
                                 "certify_islands", "friction_model",     "pyramid_sides",
                                 "warm_start",      "touching_tolerance", "restitution_threshold",
                                 "no such thing"};
  const char* name = kNames[bytes.below(static_cast<int>(kNames.size()))];
  const double value = bytes.number();
  if (std::strcmp(name, "max_iterations") == 0 && !(value >= 0.0 && value <= 1000.0)) {
    return;  // an input has to end
  }
  if (taken(signorini_solver_set_number(s.solver, name, value)) &&
      std::string_view(name) == "tolerance") {
    s.tolerance = value;
  }
  if (taken(signorini_contact_solver_set_number(s.contact_solver, name, value))) {
    note_setting(name, value, s.stated_contacts);
  }
  if (std::strcmp(name, "no such thing") == 0) {  // so that other kept inputs mean what they meant
    set_dial(bytes, s);
  }
}

using Bodies = std::array<signorini_body, 8>;
using Contacts = std::array<signorini_contact, 8>;

/// Of any numbers, some that are taken: else few scenes of several bodies are.
void make_plausible(std::int64_t body_count, Bodies& bodies, Contacts& contacts) {
  const auto part = [](double number) {
    return std::isfinite(number) ? number - std::trunc(number) : 0.5;
  };
  const auto positive = [](double number) {
    return std::isfinite(number) ? 0.0625 + std::abs(number) : 1.0;
  };
  for (signorini_body& body : bodies) {
    body.kind %= SIGNORINI_FIXED + 1;
    body.mass = positive(body.mass);
    double square = 1.0;
    for (int k = 0; k < 3; ++k) {
      body.inertia[4 * k] = positive(body.inertia[0]);
      body.angular_velocity[k] = body.linear_velocity[(k + 1) % 3];
      body.orientation[k + 1] = part(body.position[k]);
      square += body.orientation[k + 1] * body.orientation[k + 1];
    }
    body.orientation[0] = 1.0;
    for (double& number : body.orientation) {
      number /= std::sqrt(square);
    }
  }
  const auto count = static_cast<int>(std::clamp<std::int64_t>(body_count, 2, 8));
  for (signorini_contact& contact : contacts) {
    contact.body_a = (contact.body_a + 1) % count;
    contact.body_b = (contact.body_a + 1 + (contact.body_b + 1) % (count - 1)) % count;
    double square = 0.0;
    for (int k = 0; k < 3; ++k) {
      contact.normal[k] = contact.normal[k] > 0.0 ? 1.0 : part(contact.point_a[k]);
      square += contact.normal[k] * contact.normal[k];
    }
    for (int k = 0; k < 3 && square > 0.0; ++k) {
      contact.normal[k] /= std::sqrt(square);
      contact.point_b[k] = contact.point_a[k] - contact.gap * contact.normal[k];
    }
    if (contact.feature_id % 4 == 3) {  // as a host that keeps its contacts for a while
      contact.point_b[contact.feature_id % 3] += 0.0625;
    }
    contact.friction = std::abs(contact.friction);
    contact.restitution = std::min(std::abs(contact.restitution), 1.0);
  }
}

void solve_contacts(ByteReader& bytes, Session& s) {
  Bodies bodies{};
  for (signorini_body& body : bodies) {
    body.kind = bytes.below(4);
    body.mass = bytes.number();
    for (int k = 0; k < 3; ++k) {
      body.inertia[4 * k] = bytes.byte() == 255 ? bytes.number() : 1.0;
      body.position[k] = bytes.number();
      body.linear_velocity[k] = body.kind == SIGNORINI_FIXED ? 0.0 : bytes.number();
    }
    body.orientation[0] = bytes.byte() == 255 ? bytes.number() : 1.0;
  }
  Contacts contacts{};
  for (signorini_contact& contact : contacts) {
    contact.body_a = bytes.below(9) - 1;
    contact.body_b = bytes.below(9) - 1;
    for (int k = 0; k < 3; ++k) {
      contact.point_a[k] = contact.point_b[k] = bytes.number();
    }
    contact.normal[bytes.below(3)] = bytes.byte() == 255 ? bytes.number() : 1.0;
    contact.gap = bytes.number();
    contact.friction = bytes.number();
    contact.restitution = bytes.below(2) == 0 ? 0.0 : bytes.number();
    contact.allowance = bytes.below(2) == 0 ? std::nan("") : bytes.number();
    contact.feature_id = bytes.byte();
  }
  const std::int64_t body_count = bytes.count();
  const std::int64_t contact_count = bytes.count();
  const double step = bytes.byte() == 255 ? bytes.number() : 0.01;
  if (bytes.below(2) == 1) {
    make_plausible(body_count, bodies, contacts);
  }
  const signorini_error error =
      signorini_contact_solver_solve(s.contact_solver, step, body_count, bodies.data(),
                                     contact_count, contacts.data(), s.contact_result);
  check(error);
  if (error == SIGNORINI_OK) {
    require(signorini_contact_result_body_count(s.contact_result) == body_count &&
                signorini_contact_result_contact_count(s.contact_result) == contact_count,
            "every body and contact has its numbers");
    const std::string accuracy = signorini_contact_result_accuracy(s.contact_result);
    require(!accuracy.empty() || signorini_contact_result_work(s.contact_result) == 0.0,
            "work is counted with the dial");
    StatedContacts stated = s.stated_contacts;
    stated.bodies = std::span(bodies).first(body_count);
    stated.contacts = std::span(contacts).first(contact_count);
    stated.step = step;
    stated.friction_model = accuracy.empty() ? stated.friction_model : SIGNORINI_CONE;
    stated.judge(s.contact_result);
  }
}

}  // namespace

void judge_c_bytes(const std::uint8_t* data, std::size_t size) {
  ByteReader bytes(data, size);
  Session session;
  for (int calls = 0; calls < 32 && !bytes.at_end(); ++calls) {
    switch (bytes.below(6)) {
      case 0: fill(bytes, session); break;
      case 1: set_problem(bytes, session); break;
      case 2: set_rows(bytes, session); break;
      case 3: set_setting(bytes, session); break;
      case 4: solve_contacts(bytes, session); break;
      default: solve(bytes, session); break;
    }
  }
}

}  // namespace signorini::testing
