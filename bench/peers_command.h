#pragma once

#include <CLI/App.hpp>
#include <memory>

namespace signorini::bench {

/// The command `signorini-bench peers`.
class PeersCommand {
 public:
  explicit PeersCommand(CLI::App& app);
  ~PeersCommand();
  [[nodiscard]] bool is_asked() const;
  /// @return the exit code: 0, 1 if one of our solvers was wrong or crashed, 130 if interrupted.
  /// @throws std::exception for what cannot be run or written.
  [[nodiscard]] int run() const;

 private:
  struct Options;
  std::unique_ptr<Options> options_;
  CLI::App* command_;
};

/// The command `signorini-bench bullet-sets`. In a build without Bullet it says so.
class BulletSetsCommand {
 public:
  explicit BulletSetsCommand(CLI::App& app);
  ~BulletSetsCommand();
  [[nodiscard]] bool is_asked() const;
  /// @return the exit code: 0, 70 without Bullet, 130 if interrupted.
  [[nodiscard]] int run() const;

 private:
  struct Options;
  std::unique_ptr<Options> options_;
  CLI::App* command_;
};

}  // namespace signorini::bench
