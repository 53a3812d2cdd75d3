#include <signorini/lcp/frictionless.h>

#include <string>
#include <variant>

namespace signorini::lcp {
namespace {

void copy_rows(const FactoredMatrix& A, const std::vector<Index>& rows, MatrixForm& part) {
  if (!std::holds_alternative<FactoredMatrix>(part)) {
    part = FactoredMatrix();
  }
  auto& copy = std::get<FactoredMatrix>(part);
  copy.clear();
  copy.mass = A.mass;
  for (const Index i : rows) {
    copy.add_row(A.compliance(static_cast<int>(i)));
    for (const FactoredMatrix::Entry& entry : A.entries(static_cast<int>(i))) {
      copy.add_entry(entry.block,
                     Eigen::Map<const Vector>(A.values(entry), A.mass.dimension(entry.block)));
    }
  }
}

void copy_rows(const Matrix& M, const std::vector<Index>& rows, MatrixForm& part) {
  if (!std::holds_alternative<Matrix>(part)) {
    part = Matrix();
  }
  std::get<Matrix>(part) = M(rows, rows);
}

void copy_rows(const SparseMatrix& M, const std::vector<Index>& rows, MatrixForm& part) {
  SparseMatrix select(M.rows(), static_cast<Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    select.insert(rows[k], static_cast<Index>(k)) = 1.0;
  }
  part = SparseMatrix(select.transpose() * M * select);
}

void take(const Vector& whole, const std::vector<Index>& rows, Vector& part) {
  part.resize(static_cast<Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    part[static_cast<Index>(k)] = whole[rows[k]];
  }
}

/// 0 on the other rows.
void put(const Vector& part, const std::vector<Index>& rows, Index n, Vector& whole) {
  whole.setZero(n);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    whole[rows[k]] = part[static_cast<Index>(k)];
  }
}

StructuredLemkeSettings settings_of_part(const SolverSettings& settings) {
  settings.validate();
  StructuredLemkeSettings own;
  static_cast<SolverSettings&>(own) = settings;
  own.recorder = nullptr;  // told of the whole problem
  own.certify_islands = false;
  return own;
}

}  // namespace

Frictionless::Frictionless(const FrictionlessSettings& settings)
    : settings_(settings), lemke_(settings_of_part(settings)) {}

std::string Frictionless::refuses(const Problem& problem) const {
  if (!problem.is_unilateral()) {
    return "takes 0 <= z_i, w_i >= 0 and friction cones only";
  }
  const std::string asymmetry = SymmetricLcp::find_asymmetry(problem);
  return asymmetry.empty() ? "" : "takes a symmetric M; " + asymmetry;
}

void Frictionless::leave_friction_out(const Problem& problem) {
  rows_.clear();
  Index next = 0;
  for (const FrictionCone& cone : problem.cones) {
    for (; next <= cone.normal_row; ++next) {
      rows_.push_back(next);
    }
    next = Index{cone.normal_row} + cone.dimension;
  }
  for (; next < problem.size(); ++next) {
    rows_.push_back(next);
  }
  std::visit([this](const auto& M) { copy_rows(M, rows_, part_.M); }, problem.M);
  take(problem.q, rows_, part_.q);
}

Status Frictionless::iterate(const Problem& problem, const Vector* warm_start,
                             const Deadline& deadline, Result& result) {
  leave_friction_out(problem);
  if (warm_start != nullptr) {
    take(*warm_start, rows_, start_);
  }
  lemke_.solve_within(deadline.left_seconds(), part_, answer_,
                      warm_start != nullptr ? &start_ : nullptr);
  put(answer_.z, rows_, problem.size(), result.z);
  if (answer_.ray.size() > 0) {
    put(answer_.ray, rows_, problem.size(), result.ray);
  }
  result.detail = answer_.detail;
  result.statistics = answer_.statistics;
  if (is_solved(answer_.status)) {
    result.detail = "solved without friction";
    return Status::kStalled;
  }
  return answer_.status;
}

}  // namespace signorini::lcp
