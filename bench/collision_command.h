#pragma once

#include <CLI/App.hpp>
#include <memory>

namespace signorini::bench {

/// The studies of collision detection: `signorini-bench contacts`, `contact-times`, `broad-phase`
/// and `narrow-phase`.
class CollisionCommand {
 public:
  explicit CollisionCommand(CLI::App& app);
  ~CollisionCommand();
  [[nodiscard]] bool is_asked() const;
  /// @return the exit code: 0, or 1 if an answer of ours was wrong.
  /// @throws std::exception for what cannot be run or written.
  [[nodiscard]] int run() const;

 private:
  struct Options;
  std::unique_ptr<Options> options_;
  CLI::App* contacts_;
  CLI::App* contact_times_;
  CLI::App* broad_phase_;
  CLI::App* narrow_phase_;
};

}  // namespace signorini::bench
