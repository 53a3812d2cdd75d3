#pragma once

#include <signorini/lcp/instruction_set.h>
#include <signorini/lcp/row_groups.h>
#include <signorini/lcp/scaled_rows.h>
#include <signorini/lcp/sweeps.h>
#include <signorini/lcp/thread_team.h>

#include <cstdint>
#include <new>
#include <span>
#include <vector>

namespace signorini::lcp {

/// Memory that starts with a cache line.
template <typename T>
struct CacheLines {
  using value_type = T;
  CacheLines() = default;
  template <typename U>
  CacheLines(const CacheLines<U>&) {}
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{64}));
  }
  void deallocate(T* memory, std::size_t) { ::operator delete (memory, std::align_val_t{64}); }
  friend bool operator==(const CacheLines&, const CacheLines&) { return true; }
};
template <typename T>
using CacheLineVector = std::vector<T, CacheLines<T>>;

/// Sweeps over a factored A = J W J^T + diag(c), in the coordinates of scaled_rows.h: u is kept,
/// w_i = g_i . u + ..., and a step adds g_i^T dx_i to u.
///
/// Rows on at most two blocks of at most six degrees of freedom each go through the kernels of
/// sweep_kernels.h; consecutive rows on the same blocks as one record, with their products with
/// each other, so that a row waits for three operations of the row before it and not for a whole
/// product. Other rows take a plain loop.
///
/// The bits of a sweep depend neither on the instruction set (but kFma) nor on the number of
/// threads. kNatural and kColoured differ as two orders of Gauss-Seidel do.
template <typename T>
class PackedRows final : public Sweeps<T> {
 public:
  /// Takes over A. Cost: O(entries of J) times the dimension of a block. Allocates nothing once
  /// capacity is reached.
  /// @param rows q, bounds and coupling of every row; receives scale and inverse
  /// @param relaxation omega in (0, 2)
  void set(const FactoredMatrix& A, std::span<SweepRow> rows, double relaxation, RowOrder order,
           InstructionSet instructions = best_instruction_set());

  /// From now on the rows of a colour are shared out among the team; natural order is not. Null:
  /// the caller's thread alone, as at the beginning. The team must live as long as it is used.
  void use(ThreadTeam* team) { team_ = team; }

  void start(const Vector& z) override;
  void forward() override;
  void backward() override;
  void read(Vector& z) const override;
  void refresh(Vector& w) override;
  [[nodiscard]] std::span<T> state() override { return state_; }
  [[nodiscard]] double squared_length(std::span<const T> difference) const override;

  /// Colours of the last set(), 0 in the natural order.
  [[nodiscard]] int color_count() const {
    return static_cast<int>(groups_.color_starts().size()) - 1;
  }

 private:
  /// Records of one form and kind, or general rows, that follow each other.
  struct Run {
    RowRun<T> records;  // of general rows only `first` and `count`
    bool general;
    int first_group;
    std::size_t numbers, blocks, normals;  // where the records' start
  };
  /// Records of a run that one thread takes at a time.
  struct Task {
    int run;
    int first;
    int count;
  };
  struct GeneralRow {
    T q, inverse, step, lower, upper, compliance;
    int row;
    int normal_place;  // of a coupled row, else -1
  };

  void make_runs();
  void append_blocks(const RowGroups::Group& group, int& alone);
  void make_tasks();
  void fill(const Run& run, int record, const FactoredMatrix& A, std::span<const SweepRow> rows,
            double relaxation);
  void fill_columns(T* record, const RecordLayout& at, int count);
  GeneralRow general_row(int row, const FactoredMatrix& A, std::span<const SweepRow> rows,
                         double relaxation) const;
  [[nodiscard]] T general_product(const GeneralRow& row) const;
  void step_general(const GeneralRow& row);
  void add_general(const GeneralRow& row, T change);
  void sweep(const Run& run, int first, int count, bool backward);
  void sweep(bool backward);
  void sweep_on_team(bool backward);
  [[nodiscard]] T* x() { return state_.data(); }
  [[nodiscard]] T* u() { return state_.data() + x_count_; }

  ScaledRows scaled_;
  RowGroups groups_;
  const SweepKernels<T>* kernels_ = nullptr;
  CacheLineVector<T> state_;  // x, then u
  std::size_t x_count_ = 0;
  std::vector<int> place_;       // of a row's x
  std::vector<double> unscale_;  // 1 / (kappa s_i)
  std::vector<Run> runs_;
  std::vector<int> color_runs_;  // the first run of every colour, then that of the rest
  std::vector<Task> tasks_;      // of the colours
  std::vector<int> color_tasks_;
  ThreadTeam* team_ = nullptr;
  CacheLineVector<T> numbers_;
  std::vector<std::int32_t> blocks_;
  std::vector<std::int32_t> normals_;
  std::vector<GeneralRow> general_rows_;
  CacheLineVector<T> w_;
};

extern template class PackedRows<double>;
extern template class PackedRows<float>;

}  // namespace signorini::lcp
