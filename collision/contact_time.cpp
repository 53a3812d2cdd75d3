#include <signorini/collision/contact_time.h>
#include <signorini/collision/pair_query.h>
#include <signorini/core/model/number_text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace signorini::collision {
namespace {

constexpr double kRelativeTolerance = 1e-9;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kCertifiedIntervals = 100000;
/// In an overlap: so many intervals with the tolerance alone, then with this part of the depth.
constexpr int kStrictIntervals = 1000;
constexpr double kDepthSlack = 0.1;
constexpr int kSamplesBeyond = 1000;
/// Above this turn of one frame, radians, the flat-space deviation bounds are not used.
constexpr double kLargestTurn = 0.5;

bool is_half_space(const Shape& shape) {
  return std::holds_alternative<HalfSpace>(shape);
}

/// How far from the frame's origin the part of the shape lies that turning moves: a ball that sits
/// at the origin looks the same however it turns.
double turning_radius(const MovingShape& moving) {
  if (const auto* sphere = std::get_if<Sphere>(&moving.shape)) {
    return bounding_radius(*sphere, moving.local) - sphere->radius;
  }
  return bounding_radius(moving.shape, moving.local);
}

/// Where the two frames are at one time, and the gap there.
struct Moment {
  double time;
  Pose frame_a;
  Pose frame_b;
  Pose shape_a;
  Pose shape_b;
  double gap;
};

/// sqrt(x^2 - y^2), 0 where rounding makes it negative.
double leg(double x, double y) {
  return std::sqrt(std::max(0.0, (x - y) * (x + y)));
}

SpeedBound checked_bound(const Motion& motion, double t0, double t1) {
  const SpeedBound bound = motion.speed_bound(t0, t1);
  if (!(bound.linear >= 0.0 && bound.angular >= 0.0 && std::isfinite(bound.linear) &&
        std::isfinite(bound.angular))) {
    throw std::invalid_argument("motion: speed_bound: must be finite and >= 0, got " +
                                number_text(bound.linear) + " m/s, " + number_text(bound.angular) +
                                " rad/s");
  }
  return bound;
}

/// How far, between two times, a point of a shape can be from the straight line between its places
/// at these times.
struct Straying {
  double anywhere = 0.0;    ///< in any direction, m; +infinity where no bound is known
  Vec3 arc = Vec3::Zero();  ///< along n by |n x arc| more, m: the arc about a fixed axis

  [[nodiscard]] double along(const Vec3& n) const { return anywhere + n.cross(arc).norm(); }
};

Straying straying(const SpeedBound& speed, double radius, const Pose& start, const Pose& end,
                  double step) {
  const double travel = speed.linear * step;
  const double chord = std::min(travel, (end.position - start.position).norm());
  const double bend = 0.5 * leg(travel, chord) + (travel - chord);
  const double turn = speed.angular * step;
  if (radius == 0.0 || turn == 0.0) {
    return {bend, Vec3::Zero()};
  }
  if (turn > kLargestTurn || !std::isfinite(radius)) {
    return {kInfinity, Vec3::Zero()};
  }
  const Eigen::AngleAxisd turned(end.orientation * start.orientation.conjugate());
  const double angle = std::min(turn, turned.angle());
  const double turn_bend = 1.1 * (0.5 * leg(turn, angle) + (turn - angle));
  return {bend + radius * turn_bend, radius * 0.125 * angle * angle * turned.axis()};
}

class Search {
 public:
  Search(const MovingShape& a, const MovingShape& b, double duration)
      : a_(a),
        b_(b),
        duration_(duration),
        radius_a_(turning_radius(a)),
        radius_b_(turning_radius(b)) {
    const Moment start = at(0.0);
    const Moment end = at(duration);
    double size = kInfinity;
    for (const Shape* shape : {&a.shape, &b.shape}) {
      size = std::min(size, bounding_radius(*shape, Pose{}));
    }
    double far = 0.0;
    for (const Pose* pose : {&start.shape_a, &start.shape_b, &end.shape_a, &end.shape_b}) {
      far = std::max(far, pose->position.cwiseAbs().maxCoeff());
    }
    rounding_ = 16.0 * kEpsilon * (size + far);
    tolerance_ = std::max(kRelativeTolerance * size, 4.0 * rounding_);
  }

  [[nodiscard]] std::optional<double> run() {
    Moment here = at(0.0);
    Moment above = here;         // the last one at the level
    Moment above_before = here;  // the one before it
    level_ = std::min(0.0, here.gap);
    const bool touching = here.gap <= 0.5 * tolerance_;
    double step = duration_;
    double sampling_step = 0.0;
    for (int intervals = 0; here.time < duration_; ++intervals) {
      // In an overlap that shrinks the gap is at the level all the time, and steps that prove that
      // it is never eps below would be as short as eps over the speed.
      slack_ =
          intervals < kStrictIntervals ? tolerance_ : std::max(tolerance_, -kDepthSlack * level_);
      if (intervals == kCertifiedIntervals) {
        sampling_step = (duration_ - here.time) / kSamplesBeyond;
      }
      const double free_step = std::max(sure_step(here), sampling_step);
      step = std::clamp(step, free_step, std::max(free_step, duration_ - here.time));
      const Moment next = at(std::min(duration_, here.time + step));
      if (!(next.time > here.time)) {
        return std::nullopt;  // the rest of the interval is below the resolution of time
      }
      if (step > free_step && !is_free(here, next)) {
        step = shorter_step(here, next);
        continue;
      }
      if (next.gap <= level_ - 0.5 * tolerance_) {
        // In a longer step it may have been higher since the last but one time at the level.
        if (slack_ > tolerance_) {
          const Moment top = highest(above_before.time, next.time);
          if (top.gap > level_) {
            above = top;
            level_ = std::min(0.0, top.gap);
          }
        }
        return touching && above.time == 0.0 ? 0.0 : crossing_time(above.time, next.time);
      }
      if (next.gap >= level_ - rounding_) {
        above_before = above;
        above = next;
        level_ = std::max(level_, std::min(0.0, next.gap));
      }
      here = next;
      step *= 2.0;
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] Moment at(double time) const {
    Moment moment{time, a_.motion.pose(time), b_.motion.pose(time), {}, {}, 0.0};
    moment.shape_a = moment.frame_a * a_.local;
    moment.shape_b = moment.frame_b * b_.local;
    moment.gap = signed_distance(a_.shape, moment.shape_a, b_.shape, moment.shape_b);
    return moment;
  }

  /// A bound on |d'| in [here, here + step].
  [[nodiscard]] double closing_bound(const Moment& here, double t1) const {
    const SpeedBound a = checked_bound(a_.motion, here.time, t1);
    const SpeedBound b = checked_bound(b_.motion, here.time, t1);
    // A plane sweeps the other shape no faster than it moves at the other's furthest point.
    const double apart = (here.frame_a.position - here.frame_b.position).norm() +
                         (a.linear + b.linear) * (t1 - here.time);
    const double arm_a = is_half_space(a_.shape) ? apart + radius_b_ : radius_a_;
    const double arm_b = is_half_space(b_.shape) ? apart + radius_a_ : radius_b_;
    return a.linear + b.linear + a.angular * arm_a + b.angular * arm_b;
  }

  /// A step that needs no look at its end: plain conservative advancement.
  [[nodiscard]] double sure_step(const Moment& here) const {
    const double speed = closing_bound(here, duration_);
    const double rest = duration_ - here.time;
    const double slack = here.gap - (level_ - slack_);
    return slack >= speed * rest ? rest : slack / speed;
  }

  [[nodiscard]] bool is_free(const Moment& t0, const Moment& t1) const {
    const double floor = level_ - slack_;
    if (t1.gap < floor) {
      return false;
    }
    const double step = t1.time - t0.time;
    if (0.5 * (t0.gap + t1.gap - closing_bound(t0, t1.time) * step) >= floor) {
      return true;
    }
    const Straying a = straying(checked_bound(a_.motion, t0.time, t1.time), radius_a_, t0.frame_a,
                                t1.frame_a, step);
    const Straying b = straying(checked_bound(b_.motion, t0.time, t1.time), radius_b_, t0.frame_b,
                                t1.frame_b, step);
    if (!(std::min(t0.gap, t1.gap) - a.anywhere - b.anywhere >= floor)) {
      return false;
    }
    for (const Moment* moment : {&t0, &t1}) {
      const Vec3 n = normal(*moment);
      if (std::min(separation(t0, n), separation(t1, n)) - a.along(n) - b.along(n) >= floor) {
        return true;
      }
    }
    return false;
  }

  /// From B to A, of the contact with the least gap.
  [[nodiscard]] Vec3 normal(const Moment& moment) const {
    std::vector<Contact> contacts;
    find_intersection(a_.shape, moment.shape_a, b_.shape, moment.shape_b,
                      std::max(0.0, moment.gap) + rounding_, contacts);
    return std::min_element(contacts.begin(), contacts.end(),
                            [](const Contact& p, const Contact& q) { return p.gap < q.gap; })
        ->normal;
  }

  /// s_n: how far apart the shapes are along n.
  [[nodiscard]] double separation(const Moment& moment, const Vec3& n) const {
    const Vec3 origin = moment.shape_b.position;
    const Pose pose_a{moment.shape_a.position - origin, moment.shape_a.orientation};
    const Pose pose_b{Vec3::Zero(), moment.shape_b.orientation};
    return -support(a_.shape, pose_a, -n) - support(b_.shape, pose_b, n);
  }

  /// The next try after [here, next] was not shown to be free: half of it, or towards the crossing
  /// of the level where the gap at its end is below it.
  [[nodiscard]] double shorter_step(const Moment& here, const Moment& next) const {
    const double step = next.time - here.time;
    const double target = level_ - 0.75 * tolerance_;
    if (next.gap >= target || here.gap <= target) {
      return 0.5 * step;
    }
    const double crossing = (here.gap - target) / (here.gap - next.gap);
    return step * std::clamp(crossing, 0.01, 0.99);
  }

  /// The moment at which a gap that rises and then falls is largest, by golden section.
  [[nodiscard]] Moment highest(double low, double high) const {
    constexpr double kGolden = 0.6180339887498949;
    constexpr int kSections = 60;  // of the interval 3e-13
    Moment left = at(high - kGolden * (high - low));
    Moment right = at(low + kGolden * (high - low));
    for (int k = 0; k < kSections; ++k) {
      if (left.gap >= right.gap) {
        high = right.time;
        right = left;
        left = at(high - kGolden * (high - low));
      } else {
        low = left.time;
        left = right;
        right = at(low + kGolden * (high - low));
      }
    }
    return left.gap >= right.gap ? left : right;
  }

  /// A time in [low, high] at which the gap crosses the level, by bisection to the resolution of
  /// time; its earlier side. @pre gap(low) >= level - rounding, gap(high) < level
  [[nodiscard]] double crossing_time(double low, double high) const {
    while (true) {
      const double middle = 0.5 * (low + high);
      if (!(middle > low && middle < high)) {
        return low;
      }
      (at(middle).gap >= level_ ? low : high) = middle;
    }
  }

  MovingShape a_;
  MovingShape b_;
  double duration_;
  double radius_a_;
  double radius_b_;
  double rounding_ = 0.0;   ///< of a gap, m
  double tolerance_ = 0.0;  ///< eps
  double slack_ = 0.0;      ///< an interval is free where the gap stays above level - slack, m
  double level_ = 0.0;
};

}  // namespace

std::optional<double> contact_time(const MovingShape& a, const MovingShape& b, double duration) {
  if (!(duration >= 0.0) || !std::isfinite(duration)) {
    throw std::invalid_argument("contact_time: duration: must be finite and >= 0, got " +
                                number_text(duration) + " s");
  }
  if (is_half_space(a.shape) && is_half_space(b.shape)) {
    return std::nullopt;
  }
  return Search(a, b, duration).run();
}

std::optional<double> contact_time(const Shape& a, const Motion& motion_a, const Shape& b,
                                   const Motion& motion_b, double duration) {
  return contact_time({a, motion_a, {}}, {b, motion_b, {}}, duration);
}

}  // namespace signorini::collision
