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

void BestIterate::reset(const Problem& problem) {
  problem_ = &problem;
  z_.setZero(problem.size());
  certificate_ = certifier_.certify(problem, z_);
}

Certificate BestIterate::offer(const VectorRef& z) {
  const Certificate certificate = certifier_.certify(*problem_, z);
  if (z.allFinite() && merit(certificate) < merit(certificate_)) {
    z_ = z;
    certificate_ = certificate;
  }
  return certificate;
}

}  // namespace signorini::lcp
