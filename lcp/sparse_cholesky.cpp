#include <signorini/lcp/block_cholesky.h>
#include <signorini/lcp/sparse_cholesky.h>

#include <Eigen/SparseCholesky>
#include <array>
#include <stdexcept>
#include <string>

namespace signorini::lcp {

#ifdef SIGNORINI_HAS_CHOLMOD
std::unique_ptr<SparseCholesky> make_cholmod();  // sparse_cholesky_cholmod.cpp
#endif

namespace {

class EigenSimplicial final : public SparseCholesky {
 public:
  [[nodiscard]] std::string_view name() const override { return "eigen"; }
  void analyse(const SparseMatrix& lower) override {
    if (lower.rows() > 0) {
      factor_.analyzePattern(lower);
    }
  }
  [[nodiscard]] bool factor(const SparseMatrix& lower) override {
    if (lower.rows() == 0) {
      return true;
    }
    factor_.factorize(lower);
    return factor_.info() == Eigen::Success && (factor_.vectorD().array() > 0.0).all();
  }
  void solve(Vector& x) override {
    if (x.size() > 0) {
      x = factor_.solve(x).eval();
    }
  }
  [[nodiscard]] SparseCholeskyCounts counts() const override {
    SparseCholeskyCounts counts;
    const SparseMatrix& L = factor_.matrixL().nestedExpression();
    for (Index j = 0; j < L.cols(); ++j) {
      const double length = 1.0 + (L.outerIndexPtr()[j + 1] - L.outerIndexPtr()[j]);
      counts.entries += length;
      counts.flops += length * length;
    }
    counts.bytes = static_cast<std::size_t>(L.nonZeros()) * (sizeof(double) + sizeof(int));
    return counts;
  }

 private:
  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> factor_;
};

constexpr std::array kNames = {std::string_view("block"),
#ifdef SIGNORINI_HAS_CHOLMOD
                               std::string_view("cholmod"),
#endif
                               std::string_view("eigen")};

}  // namespace

std::span<const std::string_view> sparse_cholesky_names() {
  return kNames;
}

std::unique_ptr<SparseCholesky> make_sparse_cholesky(std::string_view name) {
  const std::string_view wanted = name.empty() ? kNames.front() : name;
#ifdef SIGNORINI_HAS_CHOLMOD
  if (wanted == "cholmod") {
    return make_cholmod();
  }
#endif
  if (wanted == "block") {
    return std::make_unique<BlockCholesky>();
  }
  if (wanted == "eigen") {
    return std::make_unique<EigenSimplicial>();
  }
  std::string known;
  for (const std::string_view one : kNames) {
    known.append(known.empty() ? "" : ", ").append(one);
  }
  throw std::invalid_argument("sparse Cholesky: no back-end '" + std::string(wanted) +
                              "' in this build, which has: " + known);
}

}  // namespace signorini::lcp
