#pragma once

#include <CLI/App.hpp>
#include <memory>

namespace signorini::bench {

/// The studies of stepping: `signorini-bench work-precision` and `extremes`.
class SteppingCommand {
 public:
  explicit SteppingCommand(CLI::App& app);
  ~SteppingCommand();
  [[nodiscard]] bool is_asked() const;
  /// @return the exit code: 0, or 1 if a claim of the study was wrong.
  /// @throws std::exception for what cannot be run or written.
  [[nodiscard]] int run() const;

 private:
  struct Options;
  [[nodiscard]] int run_extremes() const;

  std::unique_ptr<Options> options_;
  CLI::App* work_precision_;
  CLI::App* extremes_;
};

}  // namespace signorini::bench
