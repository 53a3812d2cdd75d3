#include "bench/broad_phase_study.h"

#include <signorini/collision/broad_phase.h>

#include "bench/broad_phase_peer.h"
#include "bench/thread_time.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <numeric>
#include <ostream>
#include <random>

namespace signorini::bench {
namespace {

using collision::Bounds;
using Pairs = std::vector<std::pair<int, int>>;
using Random = std::mt19937_64;

class OurBroadPhase final : public BroadPhasePeer {
 public:
  [[nodiscard]] std::string name() const override { return "signorini"; }
  void step(const std::vector<Bounds>& bounds, Pairs& pairs) override {
    broad_phase_.find(bounds, {}, pairs);
  }

 private:
  collision::BroadPhase broad_phase_;
};

/// Sorted along x, swept; what every better structure must beat.
class PlainSweep final : public BroadPhasePeer {
 public:
  [[nodiscard]] std::string name() const override { return "plain sort and sweep"; }
  void step(const std::vector<Bounds>& bounds, Pairs& pairs) override {
    order_.resize(bounds.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::sort(order_.begin(), order_.end(),
              [&](int i, int j) { return bounds[i].low.x() < bounds[j].low.x(); });
    pairs.clear();
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const Bounds& a = bounds[order_[k]];
      for (std::size_t m = k + 1; m < order_.size() && bounds[order_[m]].low.x() <= a.high.x();
           ++m) {
        if (a.overlaps(bounds[order_[m]])) {
          pairs.emplace_back(order_[k], order_[m]);
        }
      }
    }
  }

 private:
  std::vector<int> order_;
};

struct Crowd {
  std::string name;
  Vec3 room;           ///< half extents, for 10,000 bodies, m
  double least, most;  ///< half edges, exponents of 10
};

const std::array<Crowd, 3>& crowds() {
  static const std::array<Crowd, 3> kCrowds = {{
      {"cloud, edges 0.8 to 1.2", Vec3(14, 14, 14), std::log10(0.4), std::log10(0.6)},
      {"layer, edges 0.8 to 1.2", Vec3(60, 60, 0.5), std::log10(0.4), std::log10(0.6)},
      {"cloud, edges 0.1 to 10", Vec3(60, 60, 60), std::log10(0.05), std::log10(5.0)},
  }};
  return kCrowds;
}

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Boxes in a room, which they do not leave.
class MovingBoxes {
 public:
  MovingBoxes(const Crowd& crowd, const BroadPhaseOptions& options)
      : random_(options.seed), room_(crowd.room * std::cbrt(options.bodies / 10000.0)) {
    for (int i = 0; i < options.bodies; ++i) {
      Vec3 half;
      for (double& h : half) {
        h = std::pow(10.0, uniform(random_, crowd.least, crowd.most));
      }
      halves_.push_back(half);
      centres_.push_back(anywhere(room_));
      steps_.push_back(anywhere(Vec3::Constant(1.0 / 60.0)));
    }
    place();
  }

  void creep() {
    for (std::size_t i = 0; i < centres_.size(); ++i) {
      centres_[i] += steps_[i];
      for (int k = 0; k < 3; ++k) {
        if (std::abs(centres_[i][k]) > room_[k]) {
          steps_[i][k] = -std::copysign(steps_[i][k], centres_[i][k]);
        }
      }
    }
    place();
  }
  void jump() {
    for (Vec3& centre : centres_) {
      centre = anywhere(room_);
    }
    place();
  }
  [[nodiscard]] const std::vector<Bounds>& bounds() const { return bounds_; }

 private:
  Vec3 anywhere(const Vec3& half) {
    return {uniform(random_, -half.x(), half.x()), uniform(random_, -half.y(), half.y()),
            uniform(random_, -half.z(), half.z())};
  }
  void place() {
    bounds_.clear();
    for (std::size_t i = 0; i < centres_.size(); ++i) {
      bounds_.push_back({centres_[i] - halves_[i], centres_[i] + halves_[i]});
    }
  }

  Random random_;
  Vec3 room_;
  std::vector<Vec3> centres_, halves_, steps_;
  std::vector<Bounds> bounds_;
};

void in_order(Pairs& pairs) {
  for (auto& pair : pairs) {
    pair = std::minmax({pair.first, pair.second});
  }
  std::sort(pairs.begin(), pairs.end());
}

/// In `a` and not in `b`. Both in order.
long difference(const Pairs& a, const Pairs& b) {
  Pairs left;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(left));
  return static_cast<long>(left.size());
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void run_crowd(const Crowd& crowd, bool creeps, const BroadPhaseOptions& options,
               BroadPhaseReport& report) {
  MovingBoxes boxes(crowd, options);
  BroadPhasePeers peers;
  peers.push_back(std::make_unique<PlainSweep>());
  peers.push_back(std::make_unique<OurBroadPhase>());
#ifdef SIGNORINI_PEER_BULLET
  add_bullet_broad_phases(boxes.bounds(), peers);
#endif
#ifdef SIGNORINI_PEER_FCL
  add_fcl_broad_phases(boxes.bounds(), peers);
#endif
#ifdef SIGNORINI_PEER_BOOST
  add_boost_broad_phases(boxes.bounds(), peers);
#endif
  std::vector<BroadPhaseRow> rows;
  for (const auto& peer : peers) {
    rows.push_back({crowd.name, creeps ? "creep" : "jump", peer->name(), 0.0, 0.0, 0, 0});
  }
  std::vector<std::vector<double>> times(peers.size());
  Pairs found;
  Pairs expected;
  for (int step = 0; step < options.steps; ++step) {
    creeps ? boxes.creep() : boxes.jump();
    for (std::size_t k = 0; k < peers.size(); ++k) {
      const double start = thread_seconds();
      peers[k]->step(boxes.bounds(), found);
      times[k].push_back(1e3 * (thread_seconds() - start));
      rows[k].pairs += static_cast<double>(found.size()) / options.steps;
      in_order(found);
      if (k == 0) {
        expected = found;
      }
      rows[k].missed += difference(expected, found);
      rows[k].extra += difference(found, expected);
    }
  }
  for (std::size_t k = 0; k < peers.size(); ++k) {
    rows[k].milliseconds = median(times[k]);
    report.rows.push_back(rows[k]);
  }
}

}  // namespace

bool BroadPhaseReport::passed() const {
  return std::all_of(rows.begin(), rows.end(), [](const BroadPhaseRow& row) {
    return row.name != "signorini" || (row.missed == 0 && row.extra == 0);
  });
}

std::string BroadPhaseReport::to_csv() const {
  std::string csv = "crowd,motion,broad phase,ms a step,pairs,missed,extra\n";
  for (const BroadPhaseRow& row : rows) {
    csv += fmt::format("\"{}\",{},\"{}\",{:.4f},{:.1f},{},{}\n", row.crowd, row.motion, row.name,
                       row.milliseconds, row.pairs, row.missed, row.extra);
  }
  return csv;
}

BroadPhaseReport run_broad_phase_study(const BroadPhaseOptions& options, std::ostream& out) {
  BroadPhaseReport report;
  out << fmt::format("{} moving boxes, {} steps; ms: median CPU time of update and pairs\n",
                     options.bodies, options.steps);
  for (const Crowd& crowd : crowds()) {
    for (const bool creeps : {true, false}) {
      const std::size_t first = report.rows.size();
      run_crowd(crowd, creeps, options, report);
      out << fmt::format(
          "\n{}, {}\n{:32}{:>10}{:>12}{:>10}{:>12}\n", crowd.name,
          creeps ? "creeping by at most 1/60 m a step" : "jumping anywhere each step", "", "ms",
          "pairs", "missed", "extra");
      for (std::size_t k = first; k < report.rows.size(); ++k) {
        const BroadPhaseRow& row = report.rows[k];
        out << fmt::format("{:32}{:10.3f}{:12.0f}{:10}{:12}\n", row.name, row.milliseconds,
                           row.pairs, row.missed, row.extra);
      }
      out.flush();
    }
  }
  return report;
}

}  // namespace signorini::bench
