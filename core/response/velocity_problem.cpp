#include <signorini/core/response/velocity_problem.h>
#include <signorini/lcp/group_scale.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace signorini {
namespace {

/// The rows of some cones with each tangent bounded by itself.
/// @param is_boxed says which, by their normal rows
template <typename Choice>
void make_box(const Choice& is_boxed, ConeProblem& cones) {
  std::erase_if(cones.problem.cones, [&](const lcp::FrictionCone& cone) {
    if (!is_boxed(cone.normal_row)) {
      return false;
    }
    for (const int row : {cone.normal_row + 1, cone.normal_row + 2}) {
      cones.problem.limits.push_back(
          {.row = row, .normal_row = cone.normal_row, .coefficient = cone.coefficient});
    }
    return true;
  });
}

bool is_within(const ConeProblem& cones, const Vec3& z) {
  const double most = cones.friction.front() * z[0];
  const bool box = cones.problem.cones.empty();
  const double tangential = box ? std::max(std::abs(z[1]), std::abs(z[2])) : std::hypot(z[1], z[2]);
  return z[0] >= 0.0 && tangential <= most;
}

}  // namespace

std::string_view to_string(FrictionModel model) {
  switch (model) {
    case FrictionModel::kPyramid: return "pyramid";
    case FrictionModel::kCone: return "cone";
    case FrictionModel::kBox: return "box";
  }
  return "unknown model";
}

void VelocityProblem::assemble(FrictionModel model, const Bodies& bodies, const State& free_state,
                               const ContactSet& contacts, const lcp::VectorRef& allowance,
                               int sides, std::span<const JointRow> joints, BodyColumns columns) {
  contacts_ = static_cast<Eigen::Index>(contacts.size());
  joints_ = static_cast<Eigen::Index>(joints.size());
  turning_rows(bodies, free_state, contacts, turning_);
  if (!turning_.empty()) {
    behind_.clear();
    for (const TurningRow& turning : turning_) {
      behind_.push_back(turning.row);
    }
    behind_.insert(behind_.end(), joints.begin(), joints.end());
    joints = behind_;
  }
  if (model == FrictionModel::kPyramid) {
    PyramidProblem pyramid;
    assemble_pyramid(bodies, free_state, contacts, allowance, sides, pyramid, joints, columns);
    form_ = std::move(pyramid);
    limit_turning();
    return;
  }
  auto* cones = std::get_if<ConeProblem>(&form_);
  if (cones == nullptr) {
    cones = &form_.emplace<ConeProblem>();
  }
  assemble_cones(bodies, free_state, contacts, allowance, *cones, joints, columns);
  if (model == FrictionModel::kBox || !turning_.empty()) {
    make_box([&](int row) { return model == FrictionModel::kBox || has_turning(row, *cones); },
             *cones);
  }
  limit_turning();
}

/// A cone's rows take no part in coupled limits, so the contact of such rows has a box.
bool VelocityProblem::has_turning(int normal_row, const ConeProblem& cones) const {
  return std::ranges::binary_search(turning_, normal_row, {}, [&](const TurningRow& turning) {
    return cones.normal_row[turning.contact];  // ascending
  });
}

void VelocityProblem::limit_turning() {
  const auto* cones = std::get_if<ConeProblem>(&form_);
  lcp::Problem& asked = std::visit([](auto& form) -> lcp::Problem& { return form.problem; }, form_);
  const Eigen::Index first = asked.size() - joints_ - static_cast<Eigen::Index>(turning_.size());
  for (std::size_t k = 0; k < turning_.size(); ++k) {
    const int contact = turning_[k].contact;
    asked.limits.push_back({.row = static_cast<int>(first) + static_cast<int>(k),
                            .normal_row = cones != nullptr ? cones->normal_row[contact] : contact,
                            .coefficient = turning_[k].limit});
  }
}

const lcp::Problem& VelocityProblem::problem() const {
  return std::visit([](const auto& form) -> const lcp::Problem& { return form.problem; }, form_);
}

int VelocityProblem::columns() const {
  return std::visit([](const auto& form) { return form.columns; }, form_);
}

double VelocityProblem::normal_impulse(const lcp::VectorRef& z, std::size_t contact) const {
  const auto* cones = std::get_if<ConeProblem>(&form_);
  return z[cones != nullptr ? cones->normal_row[contact] : static_cast<lcp::Index>(contact)];
}

void VelocityProblem::impulses(const ContactSet& contacts, const lcp::VectorRef& z,
                               std::vector<Vec3>& impulses) const {
  std::visit([&](const auto& form) { contact_impulses(form, contacts, z, impulses); }, form_);
}

void VelocityProblem::moments(const lcp::VectorRef& z, std::vector<Vec3>& moments) const {
  const Eigen::Index rows = static_cast<Eigen::Index>(turning_.size());
  moments.assign(static_cast<std::size_t>(contacts_), Vec3::Zero());
  add_contact_moments(turning_, z.segment(z.size() - joints_ - rows, rows), moments);
}

void VelocityProblem::remember(const ContactSet& contacts, const lcp::VectorRef& z, bool corrected,
                               ContactMemory& memory) const {
  std::visit([&](const auto& form) { memory.add(form, contacts, z, corrected); }, form_);
}

ContactMemory::Recalled VelocityProblem::recall(const ContactSet& contacts,
                                                const ContactMemory& memory, lcp::Vector& z) const {
  return std::visit([&](const auto& form) { return memory.recall(form, contacts, z); }, form_);
}

bool VelocityProblem::closed_form(lcp::Vector& z) const {
  const lcp::Problem& asked = problem();
  if (joints_ > 0 || contacts_ != 1 || !turning_.empty()) {
    return false;
  }
  if (asked.size() == 1) {
    z.setConstant(1, std::max(-asked.q[0] / lcp::diagonal_block(asked.M, 0, 1)(0, 0), 0.0));
    return true;
  }
  const auto* cones = std::get_if<ConeProblem>(&form_);
  if (cones == nullptr) {
    return false;
  }
  if (asked.q[0] >= 0.0) {
    z.setZero(3);
    return true;
  }
  const Vec3 sticking = lcp::diagonal_block(asked.M, 0, 3).llt().solve(-Vec3(asked.q));
  if (!sticking.allFinite() || !is_within(*cones, sticking)) {
    return false;
  }
  z = sticking;
  return true;
}

}  // namespace signorini
