#include <signorini/core/response/velocity_problem.h>

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

bool is_within(const ConeProblem& cones, const lcp::Vector& z) {
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
                               int sides, std::span<const JointRow> joints) {
  contacts_ = static_cast<Eigen::Index>(contacts.size());
  joints_ = static_cast<Eigen::Index>(joints.size());
  turning_rows(bodies, free_state, contacts, turning_);
  std::vector<JointRow> behind;
  if (!turning_.empty()) {
    for (const TurningRow& turning : turning_) {
      behind.push_back(turning.row);
    }
    behind.insert(behind.end(), joints.begin(), joints.end());
    joints = behind;
  }
  if (model == FrictionModel::kPyramid) {
    PyramidProblem pyramid;
    assemble_pyramid(bodies, free_state, contacts, allowance, sides, pyramid, joints);
    form_ = std::move(pyramid);
    limit_turning();
    return;
  }
  ConeProblem cones;
  if (auto* used = std::get_if<ConeProblem>(&form_)) {
    cones = std::move(*used);
  }
  assemble_cones(bodies, free_state, contacts, allowance, cones, joints);
  if (model == FrictionModel::kBox || !turning_.empty()) {
    make_box([&](int row) { return model == FrictionModel::kBox || has_turning(row, cones); },
             cones);
  }
  form_ = std::move(cones);
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

lcp::Vector VelocityProblem::normal_impulses(const lcp::VectorRef& z) const {
  const auto* cones = std::get_if<ConeProblem>(&form_);
  return cones != nullptr ? signorini::normal_impulses(*cones, z) : lcp::Vector(z.head(contacts_));
}

std::vector<Vec3> VelocityProblem::impulses(const ContactSet& contacts,
                                            const lcp::VectorRef& z) const {
  return std::visit([&](const auto& form) { return contact_impulses(form, contacts, z); }, form_);
}

std::vector<Vec3> VelocityProblem::moments(const lcp::VectorRef& z) const {
  const Eigen::Index rows = static_cast<Eigen::Index>(turning_.size());
  return contact_moments(turning_, static_cast<std::size_t>(contacts_),
                         z.segment(z.size() - joints_ - rows, rows));
}

void VelocityProblem::remember(const ContactSet& contacts, const lcp::VectorRef& z,
                               ContactMemory& memory) const {
  std::visit([&](const auto& form) { memory.add(form, contacts, z); }, form_);
}

int VelocityProblem::recall(const ContactSet& contacts, const ContactMemory& memory,
                            lcp::Vector& z) const {
  return std::visit([&](const auto& form) { return memory.recall(form, contacts, z); }, form_);
}

lcp::Vector VelocityProblem::closed_form() const {
  const lcp::Problem& asked = problem();
  if (joints_ > 0 || !turning_.empty()) {
    return {};
  }
  if (contacts_ == 1 && asked.size() == 1) {
    lcp::Vector A;
    lcp::diagonal(asked.M, A);
    return (-asked.q.array() / A.array()).max(0.0);
  }
  const auto* cones = std::get_if<ConeProblem>(&form_);
  if (cones == nullptr || contacts_ != 1) {
    return {};
  }
  if (asked.q[0] >= 0.0) {
    return lcp::Vector::Zero(3);
  }
  const Mat3 A = lcp::to_dense(asked.M);
  const lcp::Vector z = A.llt().solve(-asked.q);
  return z.allFinite() && is_within(*cones, z) ? z : lcp::Vector();
}

}  // namespace signorini
