#include <signorini/core/response/velocity_problem.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace signorini {
namespace {

/// The cones' rows with each tangent bounded by itself.
void make_box(ConeProblem& cones) {
  for (const lcp::FrictionCone& cone : cones.problem.cones) {
    for (const int row : {cone.normal_row + 1, cone.normal_row + 2}) {
      cones.problem.limits.push_back(
          {.row = row, .normal_row = cone.normal_row, .coefficient = cone.coefficient});
    }
  }
  cones.problem.cones.clear();
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
  if (model == FrictionModel::kPyramid) {
    PyramidProblem pyramid;
    assemble_pyramid(bodies, free_state, contacts, allowance, sides, pyramid, joints);
    form_ = std::move(pyramid);
    return;
  }
  ConeProblem cones;
  if (auto* used = std::get_if<ConeProblem>(&form_)) {
    cones = std::move(*used);
  }
  assemble_cones(bodies, free_state, contacts, allowance, cones, joints);
  if (model == FrictionModel::kBox) {
    make_box(cones);
  }
  form_ = std::move(cones);
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
  if (joints_ > 0) {
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
