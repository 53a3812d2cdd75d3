#include <signorini/collision/gjk.h>

#include <array>
#include <cmath>
#include <limits>

namespace signorini::collision {
namespace {

/// Up to four points, and the point of their hull nearest to the origin.
struct Simplex {
  std::array<Vec3, 4> points;
  int count = 0;
  Vec3 nearest = Vec3::Zero();
  bool contains_origin = false;
};

/// The part of a simplex that carries the nearest point: up to three corners by number.
struct Nearest {
  Vec3 point = Vec3::Zero();
  std::array<int, 3> kept{};
  int count = 0;
};

Nearest on_segment(const Simplex& s, int i, int j) {
  const Vec3& a = s.points[i];
  const Vec3 ab = s.points[j] - a;
  const double t = -a.dot(ab);
  const double length = ab.squaredNorm();
  if (t <= 0.0) {
    return {a, {i}, 1};
  }
  if (t >= length) {
    return {s.points[j], {j}, 1};
  }
  return {a + t / length * ab, {i, j}, 2};
}

Nearest on_triangle(const Simplex& s, int i, int j, int k) {
  const Vec3& a = s.points[i];
  const Vec3& b = s.points[j];
  const Vec3& c = s.points[k];
  const Vec3 n = (b - a).cross(c - a);
  const double squared = n.squaredNorm();
  // Inside the three edges' planes: the foot of the perpendicular.
  if (squared > 0.0 && n.dot(a.cross(b)) >= 0.0 && n.dot(b.cross(c)) >= 0.0 &&
      n.dot(c.cross(a)) >= 0.0) {
    return {n.dot(a) / squared * n, {i, j, k}, 3};
  }
  Nearest best = on_segment(s, i, j);
  for (const Nearest& other : {on_segment(s, j, k), on_segment(s, k, i)}) {
    if (other.point.squaredNorm() < best.point.squaredNorm()) {
      best = other;
    }
  }
  return best;
}

/// Is the origin beyond the face (i, j, k), as seen from the fourth corner?
bool beyond(const Simplex& s, int i, int j, int k, int fourth) {
  const Vec3 n = (s.points[j] - s.points[i]).cross(s.points[k] - s.points[i]);
  const double side = n.dot(s.points[fourth] - s.points[i]);
  const double origin = -n.dot(s.points[i]);
  // A flat tetrahedron has no inside.
  const double flat = 1e-14 * n.norm() * (s.points[fourth] - s.points[i]).norm();
  return side * origin <= 0.0 || std::abs(side) <= flat;
}

void reduce(Simplex& s) {
  Nearest best;
  if (s.count == 1) {
    s.nearest = s.points[0];
    return;
  }
  if (s.count == 2) {
    best = on_segment(s, 0, 1);
  } else if (s.count == 3) {
    best = on_triangle(s, 0, 1, 2);
  } else {
    double least = std::numeric_limits<double>::infinity();
    constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
    for (const auto& f : kFaces) {
      if (!beyond(s, f[0], f[1], f[2], f[3])) {
        continue;
      }
      const Nearest other = on_triangle(s, f[0], f[1], f[2]);
      if (other.point.squaredNorm() < least) {
        least = other.point.squaredNorm();
        best = other;
      }
    }
    if (best.count == 0) {
      s.contains_origin = true;
      return;
    }
  }
  const Simplex old = s;
  s.count = best.count;
  for (int k = 0; k < best.count; ++k) {
    s.points[k] = old.points[best.kept[k]];
  }
  s.nearest = best.point;
}

}  // namespace

GjkResult gjk(const Convex& a, const Convex& b, double relative, double touch) {
  constexpr int kMost = 200;
  const auto difference = [&](const Vec3& n) { return Vec3(a.support(-n) - b.support(n)); };
  Vec3 start = a.centre() - b.centre();
  if (start.isZero(0.0)) {
    start = Vec3::UnitX();
  }
  Simplex simplex;
  simplex.points[0] = difference(start.stableNormalized());
  simplex.count = 1;
  reduce(simplex);

  GjkResult result;
  result.lower = -std::numeric_limits<double>::infinity();
  result.upper = simplex.nearest.stableNorm();
  for (int i = 0; i < kMost && result.upper > touch; ++i) {
    const Vec3 n = simplex.nearest / result.upper;
    const Vec3 w = difference(n);
    const double lower = n.dot(w);
    if (lower > result.lower) {
      result.lower = lower;
      result.normal = n;
    }
    if (result.upper - result.lower <= relative * result.upper) {
      return result;
    }
    simplex.points[simplex.count++] = w;
    reduce(simplex);
    if (simplex.contains_origin) {
      result.upper = 0.0;
      return result;
    }
    const double nearer = simplex.nearest.stableNorm();
    if (!(nearer < result.upper)) {
      return result;
    }
    result.upper = nearer;
  }
  return result;
}

}  // namespace signorini::collision
