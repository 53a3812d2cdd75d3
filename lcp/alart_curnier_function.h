#pragma once

#include <signorini/lcp/problem.h>

#include <vector>

namespace signorini::lcp {

/// The rows of a problem as one nonsmooth equation F(x, u) = 0 in scaled unknowns x = z / (s t),
/// u = s w / t, with one s a row (one a cone) and one t for all:
///
/// - a row with bounds:       F = x - clamp(x - rho u, l, h);
/// - a coupled row:           the same with l, h = -+ mu max(x_n, 0);
/// - Coulomb's law:           F_N = x_N - (x_N - rho u_N)+,
///                            F_T = x_T - P_B(x_T - rho u_T), B the disc of radius
///                            mu (x_N - rho u_N)+
///   (Alart, Curnier, Computer Methods in Applied Mechanics and Engineering 92, 1991, eq. 5.2);
/// - the associated law:      F = x - P_K(x - rho u);
///
/// with an element of its generalised derivative, dF = A dx + B du, A and B block diagonal over the
/// groups (a row, or the rows of a cone) but for the coupled rows' dependence on x_n, which is
/// kept apart.
class AlartCurnierFunction {
 public:
  struct Group {
    int first;
    int dimension;  // 1, 2 or 3
    double mu;      // of a cone
    double lower;   // of a row, scaled
    double upper;
    int limit;  // of a coupled row: its number in the problem's limits, else -1
  };
  /// A block of at most 3 x 3, column-major with stride 3.
  using Block = Eigen::Matrix3d;
  /// dF_row also has value * dx_column.
  struct Coupling {
    int row;
    int column;
    double value;
  };

  /// @param scale s, equal within a cone; @param unit t
  void set(const Problem& problem, const Vector& scale, double unit);

  [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
  /// The coupled rows, coefficients scaled.
  [[nodiscard]] const std::vector<CoupledLimit>& limits() const { return limits_; }
  [[nodiscard]] int group_of(Index row) const { return group_of_row_[row]; }

  /// F at (x, u). rho > 0, dimensionless, trades x against u where they conflict.
  void evaluate(const Vector& x, const Vector& u, double rho, Vector& F) const;
  /// A, B and the couplings at (x, u); one block a group.
  void differentiate(const Vector& x, const Vector& u, double rho, std::vector<Block>& A,
                     std::vector<Block>& B, std::vector<Coupling>& couplings) const;

 private:
  [[nodiscard]] double bound_of(const Group& group, const Vector& x) const;

  std::vector<Group> groups_;
  std::vector<int> group_of_row_;
  std::vector<CoupledLimit> limits_;  // coefficients scaled
  FrictionLaw law_ = FrictionLaw::kCoulomb;
};

}  // namespace signorini::lcp
