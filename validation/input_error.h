#pragma once

#include <stdexcept>

namespace signorini::validation {

/// A scene that cannot be read or run: the message names the file, the model or link and the
/// element or field, its value and what was expected. Programs end with exit code 65.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace signorini::validation
