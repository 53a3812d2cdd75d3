#include <signorini/collision/collision_world.h>
#include <signorini/collision/pair_query.h>

#include "random_pairs.h"
#include "tests/lcp/allocation_count.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

namespace signorini::collision {
namespace {

using testing::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Body body_of(BodyKind kind) {
  Body body;
  body.kind = kind;
  return body;
}

Collider collider(int body, const Shape& shape, const Material& material = {},
                  const Pose& local = {}) {
  return {body, shape, local, material, "collider of " + std::to_string(body)};
}

BodyState at(const Vec3& x) {
  BodyState state;
  state.x = x;
  return state;
}

template <class Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing thrown";
}

const Box kCube{Vec3::Constant(0.5)};

/// A ground (body 0) and balls and cubes at random, some overlapping.
struct Heap {
  Bodies bodies{body_of(BodyKind::kFixed)};
  std::vector<Collider> colliders{collider(0, HalfSpace{})};
  State state{at(Vec3::Zero())};

  explicit Heap(int count) {
    Random random(99);
    for (int k = 1; k <= count; ++k) {
      bodies.push_back(body_of(k % 7 == 0 ? BodyKind::kFixed : BodyKind::kDynamic));
      colliders.push_back(collider(k, k % 2 == 0 ? Shape(kCube) : Shape(Sphere{0.4})));
      BodyState body =
          at(Vec3(testing::uniform(random, -5.0, 5.0), testing::uniform(random, -5.0, 5.0),
                  testing::uniform(random, 0.0, 3.0)));
      body.q = testing::random_orientation(random);
      state.push_back(body);
    }
  }
};

TEST(CollisionWorld, TurnsTheFrictionDirectionWithItsCollider) {
  const Bodies bodies{body_of(BodyKind::kFixed), body_of(BodyKind::kDynamic)};
  State state{at(Vec3::Zero()), at(Vec3(0, 0, 0.5))};
  state[1].q = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  const Pose turned{Vec3::Zero(), Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ()))};
  Collider box = collider(1, kCube, {.friction = 0.2, .friction_ratio = 2.0}, turned);
  box.friction_direction = Vec3::UnitX();
  ContactSet found;
  CollisionWorld(bodies, {collider(0, HalfSpace{}), box}, PairingRule::kMaximum)
      .find(state, 0.01, found);
  ASSERT_EQ(found.size(), 4U);
  for (const Contact& contact : found) {
    EXPECT_LT((contact.friction_direction - Vec3(std::cos(0.7), std::sin(0.7), 0.0)).norm(), 1e-15);
  }
  box.friction_direction.x() = kNaN;
  EXPECT_NE(refusal([&] {
              CollisionWorld(bodies, {box}, PairingRule::kMaximum);
            }).find("friction_direction"),
            std::string::npos);
}

TEST(CollisionWorld, FindsWhatEveryPairOfCollidersFinds) {
  const Heap heap(200);
  const double margin = 0.05;
  CollisionWorld world(heap.bodies, heap.colliders, PairingRule::kMultiply);
  ContactSet found;
  world.find(heap.state, margin, found);

  ContactSet expected;
  std::vector<Contact> of_pair;
  for (std::size_t a = 0; a < heap.colliders.size(); ++a) {
    for (std::size_t b = a + 1; b < heap.colliders.size(); ++b) {
      if (heap.bodies[a].is_dynamic() || heap.bodies[b].is_dynamic()) {
        find_intersection(heap.colliders[a].shape, heap.state[a].pose(), heap.colliders[b].shape,
                          heap.state[b].pose(), margin, of_pair);
        for (Contact& contact : of_pair) {
          contact.body_a = static_cast<int>(a);
          contact.body_b = static_cast<int>(b);
          expected.push_back(contact);
        }
      }
    }
  }
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_GT(found.size(), 100u);
  std::set<std::uint64_t> ids;
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].body_a, expected[k].body_a);
    EXPECT_EQ(found[k].body_b, expected[k].body_b);
    EXPECT_EQ(found[k].point_a, expected[k].point_a);
    EXPECT_EQ(found[k].gap, expected[k].gap);
    ids.insert(found[k].feature_id);
  }
  EXPECT_EQ(ids.size(), found.size());
  EXPECT_NO_THROW(validate(found, static_cast<int>(heap.bodies.size())));
}

TEST(CollisionWorld, FeatureIdsDoNotDependOnLaterColliders) {
  const Heap small(20);
  const Heap large(200);  // begins with the same bodies
  ContactSet few;
  ContactSet many;
  CollisionWorld(small.bodies, small.colliders, PairingRule::kMultiply)
      .find(small.state, 0.05, few);
  CollisionWorld(large.bodies, large.colliders, PairingRule::kMultiply)
      .find(large.state, 0.05, many);
  ASSERT_FALSE(few.empty());
  for (const Contact& contact : few) {
    EXPECT_TRUE(std::any_of(many.begin(), many.end(), [&](const Contact& other) {
      return other.feature_id == contact.feature_id && other.point_a == contact.point_a;
    }));
  }
}

TEST(CollisionWorld, ContactsCarryThePairsMaterial) {
  const Bodies bodies{body_of(BodyKind::kFixed), body_of(BodyKind::kDynamic)};
  CollisionWorld world(bodies,
                       {collider(0, HalfSpace{}, {0.5, 0.2}), collider(1, kCube, {0.3, 0.8})},
                       PairingRule::kMinimum);
  ContactSet contacts;
  world.find({at(Vec3::Zero()), at({0, 0, 0.5})}, 0.0, contacts);
  ASSERT_EQ(contacts.size(), 4u);
  for (const Contact& contact : contacts) {
    EXPECT_EQ(contact.material.friction, 0.3);
    EXPECT_EQ(contact.material.restitution, 0.2);
    EXPECT_EQ(contact.body_a, 0);
    EXPECT_EQ(contact.normal, -Vec3::UnitZ());  // from B, the box, to A, the ground
  }
}

TEST(CollisionWorld, SkipsPairsOfOneBodyAndPairsThatNothingMoves) {
  const Bodies bodies{body_of(BodyKind::kFixed), body_of(BodyKind::kKinematic),
                      body_of(BodyKind::kDynamic)};
  CollisionWorld world(
      bodies,
      {collider(0, kCube), collider(1, kCube), collider(2, kCube), collider(2, Sphere{0.5})},
      PairingRule::kMultiply);
  ContactSet contacts;
  world.find({at(Vec3::Zero()), at({0.1, 0, 0}), at({50, 0, 0})}, 0.0, contacts);
  EXPECT_TRUE(contacts.empty());
}

TEST(CollisionWorld, FiltersLeaveOutTheirPairs) {
  // Four balls in one place: bodies 0 to 3.
  const Bodies bodies(4, body_of(BodyKind::kDynamic));
  const State state(4, at(Vec3::Zero()));
  std::vector<Collider> colliders;
  for (int body = 0; body < 4; ++body) {
    colliders.push_back(collider(body, Sphere{0.5}));
  }
  const auto pairs_found = [&](IgnoredPairs ignored) {
    CollisionWorld world(bodies, colliders, PairingRule::kMultiply, std::move(ignored));
    ContactSet contacts;
    world.find(state, 0.0, contacts);
    std::vector<std::pair<int, int>> found;
    for (const Contact& contact : contacts) {
      found.emplace_back(contact.body_a, contact.body_b);
    }
    return found;
  };
  using Pairs = std::vector<std::pair<int, int>>;
  EXPECT_EQ(pairs_found({}), (Pairs{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}));
  EXPECT_EQ(pairs_found(IgnoredPairs({{2, 0}, {3, 1}, {0, 2}})),
            (Pairs{{0, 1}, {0, 3}, {1, 2}, {2, 3}}));
  // One way is not enough: 3 is in nobody's mask but its own category's.
  colliders[3].filter = {.category = 2, .mask = 0xffffffffU};
  colliders[0].filter.mask = 1;
  colliders[1].filter.mask = 1;
  EXPECT_EQ(pairs_found({}), (Pairs{{0, 1}, {0, 2}, {1, 2}, {2, 3}}));
  colliders[2].filter.mask = 0;
  EXPECT_EQ(pairs_found({}), (Pairs{{0, 1}}));
  EXPECT_EQ(refusal([&] {
              CollisionWorld(bodies, colliders, PairingRule::kMultiply, IgnoredPairs({{1, 4}}));
            }),
            "ignored pair of bodies: must be in [0, 4), got 1 and 4");
}

TEST(CollisionWorld, AWarmStepAllocatesNothing) {
  const Heap heap(200);
  CollisionWorld world(heap.bodies, heap.colliders, PairingRule::kMultiply);
  ContactSet contacts;
  world.find(heap.state, 0.01, contacts);
  const std::size_t first = contacts.size();
  const lcp::AllocationCount allocations;
  world.find(heap.state, 0.01, contacts);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(contacts.size(), first);
  EXPECT_GT(first, 50U);
}

bool is_same(const Contact& p, const Contact& q) {
  return p.body_a == q.body_a && p.body_b == q.body_b && p.feature_id == q.feature_id &&
         p.gap == q.gap && p.normal == q.normal && p.point_a == q.point_a &&
         p.point_b == q.point_b && p.owner == q.owner;
}

// Whatever has moved since the last call, the contacts are those of a world that never found any.
TEST(CollisionWorld, AsksOnlyPairsThatMovedAndFindsTheSame) {
  Heap heap(60);
  Random random(5);
  CollisionWorld world(heap.bodies, heap.colliders, {});
  ContactSet found;
  world.find(heap.state, 0.05, found);
  const int all = world.pairs_asked();
  ASSERT_GT(all, 50);
  for (int k = 0; k < 40; ++k) {
    const double margin = k % 10 == 9 ? 0.1 : 0.05;
    const int most = k < 20 ? 0 : 4;
    if (k == 20) {
      world.keep_at_most(most);
    }
    const std::size_t moved = k % 4 == 0 ? 0 : 1 + random() % 60;
    if (moved != 0) {
      heap.state[moved].x += Vec3(0.01, 0.0, 0.0);
    }
    const bool same_margin = k % 10 != 9 && (k % 10 != 0 || k == 0);
    world.find(heap.state, margin, found);
    if (same_margin && k != 20) {
      EXPECT_LT(world.pairs_asked(), all / 2);
      EXPECT_TRUE(moved != 0 || world.pairs_asked() == 0) << k;
    }
    CollisionWorld fresh(heap.bodies, heap.colliders, {});
    fresh.keep_at_most(most);
    ContactSet expected;
    fresh.find(heap.state, margin, expected);
    ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end(), is_same))
        << k;
    EXPECT_EQ(world.reduction_loss().points, fresh.reduction_loss().points);
    EXPECT_EQ(world.reduction_loss().area_before, fresh.reduction_loss().area_before);
  }
}

TEST(CollisionWorld, CollidersSitWhereTheirLocalPosesPutThem) {
  const Bodies bodies{body_of(BodyKind::kFixed), body_of(BodyKind::kDynamic)};
  CollisionWorld world(
      bodies,
      {collider(0, HalfSpace{}), collider(1, Sphere{0.2}, {}, {{1.0, 0.0, 0.0}, Quat::Identity()})},
      PairingRule::kMultiply);
  State state{at(Vec3::Zero()), at({0, 0, 1.0})};
  state[1].q = Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()));  // +x turns to -z
  ContactSet contacts;
  world.find(state, 0.0, contacts);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].gap, -0.2, 1e-15);
}

TEST(CollisionWorld, FirstContactIsTheEarliestOfAllPairs) {
  const Bodies bodies{body_of(BodyKind::kFixed), body_of(BodyKind::kDynamic),
                      body_of(BodyKind::kDynamic)};
  CollisionWorld world(bodies,
                       {collider(0, HalfSpace{}), collider(1, Sphere{0.5}), collider(2, kCube)},
                       PairingRule::kMultiply);
  const StillMotion ground{Pose{}};
  const ConstantVelocityMotion slow({{0, 0, 2.5}, Quat::Identity()}, {0, 0, -1.0}, Vec3::Zero());
  const ConstantVelocityMotion fast({{5, 0, 2.5}, Quat::Identity()}, {0, 0, -4.0}, Vec3::Zero());
  const Motion* const motions[] = {&ground, &slow, &fast};
  const auto first = world.first_contact(motions, 10.0);
  ASSERT_TRUE(first.has_value());
  EXPECT_NEAR(first->time, 0.5, 1e-15);
  EXPECT_EQ(first->body_a, 0);
  EXPECT_EQ(first->body_b, 2);
  EXPECT_FALSE(world.first_contact(motions, 0.25).has_value());
}

TEST(CollisionWorld, FirstContactTurnsOffCentreCollidersAboutTheBody) {
  // A ball at the end of an arm of 1 m turns into the plane.
  const Bodies bodies{body_of(BodyKind::kFixed), body_of(BodyKind::kDynamic)};
  CollisionWorld world(
      bodies,
      {collider(0, HalfSpace{}), collider(1, Sphere{0.1}, {}, {{1.0, 0.0, 0.0}, Quat::Identity()})},
      PairingRule::kMultiply);
  const StillMotion ground{Pose{}};
  const ConstantVelocityMotion turning({{0, 0, 0.6}, Quat::Identity()}, Vec3::Zero(), {0, 3.0, 0});
  const Motion* const motions[] = {&ground, &turning};
  const auto first = world.first_contact(motions, 1.0);
  ASSERT_TRUE(first.has_value());
  EXPECT_NEAR(3.0 * first->time, M_PI / 6, 1e-13);  // 0.6 - sin(phi) = 0.1
}

TEST(CollisionWorld, NamesWhatIsWrong) {
  const Bodies bodies{body_of(BodyKind::kFixed), body_of(BodyKind::kDynamic)};
  const auto make = [&](const Collider& bad) {
    return refusal([&] { CollisionWorld world(bodies, {bad}, PairingRule::kMultiply); });
  };
  EXPECT_EQ(make(collider(2, kCube)), "collider 'collider of 2': body: must be in [0, 2), got 2");
  EXPECT_EQ(make(collider(1, Sphere{kNaN})),
            "collider 'collider of 1': sphere: radius: must be finite and > 0, got nan");
  EXPECT_EQ(make(collider(1, kCube, {-0.5, 0.0})),
            "collider 'collider of 1': material: friction: must be finite and >= 0, got -0.5");
  EXPECT_EQ(make(collider(1, HalfSpace{})),
            "collider 'collider of 1': body: a half-space is immovable, body 1 is dynamic");

  CollisionWorld world(bodies, {collider(0, HalfSpace{}), collider(1, kCube)},
                       PairingRule::kMultiply);
  ContactSet contacts;
  EXPECT_EQ(refusal([&] { world.find({at(Vec3::Zero())}, 0.0, contacts); }),
            "state: must be one a body, 2, got 1");
  EXPECT_EQ(refusal([&] {
              world.find({at(Vec3::Zero()), at({0, kInfinity, 0})}, 0.0, contacts);
            }),
            "body 1: pose: position: must be finite, got (0, inf, 0) m");
  EXPECT_EQ(refusal([&] {
              world.find({at(Vec3::Zero()), at({0, 0, 2})}, -1.0, contacts);
            }),
            "margin: must be finite and >= 0, got -1");
  const StillMotion still{Pose{}};
  const Motion* const motions[] = {&still, nullptr};
  EXPECT_EQ(refusal([&] { (void)world.first_contact(motions, 1.0); }),
            "motions: 1: must not be null");
  EXPECT_EQ(refusal([&] { (void)world.first_contact(motions, kNaN); }),
            "duration: must be finite and >= 0, got nan");
}

}  // namespace
}  // namespace signorini::collision
