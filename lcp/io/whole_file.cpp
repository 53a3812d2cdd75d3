#include <signorini/lcp/io/whole_file.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <unistd.h>

namespace signorini::lcp {

struct SignalsHeld::Mask {
  sigset_t set;
};

SignalsHeld::SignalsHeld() : previous_(std::make_unique<Mask>()) {
  sigset_t held;
  sigemptyset(&held);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    sigaddset(&held, signal);
  }
  pthread_sigmask(SIG_BLOCK, &held, &previous_->set);
}

SignalsHeld::~SignalsHeld() {
  pthread_sigmask(SIG_SETMASK, &previous_->set, nullptr);
}

std::filesystem::path partial_name(const std::filesystem::path& file) {
  std::filesystem::path name = file;
  name += ".partial-" + std::to_string(::getpid());
  return name;
}

void write_whole_file(const std::filesystem::path& file, std::string_view text) {
  const SignalsHeld held;
  const std::filesystem::path partial = partial_name(file);
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error)) {
    throw std::runtime_error(file.string() + ": not written: exists and is not a regular file");
  }
  errno = 0;
  std::ofstream stream(partial, std::ios::binary | std::ios::trunc);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) {
    error.assign(errno, std::generic_category());
  } else {
    std::filesystem::rename(partial, file, error);
  }
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw std::runtime_error(file.string() + ": not written: " + error.message());
  }
}

}  // namespace signorini::lcp
