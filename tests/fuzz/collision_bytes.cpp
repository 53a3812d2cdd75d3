#include "collision_bytes.h"

#include <signorini/collision/contact_time.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/pair_query.h>

#include "tests/collision/random_pairs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace signorini::collision::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }
  /// A number in [-1, 1], often one that makes shapes flush.
  double unit() {
    const std::uint8_t kind = byte();
    const auto value = static_cast<double>(static_cast<std::int8_t>(byte())) / 128.0;
    switch (kind % 4) {
      case 0: return static_cast<double>(static_cast<int>(8.0 * value)) / 8.0;
      case 1: return value;
      case 2: return value * 1e-9;
      default: return value + static_cast<double>(byte()) * 1e-16;
    }
  }
  /// > 0, 1e-3 to 1e3.
  double length() { return std::pow(10.0, 3.0 * unit()); }
  Vec3 vector() {
    const double x = unit();
    const double y = unit();
    return {x, y, unit()};
  }
  /// Any eight bytes as a double.
  double raw() {
    std::uint8_t bits[sizeof(double)];
    std::generate(std::begin(bits), std::end(bits), [this] { return byte(); });
    double value = 0.0;
    std::memcpy(&value, bits, sizeof value);
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

/// A tetrahedron or a wedge, stretched.
ConvexHull hull(const Vec3& size, bool is_wedge) {
  std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<std::vector<int>> faces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  if (is_wedge) {
    points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    faces = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  }
  for (Vec3& point : points) {
    point = size.cwiseProduct(point);
  }
  return make_hull(std::move(points), std::move(faces));
}

Shape shape(Bytes& bytes) {
  const double a = bytes.length();
  const double b = bytes.length();
  const double c = bytes.length();
  switch (bytes.byte() % 11) {
    case 0: return Sphere{a};
    case 1: return Box{Vec3(a, b, c)};
    case 2: return Box{Vec3::Constant(a)};
    case 3: return HalfSpace{};
    case 4: return Sphere{bytes.byte() == 0 ? bytes.raw() : b};
    case 5: return Capsule{a, b};
    case 6: return Cylinder{a, b};
    case 7: return Cone{a, b};
    case 8: return Ellipsoid{Vec3(a, b, c)};
    case 9: return hull(Vec3(a, b, c), false);
    default: return hull(Vec3(a, b, c), true);
  }
}

double extent(const Shape& shape) {
  return std::holds_alternative<HalfSpace>(shape) ? 1.0 : bounding_radius(shape, Pose{});
}

Pose pose(Bytes& bytes, double reach) {
  Quat q(1.0 + bytes.unit(), bytes.unit(), bytes.unit(), bytes.unit());
  if (bytes.byte() % 2 == 0) {
    q = Quat::Identity();
  }
  Vec3 position = reach * bytes.vector();
  if (bytes.byte() == 0) {
    position.x() = bytes.raw();
  }
  if (q.norm() > 0.1) {
    q.normalize();
  }
  return {position, q};
}

struct Case {
  Shape a, b;
  Pose pose_a, pose_b;
  double margin = 0.0;
  double size = 0.0;      ///< of both, m
  double rounding = 0.0;  ///< of a gap, m
  double search = 0.0;    ///< of a distance that is found by a search: 1e-8 of the smaller size, m
};

[[noreturn]] void broken(const char* promise, const Case& c, double value, double bound) {
  std::fprintf(stderr, "broken: %s: %.17g against %.17g\n%smargin %.17g\n", promise, value, bound,
               describe({c.a, c.pose_a, c.b, c.pose_b}).c_str(), c.margin);
  std::abort();
}

void judge(bool holds, const char* promise, const Case& c, double value, double bound) {
  if (!holds) {
    broken(promise, c, value, bound);
  }
}

void judge_contacts(const Case& c, double distance, const std::vector<Contact>& contacts) {
  const bool both_immovable =
      std::holds_alternative<HalfSpace>(c.a) && std::holds_alternative<HalfSpace>(c.b);
  if (both_immovable) {
    judge(contacts.empty(), "half-spaces have no contacts", c, 0.0, 0.0);
    return;
  }
  judge(contacts.empty() == !(distance <= c.margin), "contacts where distance <= margin", c,
        distance, c.margin);
  double least = kInfinity;
  std::set<std::uint64_t> ids;
  for (const Contact& contact : contacts) {
    judge(std::isfinite(contact.gap) && contact.point_a.allFinite() && contact.point_b.allFinite(),
          "finite contacts", c, contact.gap, 0.0);
    const double norm = contact.normal.norm();
    judge(std::abs(norm - 1.0) <= 1e-12, "|N| = 1", c, norm, 1.0);
    const double off = (contact.point_a - contact.point_b - contact.gap * contact.normal).norm();
    judge(off <= 1e-6 * c.size + c.rounding, "P_A - P_B = gap N", c, off, 1e-6 * c.size);
    judge(ids.insert(contact.feature_id).second, "ids differ", c, 0.0, 0.0);
    least = std::min(least, contact.gap);
  }
  if (!contacts.empty()) {
    judge(std::abs(least - distance) <= 2e-6 * c.size + c.rounding, "least gap = distance", c,
          least, distance);
  }
}

void judge_queries(const Case& c) {
  const double distance = signed_distance(c.a, c.pose_a, c.b, c.pose_b);
  judge(!std::isnan(distance), "no NaN", c, distance, 0.0);
  judge(test_intersection(c.a, c.pose_a, c.b, c.pose_b) == (distance <= 0.0) ||
            std::abs(distance) <= c.rounding,
        "test = (distance <= 0)", c, distance, 0.0);
  const double exchanged = signed_distance(c.b, c.pose_b, c.a, c.pose_a);
  judge(exchanged == distance || std::abs(exchanged - distance) <= c.rounding + c.search,
        "exchange keeps the distance", c, exchanged, distance);
  std::vector<Contact> contacts;
  find_intersection(c.a, c.pose_a, c.b, c.pose_b, c.margin, contacts);
  judge_contacts(c, distance, contacts);
}

void judge_contact_time(const Case& c, const Vec3& v, const Vec3& w) {
  constexpr double kDuration = 0.5;
  constexpr int kSamples = 64;
  const ConstantVelocityMotion motion(c.pose_a, v, w);
  const StillMotion still(c.pose_b);
  const std::optional<double> time = contact_time(c.a, motion, c.b, still, kDuration);
  const double end = time.value_or(kDuration);
  judge(end >= 0.0 && end <= kDuration, "time in [0, duration]", c, end, kDuration);
  if (std::holds_alternative<HalfSpace>(c.a)) {
    return;  // a half-space that turns sweeps everything
  }
  // From an overlap the level from which a dip counts is the deepest yet: contact_time_test.cpp.
  if (!(signed_distance(c.a, c.pose_a, c.b, c.pose_b) > c.rounding)) {
    return;
  }
  for (int k = 1; k < kSamples; ++k) {
    const double t = end * k / kSamples;
    const double gap = signed_distance(c.a, motion.pose(t), c.b, c.pose_b);
    const double allowed = 1e-8 * c.size + c.rounding + 1e-12 * v.norm();
    judge(gap >= -allowed, "no overlap before the contact time", c, gap, -allowed);
  }
}

}  // namespace

void judge_bytes(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  Case c;
  try {
    c.a = shape(bytes);
    c.b = shape(bytes);
    validate(c.a);
    validate(c.b);
  } catch (const std::invalid_argument&) {
    return;
  }
  const double reach = extent(c.a) + extent(c.b);
  c.search = 1e-8 * std::min(extent(c.a), extent(c.b));
  const double far = bytes.byte() % 4 == 0 ? std::abs(1e6 * bytes.unit()) : 0.0;
  c.pose_b = pose(bytes, reach);
  c.pose_b.position += far * Vec3::Ones();
  c.pose_a = pose(bytes, reach);
  c.pose_a.position += c.pose_b.position;
  c.margin = std::max(0.0, bytes.unit()) * reach;
  c.size = reach;
  const double largest =
      std::max(c.pose_a.position.cwiseAbs().maxCoeff(), c.pose_b.position.cwiseAbs().maxCoeff());
  c.rounding = 256.0 * kEpsilon * (reach + largest);
  try {
    validate(c.pose_a);
    validate(c.pose_b);
  } catch (const std::invalid_argument&) {
    return;
  }
  if (reach < 1e-6 || reach > 1e6 || largest > 1e9 * reach) {
    return;  // sizes whose squares leave the doubles' range, coordinates that swallow the shapes
  }
  judge_queries(c);
  const Vec3 v = reach * std::pow(10.0, 2.0 * bytes.unit()) * bytes.vector();
  const Vec3 w = 4.0 * bytes.vector();
  if (bytes.byte() % 8 == 0) {
    judge_contact_time(c, v, w);
  }
}

}  // namespace signorini::collision::testing
