#pragma once

#include <CLI/App.hpp>
#include <memory>

namespace signorini::bench {

/// The command `signorini-bench sequence`.
class SequenceCommand {
 public:
  explicit SequenceCommand(CLI::App& app);
  ~SequenceCommand();
  [[nodiscard]] bool is_asked() const;
  /// @return the exit code: 0, or 2 if a problem was not solved.
  /// @throws std::exception for what cannot be run, read or written.
  [[nodiscard]] int run() const;

 private:
  struct Options;
  std::unique_ptr<Options> options_;
  CLI::App* command_;
};

}  // namespace signorini::bench
