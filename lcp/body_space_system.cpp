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

void BodySpaceSystem::solve(const Vector& h, Vector& dx) {
  dx = d_.cwiseProduct(h);
  rows_.transpose_times(dx, u_);
  cholesky_->solve(u_);
  rows_.times(u_, dx);
  dx = d_.cwiseProduct(h - dx);
}

}  // namespace signorini::lcp
