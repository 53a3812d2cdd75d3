#include <signorini/core/model/number_text.h>
#include <signorini/core/response/accuracy.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace signorini {
namespace {

std::array<std::pair<const char*, Accuracy>, 4> positions() {
  return {{{"preview", Accuracy::preview()},
           {"game", Accuracy::game()},
           {"engineering", Accuracy::engineering()},
           {"reference", Accuracy::reference()}}};
}

}  // namespace

Accuracy::Accuracy(double residual) : residual_(residual) {
  if (!(residual > 0.0) || !std::isfinite(residual)) {
    throw std::invalid_argument("accuracy: residual: must be finite and > 0, got " +
                                number_text(residual) + " m/s");
  }
}

Accuracy Accuracy::named(const std::string& text) {
  for (const auto& [name, accuracy] : positions()) {
    if (text == name) {
      return accuracy;
    }
  }
  char* end = nullptr;
  const double residual = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size()) {
    throw std::invalid_argument(
        "accuracy: must be preview, game, engineering, reference or a residual in m/s, got '" +
        text + "'");
  }
  return Accuracy(residual);
}

std::string Accuracy::name() const {
  for (const auto& [name, accuracy] : positions()) {
    if (*this == accuracy) {
      return name;
    }
  }
  return number_text(residual_) + " m/s";
}

void StepBudget::validate() const {
  if (!(work >= 0.0)) {
    throw std::invalid_argument("step budget: work: must be >= 0, got " + number_text(work) +
                                " units");
  }
  if (!(seconds > 0.0)) {
    throw std::invalid_argument("step budget: seconds: must be > 0, got " + number_text(seconds) +
                                " s");
  }
}

}  // namespace signorini
