#pragma once

#include <string>
#include <vector>

namespace signorini::bench {

/// A solver's times on a set of problems.
struct ProfileSeries {
  std::string name;
  std::string library;          ///< series of a library share a colour
  std::vector<double> seconds;  ///< one a problem, +infinity: not solved
};

/// Solvers compared on the same problems.
struct ProfilePanel {
  std::string title;
  std::vector<ProfileSeries> series;
};

/// rho_s(tau): the share of all problems that solver s solves within tau times the time of the
/// fastest solver of that problem. Problems that nobody solves count in the share. Source: Dolan
/// and More, Benchmarking optimization software with performance profiles, Mathematical Programming
/// 91 (2002), equation 2.1.
struct ProfileCurve {
  std::string name;
  std::string library;
  std::vector<double> ratios;  ///< ascending, one a solved problem: rho jumps by 1 / problems there
  int problems = 0;
  int fastest = 0;  ///< problems on which it is the fastest
  [[nodiscard]] int solved() const { return static_cast<int>(ratios.size()); }
  /// rho(tau)
  [[nodiscard]] double share(double tau) const;
};

/// The curves, the one that solves most first, then the faster one.
/// @throws std::invalid_argument if the series differ in length.
[[nodiscard]] std::vector<ProfileCurve> profile_curves(const ProfilePanel& panel);

/// The panels below each other as one SVG file, tau on a logarithmic axis, with a legend beside
/// each panel. Needs nothing to be seen: no scripts, no fonts of its own.
[[nodiscard]] std::string performance_profile_svg(const std::vector<ProfilePanel>& panels,
                                                  const std::string& title);

}  // namespace signorini::bench
