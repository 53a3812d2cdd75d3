#include "bench/contact_time_study.h"

#include <signorini/collision/contact_time.h>

#include "bench/shape_kinds.h"
#include "tests/collision/random_throws.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <ostream>

namespace signorini::bench {
namespace {

using collision::testing::PlacedPair;
using collision::testing::Random;
using collision::testing::Throw;

double allowed_gap(const PlacedPair& pair) {
  const bool closed_form = has_closed_form(pair.a) && has_closed_form(pair.b);
  return (closed_form ? 1e-9 : 1e-8) * pair.size + 64.0 * pair.rounding;
}

/// The last time in [low, high] before the gap is closed, by bisection to the resolution of time.
/// @pre it closes once
double bisected_time(const Throw& thrown, double low, double high) {
  while (true) {
    const double middle = 0.5 * (low + high);
    if (!(middle > low && middle < high)) {
      return low;
    }
    (thrown.gap(middle) > 0.0 ? low : high) = middle;
  }
}

/// How far the time is from the bisected one, over what is allowed; nothing where it is grazing.
std::optional<double> time_error(const Throw& thrown, double time, double allowed) {
  constexpr double kStep = 1e-5;     // s
  constexpr double kSlowest = 0.05;  // sizes per second
  constexpr double kAllowed = 1e-9;  // s
  if (time < kStep) {
    return std::nullopt;
  }
  const double before = thrown.gap(time - kStep);
  const double after = thrown.gap(time + kStep);
  const double approach = (before - after) / (2.0 * kStep);
  if (!(approach > kSlowest * thrown.pair.size) || !(after < -allowed) || !(before > allowed)) {
    return std::nullopt;
  }
  const double error = std::abs(bisected_time(thrown, time - kStep, time + kStep) - time);
  return error / (kAllowed + 2.0 * allowed / approach);
}

void judge(const Throw& thrown, ContactTimeRow& row) {
  constexpr int kLooks = 60;
  constexpr double kDuration = 1.0;
  const PlacedPair& pair = thrown.pair;
  const double allowed = allowed_gap(pair);
  const std::optional<double> time =
      collision::contact_time(pair.a, thrown.a, pair.b, thrown.b, kDuration);
  const double until = time.value_or(kDuration);
  bool missed = false;
  for (int i = 0; i <= kLooks && !missed; ++i) {
    missed = !(thrown.gap(until * i / kLooks) >= -allowed);
  }
  bool off = false;
  if (time) {
    ++row.hits;
    const double error = time_error(thrown, *time, allowed).value_or(0.0);
    row.worst_error = std::max(row.worst_error, error);
    off = !(std::abs(thrown.gap(*time)) <= allowed) || !(error <= 1.0);
  }
  ++row.throws;
  row.missed += missed ? 1 : 0;
  row.off += off ? 1 : 0;
  if ((missed || off) && row.first_wrong.empty()) {
    row.first_wrong = describe(pair);
  }
}

ContactTimeRow run_pair(const KindPair& kinds, long throws, std::uint64_t seed) {
  ContactTimeRow row;
  row.pair = kinds.name();
  Random random(seed);
  for (long k = 0; k < throws; ++k) {
    const double apart = collision::testing::uniform(random, 0.01, 2.0);
    judge(collision::testing::random_throw(random, kinds.a.kind, kinds.b.kind, apart), row);
  }
  return row;
}

}  // namespace

bool ContactTimeReport::passed() const {
  return std::all_of(rows.begin(), rows.end(),
                     [](const ContactTimeRow& row) { return row.missed == 0 && row.off == 0; });
}

std::string ContactTimeReport::to_csv() const {
  std::string csv = "pair,throws,hits,missed,off,worst\n";
  for (const ContactTimeRow& row : rows) {
    csv += fmt::format("{},{},{},{},{},{:.4g}\n", row.pair, row.throws, row.hits, row.missed,
                       row.off, row.worst_error);
  }
  return csv;
}

ContactTimeReport run_contact_time_study(const ContactTimeOptions& options, std::ostream& out) {
  ContactTimeReport report;
  out << fmt::format("{:<22}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "pair", "throws", "hits", "missed", "off",
                     "worst");
  const std::vector<KindPair> pairs = shape_pairs();
  const auto count = static_cast<long>(pairs.size());
  ContactTimeRow sum;
  sum.pair = "all";
  const auto print = [&](const ContactTimeRow& row) {
    out << fmt::format("{:<22}{:>9}{:>9}{:>9}{:>9}{:>9.3f}\n", row.pair, row.throws, row.hits,
                       row.missed, row.off, row.worst_error);
    if (!row.first_wrong.empty()) {
      out << "  first: " << row.first_wrong;
    }
    out.flush();
  };
  for (const KindPair& pair : pairs) {
    report.rows.push_back(run_pair(pair, (options.throws + count - 1) / count, options.seed));
    const ContactTimeRow& row = report.rows.back();
    print(row);
    sum.throws += row.throws;
    sum.hits += row.hits;
    sum.missed += row.missed;
    sum.off += row.off;
    sum.worst_error = std::max(sum.worst_error, row.worst_error);
  }
  print(sum);
  return report;
}

}  // namespace signorini::bench
