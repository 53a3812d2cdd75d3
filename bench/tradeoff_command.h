#pragma once

#include <CLI/App.hpp>
#include <memory>

namespace signorini::bench {

/// The command `signorini-bench tradeoff`.
class TradeoffCommand {
 public:
  explicit TradeoffCommand(CLI::App& app);
  ~TradeoffCommand();
  [[nodiscard]] bool is_asked() const;
  /// @return the exit code: 0, 1 if one of our solvers was wrong or crashed, 130 if interrupted
  ///   (what was measured is written).
  /// @throws std::exception for what cannot be run or written.
  [[nodiscard]] int run() const;

 private:
  struct Options;
  std::unique_ptr<Options> options_;
  CLI::App* command_;
};

}  // namespace signorini::bench
