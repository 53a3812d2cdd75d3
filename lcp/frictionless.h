#pragma once

#include <signorini/lcp/structured_lemke.h>

#include <vector>

namespace signorini::lcp {

/// Settings of Frictionless.
struct FrictionlessSettings : SolverSettings {};

/// Leaves friction out: StructuredLemke on the rows that are not tangential,
///
///     0 <= z_N ⊥ A_NN z_N + q_N >= 0,    z_T = 0.
///
/// That answers a problem with friction cones where nothing would slide without friction (the
/// certificate, of the whole problem, decides), and it proves of most of those that have no answer
/// that there is none: with symmetric positive semidefinite M and a y >= 0 on the normal rows, A y
/// = 0 makes y.w = y.q whatever z is, and no friction makes w_N >= 0 where q.y < 0. Such a y is
/// what the path of Lemke's method ends on; result.ray is it, and is judged with the whole problem
/// (ray.h). What moving supports jam by friction alone has no answer either, and no such y (a
/// criterion of existence: Acary, Cadoux, Lemarechal, Malick, A formulation of the linear discrete
/// Coulomb friction problem via convex optimization, ZAMM 91, 2011).
///
/// Takes what StructuredLemke takes, and cones. Endings besides solved: kInfeasible or another
/// verdict on the ray, kStalled (the answer without friction is none with it), those of
/// StructuredLemke.
///
/// Cost: that of StructuredLemke on the rows that are left. Allocates nothing once capacity was
/// reached (a sparse M apart).
class Frictionless : public Solver {
 public:
  /// @throws std::invalid_argument for a setting out of its range.
  explicit Frictionless(const FrictionlessSettings& settings = {});

  [[nodiscard]] std::string_view name() const override { return "frictionless"; }
  [[nodiscard]] std::string refuses(const Problem& problem) const override;

 protected:
  const SolverSettings& settings() const override { return settings_; }
  Status iterate(const Problem& problem, const Vector* warm_start, const Deadline& deadline,
                 Result& result) override;

 private:
  void leave_friction_out(const Problem& problem);

  FrictionlessSettings settings_;
  StructuredLemke lemke_;
  std::vector<Index> rows_;  // those that are not tangential
  Problem part_;
  Result answer_;  // of part_
  Vector start_;
};

}  // namespace signorini::lcp
