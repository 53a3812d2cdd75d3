#include <signorini/lcp/alart_curnier_function.h>
#include <signorini/lcp/best_iterate.h>
#include <signorini/lcp/friction_cone.h>
#include <signorini/lcp/group_scale.h>
#include <signorini/lcp/nsgs.h>
#include <signorini/lcp/sparse_form.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// A contact's own problem is solved to this part of what its z changes by: the next sweep changes
// the others' part of w by more.
constexpr double kInexact = 0.03;
using Group = AlartCurnierFunction::Group;
using Vector3 = Eigen::Vector3d;

}  // namespace

class Nsgs::Workspace {
 public:
  Status solve(const Problem& problem, const NsgsSettings& settings, const Vector* warm_start,
               const Deadline& deadline, Result& result);

 private:
  void set(const Problem& problem);
  void recompute();
  bool sweep(int local_iterations);
  [[nodiscard]] Vector3 velocity_of(const Group& group) const;
  [[nodiscard]] Vector3 local_solution(const Group& group, std::size_t g, const Vector3& z,
                                       const Vector3& rest, int iterations) const;
  void add(const Group& group, const Vector3& change);

  const Problem* problem_ = nullptr;
  const FactoredMatrix* factored_ = nullptr;  // or
  SparseMatrix M_;
  SparseForm sparse_form_;
  AlartCurnierFunction function_;        // for its groups, unscaled
  std::vector<Eigen::Matrix3d> blocks_;  // M_cc of every group
  Vector scale_;                         // 1 / sqrt(D)
  Vector ones_, work_;
  Vector z_;
  Vector w_;                      // M z of a given M
  std::vector<double> impulse_;   // J^T z
  std::vector<double> velocity_;  // W J^T z
  std::vector<double> moved_;     // W_b J_ib^T of the entry at hand
  BestIterate best_;
};

void Nsgs::Workspace::set(const Problem& problem) {
  problem_ = &problem;
  factored_ = std::get_if<FactoredMatrix>(&problem.M);
  if (factored_ == nullptr) {
    sparse_form_.form(problem.M, M_);
  }
  group_scale(problem, scale_, work_);
  ones_.setOnes(problem.size());
  function_.set(problem, ones_, 1.0);
  blocks_.resize(function_.groups().size());
  for (std::size_t g = 0; g < blocks_.size(); ++g) {
    const Group& group = function_.groups()[g];
    blocks_[g] = diagonal_block(problem.M, group.first, group.dimension, work_);
  }
  if (factored_ != nullptr) {
    impulse_.resize(factored_->degrees_of_freedom());
    velocity_.resize(factored_->degrees_of_freedom());
    int widest = 0;
    for (int b = 0; b < factored_->mass.block_count(); ++b) {
      widest = std::max(widest, factored_->mass.dimension(b));
    }
    moved_.resize(widest);
  }
}

/// What is kept of M z, from z.
void Nsgs::Workspace::recompute() {
  if (factored_ == nullptr) {
    w_.noalias() = M_ * z_;
    return;
  }
  factored_->transpose_times(z_.data(), impulse_.data());
  factored_->apply_inverse_mass(impulse_.data(), velocity_.data());
}

/// w of the group's rows.
Vector3 Nsgs::Workspace::velocity_of(const Group& group) const {
  Vector3 w = Vector3::Zero();
  for (int k = 0; k < group.dimension; ++k) {
    const int i = group.first + k;
    w[k] = problem_->q[i];
    if (factored_ == nullptr) {
      w[k] += w_[i];
      continue;
    }
    w[k] += factored_->compliance(i) * z_[i];
    for (const FactoredMatrix::Entry& entry : factored_->entries(i)) {
      const double* row = factored_->values(entry);
      const double* v = velocity_.data() + factored_->mass.offset(entry.block);
      for (int j = 0; j < factored_->mass.dimension(entry.block); ++j) {
        w[k] += row[j] * v[j];
      }
    }
  }
  return w;
}

/// The group's z for w = M_cc z + rest.
Vector3 Nsgs::Workspace::local_solution(const Group& group, std::size_t g, const Vector3& z,
                                        const Vector3& rest, int iterations) const {
  const double weight = scale_[group.first] * scale_[group.first];  // 1 / D
  if (group.dimension == 1) {
    const double w = blocks_[g](0, 0) * z[0] + rest[0];
    return {std::min(std::max(z[0] - weight * w, group.lower), group.upper), 0.0, 0.0};
  }
  Vector3 now = z;
  for (int k = 0; k < iterations; ++k) {
    Vector3 w = blocks_[g] * now + rest;
    if (problem_->friction_law == FrictionLaw::kCoulomb) {
      w[0] += group.mu * tangential_norm(group.dimension, w.data());
    }
    Vector3 next = now - weight * w;
    project_on_cone(group.mu, group.dimension, next.data(), next.data());
    const bool settled =
        (next - now).norm() <= std::max(kEpsilon * next.norm(), kInexact * (next - z).norm());
    now = next;
    if (settled) {
      break;
    }
  }
  return now;
}

void Nsgs::Workspace::add(const Group& group, const Vector3& change) {
  for (int k = 0; k < group.dimension; ++k) {
    const int i = group.first + k;
    z_[i] += change[k];
    if (change[k] == 0.0) {
      continue;
    }
    if (factored_ == nullptr) {
      for (SparseMatrix::InnerIterator it(M_, i); it; ++it) {
        w_[it.row()] += it.value() * change[k];
      }
      continue;
    }
    for (const FactoredMatrix::Entry& entry : factored_->entries(i)) {
      factored_->mass.apply_inverse(entry.block, factored_->values(entry), moved_.data());
      double* v = velocity_.data() + factored_->mass.offset(entry.block);
      for (int j = 0; j < factored_->mass.dimension(entry.block); ++j) {
        v[j] += moved_[j] * change[k];
      }
    }
  }
}

/// @return false if no z changed.
bool Nsgs::Workspace::sweep(int local_iterations) {
  bool changed = false;
  for (std::size_t g = 0; g < blocks_.size(); ++g) {
    const Group& group = function_.groups()[g];
    Vector3 z = Vector3::Zero();
    z.head(group.dimension) = z_.segment(group.first, group.dimension);
    const Vector3 rest = velocity_of(group) - blocks_[g] * z;
    const Vector3 change = local_solution(group, g, z, rest, local_iterations) - z;
    if (!change.isZero(0.0)) {
      changed = true;
      add(group, change);
    }
  }
  return changed;
}

Status Nsgs::Workspace::solve(const Problem& problem, const NsgsSettings& settings,
                              const Vector* warm_start, const Deadline& deadline, Result& result) {
  const int most =
      settings.max_iterations >= 0 ? settings.max_iterations : NsgsSettings::kDefaultSweeps;
  result.statistics = {.iterations = 0};
  int& done = result.statistics.iterations;
  set(problem);
  best_.reset(problem, settings.tolerance);
  z_.setZero(problem.size());
  if (warm_start != nullptr) {
    z_ = *warm_start;
  }
  Status ending = Status::kIterationLimit;
  for (int next_look = 0;;) {
    if (done >= next_look || done == most) {
      best_.offer(z_);
      if (is_solved(judge(best_.certificate(), settings.tolerance, Status::kNotRun))) {
        break;
      }
      if (!z_.allFinite()) {
        ending = Status::kNumericalBreakdown;
        break;
      }
      recompute();
      next_look = done + std::clamp(done, 1, settings.check_period);
    }
    if (done >= most) {
      break;
    }
    if (deadline.passed()) {
      ending = Status::kTimeLimit;
      break;
    }
    ++done;
    if (!sweep(settings.local_iterations)) {
      best_.offer(z_);
      ending = Status::kStalled;
      break;
    }
  }
  result.z = best_.z();
  return ending;
}

void NsgsSettings::validate() const {
  SolverSettings::validate();
  if (check_period < 1) {
    throw std::invalid_argument("settings: check_period: must be >= 1, got " +
                                std::to_string(check_period));
  }
  if (local_iterations < 1) {
    throw std::invalid_argument("settings: local_iterations: must be >= 1, got " +
                                std::to_string(local_iterations));
  }
}

Nsgs::Nsgs(const NsgsSettings& settings)
    : settings_(settings), workspace_(std::make_unique<Workspace>()) {
  settings_.validate();
}

Nsgs::~Nsgs() = default;

std::string Nsgs::refuses(const Problem& problem) const {
  return problem.limits.empty() ? ""
                                : "takes no coupled limits; row " +
                                      std::to_string(problem.limits.front().row) + " has one";
}

Status Nsgs::iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                     Result& result) {
  return workspace_->solve(problem, settings_, warm_start, deadline, result);
}

}  // namespace signorini::lcp
