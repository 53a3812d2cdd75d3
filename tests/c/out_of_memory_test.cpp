// Memory ends at every single allocation of a call, and stays gone until the call returns: the call
// says so, nothing is lost, and the next one gives the bits that it gives otherwise.
#include <signorini/c/signorini.h>

#include "tests/lcp/allocation_count.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <malloc.h>
#include <memory>
#include <string>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>

namespace {

using signorini::lcp::NoMemoryAfter;

/// Two masses hang between stops: rows of a factored matrix, one with a coupled limit.
struct Rows {
  std::array<std::int32_t, 4> start{0, 2, 4, 5};
  std::array<std::int32_t, 5> column{0, 1, 0, 1, 1};
  std::array<double, 5> value{1.0, -1.0, 0.5, 1.0, 1.0};
  std::array<std::int32_t, 2> block_size{1, 1};
  std::array<double, 2> inverse_mass{1.0, 2.0};
  std::array<double, 3> q{-1.0, -2.0, 0.5};
  std::array<double, 9> dense{3.0, -1.0, 0.5, -1.0, 2.0, 0.25, 0.5, 0.25, 1.0};
};

/// Calls with ever more memory until it suffices. Each failure must be OUT_OF_MEMORY.
/// @return how often memory was too little
int fails_until_enough(const std::function<signorini_error()>& call) {
  for (int allowed = 0; allowed < 100'000; ++allowed) {
    signorini_error error = SIGNORINI_OK;
    {
      const NoMemoryAfter scarce(allowed);
      error = call();
    }
    if (error == SIGNORINI_OK) {
      return allowed;
    }
    EXPECT_EQ(error, SIGNORINI_OUT_OF_MEMORY) << allowed << ": " << signorini_last_error();
    if (error != SIGNORINI_OUT_OF_MEMORY) {
      return -1;
    }
  }
  ADD_FAILURE() << "no memory suffices";
  return -1;
}

class OutOfMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (!NoMemoryAfter::kWorks) {
      GTEST_SKIP() << "the sanitizers own malloc";
    }
    ASSERT_EQ(signorini_problem_create(&problem_), SIGNORINI_OK);
    ASSERT_EQ(signorini_result_create(&result_), SIGNORINI_OK);
  }
  void TearDown() override {
    signorini_result_destroy(result_);
    signorini_problem_destroy(problem_);
  }
  signorini_error set_dense() {
    return signorini_problem_set_dense(problem_, 3, SIGNORINI_COLUMN_MAJOR, rows_.dense.data(),
                                       rows_.q.data());
  }
  signorini_error set_sparse() {
    static constexpr std::array<std::int32_t, 4> kStart{0, 3, 6, 9};
    static constexpr std::array<std::int32_t, 9> kIndex{0, 1, 2, 0, 1, 2, 0, 1, 2};
    return signorini_problem_set_sparse(problem_, 3, SIGNORINI_COLUMN_MAJOR, 9, kStart.data(),
                                        kIndex.data(), rows_.dense.data(), rows_.q.data());
  }
  signorini_error set_factored() {
    return signorini_problem_set_factored(problem_, 3, 5, rows_.start.data(), rows_.column.data(),
                                          rows_.value.data(), 2, rows_.block_size.data(),
                                          SIGNORINI_INVERSE_MASS, rows_.inverse_mass.data(),
                                          nullptr, rows_.q.data());
  }
  /// z of a solve with a new solver, memory enough.
  std::vector<double> answer(const char* name) {
    signorini_solver* solver = nullptr;
    EXPECT_EQ(signorini_solver_create(name, &solver), SIGNORINI_OK);
    const signorini_error error = signorini_solver_solve(solver, problem_, nullptr, result_);
    signorini_solver_destroy(solver);
    if (error != SIGNORINI_OK) {
      return {};
    }
    const double* z = signorini_result_z(result_);
    return {z, z + signorini_result_size(result_)};
  }

  Rows rows_;
  signorini_problem* problem_ = nullptr;
  signorini_result* result_ = nullptr;
};

TEST_F(OutOfMemory, AProblemKeepsWhatItHad) {
  ASSERT_EQ(set_dense(), SIGNORINI_OK);
  const std::vector<double> before = answer("lemke");
  ASSERT_EQ(before.size(), 3u);
  for (const auto& call :
       {std::function([&] { return set_dense(); }), std::function([&] { return set_sparse(); }),
        std::function([&] { return set_factored(); })}) {
    ASSERT_EQ(set_dense(), SIGNORINI_OK);
    {
      const NoMemoryAfter scarce(1);
      EXPECT_EQ(call(), SIGNORINI_OUT_OF_MEMORY);
    }
    EXPECT_EQ(answer("lemke"), before);
    EXPECT_GT(fails_until_enough(call), 1);
    EXPECT_EQ(signorini_problem_size(problem_), 3);
  }
}

TEST_F(OutOfMemory, EverySolverSaysSoAndSolvesTheNextTime) {
  ASSERT_EQ(set_factored(), SIGNORINI_OK);
  int tried = 0;
  for (const char* const* name = signorini_solver_names(); *name != nullptr; ++name) {
    SCOPED_TRACE(*name);
    if (std::string(*name) == "exact") {
      continue;  // GMP ends the process
    }
    const std::vector<double> expected = answer(*name);
    if (expected.empty()) {
      continue;  // this form is not for it
    }
    ++tried;
    signorini_solver* solver = nullptr;
    EXPECT_GE(fails_until_enough([&] { return signorini_solver_create(*name, &solver); }), 1);
    const int failures = fails_until_enough([&] {
      const signorini_error error = signorini_solver_solve(solver, problem_, nullptr, result_);
      EXPECT_TRUE(error == SIGNORINI_OK || signorini_result_status(result_) == SIGNORINI_NOT_RUN);
      return error;
    });
    EXPECT_GT(failures, 0);
    const double* z = signorini_result_z(result_);
    EXPECT_EQ(std::vector<double>(z, z + signorini_result_size(result_)), expected);
    signorini_solver_destroy(solver);
  }
  EXPECT_GT(tried, 10);
}

/// This process may take so many bytes more than it has, while it lives.
class AddressSpace {
 public:
  explicit AddressSpace(std::uint64_t more) {
    malloc_trim(0);  // what was freed and kept would do for the next
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    getrlimit(RLIMIT_AS, &before_);
    rlimit small = before_;
    small.rlim_cur = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + more;
    setrlimit(RLIMIT_AS, &small);
  }
  ~AddressSpace() { setrlimit(RLIMIT_AS, &before_); }
  AddressSpace(const AddressSpace&) = delete;
  AddressSpace& operator=(const AddressSpace&) = delete;

 private:
  rlimit before_{};
};

/// The sparse LU of the Newton methods takes tens of megabytes here.
TEST_F(OutOfMemory, ASparseFactorisationThatDoesNotFitSaysSo) {
  constexpr int kRows = 20000;
  constexpr int kNear[] = {0, 1, 2};  // not symmetric, and little fill: see require_memory_of_lu()
  std::vector<std::int32_t> start{0};
  std::vector<std::int32_t> index;
  std::vector<double> value;
  const std::vector<double> q(kRows, -1.0);
  for (int j = 0; j < kRows; ++j) {
    for (const int near : kNear) {
      if (j + near < kRows) {
        index.push_back(j + near);
        value.push_back(near == 0 ? 4.0 : -1.0);
      }
    }
    start.push_back(static_cast<std::int32_t>(index.size()));
  }
  ASSERT_EQ(signorini_problem_set_sparse(problem_, kRows, SIGNORINI_COLUMN_MAJOR,
                                         static_cast<std::int64_t>(index.size()), start.data(),
                                         index.data(), value.data(), q.data()),
            SIGNORINI_OK);
  for (const char* name : {"alart-curnier", "interior-point"}) {
    SCOPED_TRACE(name);
    int failures = 0;
    signorini_error error = SIGNORINI_OUT_OF_MEMORY;
    for (std::uint64_t more = 0; error != SIGNORINI_OK && more < (1u << 30); more += 1u << 20) {
      signorini_solver* solver = nullptr;
      ASSERT_EQ(signorini_solver_create(name, &solver), SIGNORINI_OK);
      {
        const AddressSpace scarce(more);
        error = signorini_solver_solve(solver, problem_, nullptr, result_);
      }
      signorini_solver_destroy(solver);
      EXPECT_TRUE(error == SIGNORINI_OK || error == SIGNORINI_OUT_OF_MEMORY) << more;
      failures += error == SIGNORINI_OUT_OF_MEMORY ? 1 : 0;
    }
    EXPECT_GT(failures, 0);
    EXPECT_EQ(error, SIGNORINI_OK);
    EXPECT_TRUE(signorini_is_solved(signorini_result_status(result_)));
  }
}

TEST_F(OutOfMemory, ContactsAreSolvedTheNextTime) {
  // Two balls fall, one on the other, on fixed ground.
  std::array<signorini_body, 3> bodies{};
  std::array<signorini_contact, 2> contacts{};
  for (int k = 0; k < 3; ++k) {
    bodies[k].kind = k == 0 ? SIGNORINI_FIXED : SIGNORINI_DYNAMIC;
    bodies[k].mass = 1.0 + k;
    bodies[k].inertia[0] = bodies[k].inertia[4] = bodies[k].inertia[8] = 0.4;
    bodies[k].orientation[0] = 1.0;
    bodies[k].position[2] = k - 0.5;
    if (k > 0) {
      bodies[k].linear_velocity[0] = 0.5;
      bodies[k].linear_velocity[2] = -k;
    }
  }
  for (int k = 0; k < 2; ++k) {
    contacts[k].body_a = k + 1;
    contacts[k].body_b = k;
    contacts[k].point_a[2] = contacts[k].point_b[2] = k;
    contacts[k].normal[2] = 1.0;
    contacts[k].friction = 0.3;
    contacts[k].allowance = 0.0;
    contacts[k].feature_id = static_cast<std::uint64_t>(k);
  }
  signorini_contact_solver* solver = nullptr;
  signorini_contact_result* result = nullptr;
  ASSERT_EQ(signorini_contact_result_create(&result), SIGNORINI_OK);
  EXPECT_GE(fails_until_enough([&] { return signorini_contact_solver_create(&solver); }), 1);
  const auto solve = [&] {
    return signorini_contact_solver_solve(solver, 0.01, 3, bodies.data(), 2, contacts.data(),
                                          result);
  };
  EXPECT_GT(fails_until_enough(solve), 0);
  EXPECT_TRUE(signorini_is_solved(signorini_contact_result_status(result)));
  const double* impulses = signorini_contact_result_impulses(result);
  const std::vector<double> starved(impulses, impulses + 6);
  signorini_contact_solver* fresh = nullptr;
  ASSERT_EQ(signorini_contact_solver_create(&fresh), SIGNORINI_OK);
  std::swap(solver, fresh);
  ASSERT_EQ(solve(), SIGNORINI_OK);
  impulses = signorini_contact_result_impulses(result);
  EXPECT_EQ(std::vector<double>(impulses, impulses + 6), starved);
  signorini_contact_solver_destroy(solver);
  signorini_contact_solver_destroy(fresh);
  signorini_contact_result_destroy(result);
}

}  // namespace
