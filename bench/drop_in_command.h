#pragma once

#include <CLI/App.hpp>
#include <memory>

namespace signorini::bench {

/// `signorini-bench drop-in`: Bullet's example scenes with Bullet's solver and with ours inside, in
/// one run.
class DropInCommand {
 public:
  explicit DropInCommand(CLI::App& app);
  ~DropInCommand();
  [[nodiscard]] bool is_asked() const;
  /// @return the exit code: 0, or 1 if an island of ours was not solved.
  /// @throws std::exception for what cannot be run or written.
  [[nodiscard]] int run() const;

 private:
  struct Options;
  std::unique_ptr<Options> options_;
  CLI::App* command_;
};

}  // namespace signorini::bench
