#include <signorini/lcp/best_iterate.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {

double BestIterate::merit(const Certificate& certificate) {
  const double worst = std::max(certificate.natural_residual, certificate.unit_free_residual);
  return std::isnan(certificate.natural_residual) || std::isnan(certificate.unit_free_residual)
             ? std::numeric_limits<double>::infinity()
             : worst;
}

void BestIterate::reset(const Problem& problem, double tolerance) {
  problem_ = &problem;
  tolerance_ = tolerance;
  z_.setZero(problem.size());
  certifier_.start_iterates(problem);
  certificate_ = certifier_.certify_iterate(problem, z_, tolerance);
}

Certificate BestIterate::offer(const VectorRef& z) {
  const Certificate certificate = certifier_.certify_iterate(*problem_, z, tolerance_);
  if (z.allFinite() && merit(certificate) < merit(certificate_)) {
    z_ = z;
    certificate_ = certificate;
  }
  return certificate;
}

}  // namespace signorini::lcp
