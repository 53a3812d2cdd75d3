#include <signorini/lcp/thread_team.h>

namespace signorini::lcp {
namespace {

constexpr int kLooks = 2000;  // before sleeping

/// Waits until the counter is no longer `old`.
void wait_for_change(const std::atomic<unsigned>& counter, unsigned old) {
  for (int k = 0; k < kLooks; ++k) {
    if (counter.load(std::memory_order_acquire) != old) {
      return;
    }
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
  counter.wait(old, std::memory_order_acquire);
}

}  // namespace

ThreadTeam::ThreadTeam(int size) {
  for (int member = 1; member < size; ++member) {
    threads_.emplace_back([this, member] { serve(member); });
  }
}

ThreadTeam::~ThreadTeam() {
  stop_.store(true, std::memory_order_relaxed);
  job_.fetch_add(1, std::memory_order_release);
  job_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void ThreadTeam::serve(int member) {
  for (unsigned done = 0;; ++done) {
    wait_for_change(job_, done);
    if (stop_.load(std::memory_order_relaxed)) {
      return;
    }
    call_(argument_, member);
    wait();
  }
}

void ThreadTeam::run(Call call, void* argument) {
  call_ = call;
  argument_ = argument;
  job_.fetch_add(1, std::memory_order_release);
  job_.notify_all();
  call(argument, 0);
  wait();
}

void ThreadTeam::wait() {
  const unsigned phase = phase_.load(std::memory_order_relaxed);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == size()) {
    arrived_.store(0, std::memory_order_relaxed);
    phase_.fetch_add(1, std::memory_order_release);
    phase_.notify_all();
    return;
  }
  wait_for_change(phase_, phase);
}

}  // namespace signorini::lcp
