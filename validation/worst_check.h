#pragma once

#include <signorini/validation/report.h>

namespace signorini::validation {

/// error / tolerance: at most 1 passes. 0 / 0 is 0 (an exact value that had to be exact), anything
/// else over 0 is infinity, NaN stays NaN.
[[nodiscard]] double tolerance_ratio(const Check& check);

/// The check that stands for a scene in the front table: the failed one with the largest
/// error / tolerance (NaN counts as the largest), else the passed one with the largest, else the
/// first information-only check. nullptr if the scene has no check.
[[nodiscard]] const Check* worst_check(const SceneReport& scene);

/// Bullet's number beside a check: the first check of the scene with the same name and engine
/// "bullet", nullptr if there is none or the check is Bullet's own.
[[nodiscard]] const Check* bullets_counterpart(const SceneReport& scene, const Check& check);

}  // namespace signorini::validation
