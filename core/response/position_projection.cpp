#include <signorini/core/model/number_text.h>
#include <signorini/core/response/position_projection.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace signorini {
namespace {

bool is_overlap(const Contact& contact) {
  return contact.gap < -kToleratedOverlap;
}

bool any_overlap(const ContactSet& contacts) {
  return std::any_of(contacts.begin(), contacts.end(), is_overlap);
}

/// What an equality or a limit is off by, m or rad.
double error_of(const JointRow& row) {
  const bool is_equality = std::isinf(row.lower);
  return is_equality ? std::abs(row.error) : -row.error;
}

/// The largest of that.
double worst_error(const std::vector<JointRow>& rows) {
  double worst = 0.0;
  for (const JointRow& row : rows) {
    worst = std::max(worst, error_of(row));
  }
  return worst;
}

/// A shorter part of a displacement is not tried.
constexpr double kShortestProjectionStep = 1e-3;

// x += dx, q <- exp(dtheta) q.
void displace_body(const Vec3& dx, const Vec3& dtheta, BodyState& state) {
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

double energy(const Bodies& bodies, const State& state, const Vec3& gravity) {
  return kinetic_energy(bodies, state) + potential_energy(bodies, state, gravity);
}

}  // namespace

/// The equalities and limits of the joints that are looked at, and what they are off by.
void PositionProjection::measure(const Joints& joints, const State& state) {
  joint_rows(joints, state, 1.0, joined_);
  std::erase_if(joined_, [this](const JointRow& row) {
    return row.slot == kJointMotorSlot || joint_is_off_[row.joint] == 0;
  });
  error_ = worst_error(joined_);
}

/// Keeps the contacts and joints of the sets of linked bodies in which something is off; joined_
/// has the rows of all joints.
void PositionProjection::select(const Bodies& bodies, const ContactSet& contacts,
                                const Joints& joints) {
  pairs_.clear();
  add_body_pairs(contacts, pairs_);
  for (const Joint& joint : joints) {
    pairs_.push_back({joint.body_a, joint.body_b});
  }
  const std::vector<int>& set_of_link = sets_.find(bodies, pairs_);
  const int* set_of_joint = set_of_link.data() + contacts.size();
  set_is_off_.assign(pairs_.size(), 0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (is_overlap(contacts[i])) {
      set_is_off_[set_of_link[i]] = 1;
    }
  }
  for (const JointRow& row : joined_) {
    if (error_of(row) > kToleratedJointError) {
      set_is_off_[set_of_joint[row.joint]] = 1;
    }
  }
  contacts_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (set_is_off_[set_of_link[i]] != 0) {
      contacts_.push_back(contacts[i]);
    }
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    joint_is_off_[j] = set_is_off_[set_of_joint[j]];
  }
  std::erase_if(joined_, [this](const JointRow& row) { return joint_is_off_[row.joint] == 0; });
}

/// C + J D + c l over the contacts and the joints' rows, with their bounds.
void PositionProjection::assemble(const Bodies& metric, const State& state) {
  if (auto* used = std::get_if<lcp::FactoredMatrix>(&problem_.M)) {
    rows_.A = std::move(*used);
  }
  pairs_.clear();
  add_body_pairs(joined_, pairs_);
  start_rows(metric, state, contacts_, rows_, pairs_);
  problem_.q.resize(static_cast<lcp::Index>(contacts_.size() + joined_.size()));
  lcp::Index row = 0;
  for (const Contact& contact : contacts_) {
    add_row(state, contact, contact.normal, contact.point_a, contact.point_b, rows_);
    problem_.q[row++] = contact.gap;
  }
  for (const JointRow& joint : joined_) {
    problem_.q[row++] = joint.error;
  }
  set_joint_bounds(joined_, problem_);
  add_joint_rows(joined_, rows_, kProjectionCompliance);
  problem_.M = std::move(rows_.A);
}

/// What `length` of D makes of the state.
void PositionProjection::displace(double length, const State& state, State& moved) const {
  moved = state;
  const auto& A = std::get<lcp::FactoredMatrix>(problem_.M);
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (rows_.block_of_body[k] >= 0) {
      const int offset = A.mass.offset(rows_.block_of_body[k]);
      displace_body(length * displacement_.segment<3>(offset),
                    length * displacement_.segment<3>(offset + 3), moved[k]);
    }
  }
}

/// The largest of D, D/2, D/4 .. that brings the joints closer by a quarter of what it promises; D
/// without joints. Leaves joined_ as it is there.
void PositionProjection::choose_length(const Scene& scene, const State& state) {
  const double error = error_;
  length_ = 1.0;
  const auto closer = [&] {
    displace(length_, state, moved_);
    measure(scene.joints, moved_);
    return error_ <= (1.0 - 0.25 * length_) * error;
  };
  while (error > kToleratedJointError && length_ > kShortestProjectionStep && !closer()) {
    length_ *= 0.5;
  }
  error_ = error;
}

/// Fills l (of result_), D and how much of it to make.
bool PositionProjection::solve(const Scene& scene, const Bodies& metric, const State& state,
                               ProjectionReport& report) {
  assemble(metric, state);
  scene.solver.solve(problem_, result_);
  report.status = result_.status;
  if (!lcp::is_solved(result_.status)) {
    report.detail =
        "position projection: " + std::string(lcp::to_string(result_.status)) +
        (result_.detail.empty() ? "" : " (" + result_.detail + ")") +
        (report.passes == 0 ? ", overlaps left as they are"
                            : ", overlaps left as pass " + std::to_string(report.passes) + " did");
    return false;
  }
  const auto& A = std::get<lcp::FactoredMatrix>(problem_.M);
  push_.resize(A.degrees_of_freedom());
  displacement_.resize(A.degrees_of_freedom());
  A.transpose_times(result_.z.data(), push_.data());
  A.apply_inverse_mass(push_.data(), displacement_.data());
  choose_length(scene, state);
  return true;
}

void PositionProjection::run(const Scene& scene, const Bodies& metric, State& state,
                             ProjectionReport& report) {
  const Bodies* measured_by = &metric;
  do {
    if (!solve(scene, *measured_by, state, report)) {
      return;
    }
    if (length_ < 1.0) {  // in the metric with the stiffness of the joints that push with l
      measure(scene.joints, state);
      pushes_.assign(scene.joints.size(), {});
      const lcp::Index rows = static_cast<lcp::Index>(joined_.size());
      add_joint_impulses(scene.joints, state, joined_, result_.z.tail(rows), pushes_);
      stiff_ = scene.bodies;
      (void)stiffen(scene.bodies, state, scene.joints, pushes_, 1.0, loads_, stiff_);
      measured_by = &stiff_;
      if (!solve(scene, *measured_by, state, report)) {
        return;
      }
    }
    displace(length_, state, moved_);
    carry(state, moved_, contacts_);
    std::swap(state, moved_);
    ++report.passes;
    measure(scene.joints, state);
  } while ((error_ > kToleratedJointError || length_ < 1.0) && report.passes < kProjectionPasses);
  if (error_ > kToleratedJointError) {
    report.detail = "position projection: joints off by up to " + number_text(error_) +
                    " m or rad after " + std::to_string(report.passes) + " passes";
  }
}

void PositionProjection::project(const Bodies& bodies, const ContactSet& contacts,
                                 const Vec3& gravity, lcp::Solver& solver, State& state,
                                 ProjectionReport& report, const Joints& joints,
                                 const Bodies* metric) {
  report = {};
  joint_is_off_.assign(joints.size(), 1);
  measure(joints, state);
  if (!any_overlap(contacts) && !(error_ > kToleratedJointError)) {
    return;
  }
  select(bodies, contacts, joints);
  start_ = state;
  run({bodies, joints, solver}, metric != nullptr ? *metric : bodies, state, report);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    report.largest_displacement =
        std::max(report.largest_displacement, (state[k].x - start_[k].x).norm());
  }
  report.energy_change = energy(bodies, state, gravity) - energy(bodies, start_, gravity);
}

}  // namespace signorini
