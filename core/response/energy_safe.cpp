#include <signorini/core/response/energy_safe.h>
#include <signorini/core/response/newton_impulse.h>
#include <signorini/lcp/certificate.h>

#include <algorithm>
#include <cmath>

namespace signorini {
namespace {

constexpr double kFloors = 4.0;  // as lcp::judge() allows

/// f.A f = |J^T f|^2 in M^-1.
double squared_in_inverse_mass(const lcp::FactoredMatrix& A, const lcp::Vector& f) {
  lcp::Vector momentum(A.degrees_of_freedom());
  lcp::Vector velocity(A.degrees_of_freedom());
  A.transpose_times(f.data(), momentum.data());
  A.apply_inverse_mass(momentum.data(), velocity.data());
  return momentum.dot(velocity);
}

}  // namespace

double residual_allowed(const NormalRows& rows, const lcp::VectorRef& f, double tolerance) {
  if (f.size() == 0) {
    return 0.0;
  }
  const double floor = lcp::certify(plastic_problem(rows), f).rounding_floor;
  return std::max(tolerance, kFloors * floor) * rows.d_dot.cwiseAbs().maxCoeff();
}

bool is_admissible(const NormalRows& rows, const lcp::VectorRef& f, double tolerance) {
  if (f.size() == 0) {
    return true;
  }
  lcp::Vector diagonal;
  rows.A.diagonal(diagonal);
  const double allowed = residual_allowed(rows, f, tolerance);
  return f.cwiseProduct(diagonal).minCoeff() >= -allowed &&
         gap_velocities_after(rows, f).minCoeff() >= -allowed;
}

EnergyLine energy_line(const NormalRows& rows, const lcp::VectorRef& f_c,
                       const lcp::VectorRef& f_e) {
  return energy_line(rows.A, rows.d_dot, f_c, f_e);
}

EnergyLine energy_line(const lcp::FactoredMatrix& A, const lcp::VectorRef& before,
                       const lcp::VectorRef& f_c, const lcp::VectorRef& f_e) {
  lcp::Vector plastic_after(before.size());
  A.multiply(f_c.data(), plastic_after.data());
  plastic_after += before;
  const lcp::Vector direction = f_e - f_c;
  EnergyLine line;
  line.plastic = f_c.dot(plastic_after) - 0.5 * squared_in_inverse_mass(A, f_c);
  line.slope = direction.dot(plastic_after);
  line.curvature = squared_in_inverse_mass(A, direction);
  return line;
}

double largest_theta(const EnergyLine& line) {
  const double c = -line.plastic;
  if (line.slope + 0.5 * line.curvature <= c) {
    return 1.0;  // E(1) <= 0
  }
  if (c <= 0.0) {
    return 0.0;
  }
  const double size = std::sqrt(line.slope * line.slope + 2.0 * line.curvature * c);
  const double root =
      line.slope >= 0.0 ? 2.0 * c / (line.slope + size) : (size - line.slope) / line.curvature;
  return std::min(root, 1.0);
}

}  // namespace signorini
