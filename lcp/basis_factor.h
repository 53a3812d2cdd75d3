#pragma once

#include <signorini/lcp/scaled_lcp.h>
#include <signorini/lcp/types.h>

#include <Eigen/LU>
#include <optional>
#include <vector>

namespace signorini::lcp {

/// The basis B of Lemke's method, a choice of n columns of [I, -M, -d], factorised.
///
/// The columns of the w_i in the basis are unit vectors, so only the rows S of the indices whose w
/// is not basic matter: B is solved by an LU of the compact matrix [M_S,alpha, d_S] (alpha: the
/// basic z, one fewer than S) and one product with M. A pivot appends an eta vector (product form:
/// B_new = B E, E the identity but for one column y = B^-1 a); factor() starts afresh.
///
/// Position p of a vector x = B^-1 a belongs to the variable at(p). After factor(), w_i and z_i lie
/// at position i and z_0 at the one index left over; an entering variable takes the place of the
/// leaving one.
class BasisFactor {
 public:
  /// A variable: w_i = i, z_i = n + i, z_0 = 2 n.
  using Variable = int;

  /// The complementary basis of the active z_i and the other w_i, each at position i, not
  /// factorised. Keeps references; the cover vector is read when it is used.
  void reset(const ScaledLcp& lcp, const std::vector<char>& active, const Vector& cover);

  /// Factorises the current basis and drops the eta vectors; moves the variables to their own
  /// positions. Cost: 2/3 |S|^3. @return false if the compact matrix has a zero pivot or overflows.
  bool factor();

  /// x = B^-1 x and x = B^-T x, in place. Cost: |S|^2 + entries of M_alpha + n a pivot since
  /// factor().
  void solve(Vector& x);
  void solve_transposed(Vector& x);

  /// residual = a - B x in long double, rounded. a: column of variable, or q if variable is -1.
  void residual(Variable column, const Vector& x, Vector& residual);

  /// a = B x
  void multiply(const Vector& x, Vector& a) const;

  /// The column of a variable in [I, -M, -d].
  void column(Variable variable, Vector& a) const;

  /// Puts `entering` in the place of the variable at `position`. @param y B^-1 times its column
  void exchange(int position, Variable entering, const Vector& y);

  [[nodiscard]] Variable at(int position) const { return at_[position]; }
  [[nodiscard]] int cover_position() const { return cover_position_; }
  [[nodiscard]] int updates() const { return static_cast<int>(eta_position_.size()); }
  [[nodiscard]] int cover_variable() const { return 2 * n_; }

 private:
  void solve_factored(Vector& x);
  void solve_factored_transposed(Vector& x);

  const ScaledLcp* lcp_ = nullptr;
  const Vector* cover_ = nullptr;
  int n_ = 0;
  std::vector<Variable> at_;
  int cover_position_ = -1;

  // The factored basis: its basic z (alpha_) and the rows S, place_[i] = -1 outside S.
  std::vector<int> alpha_;
  std::vector<int> rows_;
  std::vector<int> place_;
  int cover_row_ = -1;  // the index without a basic variable of its own, -1 if z_0 is not basic
  Matrix storage_;      // the factors; grows only
  std::optional<Eigen::PartialPivLU<Eigen::Ref<Matrix>>> lu_;
  Vector compact_;

  std::vector<int> eta_position_;
  Matrix etas_;  // one column an update
  std::vector<long double> wide_;
};

}  // namespace signorini::lcp
