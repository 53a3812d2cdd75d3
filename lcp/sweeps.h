#pragma once

#include <signorini/lcp/types.h>

#include <algorithm>
#include <limits>
#include <span>

namespace signorini::lcp {

/// A row of a problem, as a sweep needs it.
struct SweepRow {
  double q;
  double lower;
  double upper;
  double scale;         ///< D_i of the certificate
  double inverse;       ///< 1 / M_ii, or 0 where there is no usable diagonal
  double coefficient;   ///< mu of a coupled row
  int normal_row = -1;  ///< of a coupled row, else -1
};

/// scale and inverse of a row, from M_ii.
inline void set_diagonal(SweepRow& row, double diagonal) {
  row.scale = diagonal > 0.0 ? diagonal : 1.0;
  row.inverse = diagonal > 0.0 && 1.0 / diagonal <= 1e308 ? 1.0 / diagonal : 0.0;
}

/// z of a row without a usable diagonal: the bound that w points to, if it is finite.
template <typename T>
T pushed_to_bound(T z, T w, T lower, T upper) {
  const T limit = std::numeric_limits<T>::max();
  const T target = w > T(0) ? lower : w < T(0) ? upper : z;
  return std::clamp(target >= -limit && target <= limit ? target : z, lower, upper);
}

/// Projected relaxation steps over the rows of a problem, z_i <- clamp(z_i - omega w_i / M_ii),
/// each with the newest z of the others; T is the type of the iterate, double or float. Kept beside
/// z is a linear function of it that makes w_i cheap.
template <typename T>
class Sweeps {
 public:
  virtual ~Sweeps() = default;

  /// Takes z, which is in its bounds.
  virtual void start(const Vector& z) = 0;
  virtual void forward() = 0;   ///< the first row first
  virtual void backward() = 0;  ///< the last row first
  /// z of now; rounded to T.
  virtual void read(Vector& z) const = 0;
  /// Recomputes what is kept from z, and w = M z + q in T from that.
  virtual void refresh(Vector& w) = 0;

  /// z in the coordinates of the sweeps, and what is kept: linear combinations of states are
  /// states.
  [[nodiscard]] virtual std::span<T> state() = 0;
  /// The sum of M_ii dz_i^2, each M_ii perhaps rounded to a power of four, over the difference dz
  /// of two states. Unit-free up to one factor.
  [[nodiscard]] virtual double squared_length(std::span<const T> difference) const = 0;
};

}  // namespace signorini::lcp
