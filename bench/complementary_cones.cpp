#include "bench/complementary_cones.h"

#include <algorithm>

namespace signorini::bench {
namespace {

using lcp::ExactProblem;

enum class Choice { kNeither, kSlack, kVariable };

/// Row-reduces [columns | q] once for each prefix of choices, so that a dependent column is refused
/// where it is chosen and its subtree is not searched.
class Search {
 public:
  explicit Search(const ExactProblem& problem)
      : problem_(problem), choices_(problem.n, Choice::kNeither) {}

  std::optional<std::vector<mpq_class>> run() {
    std::vector<std::vector<mpq_class>> rows(problem_.n);
    for (int i = 0; i < problem_.n; ++i) {
      rows[i].resize(2 * problem_.n + 1);
      rows[i][i] = 1;
      for (int j = 0; j < problem_.n; ++j) {
        rows[i][problem_.n + j] = -problem_.at(i, j);
      }
      rows[i].back() = problem_.q[i];
    }
    if (!descend(rows, 0, 0)) {
      return std::nullopt;
    }
    return solution_;
  }

 private:
  using Rows = std::vector<std::vector<mpq_class>>;

  /// @param rank columns chosen so far; row k < rank has its unit entry in the k-th of them
  bool descend(const Rows& rows, int index, int rank) {
    if (index == problem_.n) {
      return is_solution(rows, rank);
    }
    for (const Choice choice : {Choice::kNeither, Choice::kSlack, Choice::kVariable}) {
      choices_[index] = choice;
      if (choice == Choice::kNeither) {
        if (descend(rows, index + 1, rank)) {
          return true;
        }
        continue;
      }
      Rows reduced = rows;
      const int column = choice == Choice::kSlack ? index : problem_.n + index;
      if (eliminate(reduced, column, rank) && descend(reduced, index + 1, rank + 1)) {
        return true;
      }
    }
    choices_[index] = Choice::kNeither;
    return false;
  }

  /// Gauss-Jordan on one column. @return false if it depends on those chosen before.
  static bool eliminate(Rows& rows, int column, int rank) {
    const auto pivot = std::find_if(rows.begin() + rank, rows.end(),
                                    [column](const auto& row) { return sgn(row[column]) != 0; });
    if (pivot == rows.end()) {
      return false;
    }
    std::swap(*pivot, rows[rank]);
    const mpq_class inverse = 1 / rows[rank][column];
    for (mpq_class& value : rows[rank]) {
      value *= inverse;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const mpq_class factor = rows[i][column];
      if (static_cast<int>(i) == rank || sgn(factor) == 0) {
        continue;
      }
      for (std::size_t j = 0; j < rows[i].size(); ++j) {
        rows[i][j] -= factor * rows[rank][j];
      }
    }
    return true;
  }

  bool is_solution(const Rows& rows, int rank) {
    for (int i = 0; i < problem_.n; ++i) {
      const int s = sgn(rows[i].back());
      if (s < 0 || (i >= rank && s != 0)) {
        return false;
      }
    }
    solution_.assign(problem_.n, 0);
    int row = 0;
    for (int i = 0; i < problem_.n; ++i) {
      if (choices_[i] == Choice::kVariable) {
        solution_[i] = rows[row].back();
      }
      row += choices_[i] != Choice::kNeither ? 1 : 0;
    }
    return true;
  }

  const ExactProblem& problem_;
  std::vector<Choice> choices_;
  std::vector<mpq_class> solution_;
};

}  // namespace

std::optional<std::vector<mpq_class>> find_in_complementary_cones(const ExactProblem& problem) {
  return Search(problem).run();
}

}  // namespace signorini::bench
