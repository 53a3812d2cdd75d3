#include <signorini/lcp/body_space_system.h>

namespace signorini::lcp {

void BodySpaceSystem::set(const MatrixForm& M) {
  forget_factor();
  rows_.set(std::get<FactoredMatrix>(M));
  d_.setZero(rows_.rows());
  cholesky_->analyse(rows_.body_space_matrix(d_));
}

void BodySpaceSystem::multiply(const Vector& x, Vector& out) {
  rows_.transpose_times(x, u_);
  rows_.times(u_, out);
  out += rows_.compliance().cwiseProduct(x);
}

bool BodySpaceSystem::factor_new(const Vector& e, double proximal) {
  d_ = (rows_.compliance().array() + e.array() + proximal).inverse();  // 1 / infinity = 0
  return d_.allFinite() && cholesky_->factor(rows_.body_space_matrix(d_));
}

double BodySpaceSystem::factor_cost() const {
  // A solve reads every number of the factor twice, from memory; a factorisation works in cache.
  constexpr double kFlopsInTheTimeOfANumber = 67.0;
  const SparseCholeskyCounts counts = cholesky_->counts();
  return counts.entries > 0.0 ? counts.flops / (kFlopsInTheTimeOfANumber * counts.entries) : 0.0;
}

void BodySpaceSystem::solve(const Vector& h, Vector& dx) {
  dx = d_.cwiseProduct(h);
  rows_.transpose_times(dx, u_);
  cholesky_->solve(u_);
  rows_.times(u_, dx);
  dx = d_.cwiseProduct(h - dx);
}

}  // namespace signorini::lcp
