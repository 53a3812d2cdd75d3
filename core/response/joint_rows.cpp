#include <signorini/core/model/number_text.h>
#include <signorini/core/response/joint_rows.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace signorini {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The rows of one joint.
class RowsOfJoint {
 public:
  RowsOfJoint(const Joints& joints, int number, const State& state, double step,
              std::vector<JointRow>& rows)
      : joint_(joints[number]),
        number_(number),
        state_(state),
        step_(step),
        p_a_(anchor_a(joint_, state)),
        p_b_(anchor_b(joint_, state)),
        axis_(state[joint_.body_b].q * joint_.axis),
        error_(joint_error(joint_, state)),
        rows_(rows) {}

  void add() {
    switch (joint_.kind) {
      case JointKind::kFixed:
        hold_point();
        hold_orientation();
        return;
      case JointKind::kBall: hold_point(); return;
      case JointKind::kHinge:
        hold_point();
        for (const Vec3& t : across()) {
          equality(turning(t), t.dot(error_.angle));
        }
        drive(turning(axis_));
        return;
      case JointKind::kSlider:
        hold_orientation();
        for (const Vec3& t : across()) {
          equality(pushing(t, p_a_), t.dot(error_.position));
        }
        drive(pushing(axis_, p_a_));
        return;
      case JointKind::kDistance: drive(pushing(direction(), p_a_)); return;
    }
  }

 private:
  [[nodiscard]] JointRow pushing(const Vec3& along, const Vec3& point) const {
    JointRow row = empty();
    row.linear = along;
    row.angular_a = (point - state_[joint_.body_a].x).cross(along);
    row.angular_b = (point - state_[joint_.body_b].x).cross(along);
    return row;
  }

  [[nodiscard]] JointRow turning(const Vec3& about) const {
    JointRow row = empty();
    row.angular_a = row.angular_b = about;
    return row;
  }

  [[nodiscard]] JointRow empty() const {
    JointRow row;
    row.joint = number_;
    row.body_a = joint_.body_a;
    row.body_b = joint_.body_b;
    return row;
  }

  [[nodiscard]] std::array<Vec3, 2> across() const {
    const Vec3 t = joint_.axis.unitOrthogonal();
    const Quat& q = state_[joint_.body_b].q;
    return {q * t, q * joint_.axis.cross(t)};
  }

  [[nodiscard]] Vec3 direction() const {
    const Vec3 apart = p_a_ - p_b_;
    const double distance = apart.norm();
    if (!(distance > 0.0)) {
      throw std::invalid_argument("joint " + std::to_string(number_) +
                                  ": distance: the anchors coincide at " + number_text(p_a_) +
                                  " m and have no direction");
    }
    return apart / distance;
  }

  void equality(JointRow row, double error) {
    bounded(std::move(row), next_slot_++, error, -kInfinity, kInfinity, 0.0);
  }

  void bounded(JointRow row, int slot, double error, double lower, double upper, double bias) {
    row.slot = slot;
    row.error = error;
    row.lower = lower;
    row.upper = upper;
    row.bias = bias;
    rows_.push_back(row);
  }

  void hold_point() {
    const Vec3 middle = 0.5 * (p_a_ + p_b_);
    for (int k = 0; k < 3; ++k) {
      equality(pushing(Vec3::Unit(k), middle), error_.position[k]);
    }
  }

  void hold_orientation() {
    for (int k = 0; k < 3; ++k) {
      equality(turning(Vec3::Unit(k)), error_.angle[k]);
    }
  }

  /// Limits and motor, along the row of the coordinate.
  void drive(const JointRow& along) {
    const double c = joint_coordinate(joint_, state_);
    const auto [lower, upper] = joint_.limits;
    if (lower == upper) {
      bounded(along, kJointLowerSlot, c - lower, -kInfinity, kInfinity, 0.0);
    } else {
      if (std::isfinite(lower)) {
        bounded(along, kJointLowerSlot, c - lower, 0.0, kInfinity,
                std::max(c - lower, 0.0) / step_);
      }
      if (std::isfinite(upper)) {
        JointRow back = along;
        back.linear = -back.linear;
        back.angular_a = -back.angular_a;
        back.angular_b = -back.angular_b;
        bounded(back, kJointUpperSlot, upper - c, 0.0, kInfinity, std::max(upper - c, 0.0) / step_);
      }
    }
    if (joint_.motor.max_force > 0.0) {
      const double most = step_ * joint_.motor.max_force;
      bounded(along, kJointMotorSlot, 0.0, -most, most, -joint_.motor.speed);
    }
  }

  const Joint& joint_;
  int number_;
  const State& state_;
  double step_;
  Vec3 p_a_, p_b_, axis_;
  JointError error_;
  std::vector<JointRow>& rows_;
  int next_slot_ = 0;
};

/// max(0, how far c is outside its limits).
double beyond_limits(const Joint& joint, double c) {
  return joint.has_coordinate() ? std::max({0.0, joint.limits.lower - c, c - joint.limits.upper})
                                : 0.0;
}

}  // namespace

void joint_rows(const Joints& joints, const State& state, double step,
                std::vector<JointRow>& rows) {
  rows.clear();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    RowsOfJoint(joints, static_cast<int>(i), state, step, rows).add();
  }
}

void add_body_pairs(std::span<const JointRow> rows, BodyPairs& pairs) {
  for (const JointRow& row : rows) {
    pairs.emplace_back(row.body_a, row.body_b);
  }
}

void add_joint_rows(std::span<const JointRow> joints, NormalRows& rows,
                    double relative_compliance) {
  const auto inverse_mass_along = [&](int body, const Vec3& linear, const Vec3& angular) {
    if (rows.block_of_body[body] < 0) {
      return 0.0;
    }
    Vec6 values, moved;
    values << linear, angular;
    rows.A.mass.apply_inverse(rows.block_of_body[body], values.data(), moved.data());
    return values.dot(moved);
  };
  const auto add_body = [&](int body, const Vec3& linear, const Vec3& angular) {
    if (rows.block_of_body[body] >= 0) {
      Vec6 values;
      values << linear, angular;
      rows.A.add_entry(rows.block_of_body[body], values);
    }
  };
  for (const JointRow& row : joints) {
    const double diagonal = inverse_mass_along(row.body_a, row.linear, row.angular_a) +
                            inverse_mass_along(row.body_b, row.linear, row.angular_b);
    rows.A.add_row(relative_compliance * diagonal);
    add_body(row.body_a, row.linear, row.angular_a);
    add_body(row.body_b, -row.linear, -row.angular_b);
  }
}

double joint_velocity(const JointRow& row, const Velocity& a, const Velocity& b) {
  return row.linear.dot(a.linear - b.linear) + row.angular_a.dot(a.angular) -
         row.angular_b.dot(b.angular);
}

void set_joint_bounds(std::span<const JointRow> rows, lcp::Problem& problem) {
  if (rows.empty()) {
    problem.lower.resize(0);
    problem.upper.resize(0);
    return;
  }
  problem.lower.setZero(problem.size());
  problem.upper.setConstant(problem.size(), kInfinity);
  lcp::Index row = problem.size() - static_cast<lcp::Index>(rows.size());
  for (const JointRow& joint : rows) {
    problem.lower[row] = joint.lower;
    problem.upper[row] = joint.upper;
    ++row;
  }
}

void set_joint_bounds(const std::vector<Velocity>& velocities, std::span<const JointRow> rows,
                      lcp::Problem& problem) {
  set_joint_bounds(rows, problem);
  lcp::Index row = problem.size() - static_cast<lcp::Index>(rows.size());
  for (const JointRow& joint : rows) {
    problem.q[row] =
        joint_velocity(joint, velocities[joint.body_a], velocities[joint.body_b]) + joint.bias;
    ++row;
  }
}

void remember_joints(std::span<const JointRow> rows, const lcp::VectorRef& z, JointMemory& memory) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    memory[rows[i].joint][rows[i].slot] = z[static_cast<lcp::Index>(i)];
  }
}

void recall_joints(std::span<const JointRow> rows, const JointMemory& memory, lcp::Vector& z) {
  const lcp::Index first = z.size() - static_cast<lcp::Index>(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    z[first + static_cast<lcp::Index>(i)] =
        std::clamp(memory[rows[i].joint][rows[i].slot], rows[i].lower, rows[i].upper);
  }
}

void add_joint_impulses(const Joints& joints, const State& state, std::span<const JointRow> rows,
                        const lcp::VectorRef& z, std::vector<JointReport>& reports) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const JointRow& row = rows[i];
    const double size = z[static_cast<lcp::Index>(i)];
    JointReport& report = reports[row.joint];
    const Joint& joint = joints[row.joint];
    const Vec3 arm = anchor_a(joint, state) - state[joint.body_a].x;
    report.impulse += size * row.linear;
    report.angular_a += size * row.angular_a;
    report.angular_b -= size * row.angular_b;
    report.moment += size * (row.angular_a - arm.cross(row.linear));
    if (row.slot == kJointLowerSlot) {
      report.limit += size;
    } else if (row.slot == kJointUpperSlot) {
      report.limit -= size;
    } else if (row.slot == kJointMotorSlot) {
      report.motor += size;
    }
  }
}

void apply_joint_impulses(const Bodies& bodies, const Joints& joints,
                          const std::vector<JointReport>& reports, State& state) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto apply = [&](int body, const Vec3& impulse, const Vec3& angular) {
      if (bodies[body].is_dynamic()) {
        state[body].p += impulse;
        state[body].L += angular;
      }
    };
    apply(joints[i].body_a, reports[i].impulse, reports[i].angular_a);
    apply(joints[i].body_b, -reports[i].impulse, reports[i].angular_b);
  }
}

void measure_joints(const Joints& joints, const State& state, std::vector<JointReport>& reports) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointError error = joint_error(joints[i], state);
    JointReport& report = reports[i];
    report.coordinate = joint_coordinate(joints[i], state);
    const double beyond = beyond_limits(joints[i], report.coordinate);
    const bool turns = joints[i].kind == JointKind::kHinge;
    report.position_error = std::max(error.position.norm(), turns ? 0.0 : beyond);
    report.angle_error = std::max(error.angle.norm(), turns ? beyond : 0.0);
  }
}

}  // namespace signorini
