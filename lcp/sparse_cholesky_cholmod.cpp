// CHOLMOD behind SparseCholesky: the only file that knows it.
#include <signorini/lcp/sparse_cholesky.h>

#include <cholmod.h>
#include <cstring>
#include <omp.h>
#include <stdexcept>
#include <string>

namespace signorini::lcp {
namespace {

/// CHOLMOD's supernodal loops ask OpenMP for several threads whatever the caller wants; on blocks
/// as small as ours waking them costs more than the work. No parallel region is active while this
/// lives.
class OneThread {
 public:
  OneThread() : levels_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;
  ~OneThread() { omp_set_max_active_levels(levels_); }

 private:
  int levels_;
};

class Cholmod final : public SparseCholesky {
 public:
  Cholmod() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.error_handler = nullptr;
    common_.quick_return_if_not_posdef = 1;
    common_.nmethods = 1;  // AMD alone: the same ordering every time
    common_.method[0].ordering = CHOLMOD_AMD;
    common_.postorder = 1;
    common_.final_ll = 1;  // L L^T, so that an indefinite matrix is refused and not factored
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  ~Cholmod() override {
    cholmod_free_factor(&factor_, &common_);
    cholmod_free_dense(&solution_, &common_);
    cholmod_free_dense(&work_y_, &common_);
    cholmod_free_dense(&work_e_, &common_);
    cholmod_finish(&common_);
  }

  [[nodiscard]] std::string_view name() const override { return "cholmod"; }

  void analyse(const SparseMatrix& lower) override {
    cholmod_free_factor(&factor_, &common_);
    if (lower.rows() == 0) {
      return;
    }
    cholmod_sparse view = view_of(lower);
    factor_ = cholmod_analyze(&view, &common_);
    if (factor_ == nullptr) {
      throw std::runtime_error("CHOLMOD: the analysis failed, status " +
                               std::to_string(common_.status));
    }
  }

  [[nodiscard]] bool factor(const SparseMatrix& lower) override {
    if (lower.rows() == 0) {
      return true;
    }
    const OneThread guard;
    cholmod_sparse view = view_of(lower);
    cholmod_factorize(&view, factor_, &common_);
    return common_.status == CHOLMOD_OK && factor_->minor == factor_->n;
  }

  void solve(Vector& x) override {
    if (x.size() == 0) {
      return;
    }
    const OneThread guard;
    cholmod_dense right{};
    right.nrow = static_cast<std::size_t>(x.size());
    right.ncol = 1;
    right.nzmax = right.nrow;
    right.d = right.nrow;
    right.x = x.data();
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    if (cholmod_solve2(CHOLMOD_A, factor_, &right, nullptr, &solution_, nullptr, &work_y_, &work_e_,
                       &common_) == 0) {
      throw std::runtime_error("CHOLMOD: the solve failed, status " +
                               std::to_string(common_.status));
    }
    std::memcpy(x.data(), solution_->x, sizeof(double) * right.nrow);
  }
  [[nodiscard]] SparseCholeskyCounts counts() const override {
    return {common_.lnz, common_.fl, common_.memory_usage};
  }

 private:
  /// The matrix as CHOLMOD sees it; the matrix keeps its memory and is not written.
  static cholmod_sparse view_of(const SparseMatrix& lower) {
    cholmod_sparse view{};
    view.nrow = static_cast<std::size_t>(lower.rows());
    view.ncol = static_cast<std::size_t>(lower.cols());
    view.nzmax = static_cast<std::size_t>(lower.nonZeros());
    view.p = const_cast<int*>(lower.outerIndexPtr());
    view.i = const_cast<int*>(lower.innerIndexPtr());
    view.x = const_cast<double*>(lower.valuePtr());
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = 1;
    view.packed = 1;
    return view;
  }

  cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense* solution_ = nullptr;
  cholmod_dense* work_y_ = nullptr;
  cholmod_dense* work_e_ = nullptr;
};

}  // namespace

std::unique_ptr<SparseCholesky> make_cholmod() {
  return std::make_unique<Cholmod>();
}

}  // namespace signorini::lcp
