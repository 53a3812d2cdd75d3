#pragma once

#include <string>

namespace signorini::lcp {

/// The shortest text that reads back as the same double, for messages: "1e-09", "nan", "0.1".
[[nodiscard]] std::string number_text(double value);

}  // namespace signorini::lcp
