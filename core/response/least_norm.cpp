#include <signorini/core/response/least_norm.h>

#include <Eigen/QR>

namespace signorini {
namespace {

/// Contact points and normals are good to some roundings of their size; what is dependent to less
/// than this is dependent.
constexpr double kRankThreshold = 1e-12;

lcp::Matrix dense_rows(const NormalRows& rows, const std::vector<int>& chosen) {
  lcp::Matrix J = lcp::Matrix::Zero(chosen.size(), rows.A.degrees_of_freedom());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    for (const lcp::FactoredMatrix::Entry& entry : rows.A.entries(chosen[i])) {
      const int size = rows.A.mass.dimension(entry.block);
      J.row(i).segment(rows.A.mass.offset(entry.block), size) =
          Eigen::Map<const Eigen::RowVectorXd>(rows.A.values(entry), size);
    }
  }
  return J;
}

/// An orthonormal basis of {y : J^T y = 0}, one column a dimension.
lcp::Matrix null_space_of_transpose(const lcp::Matrix& J) {
  Eigen::ColPivHouseholderQR<lcp::Matrix> qr(J.rows(), J.cols());
  qr.setThreshold(kRankThreshold);
  qr.compute(J);
  const lcp::Matrix Q = qr.householderQ() * lcp::Matrix::Identity(J.rows(), J.rows());
  return Q.rightCols(J.rows() - qr.rank());
}

}  // namespace

LeastNorm least_norm(const NormalRows& rows, const lcp::VectorRef& g,
                     const std::vector<bool>& active, lcp::Solver& solver) {
  std::vector<int> chosen;
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (active[i]) {
      chosen.push_back(static_cast<int>(i));
    }
  }
  LeastNorm answer{0, lcp::Status::kSolved, g};
  if (chosen.empty()) {
    return answer;
  }
  const lcp::Matrix Z = null_space_of_transpose(dense_rows(rows, chosen));
  answer.redundancy = static_cast<int>(Z.cols());
  if (answer.redundancy == 0) {
    return answer;
  }
  const lcp::Vector given = answer.forces(chosen);
  lcp::Vector least = given - Z * (Z.transpose() * given);
  if (least.minCoeff() < 0.0) {
    lcp::Problem problem;
    problem.M = lcp::Matrix(Z * Z.transpose());
    problem.q = least;
    lcp::Result result;
    solver.solve(problem, result);
    answer.status = result.status;
    if (!lcp::is_solved(result.status)) {
      return answer;
    }
    // g_i = 0 where alpha_i > 0, and where rounding alone makes it negative.
    least = (result.z.array() > 0.0).select(0.0, result.w.cwiseMax(0.0));
  }
  answer.forces(chosen) = least;
  return answer;
}

}  // namespace signorini
