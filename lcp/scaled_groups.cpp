#include <signorini/lcp/group_scale.h>
#include <signorini/lcp/scaled_groups.h>

#include <algorithm>

namespace signorini::lcp {

/// Whether a coupled row has limits that follow another coupled row.
bool ScaledGroups::has_chained_limits(const Problem& problem) {
  is_coupled_.assign(problem.size(), 0);
  for (const CoupledLimit& limit : problem.limits) {
    is_coupled_[limit.row] = 1;
  }
  return std::ranges::any_of(problem.limits, [this](const CoupledLimit& limit) {
    return is_coupled_[limit.normal_row] != 0;
  });
}

void ScaledGroups::set(const Problem& problem) {
  in_body_space_ =
      std::holds_alternative<FactoredMatrix>(problem.M) && !has_chained_limits(problem);
  if (in_body_space_) {
    set_bodies(problem);
  } else {
    set_given(problem);
  }
  b_ = s_.cwiseProduct(problem.q);
  t_ = b_.cwiseAbs().maxCoeff();
  t_ = t_ > 0.0 ? t_ : 1.0;
  b_ /= t_;
  function_.set(problem, s_, t_);
  if (in_body_space_) {
    body_system_.set(rows_, function_);
  } else {
    system_.set(W_, function_);
  }
}

void ScaledGroups::set_bodies(const Problem& problem) {
  group_start_.clear();
  for (int i = 0, cone = 0; i < problem.size();) {
    group_start_.push_back(i);
    const bool starts_cone =
        cone < static_cast<int>(problem.cones.size()) && problem.cones[cone].normal_row == i;
    i += starts_cone ? problem.cones[cone++].dimension : 1;
  }
  group_start_.push_back(static_cast<int>(problem.size()));
  rows_.set(std::get<FactoredMatrix>(problem.M), group_start_);
  s_ = rows_.scale().cwiseInverse();
}

void ScaledGroups::set_given(const Problem& problem) {
  group_scale(problem, s_, work_);
  sparse_form_.form(problem.M, W_);
  for (int j = 0; j < W_.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(W_, j); it; ++it) {
      it.valueRef() *= s_[it.row()] * s_[j];
    }
  }
}

void ScaledGroups::multiply(const Vector& x, Vector& u) {
  if (!in_body_space_) {
    u.noalias() = W_ * x;
    return;
  }
  rows_.transpose_times(x, velocity_);
  rows_.times(velocity_, u);
  u += rows_.compliance().cwiseProduct(x);
}

}  // namespace signorini::lcp
