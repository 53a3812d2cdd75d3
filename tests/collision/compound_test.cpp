#include <signorini/collision/compound.h>
#include <signorini/collision/contact_time.h>
#include <signorini/collision/mesh.h>
#include <signorini/collision/pair_query.h>

#include "random_pairs.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>
#include <stdexcept>

namespace signorini::collision {
namespace {

using testing::Random;

Pose at(double x, double y, double z) {
  return {Vec3(x, y, z), Quat::Identity()};
}

/// Two cubes of edge 1, 2 m apart between their centres.
Compound dumbbell() {
  return make_compound({{Box{}, at(-1, 0, 0)}, {Box{}, at(1, 0, 0)}});
}

TEST(Compound, ABoxInTwoHalvesHasTheMassOfTheBox) {
  const Compound halves = make_compound(
      {{Box{Vec3(0.5, 1, 2)}, at(-0.5, 0, 0)}, {Box{Vec3(0.5, 1, 2)}, at(0.5, 0, 0)}});
  const MassProperties sum = mass_properties(halves, 3.0);
  const MassProperties whole = mass_properties(Box{Vec3(1, 1, 2)}, 3.0);
  EXPECT_NEAR(sum.mass, whole.mass, 1e-12);
  EXPECT_LE(sum.centre.norm(), 1e-15);
  EXPECT_LE((sum.inertia - whole.inertia).norm(), 1e-12 * whole.inertia.norm());
}

TEST(Compound, MassTurnsAndMovesWithItsParts) {
  Random random(2);
  const Pose local{Vec3(1, -2, 3), testing::random_orientation(random)};
  const Box box{Vec3(0.1, 0.2, 0.3)};
  const MassProperties moved = mass_properties(make_compound({{box, local}}), 5.0);
  const MassProperties own = mass_properties(box, 5.0);
  const Mat3 axes = local.orientation.toRotationMatrix();
  EXPECT_LE((moved.centre - local.position).norm(), 1e-14);
  EXPECT_LE((moved.inertia - axes * own.inertia * axes.transpose()).norm(), 1e-12);
}

TEST(Compound, ItsDistanceIsTheLeastOfItsParts) {
  Random random(3);
  const Compound body = dumbbell();
  const Compound other = make_compound({{Sphere{0.4}, at(0, 0.5, 0)}, {Box{}, at(0, -0.5, 0)}});
  for (int k = 0; k < 2000; ++k) {
    const Pose p{testing::uniform(random, 0.0, 3.0) * testing::random_direction(random),
                 testing::random_orientation(random)};
    const Pose q{testing::uniform(random, 0.0, 1.0) * testing::random_direction(random),
                 testing::random_orientation(random)};
    double expected = std::numeric_limits<double>::infinity();
    for (const CompoundPart& x : body.data->parts) {
      for (const CompoundPart& y : other.data->parts) {
        expected = std::min(expected, signed_distance(x.shape, p * x.local, y.shape, q * y.local));
      }
    }
    EXPECT_NEAR(signed_distance(body, p, other, q), expected, 1e-14);
    EXPECT_NEAR(signed_distance(other, q, body, p), expected, 1e-14);
    EXPECT_EQ(test_intersection(body, p, other, q), expected <= 0.0);
    std::vector<Contact> contacts;
    find_intersection(body, p, other, q, 0.5, contacts);
    EXPECT_EQ(contacts.empty(), expected > 0.5);
    std::set<std::uint64_t> ids;
    for (const Contact& contact : contacts) {
      ids.insert(contact.feature_id);
    }
    EXPECT_EQ(ids.size(), contacts.size());
  }
}

TEST(Compound, LandsFlatOnEightCorners) {
  std::vector<Contact> contacts;
  find_intersection(dumbbell(), at(0, 0, 0.5), HalfSpace{}, Pose{}, 1e-9, contacts);
  EXPECT_EQ(contacts.size(), 8U);
  find_intersection(dumbbell(), at(0, 0, 1.0), Box{Vec3(5, 5, 0.5)}, Pose{}, 1e-9, contacts);
  EXPECT_EQ(contacts.size(), 8U);
  const TriangleMesh floor = make_height_field(std::vector<double>(49, 0.0), 7, 7, 1.0, 1.0);
  find_intersection(dumbbell(), at(0, 0, 0.5), floor, Pose{}, 1e-9, contacts);
  EXPECT_EQ(contacts.size(), 8U);
  for (const Contact& contact : contacts) {
    EXPECT_LE((contact.normal - Vec3::UnitZ()).norm(), 1e-12);
  }
}

TEST(Compound, ContactTimeIsThatOfThePartThatHits) {
  const ConstantVelocityMotion falling(at(0, 0, 3), Vec3(0, 0, -2), Vec3::Zero());
  const StillMotion still{at(1, 0, 0)};
  const auto time = contact_time(dumbbell(), falling, Sphere{0.5}, still, 2.0);
  ASSERT_TRUE(time);
  EXPECT_NEAR(*time, 1.0, 1e-9);
}

TEST(Compound, NamesWhatIsWrong) {
  const auto refusal = [](std::vector<CompoundPart> parts) -> std::string {
    try {
      (void)make_compound(std::move(parts));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal({}), "compound: parts: must be 1 to 4096, got 0");
  EXPECT_EQ(refusal({{Box{}, {}}, {HalfSpace{}, {}}}),
            "compound: part 1: shape: must be convex and bounded");
  EXPECT_EQ(refusal({{dumbbell(), {}}}), "compound: part 0: shape: must be convex and bounded");
  EXPECT_EQ(refusal({{Sphere{-1.0}, {}}}),
            "compound: part 0: sphere: radius: must be finite and > 0, got -1");
}

}  // namespace
}  // namespace signorini::collision
