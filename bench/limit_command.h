#pragma once

#include <CLI/App.hpp>
#include <memory>

namespace signorini::bench {

/// `signorini-bench limit`: structures that stand by friction alone, a little above and below the
/// mu at which they must fall.
class LimitCommand {
 public:
  explicit LimitCommand(CLI::App& app);
  ~LimitCommand();
  [[nodiscard]] bool is_asked() const;
  /// @return the exit code: 0, or 1 if one did not stand or fall as it should.
  /// @throws std::exception for what cannot be run or written.
  [[nodiscard]] int run() const;

 private:
  struct Options;
  std::unique_ptr<Options> options_;
  CLI::App* command_;
};

}  // namespace signorini::bench
