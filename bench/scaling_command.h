#pragma once

#include <CLI/App.hpp>
#include <memory>

namespace signorini::bench {

/// `signorini-bench scaling`.
class ScalingCommand {
 public:
  explicit ScalingCommand(CLI::App& app);
  ~ScalingCommand();
  [[nodiscard]] bool is_asked() const;
  /// @return the exit code: 0, 1 if an answer was wrong or a count worse than the baseline's, 130
  /// if it was interrupted. @throws std::exception for what cannot be run, read or written
  [[nodiscard]] int run() const;

 private:
  struct Options;
  std::unique_ptr<Options> options_;
  CLI::App* command_;
};

}  // namespace signorini::bench
