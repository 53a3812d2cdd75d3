#include "guard.h"
#include "handles.h"

namespace signorini::c {

#define SIGNORINI_SAME_STATUS(ours, theirs) \
  static_assert(static_cast<int>(lcp::Status::ours) == static_cast<int>(theirs))
SIGNORINI_SAME_STATUS(kNotRun, SIGNORINI_NOT_RUN);
SIGNORINI_SAME_STATUS(kSolved, SIGNORINI_SOLVED);
SIGNORINI_SAME_STATUS(kSolvedToRounding, SIGNORINI_SOLVED_TO_ROUNDING);
SIGNORINI_SAME_STATUS(kInfeasible, SIGNORINI_INFEASIBLE);
SIGNORINI_SAME_STATUS(kNoSolutionBelow, SIGNORINI_NO_SOLUTION_BELOW);
SIGNORINI_SAME_STATUS(kRayUnproven, SIGNORINI_RAY_UNPROVEN);
SIGNORINI_SAME_STATUS(kIterationLimit, SIGNORINI_ITERATION_LIMIT);
SIGNORINI_SAME_STATUS(kTimeLimit, SIGNORINI_TIME_LIMIT);
SIGNORINI_SAME_STATUS(kStalled, SIGNORINI_STALLED);
SIGNORINI_SAME_STATUS(kNumericalBreakdown, SIGNORINI_NUMERICAL_BREAKDOWN);
SIGNORINI_SAME_STATUS(kInvalidInput, SIGNORINI_INVALID_INPUT);
#undef SIGNORINI_SAME_STATUS
static_assert(sizeof(signorini_certificate) == 80 && sizeof(signorini_statistics) == 48 &&
              sizeof(signorini_attempt) == 72);

signorini_status to_c(lcp::Status status) {
  return static_cast<signorini_status>(status);
}

signorini_certificate to_c(const lcp::Certificate& certificate) {
  return {.natural_residual = certificate.natural_residual,
          .unit_free_residual = certificate.unit_free_residual,
          .rounding_floor = certificate.rounding_floor,
          .natural_floor = certificate.natural_floor,
          .backward_error = certificate.backward_error,
          .min_z = certificate.min_z,
          .min_w = certificate.min_w,
          .complementarity = certificate.complementarity,
          .cone_violation = certificate.cone_violation,
          .worst_row = certificate.worst_row,
          .reserved = 0};
}

signorini_statistics to_c(const lcp::Statistics& statistics) {
  return {.iterations = statistics.iterations,
          .pivots = statistics.pivots,
          .factorizations = statistics.factorizations,
          .refinements = statistics.refinements,
          .factor_bytes = statistics.factor_bytes,
          .solve_seconds = statistics.solve_seconds};
}

namespace {

const lcp::Result kNone;  // what getters answer to null

const lcp::Result& result_of(const signorini_result* handle) {
  return handle == nullptr ? kNone : handle->result;
}

}  // namespace
}  // namespace signorini::c

using namespace signorini::c;
namespace lcp = signorini::lcp;

const char* signorini_status_text(signorini_status status) {
  if (status < SIGNORINI_NOT_RUN || status > SIGNORINI_INVALID_INPUT) {
    return "unknown status";
  }
  return lcp::to_string(static_cast<lcp::Status>(status)).data();  // a literal
}

int signorini_is_solved(signorini_status status) {
  return status == SIGNORINI_SOLVED || status == SIGNORINI_SOLVED_TO_ROUNDING ? 1 : 0;
}

signorini_error signorini_result_create(signorini_result** result) {
  return guard([&] {
    require(result, "result");
    *result = nullptr;
    *result = new signorini_result;
  });
}

void signorini_result_destroy(signorini_result* result) {
  delete result;
}

signorini_status signorini_result_status(const signorini_result* result) {
  return to_c(result_of(result).status);
}

const char* signorini_result_solver(const signorini_result* result) {
  return result_of(result).solver.c_str();
}

const char* signorini_result_detail(const signorini_result* result) {
  return result_of(result).detail.c_str();
}

int64_t signorini_result_size(const signorini_result* result) {
  return result_of(result).z.size();
}

const double* signorini_result_z(const signorini_result* result) {
  return result_of(result).z.data();
}

const double* signorini_result_w(const signorini_result* result) {
  return result_of(result).w.data();
}

const double* signorini_result_ray(const signorini_result* result) {
  const lcp::Vector& ray = result_of(result).ray;
  return ray.size() == 0 ? nullptr : ray.data();
}

double signorini_result_ray_bound(const signorini_result* result) {
  return result_of(result).ray_bound;
}

signorini_error signorini_result_certificate(const signorini_result* result,
                                             signorini_certificate* certificate, size_t bytes) {
  return guard([&] {
    require(result, "result");
    copy_out(to_c(result->result.certificate), certificate, bytes);
  });
}

signorini_error signorini_result_statistics(const signorini_result* result,
                                            signorini_statistics* statistics, size_t bytes) {
  return guard([&] {
    require(result, "result");
    copy_out(to_c(result->result.statistics), statistics, bytes);
  });
}

int64_t signorini_result_attempt_count(const signorini_result* result) {
  return static_cast<std::int64_t>(result_of(result).attempts.size());
}

signorini_error signorini_result_attempt(const signorini_result* result, int64_t number,
                                         signorini_attempt* attempt, size_t bytes) {
  return guard([&] {
    require(result, "result");
    const auto& attempts = result->result.attempts;
    const lcp::Attempt& one = attempts[checked_place(attempts, number, "number")];
    copy_out(signorini_attempt{.solver = one.solver.data(),
                               .reason = one.reason.data(),
                               .detail = one.detail.c_str(),
                               .natural_residual = one.natural_residual,
                               .unit_free_residual = one.unit_free_residual,
                               .solve_seconds = one.statistics.solve_seconds,
                               .iterations = one.statistics.iterations,
                               .pivots = one.statistics.pivots,
                               .status = to_c(one.status),
                               .reserved = 0},
             attempt, bytes);
  });
}

int64_t signorini_result_island_count(const signorini_result* result) {
  return static_cast<std::int64_t>(result_of(result).island_certificates.size());
}

const int32_t* signorini_result_island_of_row(const signorini_result* result) {
  const auto& islands = result_of(result).island_of_row;
  return islands.empty() ? nullptr : islands.data();
}

signorini_error signorini_result_island_certificate(const signorini_result* result, int64_t island,
                                                    signorini_certificate* certificate,
                                                    size_t bytes) {
  return guard([&] {
    require(result, "result");
    const auto& certificates = result->result.island_certificates;
    copy_out(to_c(certificates[checked_place(certificates, island, "island")]), certificate, bytes);
  });
}
