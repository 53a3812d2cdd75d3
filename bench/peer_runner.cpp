#include "bench/peer_runner.h"

#include "tools/stopwatch.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace signorini::bench {
namespace {

constexpr int kFewestSweeps = 8;
constexpr int kMostRepeats = 1000;

/// What a child sends home.
struct TimedAnswer {
  PeerAnswer answer;
  double seconds = -1.0;
  double first_seconds = -1.0;
  int repeats = 0;
};

/// Numbers and texts as bytes, read back in the order they were written. Parent and child are the
/// same program: no byte order, no versions.
class ByteWriter {
 public:
  template <typename Number>
  void number(Number value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void block(const void* data, std::size_t bytes) {
    number(std::uint64_t{bytes});
    bytes_.append(static_cast<const char*>(data), bytes);
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  template <typename Number>
  Number number() {
    Number value;
    std::memcpy(&value, next(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view block() { return next(number<std::uint64_t>()); }

 private:
  std::string_view next(std::size_t count) {
    if (bytes_.size() < count) {
      throw std::runtime_error("the child's answer is cut off");
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  std::string_view bytes_;
};

std::string to_bytes(const TimedAnswer& timed) {
  ByteWriter writer;
  writer.number(timed.seconds);
  writer.number(timed.first_seconds);
  writer.number(timed.repeats);
  writer.number(timed.answer.claim);
  writer.number(timed.answer.iterations);
  writer.number(timed.answer.pivots);
  writer.number(timed.answer.factorizations);
  writer.block(timed.answer.said.data(), timed.answer.said.size());
  writer.block(timed.answer.z.data(), sizeof(double) * timed.answer.z.size());
  return writer.take();
}

TimedAnswer from_bytes(std::string_view bytes) {
  ByteReader reader(bytes);
  TimedAnswer timed;
  timed.seconds = reader.number<double>();
  timed.first_seconds = reader.number<double>();
  timed.repeats = reader.number<int>();
  timed.answer.claim = reader.number<Claim>();
  timed.answer.iterations = reader.number<int>();
  timed.answer.pivots = reader.number<int>();
  timed.answer.factorizations = reader.number<int>();
  timed.answer.said = reader.block();
  const std::string_view z = reader.block();
  timed.answer.z.resize(static_cast<lcp::Index>(z.size() / sizeof(double)));
  std::memcpy(timed.answer.z.data(), z.data(), z.size());
  return timed;
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
    const std::unique_ptr<Peer> peer = entry.make(settings);
    peer->load(given);
    loaded();
    return to_bytes(entry.counts_sweeps
                        ? solve_with_enough_sweeps(*peer, judged, settings.tolerance, limits)
                        : solve_repeatedly(*peer, limits));
  };
  const tools::ChildAnswer child = tools::run_in_child(work, limits.child);
  if (child.end != tools::ChildEnd::kAnswered) {
    run.verdict = verdict_without_answer(child.end);
    run.said = child.reason;
    return run;
  }
  TimedAnswer timed = from_bytes(child.answer);
  run.claim = timed.answer.claim;
  run.said = timed.answer.said;
  run.seconds = timed.seconds;
  run.first_seconds = timed.first_seconds;
  run.repeats = timed.repeats;
  run.iterations = timed.answer.iterations;
  run.pivots = timed.answer.pivots;
  run.factorizations = timed.answer.factorizations;
  const bool is_finite = is_answer(timed.answer.z, judged);
  if (is_finite) {
    run.certificate = lcp::certify(judged, timed.answer.z);
    run.z = timed.answer.z;
  }
  run.verdict = judge_answer(run.certificate, is_finite, run.claim, settings.tolerance);
  return run;
}

}  // namespace signorini::bench
