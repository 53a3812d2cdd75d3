#include <signorini/core/model/number_text.h>
#include <signorini/core/model/orientation_drift.h>

#include <cmath>
#include <stdexcept>

namespace signorini {
namespace {

DriftSample sample(const Body& body, const MatrixState& start, const MatrixState& now,
                   double time) {
  const double start_energy = kinetic_energy(body, start);
  const double gain = kinetic_energy(body, now) - start_energy;
  return {time, orthogonality_error(now.R), start_energy > 0.0 ? gain / start_energy : 0.0,
          (now.L - start.L).norm()};
}

void advance(const Body& body, const DriftSettings& settings, int step, BodyState& quaternion,
             MatrixState& matrix) {
  const Vec3 none = Vec3::Zero();
  if (settings.scheme == OrientationScheme::kQuaternion) {
    integrate_free(body, none, none, settings.step, settings.integrator, quaternion);
    matrix = matrix_state(quaternion);
    return;
  }
  integrate_free(body, none, none, settings.step, settings.integrator, matrix);
  if (settings.gram_schmidt_period > 0 && step % settings.gram_schmidt_period == 0) {
    gram_schmidt(matrix.R);
  }
}

}  // namespace

void DriftSettings::validate() const {
  if (!(step > 0.0) || !std::isfinite(step)) {
    throw std::invalid_argument("drift settings: step: must be finite and > 0, got " +
                                number_text(step) + " s");
  }
  if (steps < 0) {
    throw std::invalid_argument("drift settings: steps: must be >= 0, got " +
                                std::to_string(steps));
  }
  if (gram_schmidt_period < 0) {
    throw std::invalid_argument("drift settings: gram_schmidt_period: must be >= 0, got " +
                                std::to_string(gram_schmidt_period));
  }
}

std::vector<DriftSample> orientation_drift(const Body& body, const BodyState& start,
                                           const DriftSettings& settings) {
  validate(body);
  validate({body}, {start});
  settings.validate();
  const MatrixState origin = matrix_state(start);
  BodyState quaternion = start;
  MatrixState matrix = origin;
  std::vector<DriftSample> samples{sample(body, origin, origin, 0.0)};
  samples.reserve(settings.steps + 1);
  for (int i = 1; i <= settings.steps; ++i) {
    advance(body, settings, i, quaternion, matrix);
    samples.push_back(sample(body, origin, matrix, i * settings.step));
  }
  return samples;
}

}  // namespace signorini
