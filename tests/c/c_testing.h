#pragma once

#include <signorini/c/signorini.h>

#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <string>

namespace signorini::testing_tools {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr std::int64_t kHuge = 1'000'000'000;

/// A bad argument, of which the message says this.
inline void expect_refused(signorini_error error, const std::string& part) {
  EXPECT_EQ(error, SIGNORINI_INVALID_ARGUMENT);
  EXPECT_NE(std::string(signorini_last_error()).find(part), std::string::npos)
      << signorini_last_error();
}

}  // namespace signorini::testing_tools
