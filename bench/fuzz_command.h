#pragma once

#include <CLI/App.hpp>
#include <memory>

namespace signorini::bench {

/// The command `signorini-bench fuzz`.
class FuzzCommand {
 public:
  explicit FuzzCommand(CLI::App& app);
  ~FuzzCommand();
  [[nodiscard]] bool is_asked() const;
  /// @return the exit code: 0, 1 if anything was wrong, 70 in a build without GMP, 130 if
  /// interrupted. @throws std::exception for what cannot be run or written.
  [[nodiscard]] int run() const;

 private:
  struct Options;
  std::unique_ptr<Options> options_;
  CLI::App* command_;
};

}  // namespace signorini::bench
