#include <signorini/collision/gjk.h>
#include <signorini/collision/penetration.h>
#include <signorini/collision/polyhedron_separation.h>
#include <signorini/collision/rims.h>
#include <signorini/collision/separation.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace signorini::collision {
namespace {

using Kind = Stratum::Kind;
/// Directions to try for a pair of pieces: three at most.
struct Normals {
  std::array<Vec3, 3> directions{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  int count = 0;

  void add(const Vec3& n) { directions[count++] = n; }
};

/// Relative to the smaller size: nearer than this GJK's normal is not used alone.
constexpr double kTouch = 1e-4;
/// How near, relative, the polytope and GJK come before the pieces of surface take over.
constexpr double kNear = 1e-8;
constexpr double kGjkNear = 1e-12;
/// The angles, radians, within which pieces of surface are tried: first, and again from there.
constexpr double kAngles[] = {2e-2, 1e-5};
constexpr int kNewtonSteps = 30;
/// Relative to the smaller size: separations that count as equal.
constexpr double kTie = 1e-9;
/// Of the polytope's equally good directions those are tried that are this far (cosine) from each
/// other.
constexpr double kSameBasin = 0.999;
constexpr std::size_t kMostBasins = 6;

/// The constraint n.axis = slope of a line on one of the two shapes (the outward normal of A is
/// -n).
struct Circle {
  Vec3 axis;
  double slope;

  Circle(const Stratum& line, bool of_a)
      : axis(line.axis), slope(of_a ? -line.slope : line.slope) {}
};

/// The point of a piece, and its radii, for the direction n from B to A. Of a line its anchor,
/// whose n.x differs from h by a constant on the circle.
Vec3 point_of(const Stratum& piece, const Vec3& outward) {
  return piece.is_free() ? piece.point(outward) : piece.anchor;
}

/// Newton on the circle of a line for a free piece of the other shape; nothing if n is along the
/// axis.
std::optional<Vec3> on_circle(const Stratum& a, const Stratum& b, const Circle& circle,
                              const Vec3& start) {
  const double c = std::sqrt((1.0 - circle.slope) * (1.0 + circle.slope));
  Vec3 u = start - start.dot(circle.axis) * circle.axis;
  if (!(u.norm() > 1e-12)) {
    return std::nullopt;
  }
  u.normalize();
  const auto normal = [&] { return Vec3(circle.slope * circle.axis + c * u); };
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Vec3 n = normal();
    const Vec3 W = point_of(a, -n) - point_of(b, n);
    const Vec3 t = circle.axis.cross(u);
    double curved = 0.0;
    for (const auto& [piece, outward] : {std::pair(&a, Vec3(-n)), std::pair(&b, n)}) {
      if (piece->is_free()) {
        curved += t.dot(piece->radii(outward) * t);
      }
    }
    const double slope = c * W.dot(t);
    const double bend = c * W.dot(u) + c * c * curved;
    if (!(bend > 0.0)) {
      break;  // no maximum here, or s is the same all around (one axis): any n on the circle counts
    }
    const double step = std::clamp(slope / bend, -0.5, 0.5);
    u = (std::cos(step) * u + std::sin(step) * t).normalized();
    if (std::abs(step) <= 1e-15) {
      break;
    }
  }
  return normal().normalized();
}

/// The normals that two lines share; the one nearer to `near` first.
Normals of_lines(const Stratum& a, const Stratum& b, const Vec3& near) {
  const Circle p(a, true);
  const Circle q(b, false);
  const Vec3 cross = p.axis.cross(q.axis);
  const double squared = cross.squaredNorm();
  Normals result;
  if (squared > 1e-20) {
    const double g = p.axis.dot(q.axis);
    const Vec3 base =
        ((p.slope - g * q.slope) * p.axis + (q.slope - g * p.slope) * q.axis) / squared;
    const double rest = 1.0 - base.squaredNorm();
    if (rest >= 0.0) {
      const Vec3 out = std::sqrt(rest / squared) * cross;
      const double side = out.dot(near) < 0.0 ? -1.0 : 1.0;
      result.add((base + side * out).normalized());
    }
  }
  if (squared < 1e-6) {
    // Nearly parallel: as if exactly so.
    if (const auto n = on_circle(a, b, p, near)) {
      result.add(*n);
    }
    if (const auto n = on_circle(a, b, q, near)) {
      result.add(*n);
    }
  }
  return result;
}

/// Newton on the sphere for two free pieces.
std::optional<Vec3> on_sphere(const Stratum& a, const Stratum& b, Vec3 n) {
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Vec3 W = a.point(-n) - b.point(n);
    Eigen::Matrix<double, 3, 2> T;
    T.col(0) = n.unitOrthogonal();
    T.col(1) = n.cross(T.col(0));
    const Eigen::Matrix2d H =
        T.transpose() * (a.radii(-n) + b.radii(n)) * T + n.dot(W) * Eigen::Matrix2d::Identity();
    const Eigen::LLT<Eigen::Matrix2d> factor(H);
    if (factor.info() != Eigen::Success) {
      return std::nullopt;
    }
    Eigen::Vector2d step = factor.solve(T.transpose() * W);
    if (!step.allFinite()) {
      return std::nullopt;
    }
    const double length = step.norm();
    if (a.kind != Kind::kVertex || b.kind != Kind::kVertex) {
      step *= std::min(1.0, 0.5 / length);
    }
    n = (n + T * step).normalized();
    if (length <= 1e-15) {
      break;
    }
  }
  return n;
}

/// The normals at which s may be largest, for one piece of each shape.
Normals normals_of(const Stratum& a, const Stratum& b, const Vec3& near) {
  Normals result;
  if (a.kind == Kind::kFace || b.kind == Kind::kFace) {
    result.add(a.kind == Kind::kFace ? Vec3(-a.axis) : b.axis);
    return result;
  }
  if (a.kind == Kind::kLine && b.kind == Kind::kLine) {
    return of_lines(a, b, near);
  }
  const std::optional<Vec3> n = a.kind == Kind::kLine   ? on_circle(a, b, Circle(a, true), near)
                                : b.kind == Kind::kLine ? on_circle(a, b, Circle(b, false), near)
                                                        : on_sphere(a, b, near);
  if (n) {
    result.add(*n);
  }
  return result;
}

/// How sharply a pair of pieces determines its normal.
int rank_of(const Stratum& a, const Stratum& b) {
  if (a.kind == Kind::kFace || b.kind == Kind::kFace) {
    return 3;
  }
  return (a.kind == Kind::kLine) + (b.kind == Kind::kLine);
}

/// Of the free pieces the one that reaches furthest along n.
const Stratum* furthest_free(const std::vector<Stratum>& pieces, const Vec3& n) {
  const Stratum* best = nullptr;
  for (const Stratum& piece : pieces) {
    if (piece.is_free() && (best == nullptr || n.dot(piece.point(n)) > n.dot(best->point(n)))) {
      best = &piece;
    }
  }
  return best;
}

struct Candidate {
  double distance;
  Vec3 normal;
  int rank;
  Stratum a;
  Stratum b;
};

/// What a search works on: kept from query to query.
struct SearchMemory {
  std::vector<Candidate> candidates;
  std::vector<const Candidate*> tied;
  std::vector<Stratum> pieces_a;
  std::vector<Stratum> pieces_b;
  std::vector<Axis> axes;
};

class Search {
 public:
  Search(const Convex& a, const Convex& b, SearchMemory& memory)
      : a_(a),
        b_(b),
        candidates_(memory.candidates),
        tied_(memory.tied),
        pieces_a_(memory.pieces_a),
        pieces_b_(memory.pieces_b) {
    candidates_.clear();
  }

  void refine(const Vec3& near) {
    try_pieces(near, kAngles[0]);
    try_pieces(Vec3(candidates_[highest_].normal), kAngles[1]);
  }

  /// Looks along the directions of all pieces within an angle of each of some directions (s may
  /// have several maxima on one pair of pieces), and goes on from one that is better by more than a
  /// tie.
  template <std::size_t kCount>
  void refine_around(const std::array<Vec3, kCount>& directions, double angle) {
    double best = distance() + tie();
    std::optional<Vec3> better;
    for (const Vec3& direction : directions) {
      for_all_normals(direction, angle, [&](const Vec3& n, const Stratum&, const Stratum&) {
        const double s = separation_along(a_, b_, n);
        if (s > best) {
          best = s;
          better = n;
        }
      });
    }
    if (better) {
      refine(*better);
    }
  }

  /// Two rims nearly flush: rounding stops GJK, and at its normal a rim has no one point.
  void refine_rims() {
    const Vec3 n = normal();
    collect_pieces(n, kAngles[0]);
    for (const Stratum& piece_a : pieces_a_) {
      for (const Stratum& piece_b : pieces_b_) {
        if (piece_a.kind == Kind::kRim && piece_b.kind == Kind::kRim) {
          const RimDirections found = crossing_rims(piece_a, piece_b, n);
          for (int k = 0; k < found.count; ++k) {
            offer(found.normals[k], 0, piece_a, piece_b);
          }
        }
      }
    }
  }

  /// Has a pair of pieces come at least as far as the directions it started from?
  [[nodiscard]] bool is_refined() const { return candidates_[highest_].rank >= 0; }

  void write_best(Separation& result) {
    const double largest = candidates_[highest_].distance;
    tied_.clear();
    for (const Candidate& candidate : candidates_) {
      if (candidate.distance >= largest - tie()) {
        // By insertion, which is stable and needs no memory.
        const auto place = std::upper_bound(
            tied_.begin(), tied_.end(), &candidate, [](const Candidate* p, const Candidate* q) {
              return p->rank != q->rank ? p->rank > q->rank : p->distance > q->distance;
            });
        tied_.insert(place, &candidate);
      }
    }
    result.distance = largest;
    result.face = face();
    result.meetings.clear();
    for (const Candidate* candidate : tied_) {
      result.meetings.push_back({candidate->normal, candidate->a, candidate->b});
    }
  }

  /// Less than this between two separations, m, counts as nothing.
  [[nodiscard]] double tie() const {
    return kTie * std::min(a_.size(), b_.size()) +
           16.0 * std::numeric_limits<double>::epsilon() * (a_.size() + b_.size());
  }
  [[nodiscard]] double distance() const { return candidates_[highest_].distance; }
  [[nodiscard]] Vec3 normal() const { return candidates_[highest_].normal; }

 private:
  void offer(const Vec3& n, int rank, const Stratum& piece_a, const Stratum& piece_b) {
    const double s = separation_along(a_, b_, n);
    const bool is_highest = candidates_.empty() || s > candidates_[highest_].distance;
    if (!is_highest && s < candidates_[highest_].distance - preference_tolerance(a_, b_)) {
      return;
    }
    if (is_highest) {
      highest_ = candidates_.size();
    }
    candidates_.push_back({s, n, rank, piece_a, piece_b});
  }

  void collect_pieces(const Vec3& near, double angle) {
    pieces_a_.clear();
    pieces_b_.clear();
    a_.add_strata(-near, angle, pieces_a_);
    b_.add_strata(near, angle, pieces_b_);
  }

  /// visit(n, piece_a, piece_b) for the normals of every pair of pieces within an angle of `near`.
  template <class Visit>
  void for_all_normals(const Vec3& near, double angle, Visit&& visit) {
    collect_pieces(near, angle);
    for (const Stratum& piece_a : pieces_a_) {
      for (const Stratum& piece_b : pieces_b_) {
        const Normals normals = normals_of(piece_a, piece_b, near);
        for (int k = 0; k < normals.count; ++k) {
          visit(normals.directions[k], piece_a, piece_b);
        }
      }
    }
  }

  void try_pieces(const Vec3& near, double angle) {
    for_all_normals(near, angle,
                    [&](const Vec3& n, const Stratum& piece_a, const Stratum& piece_b) {
                      offer(n, rank_of(piece_a, piece_b), piece_a, piece_b);
                    });
    offer(near, -1, *furthest_free(pieces_a_, -near), *furthest_free(pieces_b_, near));
  }

  [[nodiscard]] std::optional<FacingFace> face() const {
    std::optional<FacingFace> best;
    double best_area = 0.0;
    for (const Candidate& candidate : candidates_) {
      if (candidate.rank < 3 ||
          !is_as_far(a_, b_, candidates_[highest_].distance, candidate.distance)) {
        continue;
      }
      for (const Stratum* piece : {&candidate.a, &candidate.b}) {
        const bool of_a = piece == &candidate.a;
        const FacingFace found{of_a, of_a ? Vec3(-piece->axis) : piece->axis, candidate.distance};
        if (piece->kind == Kind::kFace && found.normal == candidate.normal &&
            (!best || prefers(found, piece->area, *best, best_area))) {
          best = found;
          best_area = piece->area;
        }
      }
    }
    return best;
  }

  const Convex& a_;
  const Convex& b_;
  std::vector<Candidate>& candidates_;
  std::vector<const Candidate*>& tied_;
  std::vector<Stratum>& pieces_a_;
  std::vector<Stratum>& pieces_b_;
  std::size_t highest_ = 0;
};

SearchMemory& memory() {
  thread_local SearchMemory of_this_thread;
  return of_this_thread;
}

constexpr double kAllAbout = 1.6;  // radians

/// Cores that all but touch, as on an edge, are nearly parted along many directions. Where one is
/// much larger the polytope's rounding hides which is the best one, and all pieces of surface about
/// the one it ended at are tried.
void refine_touch(Search& search, const Convex& a, const Convex& b) {
  constexpr double kMuchLarger = 30.0;
  constexpr double kAside = 0.3;
  const double size = std::min(a.size(), b.size());
  const double depth = -(search.distance() + a.rounding() + b.rounding());
  if (depth <= kTouch * size && std::max(a.size(), b.size()) > kMuchLarger * size) {
    const Vec3 n = search.normal();
    const Vec3 along = kAside * n.unitOrthogonal();
    const Vec3 across = n.cross(along);
    search.refine_around(std::array<Vec3, 5>{n, (n + along).normalized(), (n - along).normalized(),
                                             (n + across).normalized(), (n - across).normalized()},
                         kAllAbout);
  }
}

/// Where one shape lies deep in a round one the polytope's points run out before it knows the best
/// direction: s has a maximum wherever a face or edge of one comes nearest to the other's surface,
/// and all of them are nearly as good.
void refine_deep(Search& search, double size) {
  if (search.distance() > -0.5 * size) {
    return;
  }
  std::array<Vec3, 26> directions;
  std::size_t count = 0;
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0}) {
        const Vec3 direction(x, y, z);
        if (!direction.isZero()) {
          directions[count++] = direction.normalized();
        }
      }
    }
  }
  search.refine_around(directions, kAllAbout);
}

/// Everything that separate() tries.
void run(Search& search, const Convex& a, const Convex& b, std::vector<Axis>& axes) {
  const double size = std::min(a.size(), b.size());
  const GjkResult near = gjk(a, b, kGjkNear, 0.0);
  if (near.lower > -kTouch * size && !near.normal.isZero(0.0)) {
    search.refine(near.normal);
    if (near.lower > 0.0 && !search.is_refined()) {
      search.refine(gjk(a, b, 0.0, 0.0).normal);  // Newton needs to start nearer
    }
    if (near.lower > 0.0 &&
        near.upper - (a.rounding() + b.rounding()) > search.distance() + search.tie()) {
      search.refine_rims();
    }
  }
  if (near.lower <= kTouch * size) {
    const bool is_certain = penetration(a, b, kNear * size, axes);
    std::array<Vec3, kMostBasins> tried;
    std::size_t count = 0;
    for (const Axis& axis : axes) {
      const bool is_new = std::all_of(tried.begin(), tried.begin() + count, [&](const Vec3& n) {
        return n.dot(axis.normal) < kSameBasin;
      });
      if (is_new && count < kMostBasins) {
        tried[count++] = axis.normal;
        search.refine(axis.normal);
      }
    }
    if (!is_certain) {
      refine_deep(search, size);
    }
    refine_touch(search, a, b);
  }
}

}  // namespace

bool prefers(const FacingFace& p, double area_p, const FacingFace& q, double area_q) {
  if (std::abs(area_p - area_q) > 1e-9 * (area_p + area_q)) {
    return area_p > area_q;
  }
  if (p.of_a == q.of_a) {
    return false;
  }
  const Vec3 odd_direction(0.2672612, 0.5345225, 0.8017837);
  return ((p.normal + q.normal).dot(odd_direction) < 0.0) == p.of_a;
}

double preference_tolerance(const Convex& a, const Convex& b) {
  return 1e-6 * std::min(a.size(), b.size());
}

bool is_as_far(const Convex& a, const Convex& b, double largest, double separation) {
  const double tolerance = preference_tolerance(a, b);
  const double rounding =
      64.0 * std::numeric_limits<double>::epsilon() * (a.size() + b.size() + std::abs(largest));
  const double less = std::max(0.0, largest - separation - rounding);
  const double sum = largest + separation + 2.0 * (a.rounding() + b.rounding());
  return less <= tolerance && less * sum <= tolerance * tolerance;
}

double separation_along(const Convex& a, const Convex& b, const Vec3& n) {
  return n.dot(a.support(-n) - b.support(n)) - (a.rounding() + b.rounding());
}

void separate(const Convex& a, const Convex& b, Separation& separation) {
  Search search(a, b, memory());
  run(search, a, b, memory().axes);
  search.write_best(separation);
}

double distance(const Convex& a, const Convex& b) {
  double at_least = -std::numeric_limits<double>::infinity();
  if (a.polyhedron() != nullptr && b.polyhedron() != nullptr) {
    PolyhedronSeparation found;
    separate_polyhedra(a, b, found);
    if (found.is_distance) {
      return found.separation;
    }
    at_least = found.separation;
  }
  Search search(a, b, memory());
  run(search, a, b, memory().axes);
  return std::max(at_least, search.distance());
}

bool overlap(const Convex& a, const Convex& b) {
  if (a.polyhedron() != nullptr && b.polyhedron() != nullptr) {
    PolyhedronSeparation found;
    separate_polyhedra(a, b, found);
    if (found.separation > 0.0 || found.is_distance) {
      return found.separation <= 0.0;
    }
  }
  const double touch = kTouch * std::min(a.size(), b.size());
  const GjkResult near = gjk(a, b, 0.5, touch);
  if (near.lower > a.rounding() + b.rounding() + touch) {
    return false;
  }
  return distance(a, b) <= 0.0;
}

}  // namespace signorini::collision
