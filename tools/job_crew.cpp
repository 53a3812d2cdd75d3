#include "tools/job_crew.h"

#include "tools/child_process.h"

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <limits>
#include <poll.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace signorini::tools {

namespace {

std::system_error last_error(const char* what) {
  return std::system_error(errno, std::generic_category(), what);
}

/// @return false if the other end is closed.
bool send_all(int socket, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = ::send(socket, bytes, count, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) {
      continue;
    }
    if (sent <= 0) {
      return false;
    }
    bytes += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool send_report(int socket, const JobReport& report) {
  const std::string bytes = to_bytes(report);
  const std::uint64_t count = bytes.size();
  return send_all(socket, reinterpret_cast<const char*>(&count), sizeof count) &&
         send_all(socket, bytes.data(), bytes.size());
}

/// The number of a job, or nothing when the parent has closed its end.
std::optional<int> receive_job(int socket) {
  int job = -1;
  ssize_t got = 0;
  do {
    got = ::recv(socket, &job, sizeof job, MSG_WAITALL);
  } while (got < 0 && errno == EINTR);
  return got == sizeof job ? std::optional<int>(job) : std::nullopt;
}

JobReport run_one(const std::vector<Job>& jobs, int index) {
  constexpr double kForever = std::numeric_limits<double>::infinity();
  ChildAnswer answer = run_in_child(
      [&](const std::function<void()>&) { return jobs[static_cast<std::size_t>(index)].run(); },
      {.seconds = kForever, .loading_seconds = kForever, .bytes = kAnyMemory});
  const bool is_done = answer.end == ChildEnd::kAnswered;
  return {index, is_done, is_done ? std::move(answer.answer) : std::move(answer.reason)};
}

[[noreturn]] void work(const std::vector<Job>& jobs, int socket, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) {
    ::_exit(1);  // the parent died first
  }
  ::setpgid(0, 0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    ::signal(signal, SIG_DFL);
  }
  try {
    while (const std::optional<int> job = receive_job(socket)) {
      if (!send_report(socket, run_one(jobs, *job))) {
        break;
      }
    }
  } catch (const std::exception&) {
    ::_exit(1);  // no process to be had: the parent sees that we are no more
  }
  ::_exit(0);  // no destructors, no buffers of the parent's streams
}

class LocalCrew final : public JobCrew {
 public:
  LocalCrew(const std::vector<Job>& jobs, int hands) {
    for (int i = 0; i < hands; ++i) {
      workers_.push_back(std::make_unique<JobWorker>(jobs));
    }
  }
  [[nodiscard]] int hands() const override { return static_cast<int>(workers_.size()); }
  void give(int hand, int job) override { workers_[static_cast<std::size_t>(hand)]->give(job); }
  [[nodiscard]] std::optional<Finished> wait() override {
    constexpr int kGlanceMilliseconds = 200;  // at signals that came just before the call
    std::vector<pollfd> ends;
    for (const auto& worker : workers_) {
      ends.push_back({worker->descriptor(), POLLIN, 0});
    }
    if (::poll(ends.data(), ends.size(), kGlanceMilliseconds) <= 0) {
      return std::nullopt;
    }
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (ends[i].revents == 0) {
        continue;
      }
      if (std::optional<JobReport> report = workers_[i]->take()) {
        return Finished{static_cast<int>(i), std::move(*report)};
      }
    }
    return std::nullopt;
  }

 private:
  std::vector<std::unique_ptr<JobWorker>> workers_;
};

}  // namespace

JobWorker::JobWorker(const std::vector<Job>& jobs) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw last_error("socketpair");
  }
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw last_error("fork");
  }
  if (process_ == 0) {
    ::close(ends[0]);
    work(jobs, ends[1], parent);
  }
  ::close(ends[1]);
  descriptor_ = ends[0];
}

JobWorker::~JobWorker() {
  ::kill(process_, SIGKILL);  // what it runs dies with it
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  ::close(descriptor_);
}

void JobWorker::give(int job) {
  if (!send_all(descriptor_, reinterpret_cast<const char*>(&job), sizeof job)) {
    throw std::runtime_error("a worker process has ended");
  }
}

std::optional<JobReport> JobWorker::take() {
  char bytes[65536];
  const ssize_t got = ::recv(descriptor_, bytes, sizeof bytes, MSG_DONTWAIT);
  if (got == 0) {
    throw std::runtime_error("a worker process has ended");
  }
  if (got > 0) {
    arrived_.append(bytes, static_cast<std::size_t>(got));
  }
  std::uint64_t count = 0;
  if (arrived_.size() < sizeof count) {
    return std::nullopt;
  }
  std::memcpy(&count, arrived_.data(), sizeof count);
  if (arrived_.size() - sizeof count < count) {
    return std::nullopt;
  }
  auto report = from_bytes<JobReport>(std::string_view(arrived_).substr(sizeof count, count));
  arrived_.erase(0, sizeof count + count);
  return report;
}

std::unique_ptr<JobCrew> make_local_crew(const std::vector<Job>& jobs, int hands) {
  return std::make_unique<LocalCrew>(jobs, hands);
}

}  // namespace signorini::tools
