#include <signorini/validation/report.h>

#include <algorithm>

namespace signorini::validation {

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass: return "pass";
    case Verdict::kFail: return "fail";
    case Verdict::kInformation: return "information";
  }
  return "unknown verdict";
}

Verdict judge(double error, double tolerance) {
  return error <= tolerance ? Verdict::kPass : Verdict::kFail;
}

Verdict Check::judged() const {
  return verdict == Verdict::kPass ? judge(error, tolerance) : verdict;
}

Verdict SceneReport::verdict() const {
  const auto any = [this](Verdict wanted) {
    return std::any_of(checks.begin(), checks.end(),
                       [wanted](const Check& check) { return check.judged() == wanted; });
  };
  if (any(Verdict::kFail)) return Verdict::kFail;
  return any(Verdict::kPass) ? Verdict::kPass : Verdict::kInformation;
}

}  // namespace signorini::validation
