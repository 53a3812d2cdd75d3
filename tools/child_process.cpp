#include "tools/child_process.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <exception>
#include <fcntl.h>
#include <fstream>
#include <optional>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SIGNORINI_SANITIZED 1
#endif

namespace signorini::tools {
namespace {

using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t stopped = 0;

// What travels through the pipe: messages of one letter, a length and as many bytes; or, after
// kOutput, whatever a program prints, up to its end.
constexpr char kLoaded = 'l';
constexpr char kAnswer = 'a';
constexpr char kReason = 'r';
constexpr char kOutput = 'o';

std::system_error last_error(const char* what) {
  return std::system_error(errno, std::generic_category(), what);
}

/// A file descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }
  void close() {
    if (number_ >= 0) {
      ::close(number_);
      number_ = -1;
    }
  }

 private:
  int number_;
};

/// @return whether all of it could be written
bool write_all(int file, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t written = ::write(file, bytes, count);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      return false;
    }
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
  return true;
}

/// From a child, which ends if nobody listens.
void write_message(int pipe, char kind, std::string_view bytes) {
  const std::uint64_t count = bytes.size();
  char head[1 + sizeof count] = {kind};
  std::memcpy(head + 1, &count, sizeof count);
  if (!write_all(pipe, head, sizeof head) || !write_all(pipe, bytes.data(), bytes.size())) {
    ::_exit(1);
  }
}

#ifndef SIGNORINI_SANITIZED
std::size_t address_space_in_use() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  file >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}
#endif

void limit_resources(const ChildLimits& limits) {
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
#ifndef SIGNORINI_SANITIZED
  if (limits.bytes == kAnyMemory) {
    return;
  }
  const std::size_t bytes = address_space_in_use() + limits.bytes;
  const rlimit space = {bytes, bytes};
  ::setrlimit(RLIMIT_AS, &space);
#else
  static_cast<void>(limits);
#endif
}

void silence(int descriptor) {
  const int nowhere = ::open("/dev/null", O_RDWR);
  if (nowhere >= 0) {
    ::dup2(nowhere, descriptor);
    ::close(nowhere);
  }
}

/// What every child is born with: no terminal, no handlers of the parent's, the limits.
void settle_child(const ChildLimits& limits, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) {
    ::_exit(1);  // the parent died first
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL}) {
    ::signal(signal, SIG_DFL);
  }
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    silence(descriptor);
  }
  limit_resources(limits);
}

[[noreturn]] void run_work(const ChildWork& work, int pipe) {
  try {
    write_message(pipe, kAnswer, work([pipe] { write_message(pipe, kLoaded, {}); }));
  } catch (const std::bad_alloc&) {
    write_message(pipe, kReason, "out of memory");
  } catch (const std::exception& error) {
    write_message(pipe, kReason, error.what());
  } catch (...) {
    write_message(pipe, kReason, "an exception of unknown type");
  }
  ::_exit(0);  // no destructors, no buffers of the parent's streams
}

/// @param arguments the program first, a null pointer last: made before the fork, where memory that
/// ends is an exception
[[noreturn]] void become_program(const std::vector<char*>& arguments, int input, int pipe) {
  write_message(pipe, kOutput, {});
  ::dup2(input, STDIN_FILENO);
  ::dup2(pipe, STDOUT_FILENO);
  ::execv(arguments[0], arguments.data());
  ::dprintf(pipe, "cannot start %s: %s", arguments[0], ::strerror(errno));
  ::_exit(1);
}

struct Message {
  char kind;
  std::string bytes;
};

/// The first whole message of what has arrived, taken out of it.
std::optional<Message> take_message(std::string& arrived) {
  std::uint64_t count = 0;
  if (arrived.size() < 1 + sizeof count) {
    return std::nullopt;
  }
  std::memcpy(&count, arrived.data() + 1, sizeof count);
  const std::size_t head = 1 + sizeof count;
  if (arrived.size() - head < count) {
    return std::nullopt;
  }
  Message message{arrived[0], arrived.substr(head, count)};
  arrived.erase(0, head + count);
  return message;
}

std::string describe_status(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return "signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
  }
  return "exit " + std::to_string(WEXITSTATUS(status)) + " without an answer";
}

/// CPU seconds that a process has used; 0 where the system does not tell.
double cpu_seconds(pid_t process) {
  clockid_t clock;
  timespec time = {};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) {
    return 0.0;
  }
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// How much of its time a child has used since the start of a phase. Wall time counts from when the
/// child last computed, a thousandth of its time at least: one that gets little of the processor is
/// not one that waits.
class Allowance {
 public:
  Allowance(pid_t child, double seconds)
      : child_(child), seconds_(seconds), cpu_start_(cpu_seconds(child)) {}
  [[nodiscard]] bool is_used_up() {
    const double used = cpu_seconds(child_) - cpu_start_;
    if (used - used_then_ > 1e-3 * seconds_) {
      used_then_ = used;
      then_ = Clock::now();
    }
    const std::chrono::duration<double> waited = Clock::now() - then_;
    return used > seconds_ || waited.count() > kWallTimes * seconds_;
  }

 private:
  pid_t child_;
  double seconds_;
  double cpu_start_;
  double used_then_ = 0.0;
  Clock::time_point then_ = Clock::now();
};

/// Listens until the child has answered, ended or used up its time.
ChildAnswer listen(int pipe, pid_t child, const ChildLimits& limits) {
  ChildAnswer result;
  result.reason.clear();
  std::string arrived;
  bool is_output = false;
  Allowance allowance(child, limits.loading_seconds);
  while (true) {
    while (std::optional<Message> message = is_output ? std::nullopt : take_message(arrived)) {
      if (message->kind == kLoaded || message->kind == kOutput) {
        result.is_loaded = true;
        is_output = message->kind == kOutput;
        allowance = Allowance(child, limits.seconds);
        continue;
      }
      result.end = message->kind == kAnswer ? ChildEnd::kAnswered : ChildEnd::kCrashed;
      (message->kind == kAnswer ? result.answer : result.reason) = std::move(message->bytes);
      return result;
    }
    if (stopped != 0) {
      result.end = ChildEnd::kInterrupted;
      return result;
    }
    if (allowance.is_used_up()) {
      result.end = ChildEnd::kTimedOut;
      result.reason = result.is_loaded ? "time limit" : "time limit while loading";
      return result;
    }
    constexpr int kGlanceMilliseconds = 50;  // at the clocks and at signals
    pollfd wait = {pipe, POLLIN, 0};
    if (::poll(&wait, 1, kGlanceMilliseconds) <= 0) {
      continue;
    }
    char bytes[65536];
    const ssize_t count = ::read(pipe, bytes, sizeof bytes);
    if (count > 0) {
      arrived.append(bytes, static_cast<std::size_t>(count));
    } else if (count == 0) {
      result.end = is_output ? ChildEnd::kAnswered : ChildEnd::kCrashed;
      result.answer = is_output ? std::move(arrived) : std::string();
      return result;
    }
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// Waits until a child has ended, or has closed its output and goes on for longer than its limit.
void let_end(pid_t child, const ChildLimits& limits) {
  Allowance allowance(child, limits.seconds);
  siginfo_t ended = {};
  while (::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT | WNOHANG) == 0 &&
         ended.si_pid == 0 && stopped == 0 && !allowance.is_used_up()) {
    ::usleep(200);
  }
}

/// @param live what the child does, with its end of the pipe; does not return
/// @param is_program it becomes another program, whose exit other than 0 is a crash
ChildAnswer run(const std::function<void(int pipe)>& live, bool is_program,
                const ChildLimits& limits) {
  if (stopped != 0) {
    return {.end = ChildEnd::kInterrupted, .answer = {}, .reason = {}, .is_loaded = false};
  }
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw last_error("pipe");
  }
  Descriptor read_end(ends[0]);
  Descriptor write_end(ends[1]);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) {
    throw last_error("fork");
  }
  if (child == 0) {
    settle_child(limits, parent);
    live(write_end.number());
  }
  write_end.close();
  ChildAnswer result = listen(read_end.number(), child, limits);
  if (is_program && result.end == ChildEnd::kAnswered) {
    let_end(child, limits);  // it may still have to write its own exit status
  }
  ::kill(child, SIGKILL);  // it has answered, or it never will; no effect on one that has died
  const int status = wait_for(child);
  if (result.end == ChildEnd::kAnswered && is_program && status != 0) {
    result.end = ChildEnd::kCrashed;
    result.reason = WIFEXITED(status) ? result.answer : std::string();
    result.answer.clear();
  }
  if (result.end == ChildEnd::kCrashed && result.reason.empty()) {
    result.reason = describe_status(status);
  }
  return result;
}

}  // namespace

ChildAnswer run_in_child(const ChildWork& work, const ChildLimits& limits) {
  return run([&](int pipe) { run_work(work, pipe); }, false, limits);
}

ChildAnswer run_program(const std::vector<std::string>& command, std::string_view input,
                        const ChildLimits& limits) {
  const Descriptor file(::memfd_create("input", MFD_CLOEXEC));
  if (file.number() < 0) {
    throw last_error("memfd_create");
  }
  if (!write_all(file.number(), input.data(), input.size()) ||
      ::lseek(file.number(), 0, SEEK_SET) != 0) {
    throw last_error("the input of another program");
  }
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  return run([&](int pipe) { become_program(arguments, file.number(), pipe); }, true, limits);
}

void stop_children() {
  stopped = 1;
}

bool children_are_stopped() {
  return stopped != 0;
}

}  // namespace signorini::tools
