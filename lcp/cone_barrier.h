#pragma once

#include <signorini/lcp/alart_curnier_function.h>
#include <signorini/lcp/second_order_cone.h>

namespace signorini::lcp {

/// What an interior point method keeps of one group of rows: of a cone, x and v in the coordinates
/// (mu x_N, x_T), (v_N / mu, v_T) in which both lie in second_order_cone's L; of a row, x and for
/// each of its bounds a slack s >= 0 and a multiplier y >= 0.
///
///     cone: dx + B (du + residual) = c,        B = W^2 (and the shift's derivative),
///     row:  e dx + du = -residual + c_l / s_l - c_h / s_h,    e = y_l / s_l + y_h / s_h.
class ConeBarrier {
 public:
  using Group = AlartCurnierFunction::Group;
  using Block = AlartCurnierFunction::Block;
  using Vector3 = Eigen::Vector3d;

  /// x and v (or slacks and multipliers) inside by at least `margin` (of a cone with mu > 1, of x_N
  /// and u_N), near the solution of the group alone for u = x + b. @param shift whether the law is
  /// Coulomb's
  void start(const Group& group, const double* b, double margin, bool shift);

  /// The number of its complementary products: 0, 1 or 2.
  [[nodiscard]] int count() const;
  /// x in the group's coordinates.
  void get(double* x) const;
  /// residual = u - (v - mu |v_T| n) of a cone, u - y_l + y_h of a row; keeps it.
  void set_residual(const double* u);
  /// The group's share of A and B for the iterate at hand.
  void derive(Block& A, Block& B);

  /// The right-hand side of the predictor.
  void predict();
  /// That of the corrector for the directions at hand, towards products of `target`.
  void correct(double target);
  /// F with A dx + B du = -F. @param B as derive() gave it
  void right_side(const Block& B, double* F) const;
  /// The directions for the solution dx and du = W dx.
  void follow(const double* dx, const double* du);

  /// The sum of the products after a step.
  [[nodiscard]] double gap_after(double step) const;
  /// The longest step that keeps everything inside; infinity if there is none.
  [[nodiscard]] double longest_step() const;
  void move(double step);

 private:
  enum class Kind { kCone, kRow, kFixed };
  /// A slack and its multiplier.
  struct Bound {
    bool exists = false;
    double s = 1.0, y = 0.0, ds = 0.0, dy = 0.0, c = 0.0;
  };
  void start_row(double b, double margin);
  [[nodiscard]] Vector3 from(const double* values) const;

  Kind kind_ = Kind::kFixed;
  Group group_{};
  bool shift_ = false;
  Vector3 x_ = Vector3::Zero(), v_ = Vector3::Zero();
  Vector3 dx_ = Vector3::Zero(), dv_ = Vector3::Zero();
  Vector3 c_ = Vector3::Zero(), residual_ = Vector3::Zero(), lambda_ = Vector3::Zero();
  second_order_cone::NesterovTodd scaling_;
  Bound lower_, upper_;
};

}  // namespace signorini::lcp
