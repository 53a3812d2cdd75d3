#include <signorini/collision/hull.h>
#include <signorini/collision/pair_query.h>

#include "pair_properties.h"
#include "tests/lcp/allocation_count.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace signorini::collision {
namespace {

using testing::ShapeKind;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
constexpr long kPoses = 100;
#else
constexpr long kPoses = 1500;
#endif

constexpr const char* kNames[] = {"Sphere", "Box",       "Capsule", "Cylinder",
                                  "Cone",   "Ellipsoid", "Hull",    "HalfSpace"};

class ConvexPairs : public ::testing::TestWithParam<ShapeKind> {};

INSTANTIATE_TEST_SUITE_P(Shapes, ConvexPairs,
                         ::testing::Values(ShapeKind::kCapsule, ShapeKind::kCylinder,
                                           ShapeKind::kCone, ShapeKind::kEllipsoid,
                                           ShapeKind::kHull),
                         [](const auto& kind) { return kNames[static_cast<int>(kind.param)]; });

// With every shape that comes before it, itself, and the half-space.
TEST_P(ConvexPairs, HoldEveryPropertyAtRandomAndKissingPoses) {
  for (int other = 0; other <= static_cast<int>(ShapeKind::kHalfSpace); ++other) {
    if (other > static_cast<int>(GetParam()) && other < static_cast<int>(ShapeKind::kHalfSpace)) {
      continue;
    }
    testing::PairCounts counts;
    const std::string broken = testing::check_poses(static_cast<ShapeKind>(other), GetParam(),
                                                    kPoses, 20261125u + other, counts);
    EXPECT_EQ(broken, "") << kNames[other] << " and " << kNames[static_cast<int>(GetParam())];
    std::printf("    %s: %ld poses, %ld apart, %ld contacts\n", kNames[other], counts.poses,
                counts.apart, counts.contacts);
  }
}

TEST(ConvexPair, QueriesAllocateNothingOnceTheirMemoryHasGrown) {
  constexpr int kKinds = static_cast<int>(ShapeKind::kHalfSpace) + 1;
  std::vector<testing::PlacedPair> pairs;
  testing::Random random(3);
  for (int k = 0; k < 40 * kKinds * kKinds; ++k) {
    const auto a = static_cast<ShapeKind>(k % kKinds);
    const auto b = static_cast<ShapeKind>(k / kKinds % kKinds);
    if (a != ShapeKind::kHalfSpace || b != ShapeKind::kHalfSpace) {
      pairs.push_back(testing::random_pair(
          random, a, b, k % 3 == 0 ? testing::Placement::kAligned : testing::Placement::kAnywhere));
    }
  }
  std::vector<Contact> contacts;
  double sum = 0.0;
  const auto query_all = [&] {
    for (const testing::PlacedPair& pair : pairs) {
      find_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b, 0.1 * pair.size, contacts);
      sum += signed_distance(pair.a, pair.pose_a, pair.b, pair.pose_b);
      sum += test_intersection(pair.a, pair.pose_a, pair.b, pair.pose_b) ? 1.0 : 0.0;
    }
  };
  query_all();
  const lcp::AllocationCount allocations;
  query_all();
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_TRUE(std::isfinite(sum));
}

Pose at(double x, double y, double z, double qx, double qy, double qz, double qw) {
  return {{x, y, z}, Quat(qw, qx, qy, qz).normalized()};
}

// Poses at which a property was once wrong.
TEST(ConvexPair, HoldsEveryPropertyWhereOneWasBroken) {
  std::vector<testing::PlacedPair> pairs = {
      // The face is preferred by the tolerance, but the rim's deepest point lies beside it: the set
      // on the face began 469 tolerances above the distance.
      {Box{{0.0014528013597350663, 0.0082806398529944782, 0.017356153400246717}},
       at(-1.1340511719710304, 0.67015554019753565, -0.134443740757858, 0.50019462392408809,
          -0.30902300392053655, 0.80175738357730908, 0.10721575968408695),
       Cone{0.012820126690934294, 0.037551026315729395},
       at(-1.1559291258887416, 0.64624643119235392, -0.1667844119453164, 0.57820814647050489,
          -0.78762513751156427, -0.078069910682750224, 0.19805825193871684)},
      // The same with two rims.
      {Cylinder{0.98964198102519563, 0.25704706151098861},
       at(-0.32753374353314535, -0.23879907234551467, -1.3705975320585324, 0.40447652524701883,
          -0.5799989142438956, -0.57999891424389582, 0.40447652524701866),
       Cone{1.1616590494557504, 0.80264291217897887},
       at(-1.6166695597566125, 0.85024535591492612, -1.6093649297551629, 0.61926209941182297,
          -0.34134213369002886, -0.61926209941182286, -0.34134213369002908)},
      {Cylinder{48.763274157054241, 21.944619663553496},
       at(-817.57604555733258, 228.58235961751373, 800.74470207050877, 0.50000000000563982,
          -0.49999999999300532, 0.50000000000120581, -0.50000000000014921),
       Cylinder{614.51096047721364, 134.59432692874907},
       at(-621.94483405930407, -29.489801910523692, 279.6280922716918, 0.46821483130365305,
          0.52988194148547119, -0.52988194139142775, -0.46821483105742284)},
      // Rims that cross, of discs that are not parallel: the crossing was beside the smaller one.
      {Cylinder{115.76298632086966, 64.592306334078259},
       at(82.21077572513866, -75.244874521431157, 30.667822655757501, -0.55328727824293134,
          0.44031033094200578, 0.44031033129961378, -0.55328727832030877),
       Cylinder{0.074299935701344993, 0.080177133241952928},
       at(119.26707504394525, 52.041776651774967, 25.8698019972075, 0.49999999999566769,
          0.50000000000031897, -0.49999999999884809, -0.5000000000051652)},
      // Parallel generators that touch at their ends alone: the crossing of parallel lines.
      {Cylinder{10.872896331155939, 45.420296294681123},
       at(103.84722757075262, 300.85048018247181, -271.04896061794352, 4.329780281177467e-17,
          -0.70710678118654757, -0.70710678118654746, -4.3297802811774658e-17),
       Cylinder{239.47069773445503, 71.403498029242755},
       at(64.387634212503656, 288.53679105572712, -23.834770932786004, 0.5, -0.5,
          -0.49999999999999989, -0.5)},
      // Flush at distance 0: rounding put all corners above the margin, and a point far outside the
      // box was left.
      {Box{{0.0013264602206051041, 0.0020386695464538591, 0.0024684701957592369}},
       at(0.0016493436624034233, -0.0016402069695610334, 0.0056984752532340983,
          4.3297802811774658e-17, -0.70710678118654746, 0.70710678118654757, 4.329780281177467e-17),
       Cylinder{0.00097070808228947919, 0.00023696036281096829},
       at(0.0032127642458194953, -0.00019809558281073668, 0.0030938142747853319,
          1.2325951644078309e-32, 0.70710678118654746, 1.2325951644078309e-32,
          -0.70710678118654757)},
      // Flush to 6e-10 rad: the deepest point lies beside the other disc, all others are above it.
      {Cylinder{1.2115153240609744, 0.80196275058299793},
       at(-7119.9877675751559, -4686.9930559325276, -5771.5334435560517, 1.869946588195191e-13,
          0.70710678118727655, 5.6144747952409976e-14, -0.7071067811858186),
       Cylinder{1.3833352666438554, 1.4629116889247962},
       at(-7117.7228931348027, -4686.6594618550935, -5771.8334813856318, 0.49999999980325627,
          -0.49999999988946997, 0.50000000005090617, -0.5000000002563677)},
      // The same of a capsule that lies on a cylinder.
      {Capsule{0.06519725587557311, 0.50996710335695794},
       at(-0.34185902043222977, -0.35656369578100289, 0.64329883561861667, 6.123233995736766e-17,
          -6.123233995736766e-17, 6.123233995736766e-17, -1),
       Cylinder{0.091361242807116216, 0.053813406087408797},
       at(-0.22284835846924783, -0.27960265417705987, 0.57981831626139524, 0.5, 0.5,
          0.49999999999999989, 0.50000000000000011)},
      // Parallel capsules at distance 0: rounding put both ends of the overlap above the margin.
      {Capsule{17.334309679787353, 89.613852944822455},
       at(89.621205135381643, -20.724608086674166, -13.053839514165, 0.49999999999524297,
          -0.5000000000010465, -0.50000000000101175, -0.50000000000269873),
       Capsule{0.012802449168998814, 0.34610666890669056},
       at(105.01244610176171, -21.486570809987708, -5.0518397185408883, 0.50000000000361533,
          -0.49999999999618272, -0.49999999998959699, -0.50000000001060496)},
  };
  // Two polyhedra kissing: their axes said touching, the search that makes the set apart by 6e-17.
  const ConvexHull tetrahedron =
      make_hull({{-0.40596727655479031, 2.2547525735649145, -0.58980494513365911},
                 {0.80268951664092447, 2.2547525735649145, -0.58980494513365911},
                 {-0.40596727655479031, 5.1940000367902233, -0.58980494513365911},
                 {-0.40596727655479031, 2.2547525735649145, 11.23874998661417}},
                {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
  pairs.push_back({Box{{0.75363591157204346, 0.37083913989242795, 1.8576115175638532}},
                   at(10.662410349023453, -1.9351925941389965, -10.895217331448755,
                      0.50000000000000011, -0.5, -0.49999999999999989, -0.5),
                   tetrahedron,
                   at(9.7017662639973672, 0.32838619997964658, -9.3941006694558826,
                      0.49999999999999994, 0.49999999999999994, -0.5, -0.50000000000000011)});
  // An edge of the box along the sharp corner of a tetrahedron, beside it by less than the slack:
  // their crossing lies 8 times as far beyond the corner.
  const ConvexHull sharp =
      make_hull({{0.054167996586453701, -0.1540078017587308, 0.15893222336277252},
                 {0.18238927503687219, -0.1540078017587308, 0.15893222336277252},
                 {0.054167996586453701, 0.96683488442221066, 0.15893222336277252},
                 {0.054167996586453701, -0.1540078017587308, 1.298142766675342}},
                {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
  pairs.push_back(
      {Box{{0.075737844631996204, 0.44550519989027743, 0.70782402628697683}},
       at(-96.082651163145783, 1862.5514739377195, -358.87318653630393, -6.8779804067634193e-07,
          -0.9999999999978495, -1.9250105612129639e-06, 3.498480458350085e-07),
       sharp,
       at(-96.061081326039485, 1863.70970135483, -358.011352653963, -0.70710686800142164,
          -2.7181426459759673e-07, -3.0600636374993006e-07, -0.70710669437154439)});
  testing::Random random(1);
  for (const testing::PlacedPair& posed : pairs) {
    testing::PlacedPair pair = posed;
    const double extent_a = bounding_radius(pair.a, Pose{});
    const double extent_b = bounding_radius(pair.b, Pose{});
    pair.size = std::min(extent_a, extent_b);
    pair.rounding = std::numeric_limits<double>::epsilon() *
                    (extent_a + extent_b + pair.pose_b.position.norm());
    for (const double margin : {0.0, 0.05 * pair.size}) {
      testing::PairCounts counts;
      EXPECT_EQ(testing::broken_property(random, pair, margin, counts), "")
          << describe(pair) << "margin " << margin;
    }
  }
}

// Whatever the frame: the distance of pairs whose best direction is one of many that are nearly as
// good.
TEST(ConvexPair, DistanceIsTheSameInEveryFrame) {
  const std::vector<testing::PlacedPair> pairs{
      // A rim that touches an edge of a much larger box: the polytope ended at the face beside it.
      {Box{{44.079651287885667, 10.776018474258311, 226.26936004520343}},
       at(-161.62463570175692, 59.941702658580802, -117.55864774735355, 0.49999999999997713,
          0.4999999999999214, 0.50000000000014921, 0.49999999999995232),
       Cone{0.24113651572066683, 0.099022035687063026},
       at(-191.41085026530936, 15.620923467682692, -128.43370921552963, 7.9256176685457434e-06,
          -0.99999999668455253, -4.3442323824088829e-05, 6.8416695377993702e-05)},
      // The same, where s has two maxima for that edge and that rim.
      {Box{{538.02684539113886, 538.02684539113886, 538.02684539113886}},
       at(335.51500166409318, 1331.3887480812741, -53.669490584842869, -3.3265848389655694e-16,
          2.3878870194507686e-15, 1, 5.0801543912508679e-15),
       Cone{1.3117665694616754, 0.71394549777326044},
       at(-203.68725623685953, 794.28323529597469, -445.90361121297747, -0.59092917038030035,
          0.38847414591072144, 0.3884616345629634, -0.5907521578676258)},
      // Cones on nearly one axis, one inside the other: nearly as good all around it.
      {Cone{0.091525167812285646, 0.10568247439442995},
       at(-0.18567788958199932, -0.054718166638658854, -0.0012529152347191383, -0.5,
          -0.50000000000000022, -0.49999999999999989, -0.50000000000000011),
       Cone{0.021359928898605038, 0.049344388320536371},
       at(-0.18567613587597842, -0.05471758445445378, -0.0012528174188884151, 0.49999999999999989,
          0.5, 0.5, 0.50000000000000011)},
      // Deep inside a large cylinder, near its axis.
      {Cylinder{0.015875953477070093, 0.019310257943934431},
       at(34.543888418442052, -65.286653875057013, -68.897875017903871, 1, 1.4820738421606528e-12,
          -1.140844007076257e-13, 5.1840944244253804e-13),
       Cylinder{62.49066397540787, 79.363208129392049},
       at(34.537271987161645, -65.319592151116453, -68.914299006624731, 0.31719289667574302,
          0.63197204550421926, 0.31719289668054518, -0.63197204550127806)},
      {Cylinder{0.347415308161652, 0.46482136757947634},
       at(0.38412942774308878, 0.40596922009690273, 0.13291019524554246, 0.68688881602513874,
          0.16788017875730077, 0.68688881602513874, -0.16788017875730055),
       Ellipsoid{{0.00032647928971448728, 0.00067078717767599973, 0.0011159258877783563}},
       at(0.39082582206735661, 0.40944802153477577, 0.13289168233619977, 0.50000000000000011, -0.5,
          -0.5, 0.49999999999999989)},
      // Apart, rims nearly flush: rounding stopped GJK.
      {Cylinder{1.4382128751784167, 0.26502749126278075},
       at(0.0051477314239407601, 0.033101876357312765, -1.0124357884208268, 1,
          7.2629183805730337e-15, -6.2459833086084635e-15, -2.3616741156528487e-15),
       Cone{0.00073081803952076551, 0.00030645958339069895},
       at(1.3510094101481169, 0.53928339381607704, -0.15799156948750892, 4.1900334694561551e-06,
          -8.5836459175247601e-07, 0.99999999999077693, 3.9109877521904733e-07)},
      {Cone{28.973171093088407, 8.5018437414029329},
       at(-44.581033172255559, -19.22892125469442, -15.257229319124082, -0.70710676055233068,
          4.704656239253403e-08, 0.70710680182075991, 5.9039180223829424e-08),
       Cone{0.15003280535118793, 0.076826322425381607},
       at(-26.655311715955651, 9.3748082242759541, -11.11489718537927, -0.70710678118300851,
          7.2175401980143726e-13, -0.70710678119008663, 7.8780864009858005e-12)},
  };
  testing::Random random(1);
  for (const testing::PlacedPair& pair : pairs) {
    const double size = std::min(bounding_radius(pair.a, Pose{}), bounding_radius(pair.b, Pose{}));
    const double expected = signed_distance(pair.a, pair.pose_a, pair.b, pair.pose_b);
    EXPECT_NEAR(signed_distance(pair.b, pair.pose_b, pair.a, pair.pose_a), expected, 1e-8 * size);
    for (int k = 0; k < 100; ++k) {
      Pose frame{0.25 * testing::random_direction(random), testing::random_orientation(random)};
      frame.position -= frame.orientation * pair.pose_b.position;
      ASSERT_NEAR(signed_distance(pair.a, frame * pair.pose_a, pair.b, frame * pair.pose_b),
                  expected, 1e-8 * size)
          << describe(pair) << k;
    }
  }
}

// A vertex in the middle of a straight edge: a crossing beside it stays where it is.
TEST(ConvexPair, CrossingsOfAnEdgeInTwoPiecesStayOnTheirPiece) {
  // The cube |x| <= 1; vertex 8 is in the middle of the edge from 6 to 7, y = z = 1.
  std::vector<Vec3> vertices;
  for (int v = 0; v < 8; ++v) {
    vertices.emplace_back(v & 1 ? 1.0 : -1.0, v & 2 ? 1.0 : -1.0, v & 4 ? 1.0 : -1.0);
  }
  vertices.emplace_back(0.0, 1.0, 1.0);
  const ConvexHull cube = make_hull(vertices, {{0, 2, 3, 1},
                                               {0, 1, 5, 4},
                                               {0, 4, 6, 2},
                                               {1, 3, 7, 5},
                                               {4, 5, 7, 8, 6},
                                               {3, 2, 8},
                                               {2, 6, 8},
                                               {3, 8, 7}});
  testing::Random random(6);
  for (int k = 0; k < 200; ++k) {
    const double aside = k % 2 == 0 ? 0.6 : -0.6;
    const Pose frame{testing::random_direction(random), testing::random_orientation(random)};
    std::vector<Contact> contacts;
    find_intersection(Box{Vec3::Constant(0.25)},
                      frame * Pose{Vec3(aside, 1.1, 1.25), Quat::Identity()}, cube, frame, 1e-9,
                      contacts);
    ASSERT_EQ(contacts.size(), 4U) << k;
    for (const Contact& contact : contacts) {
      const Vec3 point = frame.inverse() * contact.point_b;
      EXPECT_NEAR(std::abs(point.x() - aside), 0.25, 1e-9) << k;
      EXPECT_NEAR(std::abs(point.y() - 0.925), 0.075, 1e-9) << k;
    }
  }
}

// Acute corners: points of the clipped face lie on it, not beside it by the slack over a sine.
TEST(ConvexPair, ClippedPointsAtAcuteCornersLieOnTheirShapes) {
  testing::Random random(2);
  for (int k = 0; k < 2000; ++k) {
    // Thin wedges with a corner of 1e-2 rad, flush on a box, off by up to the clipping's slack.
    const double thin = 1e-2;
    const ConvexHull wedge = make_hull({{0, 0, 0}, {1, 0, 0}, {1, thin, 0}, {0.5, 0, 1}},
                                       {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
    const double shift = testing::log_uniform(random, -8.0, -5.0);
    const Quat turn(Eigen::AngleAxisd(testing::uniform(random, 0.0, 7.0), Vec3::UnitZ()));
    const Pose pose_a{turn * Vec3(-0.01 + shift, shift, 0.0), turn};
    const Pose pose_b{{0, 0, -0.5}, Quat::Identity()};
    std::vector<Contact> contacts;
    find_intersection(wedge, pose_a, Box{Vec3::Constant(0.5)}, pose_b, 1e-9, contacts);
    ASSERT_FALSE(contacts.empty());
    for (const Contact& contact : contacts) {
      const Vec3 local = pose_a.orientation.conjugate() * (contact.point_a - pose_a.position);
      for (std::size_t f = 0; f < wedge.data->faces.size(); ++f) {
        ASSERT_LE(wedge.data->normals[f].dot(local) - wedge.data->offsets[f], 2e-6);
      }
    }
  }
}

}  // namespace
}  // namespace signorini::collision
