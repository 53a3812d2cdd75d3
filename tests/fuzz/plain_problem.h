#pragma once

#include <vector>

namespace signorini::testing {

/// A complementarity problem as its caller stated it (lcp/problem.h), every number in long double:
/// what the fuzzers judge answers by. Shares nothing with the library.
struct PlainProblem {
  struct Limit {
    int row, normal_row;
    long double coefficient;
  };
  struct Cone {
    int normal_row, dimension;
    long double coefficient;
  };
  /// What is said of z.
  struct Claim {
    double natural_residual = 0.0;  ///< infinite: nothing is said
    double unit_free_residual = 0.0;
    bool is_solved = false;
    bool is_to_rounding = false;
    long double tolerance = 0.0L;
    /// What two computations may differ by, of the floor. Of one z in long double, 64 terms a row:
    long double of_the_floor = 0.05L;
  };

  int n = 0;
  std::vector<long double> M = {};       ///< M_ij at [i n + j]
  std::vector<long double> size = {};    ///< |M|; of M = J W J^T + C: |J||W||J^T| + C
  std::vector<long double> q = {};       ///< n
  std::vector<long double> q_size = {};  ///< |q|; of a sum: of its terms
  long double least_q = 0.0L;            ///< |q|_inf counts as at least this: of rows left out
  std::vector<long double> lower = {}, upper = {};
  std::vector<Limit> limits = {};
  std::vector<Cone> cones = {};
  bool is_coulomb = true;

  PlainProblem() = default;
  /// M = 0, q = 0, 0 <= z.
  explicit PlainProblem(int rows);

  /// Aborts where the claim does not hold: a residual (lcp/certificate.h) below what it is, or a
  /// problem called solved (to rounding) with one above the tolerance (four floors and 1e-5).
  void judge(const double* z, const Claim& claim) const;
  /// Aborts unless the ray y shows that every feasible z has |z|_1 >= bound (infinite: there is
  /// none).
  void judge_ray(const double* y, double bound) const;

 private:
  /// Of z, and what rounding z, w and the data to double costs them.
  struct Residuals {
    long double natural = 0.0L;
    long double unit_free = 0.0L;
    long double natural_floor = 0.0L;
    long double unit_free_floor = 0.0L;
  };
  [[nodiscard]] Residuals residuals(const double* z) const;
  [[nodiscard]] long double row_residual(int row, const double* z, long double w,
                                         long double scale) const;
  [[nodiscard]] long double cone_residual(const Cone& cone, const double* z, const long double* w,
                                          long double scale) const;
  [[nodiscard]] long double cone_scale(const Cone& cone) const;
};

}  // namespace signorini::testing
