#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>
#include <signorini/core/model/joint.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/joint_rows.h>
#include <signorini/core/response/joint_stiffness.h>
#include <signorini/lcp/solver.h>
#include <signorini/lcp/status.h>

#include <string>
#include <vector>

namespace signorini {

/// What a position projection did.
struct ProjectionReport {
  /// Of the last displacement LCP. Not solved: nothing was moved after pass `passes`. kNotRun:
  /// there was nothing to do.
  lcp::Status status = lcp::Status::kNotRun;
  /// Mechanical energy gained: m g times the heights, plus the change of kinetic energy that comes
  /// from turning J with L fixed. J.
  double energy_change = 0.0;
  double largest_displacement = 0.0;  ///< of a centre of mass, m
  int passes = 0;                     ///< problems solved
  std::string detail;  ///< why it failed, or that joints are still off, one line; else empty
};

/// Overlaps up to this are left alone, m.
inline constexpr double kToleratedOverlap = 1e-10;

/// The gap that a contact may close in a step, m: none where it is as near to touching as an
/// overlap that is left alone. A face of which one corner is 1e-12 m off would else rest on the
/// others.
[[nodiscard]] inline double closable_gap(double gap) {
  return gap > kToleratedOverlap ? gap : 0.0;
}

/// Joints that hold to this are left alone, and passes end there; m or rad.
inline constexpr double kToleratedJointError = 1e-10;

/// Of a projection with joints, at most; each squares a joint's error once that is small.
inline constexpr int kProjectionPasses = 20;

/// Compliance of joint rows in a projection, in units of their A_ii: rows that depend on each other
/// (closed loops) contradict each other by the second order of their errors, and are then met in
/// the sense of least squares. A pass leaves this part of an error where none depends on another.
inline constexpr double kProjectionCompliance = 1e-12;

/// Moves bodies out of overlap by the smallest displacement in the metric of the masses:
///
///     min 1/2 D^T M D   s.t.   gap + J D >= 0,   i.e.   D = M^-1 J^T l,  0 <= l ⊥ A l + gap >= 0,
///
/// D = (dx, dtheta) of every body, J the normal rows (assembly.h), one linear step: what the
/// curvature leaves is of second order in D and is seen by the next call. Gaps > 0 among the
/// contacts are kept from closing further than to zero. Only x and q change: p and L (world axes)
/// are the same bits, so no velocity of translation is added and both momenta are conserved; w =
/// J^-1 L follows the new orientation. Bodies that contacts and joints link, though not over fixed
/// or driven ones, are left alone where no contact is deeper than kToleratedOverlap and no joint
/// farther off than kToleratedJointError: D is 0 there.
///
/// With joints: also C + J D = 0 for their equalities and C + J D >= 0 for their limits
/// (joint_rows.h), softened by kProjectionCompliance; while a joint is off, again from where the
/// bodies are then (gaps: N.(P_A - P_B) of the points carried along), up to kProjectionPasses. A
/// pass makes half, a quarter .. of D where all of it brings no joint closer, D then in the metric
/// of joint_stiffness.h for the forces l.
///
/// Keeps its memory: allocates nothing once no count exceeds an earlier one.
class PositionProjection {
 public:
  /// @param gravity for energy_change, m/s^2
  /// @param solver takes a factored symmetric LCP, with free rows if there are joints; l in kg m
  /// @param metric the bodies whose masses measure D, if others than `bodies`
  /// @throws std::invalid_argument as start_rows() and Solver::solve(); state is then unchanged
  void project(const Bodies& bodies, const ContactSet& contacts, const Vec3& gravity,
               lcp::Solver& solver, State& state, ProjectionReport& report,
               const Joints& joints = {}, const Bodies* metric = nullptr);

 private:
  struct Scene {
    const Bodies& bodies;
    const Joints& joints;
    lcp::Solver& solver;
  };
  void select(const Bodies& bodies, const ContactSet& contacts, const Joints& joints);
  void run(const Scene& scene, const Bodies& metric, State& state, ProjectionReport& report);
  bool solve(const Scene& scene, const Bodies& metric, const State& state,
             ProjectionReport& report);
  void assemble(const Bodies& metric, const State& state);
  void measure(const Joints& joints, const State& state);
  void choose_length(const Scene& scene, const State& state);
  void displace(double length, const State& state, State& moved) const;

  LinkedSets sets_;
  std::vector<char> set_is_off_;
  std::vector<char> joint_is_off_;  // or linked to what is
  ContactSet contacts_;             // of the sets that are off, carried along
  std::vector<JointRow> joined_;    // of joint_is_off_
  double error_ = 0.0;              // of joined_
  double length_ = 1.0;             // the part of D that is made
  State start_, moved_;
  BodyPairs pairs_;
  NormalRows rows_;
  lcp::Problem problem_;
  lcp::Result result_;
  lcp::Vector push_, displacement_;
  std::vector<JointReport> pushes_;
  std::vector<JointLoad> loads_;
  Bodies stiff_;
};

}  // namespace signorini
