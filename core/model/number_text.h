#pragma once

#include <Eigen/Core>
#include <cstdio>
#include <string>

namespace signorini {

/// A number as error messages show it: 9 significant digits, so that 1e-12 is not shown as 0.
[[nodiscard]] inline std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// "(1, 2, 3)".
[[nodiscard]] inline std::string number_text(const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::string text = "(";
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += (i > 0 ? ", " : "") + number_text(values[i]);
  }
  return text + ")";
}

}  // namespace signorini
