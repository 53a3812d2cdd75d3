#pragma once

#include <signorini/core/model/joint.h>
#include <signorini/core/response/assembly.h>
#include <signorini/lcp/problem.h>

#include <array>
#include <span>
#include <vector>

namespace signorini {

/// Where a joint's rows are kept: up to six equalities, then what acts on its coordinate.
inline constexpr int kJointLowerSlot = 6;
inline constexpr int kJointUpperSlot = 7;
inline constexpr int kJointMotorSlot = 8;
inline constexpr int kJointSlots = 9;

/// One row of a joint: w = J v + bias over v = [v_A, w_A, v_B, w_B],
///
///     J = [l, m_A, -l, -m_B],      w = 0 where lower < z < upper, w >= 0 at lower, w <= 0 at upper
///
/// (lcp/problem.h); z in N s or N m s pushes A along +l. With a = R_B axis, t_1 and t_2 across it,
/// d = P_A - P_B, P = (P_A + P_B)/2, n = d/|d|, r_A = P - x_A, r_B = P - x_B:
///
///     ball, fixed, hinge   C = e.d             l = e   m = r x e          e: the world's axes
///     fixed, slider        C = e.theta         l = 0   m = e
///     hinge                C = t.theta         l = 0   m = t
///     slider               C = t.d             l = t   m = (P_A - x) x t
///     coordinate: hinge    c                   l = 0   m = a
///                 slider   c = a.d             l = a   m = (P_A - x) x a
///                 distance c = |d|             l = n   m = (P_A - x) x n
///
/// theta: JointError::angle. Both bodies feel the force at one point, so that linear and angular
/// momentum are kept whatever the error is; J is C' where C = 0, elsewhere up to first order in C.
///
///     equality   lower = -inf, upper = inf, bias = 0           C' = 0
///     limits     0 <= z ⊥ c' + max(c - lower, 0)/h >= 0,       0 <= z ⊥ -c' + max(upper - c, 0)/h
///     >= 0
///                (equal limits: the equality c' = 0)
///     motor      |z| <= h max_force, bias = -speed             c' = speed where that is enough
struct JointRow {
  int joint = -1;  ///< its number in the joints given
  int slot = 0;
  int body_a = -1;
  int body_b = -1;
  Vec3 linear = Vec3::Zero();     ///< l
  Vec3 angular_a = Vec3::Zero();  ///< m_A, about the centre of mass of A
  Vec3 angular_b = Vec3::Zero();  ///< m_B
  double error = 0.0;             ///< C; of limits c - lower, upper - c; of a motor 0; m or rad
  double bias = 0.0;              ///< m/s or rad/s
  double lower = 0.0;             ///< of z, N s or N m s
  double upper = 0.0;
};

/// The rows of all joints, in their order. Joints with finite limits have their limit rows in every
/// step: a joint that is driven by others can reach any limit in one.
/// @param joints valid, with bodies of `state`. @param step h, s
/// @throws std::invalid_argument where the anchors of a distance coincide: no direction
void joint_rows(const Joints& joints, const State& state, double step, std::vector<JointRow>& rows);

/// Adds the two bodies of every row.
void add_body_pairs(std::span<const JointRow> rows, BodyPairs& pairs);

/// Adds the rows to A, after those that it has; blocks as start_rows() made them.
/// @param relative_compliance of each row, in units of its A_ii, >= 0
void add_joint_rows(std::span<const JointRow> joints, NormalRows& rows,
                    double relative_compliance = 0.0);

/// J v of a row, without bias. @param a, b velocities of its bodies
[[nodiscard]] double joint_velocity(const JointRow& row, const Velocity& a, const Velocity& b);

/// Writes lower and upper of the problem's last rows, which are these; all before are 0 <= z.
/// Without joint rows the problem has no bounds.
void set_joint_bounds(std::span<const JointRow> rows, lcp::Problem& problem);
/// That, and J v + bias into q. @param velocities of the bodies
void set_joint_bounds(const std::vector<Velocity>& velocities, std::span<const JointRow> rows,
                      lcp::Problem& problem);

/// What a joint did in a step, and how well it holds.
struct JointReport {
  Vec3 impulse = Vec3::Zero();    ///< on A at P_A (on B: minus that), world, N s; over h: the force
  Vec3 moment = Vec3::Zero();     ///< on A about P_A, world, N m s; over h: the torque
  Vec3 angular_a = Vec3::Zero();  ///< both on A about its centre of mass
  Vec3 angular_b = Vec3::Zero();  ///< and on B about its own, N m s
  double limit = 0.0;             ///< of the limits, along +c: > 0 the lower one, N s or N m s
  double motor = 0.0;             ///< of the motor, along +c
  double coordinate = 0.0;        ///< c after the step, rad or m
  double position_error = 0.0;    ///< after the step, of the anchors (also past a limit), m
  double angle_error = 0.0;       ///< after the step (also past a limit), rad
};

/// Adds what rows with impulses z did to the reports of their joints.
/// @param state positions of the rows. @param reports one a joint
void add_joint_impulses(const Joints& joints, const State& state, std::span<const JointRow> rows,
                        const lcp::VectorRef& z, std::vector<JointReport>& reports);

/// Gives the impulses to the dynamic bodies.
void apply_joint_impulses(const Bodies& bodies, const Joints& joints,
                          const std::vector<JointReport>& reports, State& state);

/// Fills coordinate and errors.
void measure_joints(const Joints& joints, const State& state, std::vector<JointReport>& reports);

/// What every row carried in the step before, for the warm start; one a joint of the scene.
using JointMemory = std::vector<std::array<double, kJointSlots>>;
void remember_joints(std::span<const JointRow> rows, const lcp::VectorRef& z, JointMemory& memory);
/// Writes the last rows of z, which are these, from the memory, within their bounds.
void recall_joints(std::span<const JointRow> rows, const JointMemory& memory, lcp::Vector& z);

}  // namespace signorini
