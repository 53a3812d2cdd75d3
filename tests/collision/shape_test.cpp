#include <signorini/collision/compound.h>
#include <signorini/collision/hull.h>
#include <signorini/collision/shape.h>
#ifdef SIGNORINI_WITH_QHULL
#include <signorini/collision/hull_builder.h>
#endif

#include "random_pairs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <stdexcept>

namespace signorini::collision {
namespace {

using testing::Random;

TEST(MassProperties, MatchClosedForms) {
  const MassProperties ball = mass_properties(Sphere{0.5}, 1000.0);
  EXPECT_NEAR(ball.mass, 1000.0 * M_PI / 6.0, 1e-10);
  EXPECT_NEAR((ball.inertia - Mat3::Identity() * 0.1 * ball.mass).norm(), 0.0, 1e-12);
  const MassProperties brick = mass_properties(Box{{0.5, 1.0, 1.5}}, 2.0);
  EXPECT_DOUBLE_EQ(brick.mass, 12.0);
  EXPECT_NEAR((brick.inertia - Mat3(Vec3(13.0, 10.0, 5.0).asDiagonal())).norm(), 0.0, 1e-14);
}

/// Mass and inertia of a solid of revolution about z, by Simpson's rule over its discs (an
/// independent reference for the closed forms): m = int rho pi r^2 dz, I_z = int rho pi r^4/2 dz,
/// I_x = int rho pi (r^4/4 + r^2 (z - c)^2) dz.
MassProperties of_revolution(const std::function<double(double)>& squared_radius,
                             const std::vector<double>& pieces, double density) {
  double mass = 0.0;
  double first = 0.0;
  double second = 0.0;
  double fourth = 0.0;
  constexpr int kSteps = 2000;
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    const double h = (pieces[k] - pieces[k - 1]) / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
      const double weight = (i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0)) * h / 3.0;
      const double z = pieces[k - 1] + i * h;
      const double area = density * M_PI * squared_radius(z) * weight;
      mass += area;
      first += area * z;
      second += area * z * z;
      fourth += area * squared_radius(z);
    }
  }
  const double centre = first / mass;
  const double across = 0.25 * fourth + second - mass * centre * centre;
  return {mass, Mat3(Vec3(across, across, 0.5 * fourth).asDiagonal()), {0.0, 0.0, centre}};
}

void expect_same(const MassProperties& p, const MassProperties& q, double relative) {
  EXPECT_NEAR(p.mass, q.mass, relative * q.mass);
  EXPECT_NEAR((p.centre - q.centre).norm(), 0.0, relative);
  EXPECT_NEAR((p.inertia - q.inertia).norm(), 0.0, relative * q.inertia.norm());
}

TEST(MassProperties, OfRoundShapesAreTheIntegralsOverTheirDiscs) {
  const double r = 0.3;
  const double h = 0.7;
  expect_same(mass_properties(Cylinder{r, h}, 7.0),
              of_revolution([&](double) { return r * r; }, {-h, h}, 7.0), 1e-12);
  const auto cone = [&](double z) { return std::pow(r * (h - z) / (2.0 * h), 2); };
  expect_same(mass_properties(Cone{r, h}, 7.0), of_revolution(cone, {-h, h}, 7.0), 1e-12);
  const auto capsule = [&](double z) {
    return r * r - std::pow(std::max(0.0, std::abs(z) - h), 2);
  };
  expect_same(mass_properties(Capsule{r, h}, 7.0),
              of_revolution(capsule, {-h - r, -h, h, h + r}, 7.0), 1e-12);
  const auto spheroid = [&](double z) { return r * r * (1.0 - z * z / (h * h)); };
  expect_same(mass_properties(Ellipsoid{{r, r, h}}, 7.0), of_revolution(spheroid, {-h, h}, 7.0),
              1e-12);
  // Three different radii: the moments of a ball, stretched.
  const MassProperties egg = mass_properties(Ellipsoid{{1.0, 2.0, 3.0}}, 0.5);
  EXPECT_NEAR(egg.mass, 4.0 * M_PI, 1e-13);
  EXPECT_NEAR((egg.inertia - Mat3((egg.mass / 5.0 * Vec3(13.0, 10.0, 5.0)).asDiagonal())).norm(),
              0.0, 1e-12);
}

TEST(MassProperties, OfATetrahedronAndACompoundAreTheirClosedForms) {
  // The corner tetrahedron x + y + z <= 1: m = rho/6, centre 1/4, int x^2 = rho/60,
  // int x y = rho/120.
  const MassProperties corner =
      mass_properties(make_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}),
                      6.0);
  EXPECT_NEAR(corner.mass, 1.0, 1e-15);
  EXPECT_NEAR((corner.centre - Vec3::Constant(0.25)).norm(), 0.0, 1e-15);
  const double diagonal = 2.0 * (0.1 - 1.0 / 16.0);
  const double product = -(0.05 - 1.0 / 16.0);
  const Mat3 wanted =
      Mat3::Constant(product) + Mat3(Vec3::Constant(diagonal - product).asDiagonal());
  EXPECT_NEAR((corner.inertia - wanted).norm(), 0.0, 1e-15);
  // Two unit cubes beside each other are one brick.
  const Box cube{Vec3::Constant(0.5)};
  const MassProperties brick = mass_properties(
      make_compound({{cube, {{1.5, 2.0, 3.0}, Quat::Identity()}},
                     {cube, {{2.5, 2.0, 3.0}, Quat(std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0)}}}),
      3.0);
  MassProperties one = mass_properties(Box{{1.0, 0.5, 0.5}}, 3.0);
  one.centre = {2.0, 2.0, 3.0};
  expect_same(brick, one, 1e-14);
}

TEST(MassProperties, AreProportionalToTheDensity) {
  Random random(5);
  for (const Shape& shape :
       {Shape(Sphere{0.3}), Shape(Box{{0.1, 0.2, 0.3}}), Shape(Capsule{0.2, 0.4}),
        Shape(Cylinder{0.2, 0.4}), Shape(Cone{0.2, 0.4}), Shape(Ellipsoid{{0.1, 0.2, 0.3}}),
        Shape(testing::random_hull(random, 0.7))}) {
    const MassProperties light = mass_properties(shape, 1.0);
    const MassProperties heavy = mass_properties(shape, 7850.0);
    EXPECT_NEAR(heavy.mass, 7850.0 * light.mass, 1e-12 * heavy.mass);
    EXPECT_NEAR((heavy.inertia - 7850.0 * light.inertia).norm(), 0.0, 1e-12 * heavy.inertia.norm());
    EXPECT_EQ(heavy.centre, light.centre);
  }
}

TEST(MassProperties, AreRefusedForHalfSpacesAndBadDensities) {
  EXPECT_THROW((void)mass_properties(HalfSpace{}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)mass_properties(Sphere{1.0}, 0.0), std::invalid_argument);
  EXPECT_THROW((void)mass_properties(Sphere{1.0}, std::nan("")), std::invalid_argument);
  EXPECT_THROW((void)mass_properties(Sphere{0.0}, 1.0), std::invalid_argument);
}

/// The 8 corners.
std::vector<Vec3> corners(const Box& box, const Pose& pose) {
  std::vector<Vec3> result;
  for (int k = 0; k < 8; ++k) {
    const Vec3 signs(k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0);
    result.push_back(pose * box.half_extents.cwiseProduct(signs));
  }
  return result;
}

TEST(Shape, BoundingRadiusAndSupportAreTheFurthestCorners) {
  Random random(3);
  for (int k = 0; k < 1000; ++k) {
    const Box box{{testing::uniform(random, 0.1, 2.0), testing::uniform(random, 0.1, 2.0),
                   testing::uniform(random, 0.1, 2.0)}};
    const Pose pose{3.0 * testing::random_direction(random), testing::random_orientation(random)};
    const Vec3 n = testing::random_direction(random);
    double furthest = 0.0;
    double highest = -1e9;
    for (const Vec3& corner : corners(box, pose)) {
      furthest = std::max(furthest, corner.norm());
      highest = std::max(highest, n.dot(corner));
    }
    EXPECT_NEAR(bounding_radius(box, pose), furthest, 1e-14);
    EXPECT_NEAR(support(box, pose, n), highest, 1e-14);
    EXPECT_NEAR(bounding_radius(Sphere{0.7}, pose), 3.7, 1e-14);
    EXPECT_NEAR(support(Sphere{0.7}, pose, n), n.dot(pose.position) + 0.7, 1e-14);
    EXPECT_TRUE(std::isinf(bounding_radius(HalfSpace{}, pose)));
    EXPECT_TRUE(std::isinf(support(HalfSpace{}, pose, n)));
    const Vec3 up = pose.orientation * Vec3::UnitZ();
    EXPECT_NEAR(support(HalfSpace{}, pose, up), up.dot(pose.position), 1e-14);
  }
}

/// A point of the surface of a round shape or hull, in its frame.
Vec3 surface_point(const Shape& shape, Random& random) {
  const Vec3 n = testing::random_direction(random);
  const Vec3 around = Vec3(n.x(), n.y(), 0.0).normalized();
  const double t = testing::uniform(random, 0.0, 1.0);
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    return capsule->radius * n + Vec3(0, 0, std::copysign(capsule->half_length, n.z()));
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return cylinder->radius * around + Vec3(0, 0, (2.0 * t - 1.0) * cylinder->half_length);
  }
  if (const auto* cone = std::get_if<Cone>(&shape)) {
    return t * cone->radius * around + Vec3(0, 0, (1.0 - 2.0 * t) * cone->half_height);
  }
  if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape)) {
    return ellipsoid->radii.cwiseProduct(n);
  }
  const std::vector<Vec3>& vertices = std::get<ConvexHull>(shape).data->vertices;
  const auto k = static_cast<std::size_t>(t * static_cast<double>(vertices.size()));
  return vertices[std::min(k, vertices.size() - 1)];
}

TEST(Shape, SupportBoundsAndRadiusHoldEverySurfacePointAndNoMore) {
  Random random(11);
  constexpr int kPoints = 4000;
  for (const Shape& shape :
       {Shape(Capsule{0.2, 0.4}), Shape(Cylinder{0.3, 0.4}), Shape(Cone{0.3, 0.5}),
        Shape(Ellipsoid{{0.2, 0.3, 0.5}}), Shape(testing::random_hull(random, 0.6))}) {
    for (int k = 0; k < 10; ++k) {
      const Pose pose{2.0 * testing::random_direction(random), testing::random_orientation(random)};
      const Vec3 n = testing::random_direction(random);
      const Bounds box = bounds(shape, pose);
      double highest = -1e9;
      double furthest = 0.0;
      Vec3 low = Vec3::Constant(1e9);
      Vec3 high = -low;
      for (int i = 0; i < kPoints; ++i) {
        const Vec3 x = pose * surface_point(shape, random);
        highest = std::max(highest, n.dot(x));
        furthest = std::max(furthest, x.norm());
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
      }
      const double h = support(shape, pose, n);
      EXPECT_LE(highest, h + 1e-14) << shape.index();
      EXPECT_GE(highest, h - 0.02) << shape.index();  // 4000 points lie that near to any
      EXPECT_LE(furthest, bounding_radius(shape, pose) + 1e-14) << shape.index();
      EXPECT_LE((box.low - low).maxCoeff(), 1e-14) << shape.index();
      EXPECT_LE((high - box.high).maxCoeff(), 1e-14) << shape.index();
      EXPECT_LE((low - box.low).maxCoeff(), 0.02) << shape.index();
      EXPECT_LE((box.high - high).maxCoeff(), 0.02) << shape.index();
    }
  }
}

TEST(Prism, OverARectangleIsABox) {
  const ConvexHull prism = make_prism({{-0.5, -0.2}, {0.5, -0.2}, {0.5, 0.2}, {-0.5, 0.2}}, 1, 3);
  EXPECT_EQ(prism.data->edges.size(), 12u);
  EXPECT_NEAR((prism.data->centre - Vec3(0, 0, 2)).norm(), 0.0, 1e-15);
  MassProperties moved = mass_properties(Box{{0.5, 0.2, 1.0}}, 3.0);
  moved.centre = prism.data->centre;
  expect_same(mass_properties(prism, 3.0), moved, 1e-14);
  EXPECT_THROW((void)make_prism({{0, 0}, {1, 0}}, 0, 1), std::invalid_argument);
  EXPECT_THROW((void)make_prism({{0, 0}, {0, 1}, {1, 0}}, 0, 1),
               std::invalid_argument);  // clockwise
}

#ifdef SIGNORINI_WITH_QHULL
TEST(HullOfPoints, KeepsTheCornersAndMergesWhatIsFlat) {
  // The corners of a cube, points in its faces, edges and inside.
  std::vector<Vec3> points{{0, 0, 0.5}, {0.1, 0.2, 0.3}, {0.5, 0.2, 0.5}};
  for (int k = 0; k < 8; ++k) {
    points.emplace_back(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
  }
  const ConvexHull cube = hull_of_points(points);
  EXPECT_EQ(cube.data->vertices.size(), 8u);
  EXPECT_EQ(cube.data->faces.size(), 6u);
  EXPECT_EQ(cube.data->edges.size(), 12u);
  EXPECT_NEAR(cube.data->volume, 1.0, 1e-14);
  expect_same(mass_properties(cube, 2.0), mass_properties(Box{}, 2.0), 1e-14);
}

TEST(HullOfPoints, OfRandomPointsHoldsThemAllAndIsClosed) {
  Random random(17);
  for (int k = 0; k < 50; ++k) {
    std::vector<Vec3> points;
    for (int i = 0; i < 40; ++i) {
      points.emplace_back(testing::uniform(random, 0.3, 1.0) * testing::random_direction(random));
    }
    const ConvexHull shape = hull_of_points(points);
    const HullData& hull = *shape.data;
    for (std::size_t f = 0; f < hull.faces.size(); ++f) {
      for (const Vec3& point : points) {
        EXPECT_LE(hull.normals[f].dot(point), hull.offsets[f] + 1e-9);
      }
    }
    EXPECT_EQ(hull.vertices.size() + hull.faces.size(), hull.edges.size() + 2);  // Euler
  }
}

TEST(HullOfPoints, RefusesWhatHasNoVolume) {
  EXPECT_THROW((void)hull_of_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), std::invalid_argument);
  EXPECT_THROW((void)hull_of_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.2, 0}}),
               std::invalid_argument);
  EXPECT_THROW((void)hull_of_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}),
               std::invalid_argument);
}
#endif

TEST(Validate, RefusesBadShapes) {
  EXPECT_THROW(validate(Shape(Capsule{0.5, 0.0})), std::invalid_argument);
  EXPECT_THROW(validate(Shape(Cylinder{std::nan(""), 0.5})), std::invalid_argument);
  EXPECT_THROW(validate(Shape(Cone{0.5, -1.0})), std::invalid_argument);
  EXPECT_THROW(validate(Shape(Ellipsoid{{0.5, 0.0, 0.5}})), std::invalid_argument);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(validate(Shape(Sphere{1e-3})));
  EXPECT_NO_THROW(validate(Shape(HalfSpace{})));
  EXPECT_THROW(validate(Shape(Sphere{infinity})), std::invalid_argument);
  EXPECT_THROW(validate(Shape(Box{{1.0, 1.0, -1.0}})), std::invalid_argument);
  EXPECT_THROW(validate(Shape(Box{{std::nan(""), 1.0, 1.0}})), std::invalid_argument);
}

}  // namespace
}  // namespace signorini::collision
