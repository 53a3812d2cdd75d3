#include "bench/narrow_phase_study.h"

#include <signorini/collision/pair_query.h>

#include "bench/narrow_phase_peer.h"
#include "bench/thread_time.h"
#include "tests/collision/random_pairs.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <ostream>

namespace signorini::bench {
namespace {

using collision::Box;
using collision::Shape;
using collision::Sphere;
using collision::testing::Random;
using collision::testing::random_direction;
using collision::testing::random_orientation;
using collision::testing::uniform;

class OurNarrowPhase final : public NarrowPhasePeer {
 public:
  OurNarrowPhase(const Shape& a, const Shape& b) : a_(a), b_(b) {}
  [[nodiscard]] std::string name() const override { return "signorini"; }
  void query(const Pose& a, const Pose& b) override {
    collision::find_intersection(a_, a, b_, b, 0.0, found_);
  }
  void read(std::vector<Contact>& contacts) override { contacts = found_; }

 private:
  const Shape& a_;
  const Shape& b_;
  std::vector<Contact> found_;
};

struct Pair {
  const char* name;
  Shape a, b;
};

struct PosePair {
  Pose a, b;
};

/// A beside B, then moved along the contact normal until it is at most 2 % deep.
PosePair touching(const Pair& pair, bool is_flush, Random& random) {
  const Quat turn = is_flush ? Quat(Eigen::AngleAxisd(uniform(random, 0.0, 7.0), Vec3::UnitZ()))
                             : random_orientation(random);
  const Vec3 aside(uniform(random, -0.4, 0.4), uniform(random, -0.4, 0.4), 0.0);
  PosePair poses{
      {is_flush ? Vec3(aside + 2.0 * Vec3::UnitZ()) : Vec3(2.0 * random_direction(random)), turn},
      {Vec3::Zero(), is_flush ? Quat::Identity() : random_orientation(random)}};
  std::vector<Contact> contacts;
  collision::find_intersection(pair.a, poses.a, pair.b, poses.b,
                               std::numeric_limits<double>::infinity(), contacts);
  const Contact& nearest =
      *std::min_element(contacts.begin(), contacts.end(),
                        [](const Contact& p, const Contact& q) { return p.gap < q.gap; });
  poses.a.position -= (nearest.gap + uniform(random, 1e-4, 2e-2)) * nearest.normal;
  return poses;
}

bool is_valid(const Pair& pair, const PosePair& poses, const Contact& contact, double distance) {
  constexpr double kTolerance = 1e-3;  // of shapes about 1 m large
  const Vec3& N = contact.normal;
  const double best = -support(pair.a, poses.a, -N) - support(pair.b, poses.b, N);
  const double beyond_a = -N.dot(contact.point_a) - support(pair.a, poses.a, -N);
  const double beyond_b = N.dot(contact.point_b) - support(pair.b, poses.b, N);
  return std::abs(N.norm() - 1.0) <= kTolerance && best >= distance - kTolerance &&
         beyond_a <= kTolerance && beyond_b <= kTolerance &&
         collision::signed_distance(Sphere{kTolerance}, {contact.point_a, Quat::Identity()}, pair.a,
                                    poses.a) <= kTolerance &&
         collision::signed_distance(Sphere{kTolerance}, {contact.point_b, Quat::Identity()}, pair.b,
                                    poses.b) <= kTolerance;
}

NarrowPhaseRow measure(NarrowPhasePeer& peer, const Pair& pair, const std::vector<PosePair>& poses,
                       int repeats) {
  NarrowPhaseRow row{pair.name, peer.name(), 0.0, 0.0, 0.0};
  const auto count = static_cast<double>(poses.size());
  std::vector<Contact> contacts;
  for (const PosePair& pose : poses) {
    peer.query(pose.a, pose.b);
    peer.read(contacts);
    const double d = collision::signed_distance(pair.a, pose.a, pair.b, pose.b);
    row.points += static_cast<double>(contacts.size()) / count;
    for (const Contact& contact : contacts) {
      row.valid += (is_valid(pair, pose, contact, d) ? 1.0 : 0.0) / count;
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < repeats; ++k) {
    const double start = thread_seconds();
    for (const PosePair& pose : poses) {
      peer.query(pose.a, pose.b);
    }
    least = std::min(least, thread_seconds() - start);
  }
  row.nanoseconds = 1e9 * least / count;
  return row;
}

}  // namespace

std::string NarrowPhaseReport::to_csv() const {
  std::string csv = "pair,narrow phase,ns a query,points,valid\n";
  for (const NarrowPhaseRow& row : rows) {
    csv += fmt::format("{},{},{:.1f},{:.3f},{:.3f}\n", row.pair, row.name, row.nanoseconds,
                       row.points, row.valid);
  }
  return csv;
}

NarrowPhaseReport run_narrow_phase_study(const NarrowPhaseOptions& options, std::ostream& out) {
  const Pair pairs[] = {
      {"box-box", Box{Vec3(0.5, 0.4, 0.3)}, Box{Vec3(0.6, 0.5, 0.4)}},
      {"sphere-box", Sphere{0.5}, Box{Vec3(0.6, 0.5, 0.4)}},
  };
  NarrowPhaseReport report;
  out << fmt::format("{:<14}{:<14}{:>10}{:>10}{:>10}\n", "pair", "", "ns", "points", "valid");
  for (const Pair& pair : pairs) {
    Random random(options.seed);
    std::vector<PosePair> poses;
    poses.reserve(options.poses);
    for (int k = 0; k < options.poses; ++k) {
      poses.push_back(touching(pair, k % 2 == 0, random));
    }
    NarrowPhasePeers peers;
    peers.push_back(std::make_unique<OurNarrowPhase>(pair.a, pair.b));
#ifdef SIGNORINI_PEER_BULLET
    add_bullet_narrow_phase(pair.a, pair.b, peers);
#endif
#ifdef SIGNORINI_PEER_FCL
    add_fcl_narrow_phase(pair.a, pair.b, peers);
#endif
    for (const auto& peer : peers) {
      const NarrowPhaseRow row = measure(*peer, pair, poses, options.repeats);
      out << fmt::format("{:<14}{:<14}{:>10.0f}{:>10.2f}{:>10.2f}\n", row.pair, row.name,
                         row.nanoseconds, row.points, row.valid);
      out.flush();
      report.rows.push_back(row);
    }
  }
  return report;
}

}  // namespace signorini::bench
