#pragma once

#include <signorini/lcp/certificate.h>
#include <signorini/lcp/problem.h>

namespace signorini::lcp {

/// Keeps the best of the vectors z it is shown, by their certificates, so that no later step of a
/// solver can make its answer worse.
class BestIterate {
 public:
  /// Forgets everything and holds z = 0. @param tolerance that iterates are judged by
  void reset(const Problem& problem, double tolerance);

  /// Certifies z (Certifier::certify_iterate()) and keeps it if it is better. Anything not finite
  /// is refused.
  /// @return the certificate of this z.
  Certificate offer(const VectorRef& z);

  [[nodiscard]] const Vector& z() const { return z_; }
  [[nodiscard]] const Certificate& certificate() const { return certificate_; }

  /// What "better" means: max(natural_residual, unit_free_residual), +infinity for NaN.
  [[nodiscard]] static double merit(const Certificate& certificate);

 private:
  const Problem* problem_ = nullptr;
  double tolerance_ = 0.0;
  Vector z_;
  Certificate certificate_;
  Certifier certifier_;
};

}  // namespace signorini::lcp
