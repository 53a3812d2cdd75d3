#include <signorini/core/model/number_text.h>
#include <signorini/core/response/time_step_settings.h>

#include <cmath>
#include <stdexcept>

namespace signorini {
namespace {

void require(bool good, const char* field, const std::string& bound, const std::string& value) {
  if (!good) {
    throw std::invalid_argument(std::string("time step settings: ") + field + ": must be " + bound +
                                ", got " + value);
  }
}

void require_not_negative(double value, const char* field, const char* unit) {
  require(value >= 0.0 && std::isfinite(value), field, "finite and >= 0",
          number_text(value) + " " + unit);
}

}  // namespace

void TimeStepSettings::validate() const {
  require(step > 0.0 && std::isfinite(step), "step", "finite and > 0", number_text(step) + " s");
  require(gravity.allFinite(), "gravity", "finite", number_text(gravity) + " m/s^2");
  require(pyramid_sides >= 4 && pyramid_sides % 2 == 0, "pyramid_sides", "even and >= 4",
          std::to_string(pyramid_sides));
  require(friction_model <= FrictionModel::kBox, "friction_model", "one of the three models",
          std::to_string(static_cast<int>(friction_model)));
  require_not_negative(margin, "margin", "m");
  require_not_negative(touching_tolerance, "touching_tolerance", "m");
  require_not_negative(restitution_threshold, "restitution_threshold", "m/s");
  require(threads >= 1, "threads", ">= 1", std::to_string(threads));
  require(accuracy.has_value() || !budget.is_limited(), "budget", "unlimited without accuracy",
          number_text(budget.work) + " units, " + number_text(budget.seconds) + " s");
  budget.validate();
  sleep.validate();
  lcp.validate();
}

}  // namespace signorini
