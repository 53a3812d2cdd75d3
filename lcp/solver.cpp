#include <signorini/lcp/number_text.h>
#include <signorini/lcp/ray.h>
#include <signorini/lcp/solver.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace signorini::lcp {

void start_result(Index n, Result& result) {
  result.status = Status::kNotRun;
  result.solver.clear();
  result.detail.clear();
  result.z.setConstant(n, Certificate::kNaN);
  result.w.setConstant(n, Certificate::kNaN);
  result.certificate = {};
  result.island_certificates.clear();
  result.island_of_row.clear();
  result.ray.resize(0);
  result.ray_bound = 0.0;
  result.statistics = {};
  result.attempts.clear();
}

void SolverSettings::validate() const {
  if (!(tolerance > 0.0 && tolerance < 1.0)) {
    throw std::invalid_argument("settings: tolerance: must be in (0, 1), got " +
                                number_text(tolerance));
  }
  if (max_iterations < -1) {
    throw std::invalid_argument(
        "settings: max_iterations: must be >= 0, or -1 for the default, got " +
        std::to_string(max_iterations));
  }
  if (!(time_limit > 0.0)) {
    throw std::invalid_argument("settings: time_limit: must be > 0 s, got " +
                                number_text(time_limit));
  }
}

Deadline::Deadline(double seconds) : start_(std::chrono::steady_clock::now()), seconds_(seconds) {}

double Deadline::elapsed_seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

bool Deadline::passed() const {
  return seconds_ < std::numeric_limits<double>::infinity() && elapsed_seconds() >= seconds_;
}

void Solver::certify(const Problem& problem, Result& result) {
  result.certificate =
      settings().quick_certificate
          ? certifier_.certify_quickly(problem, result.z, settings().tolerance, &result.w)
          : certifier_.certify(problem, result.z, &result.w);
}

/// The status is `ending` unless the certificate, or what there is of a ray, says more.
void Solver::judge_result(const Problem& problem, Status ending, Result& result) const {
  result.status = judge(result.certificate, settings().tolerance, ending);
  if (is_solved(result.status)) {
    result.ray.resize(0);
    return;
  }
  if (result.ray.size() > 0) {
    const RayVerdict verdict = judge_ray(problem, result.ray);
    result.status = verdict.status;
    result.ray_bound = verdict.bound;
  }
}

void Solver::certify_islands(const Problem& problem, Result& result) {
  islands_.find(problem);
  certifier_.certify_islands(problem, result.z, islands_, result.island_certificates);
  result.island_of_row = islands_.island;
}

/// The time limit on record is the one that held.
void Solver::record(const Problem& problem, double seconds, const Vector* warm_start,
                    Result& result) const {
  SolverSettings told = settings();
  told.time_limit =
      std::min(told.time_limit, std::max(seconds, std::numeric_limits<double>::min()));
  std::string said;
  try {
    said = settings().recorder->record({name(), told, problem, warm_start, result});
  } catch (const std::exception& error) {
    said = std::string("not recorded: ") + error.what();
  }
  if (!said.empty()) {
    result.detail += (result.detail.empty() ? "" : "; ") + said;
  }
}

void Solver::solve(const Problem& problem, Result& result, const Vector* warm_start) {
  solve_within(std::numeric_limits<double>::infinity(), problem, result, warm_start);
}

void Solver::solve_within(double seconds, const Problem& problem, Result& result,
                          const Vector* warm_start) {
  check_shapes(problem);
  settings().validate();
  const Index n = problem.size();
  if (warm_start != nullptr && warm_start->size() != n) {
    throw std::invalid_argument("warm_start: " + std::to_string(warm_start->size()) +
                                " numbers for a problem of " + std::to_string(n) + " rows");
  }
  if (const std::string why = refuses(problem); !why.empty()) {
    throw std::invalid_argument(std::string(name()) + ": " + why);
  }
  recycle(result.attempts);
  const Deadline deadline(std::min(settings().time_limit, seconds));
  start_result(n, result);
  result.solver = name();
  if (std::string bad = find_bad_value(problem); !bad.empty()) {
    result.status = Status::kInvalidInput;
    result.detail = std::move(bad);
  } else {
    const bool start_is_finite = warm_start == nullptr || warm_start->allFinite();
    const Status ending =
        n == 0 ? Status::kSolved
               : iterate(problem, start_is_finite ? warm_start : nullptr, deadline, result);
    if (!result.z.allFinite()) {
      result.z.setZero(n);
      result.detail += result.detail.empty() ? "" : "; ";
      result.detail += "the iterate was not finite: z = 0 instead";
    }
    n == 0 ? Solver::certify(problem, result) : certify(problem, result);  // iterate() has not run
    judge_result(problem, is_solved(ending) ? Status::kNumericalBreakdown : ending, result);
    if (settings().certify_islands) {
      certify_islands(problem, result);
    }
    if (!start_is_finite) {
      result.detail += result.detail.empty() ? "" : "; ";
      result.detail += "warm start not finite, not used";
    }
  }
  result.statistics.solve_seconds = deadline.elapsed_seconds();
  if (settings().recorder != nullptr) {
    record(problem, seconds, warm_start, result);
  }
}

}  // namespace signorini::lcp
