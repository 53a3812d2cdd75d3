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
  has_started_ = is_certified_ = is_answer_ = false;
}

Certificate BestIterate::certify_iterate(const VectorRef& z) {
  if (!has_started_) {
    certifier_.start_iterates(*problem_);
    has_started_ = true;
  }
  return certifier_.certify_iterate(*problem_, z, tolerance_);
}

const Certificate& BestIterate::certificate() {
  if (!is_certified_) {
    certificate_ = certify_iterate(z_);
    is_certified_ = true;
  }
  return certificate_;
}

/// What is solved needs no comparison with a z = 0 that nobody asked about.
bool BestIterate::keep_if_better(const VectorRef& z, const Certificate& certificate) {
  const bool is_first =
      !is_certified_ && judge(certificate, tolerance_, Status::kNotRun) == Status::kSolved;
  if (!z.allFinite() || !(is_first || merit(certificate) < merit(this->certificate()))) {
    return false;
  }
  z_ = z;
  certificate_ = certificate;
  is_certified_ = true;
  is_answer_ = false;
  return true;
}

Certificate BestIterate::offer(const VectorRef& z) {
  const Certificate certificate = certify_iterate(z);
  keep_if_better(z, certificate);
  return certificate;
}

Certificate BestIterate::offer_answer(const VectorRef& z, bool quickly) {
  has_started_ = false;  // certifying quickly leaves scales of its own
  const Certificate certificate =
      quickly ? certifier_.certify_quickly(*problem_, z, tolerance_, &answer_w_)
              : certifier_.certify(*problem_, z, &answer_w_);
  if (keep_if_better(z, certificate)) {
    is_answer_ = true;
    w_ = answer_w_;
  }
  return certificate;
}

bool BestIterate::take_over(Certificate& certificate, Vector& w) const {
  if (is_answer_) {
    certificate = certificate_;
    w = w_;
  }
  return is_answer_;
}

}  // namespace signorini::lcp
