#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace signorini::lcp {

/// Threads that wait for work, for loops of a few microseconds that take turns with one another.
/// Who waits looks at the clock line of the others for some microseconds before it sleeps.
class ThreadTeam {
 public:
  /// Starts size - 1 threads; the caller's is the first of the team. @param size >= 1
  explicit ThreadTeam(int size);
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;
  ~ThreadTeam();

  [[nodiscard]] int size() const { return static_cast<int>(threads_.size()) + 1; }

  /// Calls work(member) for every member 0 .. size - 1, each on its thread, and returns when all
  /// have returned. Allocates nothing. work must not throw.
  template <typename Work>
  void run(Work& work) {
    run([](void* argument, int member) { (*static_cast<Work*>(argument))(member); }, &work);
  }
  /// Returns when every member has called it. Only inside work, by every member equally often.
  void wait();

 private:
  using Call = void (*)(void* argument, int member);
  void run(Call call, void* argument);
  void serve(int member);

  Call call_ = nullptr;
  void* argument_ = nullptr;
  std::atomic<unsigned> job_{0};    // counts runs
  std::atomic<int> arrived_{0};     // of wait()
  std::atomic<unsigned> phase_{0};  // counts completed wait()s
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

}  // namespace signorini::lcp
