#include "bench/narrow_phase_study.h"

#include <signorini/collision/contact_reduction.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/mesh.h>
#include <signorini/collision/pair_query.h>
#include <signorini/collision/segments.h>

#include "bench/narrow_phase_peer.h"
#include "bench/thread_time.h"
#include "tests/collision/random_pairs.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <ostream>
#include <stdexcept>

namespace signorini::bench {
namespace {

using collision::Box;
using collision::Capsule;
using collision::Shape;
using collision::Sphere;
using collision::testing::Random;
using collision::testing::random_direction;
using collision::testing::random_orientation;
using collision::testing::uniform;

class OurNarrowPhase final : public NarrowPhasePeer {
 public:
  /// @param most of a patch; 0: all
  OurNarrowPhase(const Shape& a, const Shape& b, int most) : a_(a), b_(b), most_(most) {}
  [[nodiscard]] std::string name() const override {
    return most_ == 0 ? "signorini" : fmt::format("signorini, {}", most_);
  }
  void query(const Pose& a, const Pose& b) override {
    collision::find_intersection(a_, a, b_, b, 0.0, found_);
    if (most_ != 0) {
      (void)collision::reduce_contacts(found_, most_);
    }
  }
  void read(std::vector<Contact>& contacts) override { contacts = found_; }

 private:
  const Shape& a_;
  const Shape& b_;
  int most_;
  std::vector<Contact> found_;
};

struct Pair {
  const char* name;
  Shape a, b;
  Quat face_down_a = Quat::Identity();  ///< turns A so that a face of it looks down
  Quat face_up_b = Quat::Identity();    ///< turns B so that a face of it looks up
};

/// The hull of 18 points of a spiral on an ellipsoid: 32 triangles, each found by trying every
/// three points.
collision::ConvexHull hull_of_32_faces(const Vec3& radii) {
  constexpr int kPoints = 18;
  std::vector<Vec3> points;
  points.reserve(kPoints);
  for (int k = 0; k < kPoints; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / kPoints;
    const double angle = k * M_PI * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    points.push_back(radii.cwiseProduct(Vec3(r * std::cos(angle), r * std::sin(angle), z)));
  }
  std::vector<std::vector<int>> faces;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = i + 1; j < kPoints; ++j) {
      for (int k = j + 1; k < kPoints; ++k) {
        const Vec3 n = (points[j] - points[i]).cross(points[k] - points[i]);
        int above = 0;
        int below = 0;
        for (const Vec3& point : points) {
          const double height = n.dot(point - points[i]);
          above += height > 1e-12 ? 1 : 0;
          below += height < -1e-12 ? 1 : 0;
        }
        if (above == 0) {
          faces.push_back({i, j, k});
        } else if (below == 0) {
          faces.push_back({i, k, j});
        }
      }
    }
  }
  return collision::make_hull(std::move(points), std::move(faces));
}

/// Ground of 200 triangles, 5 m square: flat where x < 0, bumps elsewhere.
collision::TriangleMesh ground() {
  constexpr int kSide = 11;
  std::vector<double> heights;
  heights.reserve(kSide * kSide);
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      heights.push_back(i <= kSide / 2 ? 0.0 : 0.15 * std::sin(2.0 * i) * std::cos(1.7 * j));
    }
  }
  return collision::make_height_field(heights, kSide, kSide, 0.5, 0.5);
}

Quat turn_face(const collision::ConvexHull& hull, const Vec3& to) {
  return Quat::FromTwoVectors(hull.data->normals[0], to);
}

bool is_mesh(const Shape& shape) {
  return std::holds_alternative<collision::TriangleMesh>(shape);
}

struct PosePair {
  Pose a, b;
};

/// Poses to start from: B at the origin, A above it or beside it.
PosePair apart(const Pair& pair, bool is_flush, Random& random) {
  const Quat yaw(Eigen::AngleAxisd(uniform(random, 0.0, 7.0), Vec3::UnitZ()));
  const Vec3 aside(uniform(random, -0.4, 0.4), uniform(random, -0.4, 0.4), 2.0);
  if (is_mesh(pair.b)) {
    return {{is_flush ? Vec3(aside - 1.2 * Vec3::UnitX()) : Vec3(aside + 1.2 * Vec3::UnitX()),
             is_flush ? yaw * pair.face_down_a : random_orientation(random)},
            {}};
  }
  if (is_flush) {
    return {{aside, yaw * pair.face_down_a}, {Vec3::Zero(), pair.face_up_b}};
  }
  return {{2.0 * random_direction(random), random_orientation(random)},
          {Vec3::Zero(), random_orientation(random)}};
}

/// A beside B, then moved along the contact normal until it is at most 2 % deep.
PosePair touching(const Pair& pair, bool is_flush, Random& random) {
  PosePair poses = apart(pair, is_flush, random);
  std::vector<Contact> contacts;
  collision::find_intersection(pair.a, poses.a, pair.b, poses.b,
                               std::numeric_limits<double>::infinity(), contacts);
  const Contact& nearest =
      *std::min_element(contacts.begin(), contacts.end(),
                        [](const Contact& p, const Contact& q) { return p.gap < q.gap; });
  poses.a.position -= (nearest.gap + uniform(random, 1e-4, 2e-2)) * nearest.normal;
  return poses;
}

constexpr double kTolerance = 1e-3;  // of shapes about 1 m large

bool is_on(const Shape& shape, const Pose& pose, const Vec3& point) {
  return collision::signed_distance(Sphere{kTolerance}, {point, Quat::Identity()}, shape, pose) <=
         kTolerance;
}

/// Is N, at a point of a mesh, a normal of its surface: of a triangle there, or one along which no
/// triangle there reaches further than the point? (At an edge inside a flat piece only the piece's
/// normal is.)
bool is_normal_of(const collision::MeshData& mesh, const Vec3& point, const Vec3& N) {
  constexpr double kAngle = 1e-2;  // radians
  bool is_of_a_triangle = false;
  bool is_furthest = true;
  for (const collision::MeshData::Triangle& numbers : mesh.triangles) {
    collision::Triangle triangle;
    std::transform(numbers.vertices.begin(), numbers.vertices.end(), triangle.corners.begin(),
                   [&](int v) { return mesh.vertices[v]; });
    triangle.normal = numbers.normal;
    collision::SegmentOnTriangle nearest;
    if (!collision::nearest_points({point}, triangle, kTolerance, nearest) ||
        nearest.between.norm() > kTolerance) {
      continue;
    }
    is_of_a_triangle = is_of_a_triangle || N.cross(triangle.normal).norm() <= kAngle;
    for (const Vec3& corner : triangle.corners) {
      const Vec3 to = corner - point;
      is_furthest = is_furthest && N.dot(to) <= kAngle * to.norm() + kTolerance;
    }
  }
  return is_of_a_triangle || is_furthest;
}

/// The normal parts the shapes as well as the best does; from a mesh, which has no one best normal:
/// it is one of its surface and asks for no more than the deepest of its triangles does.
bool has_good_normal(const Pair& pair, const PosePair& poses, const Contact& contact,
                     double distance) {
  const Vec3& N = contact.normal;
  if (is_mesh(pair.b)) {
    const double gap = N.dot(contact.point_a - contact.point_b);
    const auto& mesh = *std::get<collision::TriangleMesh>(pair.b).data;
    return is_normal_of(mesh, poses.b.inverse() * contact.point_b,
                        poses.b.orientation.conjugate() * N) &&
           gap >= distance - kTolerance &&
           (contact.point_a - contact.point_b - gap * N).norm() <= kTolerance;
  }
  const double best = -support(pair.a, poses.a, -N) - support(pair.b, poses.b, N);
  return best >= distance - kTolerance &&
         -N.dot(contact.point_a) - support(pair.a, poses.a, -N) <= kTolerance &&
         N.dot(contact.point_b) - support(pair.b, poses.b, N) <= kTolerance;
}

bool is_valid(const Pair& pair, const PosePair& poses, const Contact& contact, double distance) {
  return std::abs(contact.normal.norm() - 1.0) <= kTolerance &&
         has_good_normal(pair, poses, contact, distance) &&
         is_on(pair.a, poses.a, contact.point_a) && is_on(pair.b, poses.b, contact.point_b);
}

NarrowPhaseRow measure(NarrowPhasePeer& peer, const Pair& pair, const std::vector<PosePair>& poses,
                       int repeats) {
  NarrowPhaseRow row{pair.name, peer.name(), 0.0, 0.0, 0.0, 0.0, 0.0};
  const auto count = static_cast<double>(poses.size());
  std::vector<Contact> contacts;
  for (const PosePair& pose : poses) {
    peer.query(pose.a, pose.b);
    peer.read(contacts);
    const double d = collision::signed_distance(pair.a, pose.a, pair.b, pose.b);
    row.points += static_cast<double>(contacts.size()) / count;
    constexpr int kAll = 1000;
    std::vector<Contact> valid;
    std::copy_if(contacts.begin(), contacts.end(), std::back_inserter(valid),
                 [&](const Contact& contact) { return is_valid(pair, pose, contact, d); });
    row.valid += static_cast<double>(valid.size()) / count;
    (void)collision::reduce_contacts(valid, kAll);
    row.corners += static_cast<double>(valid.size()) / count;
    row.area += collision::reduce_contacts(contacts, kAll).area_before / count;
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
  std::string csv = "pair,narrow phase,ns a query,points,valid,corners,area\n";
  for (const NarrowPhaseRow& row : rows) {
    csv += fmt::format("{},{},{:.1f},{:.3f},{:.3f},{:.3f},{:.5f}\n", row.pair, row.name,
                       row.nanoseconds, row.points, row.valid, row.corners, row.area);
  }
  return csv;
}

NarrowPhaseReport run_narrow_phase_study(const NarrowPhaseOptions& options, std::ostream& out) {
  const collision::ConvexHull stone = hull_of_32_faces({0.5, 0.45, 0.4});
  const collision::ConvexHull rock = hull_of_32_faces({0.6, 0.5, 0.45});
  const Vec3 up = Vec3::UnitZ();
  const Box brick{Vec3(0.6, 0.5, 0.4)};
  const Quat lying(Eigen::AngleAxisd(M_PI_2, Vec3::UnitX()));
  const Pair pairs[] = {
      {"box-box", Box{Vec3(0.5, 0.4, 0.3)}, brick},
      {"sphere-box", Sphere{0.5}, brick},
      {"box-cylinder", brick, collision::Cylinder{0.4, 0.5}},
      {"box-hull", brick, rock, Quat::Identity(), turn_face(rock, up)},
      {"hull-hull", stone, rock, turn_face(stone, -up), turn_face(rock, up)},
      {"capsule-mesh", Capsule{0.2, 0.4}, ground(), lying},
  };
  NarrowPhaseReport report;
  out << fmt::format("{:<14}{:<16}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "pair", "", "ns", "points",
                     "valid", "corners", "area");
  std::string known;
  for (const Pair& pair : pairs) {
    known += (known.empty() ? "" : ", ") + std::string(pair.name);
    if (!options.pair.empty() && options.pair != pair.name) {
      continue;
    }
    Random random(options.seed);
    std::vector<PosePair> poses;
    poses.reserve(options.poses);
    for (int k = 0; k < options.poses; ++k) {
      poses.push_back(touching(pair, k % 2 == 0, random));
    }
    NarrowPhasePeers peers;
    peers.push_back(std::make_unique<OurNarrowPhase>(pair.a, pair.b, 0));
    peers.push_back(std::make_unique<OurNarrowPhase>(pair.a, pair.b, 4));
#ifdef SIGNORINI_PEER_BULLET
    add_bullet_narrow_phase(pair.a, pair.b, peers);
#endif
#ifdef SIGNORINI_PEER_FCL
    add_fcl_narrow_phase(pair.a, pair.b, peers);
#endif
    for (const auto& peer : peers) {
      const NarrowPhaseRow row = measure(*peer, pair, poses, options.repeats);
      out << fmt::format("{:<14}{:<16}{:>10.0f}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.4f}\n", row.pair,
                         row.name, row.nanoseconds, row.points, row.valid, row.corners, row.area);
      out.flush();
      report.rows.push_back(row);
    }
  }
  if (report.rows.empty()) {
    throw std::invalid_argument("pair: must be one of " + known + ", got " + options.pair);
  }
  return report;
}

}  // namespace signorini::bench
