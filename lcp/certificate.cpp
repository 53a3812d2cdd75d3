#include <signorini/lcp/certificate.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kFloorsAllowed = 4.0;
// No rounding floor excuses a residual above this: where z is so large that |M||z| has no digits
// left beside q, the floor is large too, and an infeasible problem would pass for a rounded one.
constexpr double kRoundingCeiling = 1e-5;

struct Bounds {
  long double lower;
  long double upper;
};

std::vector<Bounds> bounds_at(const Problem& problem, const VectorRef& z) {
  std::vector<Bounds> bounds(problem.size(), {0.0L, kInfinity});
  for (Index i = 0; i < problem.size(); ++i) {
    if (problem.lower.size() > 0) {
      bounds[i].lower = problem.lower[i];
    }
    if (problem.upper.size() > 0) {
      bounds[i].upper = problem.upper[i];
    }
  }
  for (const CoupledLimit& limit : problem.limits) {
    const long double most =
        static_cast<long double>(limit.coefficient) * std::max(z[limit.normal_row], 0.0);
    bounds[limit.row] = {-most, most};
  }
  return bounds;
}

/// z - clamp(z - w / scale, lower, upper), which is 0 exactly where row (z, w) is solved.
long double step(long double z, long double w, long double scale, const Bounds& bounds) {
  const long double moved = z - w / scale;
  const long double clamped = std::min(std::max(moved, bounds.lower), bounds.upper);
  return clamped == moved ? w / scale : z - clamped;
}

Certificate refuse() {
  Certificate certificate;
  certificate.natural_residual = kInfinity;
  certificate.unit_free_residual = kInfinity;
  certificate.rounding_floor = 0.0;
  certificate.natural_floor = 0.0;
  certificate.backward_error = kInfinity;
  return certificate;
}

}  // namespace

Certificate certify(const Problem& problem, const VectorRef& z, Vector* w) {
  const Index n = problem.size();
  if (w != nullptr) {
    w->setConstant(n, Certificate::kNaN);
  }
  if (z.size() != n || !z.allFinite()) {
    return refuse();
  }
  const std::vector<long double> wide_z(z.data(), z.data() + n);
  std::vector<long double> wide_w(n);
  multiply(problem.M, wide_z.data(), wide_w.data());
  std::vector<long double> magnitude;
  absolute_multiply(problem.M, z, magnitude);
  Vector scale;
  diagonal(problem.M, scale);
  const std::vector<Bounds> bounds = bounds_at(problem, z);

  const double q_inf = n > 0 ? problem.q.cwiseAbs().maxCoeff() : 0.0;
  long double natural = 0.0L;
  long double unit_free = 0.0L;
  long double backward = 0.0L;
  long double z_dot_w = 0.0L;
  long double most = 0.0L;
  Certificate certificate;
  for (Index i = 0; i < n; ++i) {
    wide_w[i] += problem.q[i];
    if (w != nullptr) {
      (*w)[i] = static_cast<double>(wide_w[i]);
    }
    const double d = scale[i] > 0.0 ? scale[i] : 1.0;
    const long double scaled = d * std::abs(step(wide_z[i], wide_w[i], d, bounds[i]));
    const long double plain = std::abs(step(wide_z[i], wide_w[i], 1.0L, bounds[i]));
    if (!std::isfinite(scaled) || !std::isfinite(plain) || !std::isfinite(magnitude[i])) {
      return refuse();
    }
    natural = std::max(natural, plain);
    if (scaled > unit_free || certificate.worst_row < 0) {
      unit_free = scaled;
      certificate.worst_row = static_cast<int>(i);
    }
    const long double size = magnitude[i] + std::abs(problem.q[i]);
    most = std::max(most, size);
    if (scaled > 0.0L) {
      backward = std::max(backward, scaled / (d * std::abs(wide_z[i]) + size));
    }
    if (bounds[i].lower == 0.0L && bounds[i].upper == kInfinity) {
      z_dot_w += wide_z[i] * wide_w[i];
      certificate.min_z = std::fmin(certificate.min_z, z[i]);
      certificate.min_w = std::fmin(certificate.min_w, static_cast<double>(wide_w[i]));
    }
  }
  certificate.natural_residual = static_cast<double>(natural / (1.0L + q_inf));
  certificate.natural_floor = static_cast<double>(kEpsilon * most / (1.0L + q_inf));
  if (q_inf > 0.0) {
    certificate.unit_free_residual = static_cast<double>(unit_free / q_inf);
    certificate.rounding_floor = static_cast<double>(kEpsilon * most / q_inf);
  } else {
    certificate.unit_free_residual = unit_free == 0.0L ? 0.0 : kInfinity;
    certificate.rounding_floor = 0.0;
  }
  certificate.backward_error = static_cast<double>(backward);
  certificate.complementarity = static_cast<double>(std::abs(z_dot_w));
  return certificate;
}

Status judge(const Certificate& certificate, double tolerance, Status otherwise) {
  const double natural = certificate.natural_residual;
  const double unit_free = certificate.unit_free_residual;
  if (natural <= tolerance && unit_free <= tolerance) {  // false for NaN
    return Status::kSolved;
  }
  const auto within = [tolerance](double residual, double floor) {
    return residual <= std::max(tolerance, std::min(kFloorsAllowed * floor, kRoundingCeiling));
  };
  return within(natural, certificate.natural_floor) && within(unit_free, certificate.rounding_floor)
             ? Status::kSolvedToRounding
             : otherwise;
}

}  // namespace signorini::lcp
