#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace signorini::lcp {

using Vector = Eigen::VectorXd;
using VectorRef = Eigen::Ref<const Vector>;
using Matrix = Eigen::MatrixXd;  ///< dense, column-major
using MatrixRef = Eigen::Ref<const Matrix>;
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using Index = Eigen::Index;

}  // namespace signorini::lcp
