#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

namespace signorini::lcp {

/// Writes a file whole or not at all: the text goes to a new file beside it (the same name with
/// ".partial-" and the process id), which is renamed over the old one once all of it is written.
/// Interrupt, hang-up and termination signals wait meanwhile, so that Ctrl-C leaves nothing behind.
///
/// @throws std::runtime_error naming the file and the system's reason. The file is then as it was
///   before, and nothing is left beside it.
void write_whole_file(const std::filesystem::path& file, std::string_view text);

/// Holds back interrupt, hang-up and termination signals in this thread while it lives.
class SignalsHeld {
 public:
  SignalsHeld();
  ~SignalsHeld();
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  struct Mask;
  std::unique_ptr<Mask> previous_;
};

/// A name beside `file` that no other process uses.
[[nodiscard]] std::filesystem::path partial_name(const std::filesystem::path& file);

}  // namespace signorini::lcp
