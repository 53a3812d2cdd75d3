#include "bench/pair_checks.h"

#include <signorini/collision/pair_query.h>

#include "bench/shape_kinds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace signorini::bench {
namespace {

using namespace collision;           // NOLINT: the whole file is about them
using namespace collision::testing;  // NOLINT

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double distance(const PlacedPair& pair) {
  return signed_distance(pair.a, pair.pose_a, pair.b, pair.pose_b);
}

std::vector<Contact> contacts_of(const PlacedPair& pair, double margin) {
  std::vector<Contact> contacts;
  find_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b, margin, contacts);
  return contacts;
}

/// s(n) with B's position as the origin.
double separation(const PlacedPair& pair, const Vec3& n) {
  const Pose pose_a{pair.pose_a.position - pair.pose_b.position, pair.pose_a.orientation};
  const Pose pose_b{Vec3::Zero(), pair.pose_b.orientation};
  return -support(pair.a, pose_a, -n) - support(pair.b, pose_b, n);
}

/// How far a point lies outside a convex shape, by the directions given.
double outside(const Shape& shape, const Pose& pose, const Vec3& point,
               const std::array<Vec3, 4>& directions) {
  const Pose near{Vec3::Zero(), pose.orientation};
  double most = 0.0;
  for (const Vec3& n : directions) {
    const double h = support(shape, near, n);
    if (std::isfinite(h)) {
      most = std::max(most, n.dot(point - pose.position) - h);
    }
  }
  return most;
}

/// N, its opposite, 20 at random and 20 about N.
std::array<Vec3, 42> directions_about(const Vec3& N, Random& random) {
  std::array<Vec3, 42> result;
  result[0] = N;
  result[1] = -N;
  for (std::size_t k = 2; k < result.size(); k += 2) {
    result[k] = random_direction(random);
    result[k + 1] = (N + log_uniform(random, -8.0, 0.0) * random_direction(random)).normalized();
  }
  return result;
}

// Of the smaller size. A closed form loses some tens of roundings; 1e-9 is far above them.
constexpr double kOfClosedForm = 1e-9;

class Judge {
 public:
  Judge(const PlacedPair& pair, double margin, Random& random)
      : pair_(pair), margin_(margin), random_(random) {
    const bool boxes = std::holds_alternative<Box>(pair.a) && std::holds_alternative<Box>(pair.b);
    const bool closed_form = has_closed_form(pair.a) && has_closed_form(pair.b);
    allowed_ = (closed_form ? kOfClosedForm : kOfSearch) * pair.size + 200.0 * pair.rounding;
    preference_ = boxes || !closed_form ? kPreference * pair.size : 0.0;
  }

  JudgedPair run() {
    try {
      judge_distance();
      judge_contacts();
    } catch (const std::invalid_argument&) {
      book_.require(PairProperty::kNoNaN, false);  // every pose of the study is a good one
    }
    return {book_.verdict(), d_};
  }

 private:
  [[nodiscard]] double allowed(PairProperty property) const {
    switch (property) {
      case PairProperty::kNoBetter:
      case PairProperty::kTest:
      case PairProperty::kExchange:
      case PairProperty::kRigidMotion: return allowed_;
      case PairProperty::kPoints:
      case PairProperty::kParts: return allowed_ + 2.0 * preference_;
      default: return allowed_ + preference_;
    }
  }
  void off_by(PairProperty property, double metres) {
    book_.off_by(property, metres, allowed(property));
  }

  void judge_distance() {
    d_ = distance(pair_);
    book_.require(PairProperty::kNoNaN, !std::isnan(d_));
    const bool touch = test_intersection(pair_.a, pair_.pose_a, pair_.b, pair_.pose_b);
    if (touch != (d_ <= 0.0)) {
      off_by(PairProperty::kTest, std::abs(d_));
    }
    if (!std::isfinite(d_)) {
      return;
    }
    off_by(PairProperty::kExchange, std::abs(distance(exchanged(pair_)) - d_));
    const Pose motion{pair_.size * random_direction(random_), random_orientation(random_)};
    PlacedPair near = pair_;
    near.pose_a.position -= pair_.pose_b.position;
    near.pose_b.position.setZero();
    off_by(PairProperty::kRigidMotion, std::abs(distance(carried(near, motion)) - d_));
  }

  void judge_contacts() {
    const std::vector<Contact> contacts = contacts_of(pair_, margin_);
    if (contacts.empty()) {
      if (std::isfinite(d_) && d_ <= margin_) {
        off_by(PairProperty::kNothingMissed,
               std::max(margin_ - d_, 2.0 * allowed(PairProperty::kNothingMissed)));
      }
      return;
    }
    double least = kInfinity;
    Vec3 N = Vec3::Zero();
    for (const Contact& contact : contacts) {
      if (contact.gap < least) {
        least = contact.gap;
        N = contact.normal;
      }
      judge_contact(contact);
    }
    if (d_ > margin_) {
      off_by(PairProperty::kNothingBeyond, d_ - margin_);
    }
    // N may part the shapes by the preference less than the best direction does, and the least gap
    // be the preference from that, either way: above it where the deepest point lies beside the
    // face, below it where a point does.
    const double twice = allowed_ + 2.0 * preference_;
    book_.off_by(PairProperty::kCertified, std::abs(separation(pair_, N) - least), twice);
    book_.off_by(PairProperty::kCertified, std::abs(d_ - least), twice);
    for (const Vec3& n : directions_about(N, random_)) {
      const double s = separation(pair_, n);
      if (std::isfinite(s)) {
        off_by(PairProperty::kNoBetter, s - d_);
      }
    }
    off_by(PairProperty::kParts, std::abs(distance(moved(pair_, -least * N))));
  }

  void judge_contact(const Contact& contact) {
    book_.require(PairProperty::kNoNaN, std::isfinite(contact.gap) && contact.point_a.allFinite() &&
                                            contact.point_b.allFinite() &&
                                            contact.normal.allFinite());
    book_.require(PairProperty::kUnitNormal, std::abs(contact.normal.norm() - 1.0) <= 1e-12);
    off_by(PairProperty::kPoints,
           (contact.point_a - contact.point_b - contact.gap * contact.normal).norm());
    const std::array<Vec3, 4> directions{contact.normal, Vec3(-contact.normal),
                                         random_direction(random_), random_direction(random_)};
    off_by(PairProperty::kPoints, outside(pair_.a, pair_.pose_a, contact.point_a, directions));
    off_by(PairProperty::kPoints, outside(pair_.b, pair_.pose_b, contact.point_b, directions));
    off_by(PairProperty::kNothingBeyond, contact.gap - margin_);
  }

  const PlacedPair& pair_;
  double margin_;
  Random& random_;
  double allowed_;     ///< of a distance, m
  double preference_;  ///< of what a contact set's direction is chosen by, m; 0: not chosen
  double d_ = 0.0;
  VerdictBook book_;
};

}  // namespace

std::string_view to_string(PairProperty property) {
  switch (property) {
    case PairProperty::kNoNaN: return "no NaN";
    case PairProperty::kUnitNormal: return "|N| = 1";
    case PairProperty::kPoints: return "points";
    case PairProperty::kNothingMissed: return "missed";
    case PairProperty::kNothingBeyond: return "beyond";
    case PairProperty::kCertified: return "certified";
    case PairProperty::kNoBetter: return "no better";
    case PairProperty::kParts: return "parts";
    case PairProperty::kTest: return "test";
    case PairProperty::kExchange: return "exchange";
    case PairProperty::kRigidMotion: return "motion";
  }
  return "";
}

JudgedPair judge_pair(const PlacedPair& pair, double margin, Random& random) {
  return Judge(pair, margin, random).run();
}

PlacedPair kissing(const PlacedPair& pair, Random& random) {
  const std::vector<Contact> contacts = contacts_of(pair, kInfinity);
  if (contacts.empty()) {
    return pair;
  }
  const Contact& nearest =
      *std::min_element(contacts.begin(), contacts.end(),
                        [](const Contact& p, const Contact& q) { return p.gap < q.gap; });
  const double kind = uniform(random, 0.0, 3.0);
  double gap = 0.0;
  if (kind < 1.0) {
    gap = pair.size * 1e-9 * uniform(random, -1.0, 1.0);
  } else if (kind < 2.0) {
    gap = std::round(uniform(random, -4.0, 4.0)) * pair.rounding;
  }
  return moved(pair, (gap - nearest.gap) * nearest.normal);
}

}  // namespace signorini::bench
