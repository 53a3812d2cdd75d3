#include <signorini/core/response/contact_memory.h>

#include <gtest/gtest.h>
#include <limits>

namespace signorini {
namespace {

/// A problem of n contacts, all frictional, whose matrix does not matter here.
PyramidProblem pyramid_of(const ContactSet& contacts, int sides, const Vec3& slip) {
  PyramidProblem pyramid;
  pyramid.sides = sides;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    pyramid.frictional.push_back(static_cast<int>(i));
    pyramid.frames.push_back(tangent_frame(contacts[i].normal, slip));
  }
  pyramid.problem.q = lcp::Vector::Zero(static_cast<lcp::Index>(contacts.size()) * (sides + 2));
  return pyramid;
}

Contact contact(int a, int b, std::uint64_t id) {
  Contact contact;
  contact.body_a = a;
  contact.body_b = b;
  contact.feature_id = id;
  contact.normal = Vec3::UnitZ();
  contact.point_a = contact.point_b = Vec3::Zero();
  return contact;
}

const ContactSet kContacts = {contact(1, 0, 7), contact(1, 0, 3), contact(2, 1, 7)};

/// f = 1, 2, 3; beta = 10 + index; lambda = 100, 101, 102.
lcp::Vector numbered(const PyramidProblem& pyramid) {
  lcp::Vector z(pyramid.problem.size());
  const lcp::Index n = static_cast<lcp::Index>(pyramid.frictional.size());
  for (lcp::Index i = 0; i < z.size(); ++i) {
    z[i] = static_cast<double>(i);
  }
  z.head(n) << 1.0, 2.0, 3.0;
  return z;
}

TEST(ContactMemory, RecallsTheSameImpulsesWhateverTheOrderOfTheContacts) {
  const PyramidProblem before = pyramid_of(kContacts, 8, Vec3(0.3, -1.0, 0.0));
  const lcp::Vector z = numbered(before);
  ContactMemory memory;
  memory.remember(before, kContacts, z);

  const ContactSet now = {kContacts[2], kContacts[0], kContacts[1]};
  const PyramidProblem after = pyramid_of(now, 8, Vec3(-0.2, 0.1, 0.0));  // turned frames
  lcp::Vector start;
  EXPECT_EQ(memory.recall(after, now, start).known, 3);
  ASSERT_EQ(start.size(), z.size());
  EXPECT_GE(start.minCoeff(), 0.0);
  const auto old_impulses = contact_impulses(before, kContacts, z);
  const auto new_impulses = contact_impulses(after, now, start);
  const int source[] = {2, 0, 1};
  for (int i = 0; i < 3; ++i) {
    // Impulses of size 100, a few roundings each.
    EXPECT_LE((new_impulses[i] - old_impulses[source[i]]).norm(), 1e-12) << i;
    EXPECT_EQ(start[3 + 8 * 3 + i], z[3 + 8 * 3 + source[i]]) << i;
  }
}

TEST(ContactMemory, NewContactsStartAtZero) {
  const PyramidProblem before = pyramid_of(kContacts, 4, Vec3::UnitX());
  ContactMemory memory;
  memory.remember(before, kContacts, numbered(before));
  const ContactSet now = {contact(1, 0, 8), contact(0, 1, 7), contact(3, 1, 7)};
  lcp::Vector start = lcp::Vector::Ones(1);
  EXPECT_EQ(memory.recall(pyramid_of(now, 4, Vec3::UnitX()), now, start).known, 0);
  EXPECT_EQ(start, lcp::Vector(lcp::Vector::Zero(18)));
  memory.forget();
  EXPECT_EQ(memory.recall(before, kContacts, start).known, 0);
}

TEST(ContactMemory, SaysWhetherAnImpulseWasACorrection) {
  const PyramidProblem before = pyramid_of(kContacts, 4, Vec3::UnitX());
  ContactMemory memory;
  lcp::Vector start;
  memory.remember(before, kContacts, numbered(before));
  EXPECT_FALSE(memory.recall(before, kContacts, start).corrected);
  const ContactSet one = {contact(3, 1, 9)};
  const PyramidProblem other = pyramid_of(one, 4, Vec3::UnitX());
  memory.add(other, one, lcp::Vector::Ones(other.problem.size()), true);
  memory.sort();
  EXPECT_FALSE(memory.recall(before, kContacts, start).corrected);
  EXPECT_TRUE(memory.recall(other, one, start).corrected);
}

TEST(ContactMemory, ADirectionAlongAnEdgeOfThePyramidIsHit) {
  PyramidProblem pyramid = pyramid_of({kContacts[0]}, 8, Vec3::UnitX());
  lcp::Vector z = lcp::Vector::Zero(10);
  z[0] = 1.0;
  ContactMemory memory;
  for (int j = 0; j < 8; ++j) {
    z.segment(1, 8).setZero();
    z[1 + j] = 0.5;
    memory.remember(pyramid, {kContacts[0]}, z);
    lcp::Vector start;
    memory.recall(pyramid, {kContacts[0]}, start);
    EXPECT_LE((start - z).cwiseAbs().maxCoeff(), 1e-14) << j;
  }
}

}  // namespace
}  // namespace signorini
