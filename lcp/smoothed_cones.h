#pragma once

#include <signorini/lcp/alart_curnier_function.h>
#include <signorini/lcp/problem.h>

#include <span>
#include <vector>

namespace signorini::lcp {

/// The rows of a problem, friction cones among them, as one smooth equation F(x, u; mu) = 0 in the
/// scaled unknowns of AlartCurnierFunction; for mu = 0 it is what they ask:
///
/// - a row with bounds:     F = x - p(x - u), p of smooth_clamp.h;
/// - a cone of coefficient m: F = T x - P(T x - T^-1 u~), T = diag(m^1/2, m^-1/2, m^-1/2), which
///   makes K and its dual cone the one second-order cone that P projects on smoothly: of y with the
///   spectral values l = y_N -+ |y_T| it keeps the axes and gives them s(l) (Fukushima, Luo, Tseng,
///   SIAM J. Optim. 12, 2001, section 4: Chen, Harker, Kanzow and Smale's function). u~ = u in the
///   associated law; in Coulomb's De Saxce's u_N + m (|u_T|_e - e), |u_T|_e^2 = |u_T|^2 + e^2,
///   e = 0.03 mu;
/// - a cone with m < 1e-12: its normal row as above, and F_T = x_T (its force is nothing beside
///   x_N; a certificate judges it as it is).
///
/// A large m costs digits: 1e3 is solved by cone-smoothing's tests, 1e6 was not.
///
/// The solutions for mu > 0 are a central path, (T x) o (T^-1 u~) = mu^2 (1, 0, 0).
class SmoothedCones {
 public:
  using Group = AlartCurnierFunction::Group;
  using Block = AlartCurnierFunction::Block;

  /// Refers to the groups, which must outlive it unchanged. @pre none is a coupled row
  void set(const std::vector<Group>& groups, FrictionLaw law) {
    groups_ = groups;
    law_ = law;
  }

  void evaluate(const Vector& x, const Vector& u, double mu, Vector& F) const;
  /// F, and dF = A dx + B du + by_mu dmu, A and B one block a group.
  void linearise(const Vector& x, const Vector& u, double mu, Vector& F, std::vector<Block>& A,
                 std::vector<Block>& B, Vector& by_mu) const;

 private:
  std::span<const Group> groups_;
  FrictionLaw law_ = FrictionLaw::kCoulomb;
};

}  // namespace signorini::lcp
