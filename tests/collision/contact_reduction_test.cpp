#include <signorini/collision/collision_world.h>
#include <signorini/collision/contact_reduction.h>

#include "random_pairs.h"
#include "tests/lcp/allocation_count.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <stdexcept>

namespace signorini::collision {
namespace {

Contact contact_at(const Vec3& point, double gap, std::uint64_t id, const Vec3& normal) {
  Contact contact;
  contact.body_a = 1;
  contact.body_b = 0;
  contact.point_a = point;
  contact.point_b = point - gap * normal;
  contact.normal = normal;
  contact.gap = gap;
  contact.feature_id = id;
  return contact;
}

std::vector<Contact> octagon(double gap = 0.0) {
  std::vector<Contact> contacts;
  for (int k = 0; k < 8; ++k) {
    const double angle = k * M_PI_4;
    contacts.push_back(contact_at({std::cos(angle), std::sin(angle), 0.0}, gap,
                                  static_cast<std::uint64_t>(k), Vec3::UnitZ()));
  }
  return contacts;
}

std::set<std::uint64_t> ids(const std::vector<Contact>& contacts) {
  std::set<std::uint64_t> result;
  for (const Contact& contact : contacts) {
    result.insert(contact.feature_id);
  }
  return result;
}

TEST(ContactReduction, KeepsTheHullOfThePatchAndNothingElse) {
  std::vector<Contact> contacts = octagon();
  contacts.push_back(contact_at({0.1, 0.2, 0.0}, 0.0, 20, Vec3::UnitZ()));
  contacts.push_back(contact_at({0.3, -0.2, 0.0}, 0.0, 21, Vec3::UnitZ()));
  contacts.push_back(
      contact_at(0.5 * (contacts[0].point_a + contacts[1].point_a), 0.0, 22, Vec3::UnitZ()));
  const ReductionLoss loss = reduce_contacts(contacts, 8);
  EXPECT_EQ(loss.points, 3);
  EXPECT_NEAR(loss.area_before, std::sqrt(8.0), 1e-14);
  EXPECT_NEAR(loss.area_after, std::sqrt(8.0), 1e-14);
  EXPECT_EQ(ids(contacts), ids(octagon()));
}

TEST(ContactReduction, LeavesOutTheCornersThatCostTheLeastArea) {
  std::vector<Contact> contacts = octagon();
  ReductionLoss loss = reduce_contacts(contacts, 4);
  EXPECT_EQ(loss.points, 4);
  EXPECT_NEAR(loss.area_after, 2.0, 1e-14);  // a square, the largest four-cornered part
  EXPECT_EQ(contacts.size(), 4u);
  // A sliver beside a square goes first.
  contacts = {
      contact_at({0, 0, 0}, 0, 1, Vec3::UnitZ()), contact_at({1, 0, 0}, 0, 2, Vec3::UnitZ()),
      contact_at({1, 1, 0}, 0, 3, Vec3::UnitZ()), contact_at({0, 1, 0}, 0, 4, Vec3::UnitZ()),
      contact_at({0.5, -0.01, 0}, 0, 0, Vec3::UnitZ())};
  loss = reduce_contacts(contacts, 4);
  EXPECT_EQ(ids(contacts), (std::set<std::uint64_t>{1, 2, 3, 4}));
  EXPECT_NEAR(loss.area_before - loss.area_after, 0.005, 1e-15);
}

TEST(ContactReduction, NeverLeavesOutTheDeepestPoint) {
  for (const int most : {3, 4, 8}) {
    std::vector<Contact> contacts = octagon();
    contacts.push_back(contact_at({0.1, 0.2, 0.0}, -0.01, 20, Vec3::UnitZ()));
    (void)reduce_contacts(contacts, most);
    EXPECT_TRUE(ids(contacts).contains(20)) << most;
    EXPECT_EQ(contacts.size(), static_cast<std::size_t>(most));
    contacts = octagon();
    contacts[7].gap = -1e-3;
    (void)reduce_contacts(contacts, most);
    EXPECT_TRUE(ids(contacts).contains(7)) << most;
  }
}

TEST(ContactReduction, KeepsPatchesApartByNormalAndByBodies) {
  std::vector<Contact> contacts = octagon();
  for (Contact contact : octagon()) {
    contact.normal = Vec3::UnitX();
    contact.point_a = {0.0, contact.point_a.x(), contact.point_a.y()};
    contact.feature_id += 100;
    contacts.push_back(contact);
    contact.body_b = 2;
    contact.feature_id += 100;
    contacts.push_back(contact);
  }
  const ReductionLoss loss = reduce_contacts(contacts, 3);
  EXPECT_EQ(contacts.size(), 9u);
  EXPECT_EQ(loss.points, 15);
  EXPECT_NEAR(loss.area_before, 3.0 * std::sqrt(8.0), 1e-13);
}

TEST(ContactReduction, TakesFewAndDegenerateSetsAsTheyAre) {
  std::vector<Contact> contacts;
  EXPECT_EQ(reduce_contacts(contacts, 4).points, 0);
  contacts = {contact_at({1, 2, 3}, 0.1, 7, Vec3::UnitZ())};
  EXPECT_EQ(reduce_contacts(contacts, 3).points, 0);
  ASSERT_EQ(contacts.size(), 1u);
  // All at one place; all on a line: its two ends.
  contacts.assign(5, contacts[0]);
  EXPECT_EQ(reduce_contacts(contacts, 3).points, 4);
  contacts.clear();
  for (int k = 0; k < 5; ++k) {
    contacts.push_back(contact_at({0.1 * k, 0.2 * k, 0.0}, 0.0, k, Vec3::UnitZ()));
  }
  const ReductionLoss loss = reduce_contacts(contacts, 3);
  EXPECT_EQ(ids(contacts), (std::set<std::uint64_t>{0, 4}));
  EXPECT_NEAR(loss.area_before, 0.0, 1e-15);
  EXPECT_THROW((void)reduce_contacts(contacts, 2), std::invalid_argument);
  EXPECT_EQ(contacts.size(), 2u);
}

TEST(ContactReduction, ChoosesTheSameUnderJitterAndAllocatesNothing) {
  testing::Random random(5);
  std::set<std::uint64_t> first;
  std::vector<Contact> contacts = octagon();
  (void)reduce_contacts(contacts, 4);
  first = ids(contacts);
  for (int k = 0; k < 2000; ++k) {
    contacts = octagon();
    for (Contact& contact : contacts) {
      contact.point_a += 1e-9 * testing::random_direction(random);
      contact.gap += 1e-9 * testing::uniform(random, -1.0, 1.0);
    }
    const lcp::AllocationCount allocations;
    (void)reduce_contacts(contacts, 4);
    ASSERT_EQ(allocations.count(), 0);
    ASSERT_EQ(ids(contacts), first) << k;
  }
}

TEST(ContactReduction, IsAnOptionOfTheWorldAndOffByDefault) {
  Bodies bodies(2);
  bodies[0].kind = BodyKind::kFixed;
  bodies[1].mass = 1.0;
  bodies[1].inertia = Mat3::Identity();
  std::vector<Collider> colliders(2);
  colliders[0] = {0, HalfSpace{}, {}, {}, "ground"};
  colliders[1] = {1, Cylinder{0.5, 0.5}, {}, {}, "drum"};
  State state(2);
  state[1].x = {0, 0, 0.5};
  CollisionWorld world(bodies, colliders, PairingRule::kMultiply);
  ContactSet contacts;
  world.find(state, 1e-6, contacts);
  EXPECT_EQ(contacts.size(), 8u);
  EXPECT_EQ(world.reduction_loss().points, 0);
  world.keep_at_most(4);
  world.find(state, 1e-6, contacts);
  EXPECT_EQ(contacts.size(), 4u);
  EXPECT_EQ(world.reduction_loss().points, 4);
  EXPECT_NEAR(world.reduction_loss().area_after, 0.5, 1e-12);  // 2 r^2 of 2.83 r^2
  world.keep_at_most(0);
  world.find(state, 1e-6, contacts);
  EXPECT_EQ(contacts.size(), 8u);
  EXPECT_THROW(world.keep_at_most(2), std::invalid_argument);
}

}  // namespace
}  // namespace signorini::collision
