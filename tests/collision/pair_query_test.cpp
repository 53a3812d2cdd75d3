#include <signorini/collision/feature_id.h>
#include <signorini/collision/pair_query.h>

#include "random_pairs.h"
#include "reference_distance.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <set>

namespace signorini::collision {
namespace {

using testing::PlacedPair;
using testing::Placement;
using testing::Random;
using testing::ShapeKind;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
constexpr int kPosesPerPair = 20000;
#else
constexpr int kPosesPerPair = 200000;
#endif

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Contact> find(const PlacedPair& pair, double margin) {
  std::vector<Contact> contacts;
  find_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b, margin, contacts);
  return contacts;
}

double distance(const PlacedPair& pair) {
  return signed_distance(pair.a, pair.pose_a, pair.b, pair.pose_b);
}

bool overlaps(const PlacedPair& pair) {
  return test_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b);
}

const Contact& deepest(const std::vector<Contact>& contacts) {
  return *std::min_element(contacts.begin(), contacts.end(),
                           [](const Contact& p, const Contact& q) { return p.gap < q.gap; });
}

bool is_box(const Shape& shape) {
  return std::holds_alternative<Box>(shape);
}

/// Derived numbers are off by at most some tens of roundings of the largest number in the data.
double rounding(const PlacedPair& pair) {
  return 64.0 * pair.rounding;
}

/// The axis of a box pair's contact set is chosen with a preference of 1e-6 of the smaller box.
double gap_tolerance(const PlacedPair& pair) {
  return rounding(pair) + (is_box(pair.a) && is_box(pair.b) ? 1e-6 * pair.size : 0.0);
}

/// How far a point is outside a shape (<= 0: on or in it).
double outside(const Shape& shape, const Pose& pose, const Vec3& point) {
  const Vec3 local = pose.orientation.conjugate() * (point - pose.position);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return local.norm() - sphere->radius;
  }
  if (const auto* box = std::get_if<Box>(&shape)) {
    return (local.cwiseAbs() - box->half_extents).maxCoeff();
  }
  return local.z();
}

struct Counts {
  int poses = 0;
  int apart = 0;
  int contacts = 0;
  std::map<NormalOwner, int> owners;
};

/// What must hold for every pair of shapes, wherever they are. One fact a line; ASSERTs, so that a
/// failure ends the run of poses.
void check_pose(const PlacedPair& pair, double margin, Counts& counts) {
  const double d = distance(pair);
  ASSERT_TRUE(std::isfinite(d));
  ASSERT_EQ(overlaps(pair), d <= 0.0);
  ASSERT_NEAR(distance(exchanged(pair)), d, rounding(pair));

  const std::vector<Contact> contacts = find(pair, margin);
  ASSERT_EQ(contacts.empty(), d > margin) << "distance " << d;
  ++counts.poses;
  counts.apart += d > 0.0;
  counts.contacts += static_cast<int>(contacts.size());

  std::set<std::uint64_t> ids;
  for (const Contact& contact : contacts) {
    ++counts.owners[contact.owner];
    ASSERT_NO_THROW(validate(ContactSet{contact}, 2));
    ASSERT_NEAR(contact.normal.norm(), 1.0, 1e-14);
    ASSERT_LE(contact.gap, margin + rounding(pair));
    ASSERT_LE((contact.point_a - contact.point_b - contact.gap * contact.normal).norm(),
              rounding(pair));
    ASSERT_LE(outside(pair.a, pair.pose_a, contact.point_a), gap_tolerance(pair));
    ASSERT_LE(outside(pair.b, pair.pose_b, contact.point_b), gap_tolerance(pair));
    ASSERT_TRUE(ids.insert(contact.feature_id).second) << "feature id twice";
    ASSERT_EQ(contact.normal, contacts.front().normal);
  }
  if (contacts.empty()) {
    return;
  }

  const Contact& first = deepest(contacts);
  ASSERT_NEAR(first.gap, d, gap_tolerance(pair));
  // Moving A by -gap along N ends the overlap or brings the touch.
  ASSERT_NEAR(distance(moved(pair, -first.gap * first.normal)), 0.0, 2.0 * gap_tolerance(pair));
}

/// check_pose(), and what is needed to see a failure again.
bool passes(const PlacedPair& pair, double margin, Counts& counts) {
  check_pose(pair, margin, counts);
  if (::testing::Test::HasFatalFailure()) {
    ADD_FAILURE() << describe(pair) << "margin " << margin;
    return false;
  }
  return true;
}

Placement placement_of(int k) {
  return k % 2 == 0 ? Placement::kAnywhere
                    : (k % 4 == 1 ? Placement::kAligned : Placement::kNearlyAligned);
}

double random_margin(Random& random, const PlacedPair& pair) {
  const double kind = testing::uniform(random, 0.0, 1.0);
  return kind < 0.3 ? 0.0 : (kind < 0.9 ? 0.1 * pair.size : 10.0 * pair.size);
}

/// Moves A along the normal until the gap is 0 or a tiny distance off it.
PlacedPair kissing(Random& random, const PlacedPair& pair) {
  const std::vector<Contact> contacts = find(pair, kInfinity);
  const Contact& contact = deepest(contacts);
  const double tiny = testing::uniform(random, 0.0, 1.0) < 0.3
                          ? 0.0
                          : testing::log_uniform(random, -16.0, -9.0) *
                                (testing::uniform(random, 0.0, 1.0) < 0.5 ? -1.0 : 1.0);
  return moved(pair, (tiny * pair.size - contact.gap) * contact.normal);
}

struct Kinds {
  ShapeKind a;
  ShapeKind b;
  const char* name;
};

class PairProperties : public ::testing::TestWithParam<Kinds> {};

INSTANTIATE_TEST_SUITE_P(
    AllPairs, PairProperties,
    ::testing::Values(Kinds{ShapeKind::kSphere, ShapeKind::kSphere, "SphereSphere"},
                      Kinds{ShapeKind::kSphere, ShapeKind::kBox, "SphereBox"},
                      Kinds{ShapeKind::kBox, ShapeKind::kSphere, "BoxSphere"},
                      Kinds{ShapeKind::kSphere, ShapeKind::kHalfSpace, "SphereHalfSpace"},
                      Kinds{ShapeKind::kHalfSpace, ShapeKind::kSphere, "HalfSpaceSphere"},
                      Kinds{ShapeKind::kBox, ShapeKind::kBox, "BoxBox"},
                      Kinds{ShapeKind::kBox, ShapeKind::kHalfSpace, "BoxHalfSpace"},
                      Kinds{ShapeKind::kHalfSpace, ShapeKind::kBox, "HalfSpaceBox"}),
    [](const auto& kinds) { return kinds.param.name; });

void print(const char* what, const Counts& counts) {
  std::printf("    %s: %d poses, %d apart, %d contacts", what, counts.poses, counts.apart,
              counts.contacts);
  constexpr const char* kOwners[] = {"face A", "face B", "edge-edge", "curved"};
  for (const auto& [owner, count] : counts.owners) {
    std::printf(", %s %d", kOwners[static_cast<int>(owner)], count);
  }
  std::printf("\n");
}

TEST_P(PairProperties, HoldAtRandomPoses) {
  Random random(20260101);
  Counts counts;
  for (int k = 0; k < kPosesPerPair; ++k) {
    const PlacedPair pair = random_pair(random, GetParam().a, GetParam().b, placement_of(k));
    if (!passes(pair, random_margin(random, pair), counts)) {
      break;
    }
  }
  print(GetParam().name, counts);
}

TEST_P(PairProperties, HoldWhereTheShapesKiss) {
  Random random(20260102);
  Counts counts;
  for (int k = 0; k < kPosesPerPair / 4; ++k) {
    const PlacedPair pair = random_pair(random, GetParam().a, GetParam().b, placement_of(k));
    if (!passes(kissing(random, pair), random_margin(random, pair), counts)) {
      break;
    }
  }
  print(GetParam().name, counts);
}

/// The contact of `contacts` with this id, or null.
const Contact* with_id(const std::vector<Contact>& contacts, std::uint64_t id) {
  const auto found = std::find_if(contacts.begin(), contacts.end(),
                                  [&](const Contact& c) { return c.feature_id == id; });
  return found == contacts.end() ? nullptr : &*found;
}

/// Both sets list the same points, in any order, to a tolerance.
bool same_points(const std::vector<Contact>& p, const std::vector<Contact>& q, double tolerance) {
  const auto has = [&](const std::vector<Contact>& contacts, const Contact& wanted) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const Contact& c) {
      return (c.point_a - wanted.point_a).norm() <= tolerance &&
             (c.point_b - wanted.point_b).norm() <= tolerance;
    });
  };
  return p.size() == q.size() &&
         std::all_of(p.begin(), p.end(), [&](const Contact& c) { return has(q, c); });
}

void exchange(std::vector<Contact>& contacts) {
  for (Contact& contact : contacts) {
    std::swap(contact.point_a, contact.point_b);
    contact.normal = -contact.normal;
    contact.feature_id = exchanged(contact.feature_id);
  }
}

// Away from ties: the points, normals and features do not depend on the order of the shapes.
TEST_P(PairProperties, ExchangeOfAAndBMirrorsTheContactSet) {
  Random random(20260103);
  int compared = 0;
  for (int k = 0; k < kPosesPerPair / 10; ++k) {
    const PlacedPair pair = random_pair(random, GetParam().a, GetParam().b, Placement::kAnywhere);
    const double margin = random_margin(random, pair);
    const std::vector<Contact> contacts = find(pair, margin);
    std::vector<Contact> mirrored = find(exchanged(pair), margin);
    exchange(mirrored);
    ASSERT_EQ(contacts.size(), mirrored.size()) << describe(pair) << margin;
    for (const Contact& contact : contacts) {
      const Contact* other = with_id(mirrored, contact.feature_id);
      ASSERT_NE(other, nullptr) << describe(pair) << margin;
      // A normal from two near points is uncertain by the rounding of their difference.
      const double turn = pair.rounding / std::max(std::abs(contact.gap), 1e-6 * pair.size);
      ASSERT_LE((other->normal - contact.normal).norm(), 1e-9 + 64.0 * turn) << describe(pair);
      ASSERT_LE((other->point_a - contact.point_a).norm(), 1e-6 * pair.size + rounding(pair));
      ASSERT_LE((other->point_b - contact.point_b).norm(), 1e-6 * pair.size + rounding(pair));
      ++compared;
    }
  }
  std::printf("    %s: %d contacts compared\n", GetParam().name, compared);
  EXPECT_GT(compared, kPosesPerPair / 40);
}

// Ties included: faces flush, boxes equal. The points are the same whichever face carries them.
TEST_P(PairProperties, ExchangeOfAAndBKeepsThePointsOfAlignedShapes) {
  Random random(20260104);
  int compared = 0;
  for (int k = 0; k < kPosesPerPair / 10; ++k) {
    const PlacedPair pair =
        kissing(random, random_pair(random, GetParam().a, GetParam().b, Placement::kAligned));
    std::vector<Contact> mirrored = find(exchanged(pair), 0.01 * pair.size);
    exchange(mirrored);
    const std::vector<Contact> contacts = find(pair, 0.01 * pair.size);
    ASSERT_TRUE(same_points(contacts, mirrored, 1e-5 * pair.size + rounding(pair)))
        << describe(pair) << contacts.size() << " and " << mirrored.size();
    compared += static_cast<int>(contacts.size());
  }
  std::printf("    %s: %d contacts compared\n", GetParam().name, compared);
}

TEST_P(PairProperties, ARigidMotionCarriesTheContactSetAlong) {
  Random random(20260105);
  int compared = 0;
  for (int k = 0; k < kPosesPerPair / 10; ++k) {
    PlacedPair pair = random_pair(random, GetParam().a, GetParam().b, Placement::kAnywhere);
    const Pose motion{pair.size * testing::random_direction(random),
                      testing::random_orientation(random)};
    const double margin = random_margin(random, pair);
    const PlacedPair there = carried(pair, motion);
    pair.rounding += std::numeric_limits<double>::epsilon() * there.pose_b.position.norm();
    ASSERT_NEAR(distance(there), distance(pair), rounding(pair)) << describe(pair);
    std::vector<Contact> contacts = find(pair, margin);
    const std::vector<Contact> carried_contacts = find(there, margin);
    ASSERT_EQ(contacts.size(), carried_contacts.size()) << describe(pair) << margin;
    for (const Contact& contact : contacts) {
      const Contact* other = with_id(carried_contacts, contact.feature_id);
      ASSERT_NE(other, nullptr) << describe(pair) << margin;
      ASSERT_LE((other->point_a - motion * contact.point_a).norm(),
                1e-6 * pair.size + rounding(pair));
      ++compared;
    }
  }
  std::printf("    %s: %d contacts compared\n", GetParam().name, compared);
}

TEST(BoxBoxDistance, AgreesWithAQuadraticProgrammeWhereApart) {
  Random random(20260106);
  int apart = 0;
  for (int k = 0; k < kPosesPerPair / 40; ++k) {
    PlacedPair pair = random_pair(random, ShapeKind::kBox, ShapeKind::kBox, placement_of(k));
    const Box& a = std::get<Box>(pair.a);
    const Box& b = std::get<Box>(pair.b);
    const double d = distance(pair);
    const double reference = testing::reference_box_distance(a, pair.pose_a, b, pair.pose_b);
    // Overlapping boxes leave the reference the rounding of near-singular systems.
    EXPECT_NEAR(std::max(d, 0.0), reference, rounding(pair) + 1e-12 * pair.size) << describe(pair);
    apart += d > 0.0;
  }
  std::printf("    %d poses, %d apart\n", kPosesPerPair / 40, apart);
}

TEST(BoxBoxDistance, IsMinusTheLeastTranslationWhereOverlapping) {
  Random random(20260107);
  int overlapping = 0;
  for (int k = 0; k < kPosesPerPair / 2000; ++k) {
    const PlacedPair pair = random_pair(random, ShapeKind::kBox, ShapeKind::kBox, placement_of(k));
    const double d = distance(pair);
    if (d > -1e-6 * pair.size) {
      continue;
    }
    ++overlapping;
    const double large = bounding_radius(pair.a, Pose{}) + bounding_radius(pair.b, Pose{});
    EXPECT_NEAR(-d,
                testing::reference_box_depth(std::get<Box>(pair.a), pair.pose_a,
                                             std::get<Box>(pair.b), pair.pose_b),
                1e-8 * large)
        << describe(pair);
  }
  std::printf("    %d overlapping\n", overlapping);
  EXPECT_GT(overlapping, 0);
}

}  // namespace
}  // namespace signorini::collision
