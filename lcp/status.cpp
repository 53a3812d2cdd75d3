#include <signorini/lcp/status.h>

namespace signorini::lcp {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::kNotRun: return "not run";
    case Status::kSolved: return "solved";
    case Status::kSolvedToRounding: return "solved to rounding";
    case Status::kInfeasible: return "infeasible";
    case Status::kNoSolutionBelow: return "no solution below Z";
    case Status::kRayUnproven: return "ray unproven";
    case Status::kIterationLimit: return "iteration limit";
    case Status::kTimeLimit: return "time limit";
    case Status::kStalled: return "stalled";
    case Status::kNumericalBreakdown: return "numerical breakdown";
    case Status::kInvalidInput: return "invalid input";
  }
  return "unknown status";
}

}  // namespace signorini::lcp
