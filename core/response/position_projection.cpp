#include <signorini/core/model/number_text.h>
#include <signorini/core/response/assembly.h>
#include <signorini/core/response/joint_rows.h>
#include <signorini/core/response/joint_stiffness.h>
#include <signorini/core/response/position_projection.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace signorini {
namespace {

bool any_overlap(const ContactSet& contacts) {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const Contact& contact) { return contact.gap < -kToleratedOverlap; });
}

bool is_equality(const JointRow& row) {
  return std::isinf(row.lower);
}

/// The largest of what equalities and limits are off by, m and rad alike.
double worst_error(const std::vector<JointRow>& rows) {
  double worst = 0.0;
  for (const JointRow& row : rows) {
    worst = std::max(worst, is_equality(row) ? std::abs(row.error) : -row.error);
  }
  return worst;
}

/// Equalities and limits.
std::vector<JointRow> position_rows(const Joints& joints, const State& state) {
  std::vector<JointRow> rows;
  joint_rows(joints, state, 1.0, rows);
  std::erase_if(rows, [](const JointRow& row) { return row.slot == kJointMotorSlot; });
  return rows;
}

/// A shorter part of a displacement is not tried.
constexpr double kShortestProjectionStep = 1e-3;

// x += dx, q <- exp(dtheta) q.
void displace(const Vec3& dx, const Vec3& dtheta, BodyState& state) {
  state.x += dx;
  const double angle = dtheta.norm();
  if (angle > 0.0) {
    state.q = (Quat(Eigen::AngleAxisd(angle, dtheta / angle)) * state.q).normalized();
  }
}

/// The contacts with their points carried along from one state to another.
void carry(const State& from, const State& to, ContactSet& contacts) {
  for (Contact& contact : contacts) {
    for (const auto& [body, point] :
         {std::pair{contact.body_a, &contact.point_a}, {contact.body_b, &contact.point_b}}) {
      *point = to[body].pose() * (from[body].pose().inverse() * *point);
    }
    contact.gap = contact.normal.dot(contact.point_a - contact.point_b);
  }
}

/// C + J D + c l over the contacts and the joints' rows, with their bounds.
void assemble(const Bodies& bodies, const State& state, const ContactSet& contacts,
              const std::vector<JointRow>& joints, NormalRows& rows, lcp::Problem& problem) {
  assemble_normals(bodies, state, contacts, rows, body_pairs(joints));
  problem.q.resize(static_cast<lcp::Index>(contacts.size() + joints.size()));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    problem.q[static_cast<lcp::Index>(i)] = contacts[i].gap;
  }
  if (!joints.empty()) {
    lcp::Vector errors(static_cast<lcp::Index>(joints.size()));
    std::vector<JointRow> unbiased = joints;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      errors[static_cast<lcp::Index>(i)] = joints[i].error;
      unbiased[i].bias = 0.0;
    }
    set_joint_bounds(errors, unbiased, problem);
    add_joint_rows(joints, rows, kProjectionCompliance);
  }
  problem.M = rows.A;
}

/// D = M^-1 J^T l of the bodies, each by its block.
lcp::Vector displacement_of(const NormalRows& rows, const lcp::Vector& l) {
  lcp::Vector push(rows.A.degrees_of_freedom());
  lcp::Vector displacement(rows.A.degrees_of_freedom());
  rows.A.transpose_times(l.data(), push.data());
  rows.A.apply_inverse_mass(push.data(), displacement.data());
  return displacement;
}

State displaced(const State& state, const NormalRows& rows, const lcp::Vector& displacement) {
  State moved = state;
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (rows.block_of_body[k] >= 0) {
      const int offset = rows.A.mass.offset(rows.block_of_body[k]);
      displace(displacement.segment<3>(offset), displacement.segment<3>(offset + 3), moved[k]);
    }
  }
  return moved;
}

/// The largest of D, D/2, D/4 .. that brings the joints closer by a quarter of what it promises; D
/// without joints.
double step_length(const State& state, const Joints& joints, const NormalRows& rows,
                   const lcp::Vector& displacement, double error) {
  double length = 1.0;
  const auto closer = [&] {
    const State moved = displaced(state, rows, length * displacement);
    return worst_error(position_rows(joints, moved)) <= (1.0 - 0.25 * length) * error;
  };
  while (error > kToleratedJointError && length > kShortestProjectionStep && !closer()) {
    length *= 0.5;
  }
  return length;
}

double energy(const Bodies& bodies, const State& state, const Vec3& gravity) {
  return kinetic_energy(bodies, state) + potential_energy(bodies, state, gravity);
}

/// The passes of one projection.
class Projection {
 public:
  Projection(const Bodies& bodies, const Bodies& metric, const ContactSet& contacts,
             const Joints& joints, lcp::Solver& solver, State& state)
      : bodies_(bodies),
        metric_(metric),
        contacts_(contacts),
        joints_(joints),
        solver_(solver),
        state_(state),
        joined_(position_rows(joints, state)),
        error_(worst_error(joined_)) {}

  [[nodiscard]] bool has_work() const {
    return any_overlap(contacts_) || error_ > kToleratedJointError;
  }

  void run(ProjectionReport& report) {
    do {
      if (!solve(report)) {
        return;
      }
      if (length_ < 1.0) {
        stiffen();
        if (!solve(report)) {
          return;
        }
      }
      State moved = displaced(state_, rows_, length_ * displacement_);
      carry(state_, moved, contacts_);
      state_ = std::move(moved);
      ++report.passes;
      joined_ = position_rows(joints_, state_);
      error_ = worst_error(joined_);
    } while ((error_ > kToleratedJointError || length_ < 1.0) && report.passes < kProjectionPasses);
    if (error_ > kToleratedJointError) {
      report.detail = "position projection: joints off by up to " + number_text(error_) +
                      " m or rad after " + std::to_string(report.passes) + " passes";
    }
  }

 private:
  /// Fills rows_, l_, displacement_ and how much of it to make.
  bool solve(ProjectionReport& report) {
    lcp::Problem problem;
    lcp::Result result;
    assemble(metric_, state_, contacts_, joined_, rows_, problem);
    solver_.solve(problem, result);
    report.status = result.status;
    if (!lcp::is_solved(result.status)) {
      report.detail = "position projection: " + std::string(lcp::to_string(result.status)) +
                      (result.detail.empty() ? "" : " (" + result.detail + ")") +
                      (report.passes == 0
                           ? ", overlaps left as they are"
                           : ", overlaps left as pass " + std::to_string(report.passes) + " did");
      return false;
    }
    l_ = std::move(result.z);
    displacement_ = displacement_of(rows_, l_);
    length_ = step_length(state_, joints_, rows_, displacement_, error_);
    return true;
  }

  /// The metric with the stiffness of the joints that push with l.
  void stiffen() {
    std::vector<JointReport> pushes(joints_.size());
    const lcp::Index joint_rows = static_cast<lcp::Index>(joined_.size());
    add_joint_impulses(joints_, state_, joined_, l_.tail(joint_rows), pushes);
    int links = 0;
    metric_ = stiffened(bodies_, state_, joints_, pushes, 1.0, links);
  }

  const Bodies& bodies_;
  Bodies metric_;
  ContactSet contacts_;
  const Joints& joints_;
  lcp::Solver& solver_;
  State& state_;
  std::vector<JointRow> joined_;
  double error_;
  NormalRows rows_;
  lcp::Vector l_, displacement_;
  double length_ = 1.0;
};

}  // namespace

void project_positions(const Bodies& bodies, const ContactSet& contacts, const Vec3& gravity,
                       lcp::Solver& solver, State& state, ProjectionReport& report,
                       const Joints& joints, const Bodies* metric) {
  report = {};
  const State start = state;
  Projection projection(bodies, metric != nullptr ? *metric : bodies, contacts, joints, solver,
                        state);
  if (!projection.has_work()) {
    return;
  }
  projection.run(report);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    report.largest_displacement =
        std::max(report.largest_displacement, (state[k].x - start[k].x).norm());
  }
  report.energy_change = energy(bodies, state, gravity) - energy(bodies, start, gravity);
}

}  // namespace signorini
