#include <signorini/c/signorini.h>

#include "byte_reader.h"
#include "lcp_bytes.h"

#include <array>
#include <cmath>
#include <cstring>
#include <string>

namespace signorini::testing {
namespace {

constexpr int kRoom = 64;  // numbers in every array: more than any plausible count reads

/// The handles, and arrays to hand in.
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

  Session() {
    require(signorini_problem_create(&problem) == 0 && signorini_result_create(&result) == 0 &&
                signorini_solver_create("auto", &solver) == 0 &&
                signorini_contact_solver_create(&contact_solver) == 0 &&
                signorini_contact_result_create(&contact_result) == 0,
            "handles are made");
    signorini_solver_set_number(solver, "max_iterations", 200);
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

void set_problem(ByteReader& bytes, Session& s) {
  const std::int64_t n = bytes.count();
  const std::int32_t order = bytes.below(3);
  const double* q = bytes.byte() == 255 ? nullptr : s.others.data();
  switch (bytes.below(3)) {
    case 0: check(signorini_problem_set_dense(s.problem, n, order, s.numbers.data(), q)); break;
    case 1:
      check(signorini_problem_set_sparse(s.problem, n, order, bytes.count(), s.starts.data(),
                                         s.indices.data(), s.numbers.data(), q));
      break;
    default: {
      // Blocks of at most two rows: their numbers fit the room.
      std::array<std::int32_t, kRoom> sizes{};
      for (std::int32_t& size : sizes) {
        size = bytes.byte() >= 250 ? 1'000'000'000 : bytes.below(3);
      }
      const double* compliance = bytes.below(2) == 0 ? nullptr : s.others.data();
      check(signorini_problem_set_factored(s.problem, n, bytes.count(), s.starts.data(),
                                           s.indices.data(), s.numbers.data(), bytes.count(),
                                           sizes.data(), order, s.numbers.data(), compliance, q));
      break;
    }
  }
}

void set_rows(ByteReader& bytes, Session& s) {
  switch (bytes.below(3)) {
    case 0:
      check(signorini_problem_set_bounds(s.problem, bytes.count(),
                                         bytes.below(2) == 0 ? nullptr : s.others.data(),
                                         bytes.below(2) == 0 ? nullptr : s.numbers.data()));
      break;
    case 1:
      check(signorini_problem_set_limits(s.problem, bytes.count(), s.indices.data(),
                                         s.starts.data(), s.numbers.data()));
      break;
    default:
      check(signorini_problem_set_cones(s.problem, bytes.count(), s.starts.data(), s.indices.data(),
                                        s.numbers.data(), bytes.below(3)));
      break;
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
  require(n == signorini_problem_size(s.problem), "z has a number a row");
  signorini_certificate certificate{};
  check(signorini_result_certificate(s.result, &certificate, sizeof certificate));
  if (signorini_is_solved(signorini_result_status(s.result)) != 0) {
    require(certificate.natural_residual <= 1e-5 && certificate.unit_free_residual <= 1e-5,
            "what is solved has a small residual");
  }
  signorini_attempt attempt{};
  for (std::int64_t k = 0; k <= signorini_result_attempt_count(s.result); ++k) {
    check(signorini_result_attempt(s.result, k, &attempt, sizeof attempt));
  }
}

void set_dial(ByteReader& bytes, Session& s) {
  constexpr std::array kPositions = {"preview", "game", "engineering", "reference", "1e-6",
                                     "",        "x"};
  const char* position = kPositions[bytes.below(static_cast<int>(kPositions.size()))];
  check(signorini_contact_solver_set_text(s.contact_solver, "accuracy", position));
  check(signorini_contact_solver_set_number(s.contact_solver, "budget_work", bytes.number()));
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
  check(signorini_solver_set_number(s.solver, name, value));
  check(signorini_contact_solver_set_number(s.contact_solver, name, value));
  if (std::strcmp(name, "no such thing") == 0) {  // so that other kept inputs mean what they meant
    set_dial(bytes, s);
  }
}

void solve_contacts(ByteReader& bytes, Session& s) {
  std::array<signorini_body, 8> bodies{};
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
  std::array<signorini_contact, 8> contacts{};
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
  const signorini_error error = signorini_contact_solver_solve(
      s.contact_solver, bytes.byte() == 255 ? bytes.number() : 0.01, body_count, bodies.data(),
      contact_count, contacts.data(), s.contact_result);
  check(error);
  if (error == SIGNORINI_OK) {
    require(signorini_contact_result_body_count(s.contact_result) == body_count &&
                signorini_contact_result_contact_count(s.contact_result) == contact_count,
            "every body and contact has its numbers");
    const std::string accuracy = signorini_contact_result_accuracy(s.contact_result);
    require(!accuracy.empty() || signorini_contact_result_work(s.contact_result) == 0.0,
            "work is counted with the dial");
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
