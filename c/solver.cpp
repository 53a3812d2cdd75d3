#include "guard.h"
#include "handles.h"
#include "settings.h"

#include <array>
#include <memory>
#include <string>
#include <utility>

struct signorini_solver {
  std::string name;
  signorini::c::NamedSettings settings;
  std::unique_ptr<signorini::lcp::Solver> solver;  // null: to be made
};

namespace signorini::c {
namespace {

/// The solver's settings with one of them changed; its workspace is kept only if they are refused.
template <typename Change>
signorini_error change_settings(signorini_solver* solver, const char* setting,
                                Change change) noexcept {
  return guard([&] {
    require(solver, "solver");
    require(setting, "setting");
    NamedSettings changed = solver->settings;
    change(changed);
    std::unique_ptr<lcp::Solver> made = lcp::make_solver(solver->name, changed.lcp);
    solver->solver = std::move(made);
    solver->settings = std::move(changed);
  });
}

}  // namespace
}  // namespace signorini::c

using namespace signorini::c;
namespace lcp = signorini::lcp;

const char* const* signorini_solver_names(void) {
  static const std::array<const char*, 64> names = [] {
    std::array<const char*, 64> all{};  // names are literals, hence null-terminated
    const auto known = lcp::solver_names();
    for (std::size_t k = 0; k < known.size() && k + 1 < all.size(); ++k) {
      all[k] = known[k].data();
    }
    return all;
  }();
  return names.data();
}

signorini_error signorini_solver_create(const char* name, signorini_solver** solver) {
  return guard([&] {
    require(solver, "solver");
    *solver = nullptr;
    require(name, "name");
    auto made = std::make_unique<signorini_solver>();
    made->name = name;
    made->solver = lcp::make_solver(made->name, made->settings.lcp);
    *solver = made.release();
  });
}

void signorini_solver_destroy(signorini_solver* solver) {
  delete solver;
}

signorini_error signorini_solver_set_number(signorini_solver* solver, const char* setting,
                                            double value) {
  return change_settings(solver, setting,
                         [&](NamedSettings& settings) { settings.set_number(setting, value); });
}

signorini_error signorini_solver_set_text(signorini_solver* solver, const char* setting,
                                          const char* value) {
  return change_settings(solver, setting, [&](NamedSettings& settings) {
    require(value, "value");
    settings.set_text(setting, value);
  });
}

signorini_error signorini_solver_solve(signorini_solver* solver, const signorini_problem* problem,
                                       const double* warm_start, signorini_result* result) {
  return guard([&] {
    require(solver, "solver");
    require(problem, "problem");
    require(result, "result");
    if (solver->solver == nullptr) {
      solver->solver = lcp::make_solver(solver->name, solver->settings.lcp);
    }
    lcp::Vector start;
    if (warm_start != nullptr) {
      start = Eigen::Map<const lcp::Vector>(warm_start, problem->problem.size());
    }
    try {
      solver->solver->solve(problem->problem, result->result,
                            warm_start == nullptr ? nullptr : &start);
    } catch (const std::invalid_argument&) {
      throw;  // thrown before anything was changed
    } catch (...) {
      solver->solver.reset();  // whatever state its workspace was left in
      result->result = {};
      throw;
    }
  });
}
