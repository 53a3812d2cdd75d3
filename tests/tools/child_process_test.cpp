#include "tools/child_process.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <gtest/gtest.h>
#include <stdexcept>
#include <unistd.h>
#include <vector>

namespace signorini::tools {
namespace {

using Loaded = std::function<void()>;

TEST(ChildProcess, BringsAnyBytesBack) {
  std::string bytes(300000, 'x');
  bytes[7] = '\0';
  const ChildAnswer child = run_in_child([&](const Loaded&) { return bytes; }, {});
  ASSERT_EQ(child.end, ChildEnd::kAnswered);
  EXPECT_EQ(child.answer, bytes);
  EXPECT_FALSE(child.is_loaded);
}

TEST(ChildProcess, WhatTheChildChangesStaysThere) {
  int number = 1;
  const ChildAnswer child = run_in_child(
      [&](const Loaded&) {
        number = 2;
        return std::to_string(number);
      },
      {});
  EXPECT_EQ(child.answer, "2");
  EXPECT_EQ(number, 1);
}

TEST(ChildProcess, ASignalIsACrashWithItsName) {
  const ChildAnswer child = run_in_child(
      [](const Loaded&) -> std::string {
        ::raise(SIGKILL);
        return "never";
      },
      {});
  EXPECT_EQ(child.end, ChildEnd::kCrashed);
  EXPECT_EQ(child.reason, "signal 9 (Killed)");
}

TEST(ChildProcess, AnExitWithoutAnAnswerIsACrash) {
  const ChildAnswer child = run_in_child(
      [](const Loaded&) -> std::string {
        std::printf("what a child prints is dropped\n");
        ::_exit(0);
      },
      {});
  EXPECT_EQ(child.end, ChildEnd::kCrashed);
  EXPECT_EQ(child.reason, "exit 0 without an answer");
}

TEST(ChildProcess, AnExceptionIsACrashWithItsText) {
  const ChildAnswer child = run_in_child(
      [](const Loaded&) -> std::string { throw std::runtime_error("no such thing"); }, {});
  EXPECT_EQ(child.end, ChildEnd::kCrashed);
  EXPECT_EQ(child.reason, "no such thing");
}

TEST(ChildProcess, AHangEndsAtItsTimeLimit) {
  const ChildWork hang = [](const Loaded& loaded) -> std::string {
    loaded();
    while (true) {
      ::pause();
    }
  };
  const ChildAnswer child = run_in_child(hang, {.seconds = 0.2});
  EXPECT_EQ(child.end, ChildEnd::kTimedOut);
  EXPECT_EQ(child.reason, "time limit");
  EXPECT_TRUE(child.is_loaded);
  const ChildAnswer loading = run_in_child(
      [](const Loaded&) -> std::string {
        while (true) {
          ::pause();
        }
      },
      {.seconds = 100.0, .loading_seconds = 0.2});
  EXPECT_EQ(loading.end, ChildEnd::kTimedOut);
  EXPECT_EQ(loading.reason, "time limit while loading");
}

TEST(ChildProcess, OneThatGetsLittleOfTheProcessorKeepsItsTime) {
  const ChildAnswer child = run_in_child(
      [](const Loaded&) -> std::string {
        for (int k = 0; k < 6; ++k) {
          const std::clock_t start = std::clock();
          while (std::clock() - start < CLOCKS_PER_SEC / 1000) {
          }
          ::usleep(450000);
        }
        return "done";
      },
      {.loading_seconds = 0.4});  // 2 s of wall time for one that waits; this takes 2.7
  EXPECT_EQ(child.end, ChildEnd::kAnswered) << child.reason;
  EXPECT_EQ(child.answer, "done");
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(ChildProcess, MemoryAboveTheLimitIsRefused) {
  const ChildAnswer child = run_in_child(
      [](const Loaded&) {
        const std::vector<double> much(std::size_t{1} << 26, 1.0);  // half a GiB
        return std::to_string(much[much.size() / 2]);
      },
      {.bytes = std::size_t{1} << 28});
  EXPECT_EQ(child.end, ChildEnd::kCrashed);
  EXPECT_EQ(child.reason, "out of memory");
}
#endif

TEST(ChildProcess, AnotherProgramGetsItsInputAndAnswersByItsOutput) {
  std::string bytes(300000, 'x');
  bytes[7] = '\0';
  const ChildAnswer child = run_program({"/bin/cat"}, bytes, {});
  ASSERT_EQ(child.end, ChildEnd::kAnswered) << child.reason;
  EXPECT_EQ(child.answer, bytes);
  const ChildAnswer silent = run_program({"/bin/true"}, {}, {});
  EXPECT_EQ(silent.end, ChildEnd::kAnswered);
  EXPECT_EQ(silent.answer, "");
}

TEST(ChildProcess, AnotherProgramsFailureIsACrash) {
  const ChildAnswer says = run_program({"/bin/sh", "-c", "echo no such scene; exit 1"}, {}, {});
  EXPECT_EQ(says.end, ChildEnd::kCrashed);
  EXPECT_EQ(says.reason, "no such scene\n");
  EXPECT_EQ(says.answer, "");
  EXPECT_EQ(run_program({"/bin/false"}, {}, {}).reason, "exit 1 without an answer");
  const ChildAnswer killed = run_program({"/bin/sh", "-c", "kill -SEGV $$"}, {}, {});
  EXPECT_EQ(killed.end, ChildEnd::kCrashed);
  EXPECT_NE(killed.reason.find("signal 11"), std::string::npos) << killed.reason;
  const ChildAnswer absent = run_program({"/no/such/program"}, {}, {});
  EXPECT_EQ(absent.end, ChildEnd::kCrashed);
  EXPECT_NE(absent.reason.find("cannot start /no/such/program"), std::string::npos)
      << absent.reason;
}

TEST(ChildProcess, AnotherProgramKeepsItsTimeLimit) {
  const ChildAnswer child =
      run_program({"/bin/sh", "-c", "while true; do true; done"}, {}, {.seconds = 0.2});
  EXPECT_EQ(child.end, ChildEnd::kTimedOut);
  EXPECT_EQ(child.reason, "time limit");
}

/// The last test: what is stopped stays stopped.
TEST(ChildProcessStopped, EndsTheRunningChildAndEveryLaterOne) {
  std::signal(SIGALRM, [](int) { stop_children(); });
  ::alarm(1);
  const ChildAnswer child = run_in_child(
      [](const Loaded&) -> std::string {
        while (true) {
          ::pause();
        }
      },
      {});
  EXPECT_EQ(child.end, ChildEnd::kInterrupted);
  EXPECT_TRUE(children_are_stopped());
  EXPECT_EQ(run_in_child([](const Loaded&) { return std::string(); }, {}).end,
            ChildEnd::kInterrupted);
}

}  // namespace
}  // namespace signorini::tools
