#include <signorini/core/model/contact.h>
#include <signorini/core/model/motion.h>

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Contact good() {
  Contact contact;
  contact.body_a = 0;
  contact.body_b = 1;
  contact.point_a = contact.point_b = Vec3(1, 2, 3);
  contact.normal = Vec3::UnitZ();
  contact.gap = 0.0;
  return contact;
}

std::string message(const Contact& contact) {
  try {
    validate(ContactSet{good(), contact}, 2);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

void expect_refused(const std::function<void(Contact&)>& spoil,
                    const std::vector<std::string>& words) {
  Contact contact = good();
  spoil(contact);
  const std::string text = message(contact);
  EXPECT_NE(text.find("contact 1"), std::string::npos) << text;
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' in: " << text;
  }
}

TEST(Contact, AcceptsAGoodSetAndTheEmptyOne) {
  EXPECT_EQ(message(good()), "accepted");
  EXPECT_NO_THROW(validate(ContactSet{}, 0));
}

TEST(Contact, AContactThatWasNotFilledInIsRefused) {
  Contact contact;
  contact.body_a = 0;
  contact.body_b = 1;
  EXPECT_NE(message(contact), "accepted");
}

TEST(Contact, RefusesByContactAndField) {
  expect_refused([](Contact& c) { c.body_a = -1; }, {"body_a", "-1"});
  expect_refused([](Contact& c) { c.body_b = 2; }, {"body_b", "[0, 2)", "2"});
  expect_refused([](Contact& c) { c.body_b = 0; }, {"body_b", "differ"});
  expect_refused([](Contact& c) { c.point_a.x() = kNaN; }, {"point_a", "nan"});
  expect_refused([](Contact& c) { c.point_b.y() = kInfinity; }, {"point_b", "inf"});
  expect_refused([](Contact& c) { c.normal.setZero(); }, {"normal", "zero vector"});
  expect_refused([](Contact& c) { c.normal *= 1.0 + 1e-8; }, {"normal", "unit"});
  expect_refused([](Contact& c) { c.normal.x() = kNaN; }, {"normal", "nan"});
  expect_refused([](Contact& c) { c.gap = kNaN; }, {"gap", "nan"});
  expect_refused([](Contact& c) { c.gap = kInfinity; }, {"gap", "inf"});
  expect_refused([](Contact& c) { c.surface_a.radius_along = -1.0; },
                 {"surface_a.radius_along", "-1"});
  expect_refused([](Contact& c) { c.surface_b.radius_across = kNaN; },
                 {"surface_b.radius_across", "nan"});
  expect_refused([](Contact& c) { c.surface_b.direction.setZero(); }, {"surface_b.direction"});
  expect_refused([](Contact& c) { c.material.friction = -0.5; }, {"friction", "-0.5"});
  expect_refused([](Contact& c) { c.material.restitution = 1.5; }, {"restitution", "1.5"});
  expect_refused([](Contact& c) { c.material.friction_ratio = 0.0; }, {"friction_ratio", "0"});
  expect_refused([](Contact& c) { c.material.rolling_friction = -0.1; },
                 {"rolling_friction", "-0.1"});
  expect_refused([](Contact& c) { c.material.spinning_friction = kNaN; },
                 {"spinning_friction", "nan"});
  expect_refused([](Contact& c) { c.friction_direction.x() = kInfinity; },
                 {"friction_direction", "inf"});
}

TEST(Material, RefusesByFieldAndValue) {
  EXPECT_NO_THROW(validate(Material{0.0, 0.0}));
  EXPECT_NO_THROW(validate(Material{5.0, 1.0}));
  for (const double friction : {-1e-12, kNaN, kInfinity}) {
    EXPECT_THROW(validate(Material{friction, 0.0}), std::invalid_argument);
  }
  for (const double restitution : {-1e-12, 1.0 + 1e-12, kNaN}) {
    EXPECT_THROW(validate(Material{0.0, restitution}), std::invalid_argument);
  }
  try {
    validate(Material{-1e-12, 0.0});
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("-1e-12"), std::string::npos) << error.what();
  }
}

TEST(Material, PairsByEachRule) {
  const Material a{0.5, 0.2};
  const Material b{0.8, 1.0};
  const auto expect = [&](PairingRule rule, double friction, double restitution) {
    for (const Material& result : {pair(a, b, rule), pair(b, a, rule)}) {
      EXPECT_DOUBLE_EQ(result.friction, friction);
      EXPECT_DOUBLE_EQ(result.restitution, restitution);
    }
  };
  expect(PairingRule::kMultiply, 0.4, 0.2);
  expect(PairingRule::kMinimum, 0.5, 0.2);
  expect(PairingRule::kMaximum, 0.8, 1.0);
  expect(PairingRule::kMean, 0.65, 0.6);
  EXPECT_THROW((void)pair(a, b, static_cast<PairingRule>(9)), std::invalid_argument);
}

TEST(Material, PairsFrictionAcrossByTheRuleAndTakesTheLargerLengths) {
  const Material wood{.friction = 0.2, .friction_ratio = 2.5, .rolling_friction = 0.02};
  const Material ground{.friction = 0.4, .spinning_friction = 0.01};
  const Material least = pair(wood, ground, PairingRule::kMinimum);
  EXPECT_EQ(least.friction, 0.2);
  EXPECT_DOUBLE_EQ(least.friction_ratio, 0.4 / 0.2);
  EXPECT_DOUBLE_EQ(pair(wood, ground, PairingRule::kMultiply).friction_ratio, 2.5);
  for (const PairingRule rule : {PairingRule::kMultiply, PairingRule::kMean}) {
    EXPECT_EQ(pair(ground, wood, rule).rolling_friction, 0.02);
    EXPECT_EQ(pair(ground, wood, rule).spinning_friction, 0.01);
  }
  EXPECT_EQ(pair(wood, {.friction = 0.0}, PairingRule::kMinimum).friction_ratio, 1.0);
}

TEST(Motion, ConstantVelocityTurnsAboutTheWorldAxisAndKeepsItsBound) {
  const Pose start{Vec3(1, 2, 3), Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX()))};
  const Vec3 v(1, 0, -2);
  const Vec3 w(0, 3, 4);
  const ConstantVelocityMotion motion(start, v, w);
  const Pose end = motion.pose(0.5);
  EXPECT_LT((end.position - (start.position + 0.5 * v)).norm(), 1e-15);
  const Quat turn(Eigen::AngleAxisd(2.5, w / 5.0));
  EXPECT_LT(end.orientation.angularDistance(turn * start.orientation), 1e-15);
  const SpeedBound bound = motion.speed_bound(0.0, 1.0);
  EXPECT_DOUBLE_EQ(bound.linear, v.norm());
  EXPECT_DOUBLE_EQ(bound.angular, 5.0);
  EXPECT_EQ(ConstantVelocityMotion(start, v, Vec3::Zero()).pose(2.0).orientation.coeffs(),
            start.orientation.coeffs());
}

}  // namespace
}  // namespace signorini
