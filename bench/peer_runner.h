#pragma once

#include <signorini/lcp/certificate.h>

#include "bench/peer.h"
#include "tools/child_process.h"

#include <functional>
#include <string>
#include <string_view>

namespace signorini::bench {

/// What became of a solver on a problem, by the residual of its answer on the caller's data.
enum class Verdict : unsigned char {
  kSolved,    ///< within the tolerance, or within four rounding floors and 1e-5
  kWrong,     ///< said "solved" (or returned NaN and said nothing), and it is not
  kFailed,    ///< said that it failed, and it did
  kUnsolved,  ///< says nothing of its answer, which is not good enough at the sweep limit
  kTimedOut,
  kCrashed,
  kRefused,      ///< cannot take the problem, or is not asked to
  kInterrupted,  ///< this program was told to stop
};

/// "solved", "wrong", ...
[[nodiscard]] std::string_view to_string(Verdict verdict);
/// "", "W", "F", "I", "T", "C", "-", "?"
[[nodiscard]] std::string_view mark(Verdict verdict);

/// The one judgement, the same for everybody. An answer counts by what it is: a solver that says
/// "failed" of an answer within the tolerance has solved.
/// @param certificate of the answer on the caller's data, certify(); natural_residual decides
/// @param is_finite whether the answer has n finite numbers
[[nodiscard]] Verdict judge_answer(const lcp::Certificate& certificate, bool is_finite, Claim claim,
                                   double tolerance);

struct RunLimits {
  tools::ChildLimits child;
  int repeats = 5;               ///< of short solves, at least; the minimum counts
  double short_seconds = 0.1;    ///< longer solves are timed once
  double repeat_seconds = 0.02;  ///< short solves are repeated for at least this long
  int most_sweeps = 1 << 15;     ///< for solvers that count them
};

/// One solver on one problem.
struct PeerRun {
  Verdict verdict = Verdict::kRefused;
  Claim claim = Claim::kNothing;
  std::string said;              ///< the solver's word, or why there is none
  lcp::Certificate certificate;  ///< of its answer; NaN if there is none
  lcp::Vector z;                 ///< its answer, n finite numbers, or empty
  /// Of the fastest solve, with all memory warm: wall time, or the process's CPU time where that is
  /// less, because others had the processor; -1: none ended.
  double seconds = -1.0;
  double first_seconds = -1.0;  ///< of the first one
  int repeats = 0;
  int iterations = -1;
  int pivots = -1;
  int factorizations = -1;
};

/// What the child does: loads, solves, times; the bytes that run_peer() makes a PeerRun of.
/// @param loaded called once the problem is loaded
[[nodiscard]] std::string measure_peer(const PeerEntry& entry, const lcp::Problem& given,
                                       const lcp::Problem& judged, const PeerSettings& settings,
                                       const RunLimits& limits,
                                       const std::function<void()>& loaded);

/// Runs the solver in a child process, or in its own program, and judges its answer here, in long
/// double, on `judged`. Solvers that count sweeps are given 8, 16, 32 ... until the answer is good
/// enough; the time is that of the last number alone.
/// @param given what the solver gets: `judged`, or regularised(judged)
[[nodiscard]] PeerRun run_peer(const PeerEntry& entry, const lcp::Problem& given,
                               const lcp::Problem& judged, const PeerSettings& settings,
                               const RunLimits& limits);

}  // namespace signorini::bench
