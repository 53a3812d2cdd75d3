#include "bench/peer_runner.h"

#include "bench/peer_task.h"
#include "tools/byte_archive.h"
#include "tools/stopwatch.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

namespace signorini::bench {
namespace {

constexpr int kFewestSweeps = 8;
constexpr int kMostRepeats = 1000;

/// What a child sends home.
struct TimedAnswer {
  PeerAnswer answer;
  std::vector<double> z = {};  ///< of the answer, on its way
  double seconds = -1.0;
  double first_seconds = -1.0;
  int repeats = 0;
};
void visit_fields(auto& archive, tools::Reflects<TimedAnswer> auto& timed) {
  archive(timed.answer.claim, timed.answer.said, timed.z, timed.answer.iterations,
          timed.answer.pivots, timed.answer.factorizations, timed.seconds, timed.first_seconds,
          timed.repeats);
}

bool is_answer(const lcp::Vector& z, const lcp::Problem& problem) {
  return z.size() == problem.size() && z.allFinite();
}

bool meets(const lcp::Certificate& certificate, double tolerance) {
  constexpr double kMostRounding = 1e-5;
  return certificate.natural_residual <= tolerance ||
         (certificate.natural_residual <= 4.0 * certificate.natural_floor &&
          certificate.natural_residual <= kMostRounding);
}

double solve_once(Peer& peer, PeerAnswer& answer) {
  peer.rewind();
  const tools::Stopwatch stopwatch;
  peer.solve(answer);
  return stopwatch.seconds();
}

TimedAnswer solve_repeatedly(Peer& peer, const RunLimits& limits) {
  TimedAnswer timed;
  timed.first_seconds = solve_once(peer, timed.answer);
  timed.seconds = timed.first_seconds;
  timed.repeats = 1;
  double spent = timed.seconds;
  while (timed.seconds < limits.short_seconds && timed.repeats < kMostRepeats &&
         (timed.repeats < limits.repeats || spent < limits.repeat_seconds)) {
    const double seconds = solve_once(peer, timed.answer);
    timed.seconds = std::min(timed.seconds, seconds);
    spent += seconds;
    ++timed.repeats;
  }
  return timed;
}

/// The first number of sweeps that is enough, doubling.
TimedAnswer solve_with_enough_sweeps(Peer& peer, const lcp::Problem& judged, double tolerance,
                                     const RunLimits& limits) {
  RunLimits once = limits;
  once.repeats = 1;
  once.repeat_seconds = 0.0;
  for (int sweeps = kFewestSweeps;; sweeps *= 2) {
    peer.set_sweeps(sweeps);
    TimedAnswer timed = solve_repeatedly(peer, once);
    const bool is_good =
        is_answer(timed.answer.z, judged) && meets(lcp::certify(judged, timed.answer.z), tolerance);
    if (is_good) {
      return solve_repeatedly(peer, limits);
    }
    if (sweeps >= limits.most_sweeps || !is_answer(timed.answer.z, judged)) {
      return timed;
    }
  }
}

Verdict verdict_without_answer(tools::ChildEnd end) {
  switch (end) {
    case tools::ChildEnd::kTimedOut: return Verdict::kTimedOut;
    case tools::ChildEnd::kInterrupted: return Verdict::kInterrupted;
    case tools::ChildEnd::kCrashed:
    case tools::ChildEnd::kAnswered: break;
  }
  return Verdict::kCrashed;
}

struct VerdictText {
  std::string_view name;
  std::string_view mark;
};

constexpr std::array<VerdictText, 8> kVerdicts = {{{"solved", ""},
                                                   {"wrong", "W"},
                                                   {"failed", "F"},
                                                   {"unsolved", "I"},
                                                   {"timed out", "T"},
                                                   {"crashed", "C"},
                                                   {"refused", "-"},
                                                   {"interrupted", "?"}}};

}  // namespace

std::string_view to_string(Verdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)].name;
}

std::string_view mark(Verdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)].mark;
}

Verdict judge_answer(const lcp::Certificate& certificate, bool is_finite, Claim claim,
                     double tolerance) {
  if (is_finite && meets(certificate, tolerance)) {
    return Verdict::kSolved;
  }
  if (claim == Claim::kFailed) {
    return Verdict::kFailed;
  }
  return claim == Claim::kSolved || !is_finite ? Verdict::kWrong : Verdict::kUnsolved;
}

std::string measure_peer(const PeerEntry& entry, const lcp::Problem& given,
                         const lcp::Problem& judged, const PeerSettings& settings,
                         const RunLimits& limits, const std::function<void()>& loaded) {
  const std::unique_ptr<Peer> peer = entry.make(settings);
  peer->load(given);
  loaded();
  TimedAnswer timed = entry.counts_sweeps
                          ? solve_with_enough_sweeps(*peer, judged, settings.tolerance, limits)
                          : solve_repeatedly(*peer, limits);
  timed.z.assign(timed.answer.z.begin(), timed.answer.z.end());
  return tools::to_bytes(timed);
}

PeerRun run_peer(const PeerEntry& entry, const lcp::Problem& given, const lcp::Problem& judged,
                 const PeerSettings& settings, const RunLimits& limits) {
  PeerRun run;
  if (entry.refuses != nullptr) {
    run.said = entry.refuses(given);
    if (!run.said.empty()) {
      return run;
    }
  }
  const tools::ChildWork work = [&](const std::function<void()>& loaded) {
    return measure_peer(entry, given, judged, settings, limits, loaded);
  };
  const tools::ChildAnswer child =
      entry.program.empty()
          ? tools::run_in_child(work, limits.child)
          : tools::run_program({entry.program, entry.name},
                               tools::to_bytes(peer_task(given, settings, limits)), limits.child);
  if (child.end != tools::ChildEnd::kAnswered) {
    run.verdict = verdict_without_answer(child.end);
    run.said = child.reason;
    return run;
  }
  TimedAnswer timed;
  try {
    timed = tools::from_bytes<TimedAnswer>(child.answer);
  } catch (const std::runtime_error& error) {
    run.verdict = Verdict::kCrashed;
    run.said = error.what();
    return run;
  }
  run.claim = timed.answer.claim;
  run.said = timed.answer.said;
  run.seconds = timed.seconds;
  run.first_seconds = timed.first_seconds;
  run.repeats = timed.repeats;
  run.iterations = timed.answer.iterations;
  run.pivots = timed.answer.pivots;
  run.factorizations = timed.answer.factorizations;
  const lcp::Vector z =
      Eigen::Map<const lcp::Vector>(timed.z.data(), static_cast<lcp::Index>(timed.z.size()));
  const bool is_finite = is_answer(z, judged);
  if (is_finite) {
    run.certificate = lcp::certify(judged, z);
    run.z = z;
  }
  run.verdict = judge_answer(run.certificate, is_finite, run.claim, settings.tolerance);
  return run;
}

}  // namespace signorini::bench
