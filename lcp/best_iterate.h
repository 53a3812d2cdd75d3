#pragma once

#include <signorini/lcp/certificate.h>
#include <signorini/lcp/problem.h>

namespace signorini::lcp {

/// Keeps the best of the vectors z it is shown, by their certificates, so that no later step of a
/// solver can make its answer worse.
class BestIterate {
 public:
  /// Forgets everything and holds z = 0, which is certified when that is needed.
  /// @param tolerance that iterates are judged by
  void reset(const Problem& problem, double tolerance);

  /// Certifies z (Certifier::certify_iterate()) and keeps it if it is better. Anything not finite
  /// is refused.
  /// @return the certificate of this z.
  Certificate offer(const VectorRef& z);
  /// The same of what is likely to be the answer: certified as answers are (Certifier::certify(),
  /// or quickly), which take_over() spares doing again.
  Certificate offer_answer(const VectorRef& z, bool quickly);

  [[nodiscard]] const Vector& z() const { return z_; }
  [[nodiscard]] const Certificate& certificate();
  /// The certificate and w of z(). @return false, and writes nothing, unless z() is what
  /// offer_answer() was given
  [[nodiscard]] bool take_over(Certificate& certificate, Vector& w) const;

  /// What "better" means: max(natural_residual, unit_free_residual), +infinity for NaN.
  [[nodiscard]] static double merit(const Certificate& certificate);

 private:
  [[nodiscard]] Certificate certify_iterate(const VectorRef& z);
  bool keep_if_better(const VectorRef& z, const Certificate& certificate);

  const Problem* problem_ = nullptr;
  double tolerance_ = 0.0;
  Vector z_;
  Vector w_;         // of z_, where it is an answer
  Vector answer_w_;  // of the answer at hand
  Certificate certificate_;
  Certifier certifier_;
  bool has_started_ = false;   // certifier_.start_iterates()
  bool is_certified_ = false;  // z_
  bool is_answer_ = false;     // z_: certified as answers are, with w_
};

}  // namespace signorini::lcp
