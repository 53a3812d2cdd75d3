#include <signorini/core/model/number_text.h>
#include <signorini/core/response/accuracy.h>

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <system_error>
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
  double residual = 0.0;  // read alike in every locale
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, residual);
  if (read.ec != std::errc() || read.ptr != end) {
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
