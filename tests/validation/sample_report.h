#pragma once

#include <signorini/validation/report.h>

namespace signorini::validation {

/// A report of 16 scenes made of closed forms and of invented errors, for the tests of the writer
/// and of the page: passes, a failure, a failure by NaN, information only, no checks at all, long
/// names, markup in texts, logarithmic plots with zeros and gaps, long series. Deterministic.
[[nodiscard]] Report sample_report();

}  // namespace signorini::validation
