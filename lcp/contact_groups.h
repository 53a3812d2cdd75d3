#pragma once

#include <signorini/lcp/friction_cone.h>
#include <signorini/lcp/problem.h>

#include <span>
#include <string>
#include <vector>

namespace signorini::lcp {

/// The groups of a factored problem's rows: a friction cone, an LCP row or a free row each.
class ContactGroups {
 public:
  struct Group {
    int first;      ///< row
    int dimension;  ///< 1: no cone
    double mu;
    bool is_free;
  };

  /// Why a problem has other rows than these, or empty.
  [[nodiscard]] static std::string refuses(const Problem& problem);

  /// Reuses memory. @pre refuses() is empty
  void set(const Problem& problem);

  [[nodiscard]] std::size_t size() const { return groups_.size(); }
  [[nodiscard]] const Group& operator[](std::size_t c) const { return groups_[c]; }
  /// First rows, then the number of rows.
  [[nodiscard]] std::span<const int> starts() const { return starts_; }

  /// Every group's z to the nearest point that its cone or bound allows.
  void clamp(Vector& z) const;
  /// The group's x mirrored at that point, then put inside.
  void reflect(std::size_t c, Vector& x) const;

  /// The larger residual of the certificate at z, in double, or a bound of it; +infinity if not
  /// finite. For a z inside its cone |w~_c| bounds both, whatever the scale of the group, since
  /// projecting shortens distances: no diagonal block is needed where contacts stick, nor where
  /// another group's residual is larger than the bound.
  /// @param w M z + q @param fine bounds up to this are not made sharper
  [[nodiscard]] double residual(const Problem& problem, const Vector& z, const Vector& w,
                                double fine) const;

 private:
  [[nodiscard]] double residual_of(const Problem& problem, const Group& group, const Vector& z,
                                   const Vector& w, double fine) const;

  double q_inf_ = 0.0;
  std::vector<Group> groups_;
  std::vector<int> starts_;
};

}  // namespace signorini::lcp
