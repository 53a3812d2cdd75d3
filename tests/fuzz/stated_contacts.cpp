#include "stated_contacts.h"

#include "byte_reader.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace signorini::testing {
namespace {

using Real = long double;
using Real3 = Eigen::Matrix<Real, 3, 1>;
using Real33 = Eigen::Matrix<Real, 3, 3>;
using Row = Eigen::Matrix<Real, 6, 1>;  // of one body: linear, angular

constexpr Real kRounding = std::numeric_limits<double>::epsilon();
/// z is made of rounded impulses, q of rounded velocities.
constexpr Real kOfTheFloor = 64.0L;
constexpr Real kMostSides = 256.0L;          // of a pyramid: each may keep the residual
constexpr double kToleratedOverlap = 1e-10;  // m, position_projection.h

Real3 vec3(const double* values) {
  return {values[0], values[1], values[2]};
}

Row row(const double* values) {
  Row six;
  six << vec3(values), vec3(values + 3);
  return six;
}

bool is_ordinary(const double* values, int count) {
  return std::all_of(values, values + count, [](double value) {
    return value == 0.0 || (std::abs(value) > 1e-50 && std::abs(value) < 1e50);
  });
}

bool is_ordinary(const signorini_body& body) {
  return is_ordinary(&body.mass, 1) && is_ordinary(body.inertia, 9) &&
         is_ordinary(body.position, 3) && is_ordinary(body.linear_velocity, 3) &&
         is_ordinary(body.angular_velocity, 3);
}

bool is_ordinary(const signorini_contact& contact) {
  return is_ordinary(contact.point_a, 3) && is_ordinary(contact.point_b, 3) &&
         is_ordinary(&contact.gap, 1) && is_ordinary(&contact.friction, 1) &&
         (std::isnan(contact.allowance) || is_ordinary(&contact.allowance, 1));
}

Row velocity(const signorini_body& body) {
  Row v;
  v << vec3(body.linear_velocity), vec3(body.angular_velocity);
  return v;
}

/// M^-1 of a body times a row, and what rounding is measured by: turning into body axes and back
/// mixes the angular parts, and the inertia's condition (`lost`) multiplies what that loses.
struct Mobility {
  Real inverse_mass = 0.0L;
  Real33 inverse_inertia = Real33::Zero();
  Real lost = 1.0L;

  explicit Mobility(const signorini_body& body) {
    if (body.kind != SIGNORINI_DYNAMIC) {
      return;
    }
    inverse_mass = 1.0L / body.mass;
    const double* o = body.orientation;
    const Real33 R = Eigen::Quaternion<Real>(o[0], o[1], o[2], o[3]).toRotationMatrix();
    const Real33 J = Eigen::Map<const Eigen::Matrix3d>(body.inertia).cast<Real>();
    inverse_inertia = R * J.inverse() * R.transpose();
    lost = J.norm() * inverse_inertia.norm();
  }
  [[nodiscard]] Row times(const Row& x) const {
    Row y;
    y << inverse_mass * x.head<3>(), inverse_inertia * x.tail<3>();
    return y;
  }
  [[nodiscard]] Row times_absolute(const Row& x) const {
    Row y;
    y << inverse_mass * x.head<3>().cwiseAbs(),
        Real3::Constant(lost * inverse_inertia.norm() * x.tail<3>().norm());
    return y;
  }
};

/// r x d without the cancellation: what rounding its terms is measured by.
Real3 cross_size(const Real3& r, const Real3& d) {
  const Real3 a = r.cwiseAbs();
  const Real3 b = d.cwiseAbs();
  return {a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]};
}

/// One row of J: its two bodies' parts.
struct PairRow {
  std::array<int, 2> body{};
  std::array<Row, 2> part{};
  std::array<Row, 2> size{};

  PairRow(const signorini_contact& contact, const std::span<const signorini_body> bodies,
          const Real3& direction, const Real3& point_a, const Real3& point_b)
      : body{contact.body_a, contact.body_b} {
    const Real3 r_a = point_a - vec3(bodies[body[0]].position);
    const Real3 r_b = point_b - vec3(bodies[body[1]].position);
    part[0] << direction, r_a.cross(direction);
    part[1] << -direction, -r_b.cross(direction);
    size[0] << direction.cwiseAbs(), cross_size(r_a, direction);
    size[1] << direction.cwiseAbs(), cross_size(r_b, direction);
  }
};

/// What a host's numbers make of one island.
class Island {
 public:
  Island(const StatedContacts& stated, const std::vector<Mobility>& mobility)
      : stated_(stated), mobility_(mobility) {}

  /// @return false where rounding decides whether it bounces
  bool add(const signorini_contact& contact, const Real3& impulse, Real normal_impulse) {
    const Real3 normal = vec3(contact.normal);
    const PairRow along(contact, stated_.bodies, normal, vec3(contact.point_a),
                        vec3(contact.point_b));
    const auto [d_dot, d_dot_size] = speed(along);
    Real allowance = contact.allowance;
    if (std::isnan(contact.allowance)) {
      if (std::abs(d_dot + stated_.restitution_threshold) <= 64.0L * kRounding * d_dot_size) {
        return false;
      }
      const bool bounces = contact.gap <= stated_.touching_tolerance &&
                           d_dot < -static_cast<Real>(stated_.restitution_threshold);
      const Real closable = contact.gap > kToleratedOverlap ? contact.gap : 0.0;
      allowance = bounces ? contact.restitution * d_dot : closable / stated_.step;
    }
    add_row(along, normal_impulse, d_dot + allowance, d_dot_size + std::abs(allowance));
    normal_rows_.push_back(static_cast<int>(rows_.size()) - 1);
    judge_impulse(contact, normal, impulse, normal_impulse);
    if (contact.friction > 0.0) {
      add_friction(contact, normal, impulse);
    }
    return true;
  }

  void judge(PlainProblem::Claim claim) const {
    const std::vector<int> kept =
        stated_.friction_model == SIGNORINI_CONE ? all_rows() : normal_rows_;
    PlainProblem problem(static_cast<int>(kept.size()));
    std::vector<double> z;
    for (const int i : kept) {
      const auto at = z.size();
      z.push_back(static_cast<double>(z_[i]));
      problem.q[at] = q_[i];
      problem.q_size[at] = q_size_[i];
      for (std::size_t j = 0; j < rows_.size(); ++j) {
        const auto [value, size] = product(rows_[i], rows_[j]);
        const auto there = std::ranges::find(kept, static_cast<int>(j));
        if (there == kept.end()) {
          problem.q[at] += value * z_[j];
          problem.q_size[at] += size * std::abs(z_[j]);
        } else {
          const auto to = static_cast<std::size_t>(there - kept.begin());
          problem.M[at * kept.size() + to] = value;
          problem.size[at * kept.size() + to] = size;
        }
      }
    }
    for (const Real q : q_) {
      problem.least_q = std::max(problem.least_q, std::abs(q));
    }
    if (stated_.friction_model == SIGNORINI_CONE) {
      problem.cones = cones_;
    }
    if (!std::isnan(stated_.residual)) {
      const Real wanted = problem.least_q > 0.0L ? stated_.residual / problem.least_q : 1.0L;
      claim.tolerance = std::clamp(wanted, 1e-20L, 0.1L);
    }
    claim.of_the_floor = kOfTheFloor;
    problem.judge(z.data(), claim);
    if (claim.is_solved || claim.is_to_rounding) {
      const Real tolerance = claim.is_to_rounding ? 1e-5L : claim.tolerance;
      require(friction_excess_ <= kMostSides * tolerance * (1.0L + problem.least_q),
              "friction keeps to its bound");
    }
  }

 private:
  struct Sum {
    Real value = 0.0L, size = 0.0L;
  };
  /// Its normal part is what it is said to be, and notes by how much friction exceeds its bound.
  void judge_impulse(const signorini_contact& contact, const Real3& normal, const Real3& impulse,
                     Real normal_impulse) {
    const Real along = impulse.dot(normal);
    const Real rounding = kOfTheFloor * kRounding * impulse.norm();
    require(std::abs(along - normal_impulse) <= rounding, "an impulse has its normal part");
    const Real most = stated_.friction_model == SIGNORINI_BOX ? std::sqrt(2.0L) : 1.0L;
    const Real bound = most * contact.friction * std::abs(normal_impulse);
    friction_excess_ = std::max(friction_excess_, (impulse - along * normal).norm() - bound -
                                                      (1.0L + contact.friction) * rounding);
  }
  [[nodiscard]] std::vector<int> all_rows() const {
    std::vector<int> all(rows_.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      all[k] = static_cast<int>(k);
    }
    return all;
  }
  /// J v of one row.
  [[nodiscard]] Sum speed(const PairRow& row) const {
    Sum sum;
    for (int side = 0; side < 2; ++side) {
      const Row v = velocity(stated_.bodies[row.body[side]]);
      sum.value += row.part[side].dot(v);
      sum.size +=
          row.size[side].head<3>().dot(v.head<3>().cwiseAbs()) +
          mobility_[row.body[side]].lost * row.size[side].tail<3>().norm() * v.tail<3>().norm();
    }
    return sum;
  }
  /// J_i M^-1 J_j^T.
  [[nodiscard]] Sum product(const PairRow& one, const PairRow& other) const {
    Sum sum;
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) {
        if (one.body[a] == other.body[b]) {
          const Mobility& mobility = mobility_[one.body[a]];
          sum.value += one.part[a].dot(mobility.times(other.part[b]));
          sum.size += one.size[a].dot(mobility.times_absolute(other.size[b]));
        }
      }
    }
    return sum;
  }
  void add_row(const PairRow& row, Real z, Real q, Real q_size) {
    rows_.push_back(row);
    z_.push_back(z);
    q_.push_back(q);
    q_size_.push_back(q_size);
  }
  void add_friction(const signorini_contact& contact, const Real3& normal, const Real3& impulse) {
    const Real3 point = 0.5L * (vec3(contact.point_a) + vec3(contact.point_b));
    const auto across = [&](const Real3& direction) {
      return PairRow(contact, stated_.bodies, direction, point, point);
    };
    Real3 slip;
    for (int k = 0; k < 3; ++k) {
      slip[k] = speed(across(Real3::Unit(k))).value;
    }
    const Real3 unit = normal.normalized();
    Real3 tangential = slip - slip.dot(unit) * unit;
    tangential -= tangential.dot(unit) * unit;  // what cancellation left
    const bool slips = tangential.norm() > 1e-9L * slip.norm();
    const Real3 first = slips ? Real3(tangential.normalized()) : unit.unitOrthogonal();
    for (const Real3& direction : {first, Real3(unit.cross(first))}) {
      const PairRow row = across(direction);
      const auto [value, size] = speed(row);
      add_row(row, impulse.dot(direction), value, size);
    }
    cones_.push_back({.normal_row = static_cast<int>(rows_.size()) - 3,
                      .dimension = 3,
                      .coefficient = contact.friction});
  }

  const StatedContacts& stated_;
  const std::vector<Mobility>& mobility_;
  std::vector<PairRow> rows_;
  std::vector<Real> z_, q_, q_size_;
  std::vector<int> normal_rows_;
  std::vector<PlainProblem::Cone> cones_;
  Real friction_excess_ = 0.0L;
};

/// v+ = v + M^-1 J^T of the impulses.
void judge_velocities(const StatedContacts& stated, const std::vector<Mobility>& mobility,
                      const double* impulses, const double* velocities) {
  for (std::size_t k = 0; k < stated.bodies.size(); ++k) {
    Row change = Row::Zero();
    Row size = velocity(stated.bodies[k]).cwiseAbs();
    for (std::size_t i = 0; i < stated.contacts.size(); ++i) {
      const signorini_contact& contact = stated.contacts[i];
      const Real3 impulse = vec3(impulses + 3 * i);
      for (const auto& [body, sign] : {std::pair{contact.body_a, 1.0L}, {contact.body_b, -1.0L}}) {
        if (body == static_cast<int>(k)) {
          const Real3 point = 0.5L * (vec3(contact.point_a) + vec3(contact.point_b));
          const Real3 r = point - vec3(stated.bodies[k].position);
          Row pushed;
          Row pushed_size;
          pushed << impulse, r.cross(impulse);
          pushed_size << impulse.cwiseAbs(), cross_size(r, impulse);
          change += sign * mobility[k].times(pushed);
          size += mobility[k].times_absolute(pushed_size);
        }
      }
    }
    const Row off = row(velocities + 6 * k) - velocity(stated.bodies[k]) - change;
    require((off.array().abs() <= kOfTheFloor * mobility[k].lost * kRounding * size.norm()).all(),
            "the velocities are those that the impulses give");
  }
}

}  // namespace

void StatedContacts::judge(const signorini_contact_result* result) const {
  const auto ordinary = [](const auto& one) { return is_ordinary(one); };
  if (!std::ranges::all_of(bodies, ordinary) || !std::ranges::all_of(contacts, ordinary) ||
      !is_ordinary(&step, 1)) {
    return;
  }
  const double* impulses = signorini_contact_result_impulses(result);
  const double* normal_impulses = signorini_contact_result_normal_impulses(result);
  const std::vector<Mobility> mobility(bodies.begin(), bodies.end());
  judge_velocities(*this, mobility, impulses, signorini_contact_result_velocities(result));
  const std::int32_t* island_of = signorini_contact_result_island_of_contact(result);
  for (std::int64_t number = 0; number < signorini_contact_result_island_count(result); ++number) {
    signorini_island told{};
    require(signorini_contact_result_island(result, number, &told, sizeof told) == SIGNORINI_OK,
            "every island has a report");
    Island island(*this, mobility);
    bool is_clear = true;
    for (std::size_t i = 0; i < contacts.size() && is_clear; ++i) {
      if (island_of[i] == number) {
        is_clear = island.add(contacts[i], vec3(impulses + 3 * i), normal_impulses[i]);
      }
    }
    if (is_clear) {
      island.judge({.natural_residual = std::numeric_limits<double>::infinity(),
                    .unit_free_residual = friction_model == SIGNORINI_CONE
                                              ? told.unit_free_residual
                                              : std::numeric_limits<double>::infinity(),
                    .is_solved = told.status == SIGNORINI_SOLVED,
                    .is_to_rounding = told.status == SIGNORINI_SOLVED_TO_ROUNDING,
                    .tolerance = tolerance});
    }
  }
}

}  // namespace signorini::testing
