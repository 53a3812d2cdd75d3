#pragma once

#include <signorini/lcp/problem.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace signorini::bench {

/// What a solver says of its own answer.
enum class Claim : unsigned char {
  kNothing,  ///< it has no opinion: it swept as often as it was told
  kSolved,
  kFailed,
};

/// What a solver returns. Counters start at -1: "it does not say".
struct PeerAnswer {
  Claim claim = Claim::kNothing;
  std::string said;  ///< its own word: a status, a return code
  lcp::Vector z;     ///< n numbers, or empty
  int iterations = -1;
  int pivots = -1;
  int factorizations = -1;
};

/// A solver that is to be compared, ours or another library's. One life: load() once, then
/// rewind() and solve() any number of times. Only solve() is timed.
class Peer {
 public:
  virtual ~Peer() = default;

  /// Takes the problem over into the library's own types: the library gets the very numbers of
  /// the problem (formed, where it takes no factors). Not timed.
  virtual void load(const lcp::Problem& problem) = 0;
  /// Puts back what a solve destroys. Not timed.
  virtual void rewind() {}
  /// Solves from z = 0.
  virtual void solve(PeerAnswer& answer) = 0;
  /// For a method that stops at no accuracy of its own: how often it is to sweep. The runner
  /// doubles it until the answer is good enough.
  virtual void set_sweeps(int /*sweeps*/) {}
};

/// How accurate a solver is to be, in its own terms.
struct PeerSettings {
  double tolerance = 1e-8;   ///< natural residual, dimensionless
  double time_limit = 60.0;  ///< s, for solvers that can be told
};

/// A solver by name.
struct PeerEntry {
  std::string name;                 ///< "ode-dantzig"
  std::string library;              ///< "Signorini", "Bullet", "Bullet float", "ODE", ...
  bool needs_dense = true;          ///< it takes n^2 numbers
  bool counts_sweeps = false;       ///< see Peer::set_sweeps()
  bool may_be_regularised = false;  ///< a Dantzig: worth trying with A_ii (1 + 1e-10)
  /// Why it cannot take this problem, or empty.
  std::function<std::string(const lcp::Problem& problem)> refuses;
  std::function<std::unique_ptr<Peer>(const PeerSettings& settings)> make;
  /// A program that is given a PeerTask and the solver's name, for a library that cannot be in this
  /// one; empty: `make` and this one.
  std::filesystem::path program = {};
};

/// Adds the solvers of one library; those that this build has are called by all_peers().
void add_signorini_peers(std::vector<PeerEntry>& entries);
void add_bullet_peers(std::vector<PeerEntry>& entries);
/// The same in single precision, in a program of its own beside this one
/// (bullet_float_peer_main.cpp); none where that was not built.
void add_bullet_float_peers(std::vector<PeerEntry>& entries);
void add_ode_peers(std::vector<PeerEntry>& entries);
void add_dart_peers(std::vector<PeerEntry>& entries);
void add_siconos_peers(std::vector<PeerEntry>& entries);

/// Every solver of this build, ours first.
[[nodiscard]] std::vector<PeerEntry> all_peers();

/// The libraries that this build was made without, and the Debian package of each.
struct AbsentPeer {
  std::string library;
  std::string package;
};
[[nodiscard]] std::vector<AbsentPeer> absent_peers();

/// A_ii is multiplied by this in the variants called NAME+reg.
inline constexpr double kRegularisation = 1.0 + 1e-10;

/// M with the diagonal times kRegularisation, dense; the rest as it is.
[[nodiscard]] lcp::Problem regularised(const lcp::Problem& problem);

/// What several libraries refuse. Each returns a reason or nothing.
[[nodiscard]] std::string refuses_all_but_lcp(const lcp::Problem& problem);
[[nodiscard]] std::string refuses_cones(const lcp::Problem& problem);
/// Symmetric M, 0 in [lower, upper], any bounds and coupled limits; no cones.
[[nodiscard]] std::string refuses_all_but_symmetric_boxes(const lcp::Problem& problem);
/// As above, any M with a diagonal.
[[nodiscard]] std::string refuses_all_but_boxes(const lcp::Problem& problem);

/// Bounds and friction couplings row by row, as ODE, DART and Bullet want them: of a coupled row
/// lower = -mu, upper = mu, and normal_row says of whom; else normal_row = -1.
struct RowBounds {
  lcp::Vector lower;
  lcp::Vector upper;
  std::vector<int> normal_row;
};
[[nodiscard]] RowBounds row_bounds(const lcp::Problem& problem);

}  // namespace signorini::bench
