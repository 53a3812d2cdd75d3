#include <signorini/lcp/nncg.h>

#include <algorithm>

namespace signorini::lcp {

std::string_view Nncg::name() const {
  return settings_.precision == Precision::kFloat ? "nncg-float" : "nncg";
}

void Nncg::begin() {
  squared_length_ = 0.0;
  is_first_ = true;
  has_step_ = false;
}

bool Nncg::forget() {
  const bool had_any = squared_length_ > 0.0;
  begin();
  return had_any;
}

template <typename T>
void Nncg::advance(Sweeps<T>& sweeps, Memory<T>& memory) {
  const std::span<T> state = sweeps.state();
  auto& [change, direction] = memory;
  if (has_step_) {  // that the sweep before called for
    const T beta = static_cast<T>(beta_);
    for (std::size_t i = 0; i < state.size(); ++i) {
      const T step = beta * direction[i];
      direction[i] = step + change[i];
      state[i] += step;
    }
  }
  change.assign(state.begin(), state.end());
  sweeps.forward();
  for (std::size_t i = 0; i < state.size(); ++i) {
    change[i] = state[i] - change[i];
  }
  const double before = squared_length_;
  squared_length_ = sweeps.squared_length(change);
  beta_ = squared_length_ / before;
  has_step_ = !is_first_ && beta_ <= 1.0;
  if (is_first_) {
    direction.assign(change.begin(), change.end());
    is_first_ = false;
  } else if (!has_step_) {
    std::fill(direction.begin(), direction.end(), T(0));
  }
}

}  // namespace signorini::lcp
