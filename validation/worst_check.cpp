#include <signorini/validation/worst_check.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::validation {
namespace {

int severity(Verdict verdict) {
  switch (verdict) {
    case Verdict::kFail: return 2;
    case Verdict::kPass: return 1;
    case Verdict::kInformation: return 0;
  }
  return 0;
}

bool is_worse(const Check& left, const Check& right) {
  const int difference = severity(left.judged()) - severity(right.judged());
  if (difference != 0) return difference > 0;
  if (left.judged() == Verdict::kInformation) return false;
  const double left_ratio = tolerance_ratio(left);
  const double right_ratio = tolerance_ratio(right);
  if (std::isnan(left_ratio)) return !std::isnan(right_ratio);
  return left_ratio > right_ratio;
}

}  // namespace

double tolerance_ratio(const Check& check) {
  if (check.error == 0.0 && check.tolerance == 0.0) return 0.0;
  if (std::isnan(check.error) || std::isnan(check.tolerance)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  // A negative tolerance is met by no error; a tolerance of 0 by 0 alone.
  if (check.tolerance <= 0.0) return std::numeric_limits<double>::infinity();
  return check.error / check.tolerance;
}

const Check* worst_check(const SceneReport& scene) {
  const Check* worst = nullptr;
  for (const Check& check : scene.checks) {
    if (worst == nullptr || is_worse(check, *worst)) worst = &check;
  }
  return worst;
}

const Check* bullets_counterpart(const SceneReport& scene, const Check& check) {
  if (check.engine == "bullet") return nullptr;
  const auto found =
      std::find_if(scene.checks.begin(), scene.checks.end(), [&check](const Check& other) {
        return other.engine == "bullet" && other.name == check.name;
      });
  return found == scene.checks.end() ? nullptr : &*found;
}

}  // namespace signorini::validation
