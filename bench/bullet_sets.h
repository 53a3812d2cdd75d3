#pragma once

#include "bench/bullet_capture.h"
#include "tools/child_process.h"

#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace signorini::bench {

/// A scene in Bullet of which one step's contact set is compared. Unit cubes or spheres of diameter
/// 1, 1 kg, on a large box; dt = 1/60 s; Bullet's default settings, islands not split, so that one
/// group is the whole set.
class BulletScene {
 public:
  /// @param name "stack10", "stack30", "spheres125" or "pyramid10"
  /// @param friction mu of every pair, >= 0
  /// @throws std::invalid_argument listing the names.
  explicit BulletScene(const std::string& name, double friction = 0.0);
  ~BulletScene();
  BulletScene(const BulletScene&) = delete;
  BulletScene& operator=(const BulletScene&) = delete;

  [[nodiscard]] static std::vector<std::string> names();
  /// Steps up to the one that is compared, then shows its contacts to the visitor.
  void visit(const CapturingSolver::Visitor& visitor);

 private:
  struct Parts;
  void add_body(btCollisionShape& shape, double mass, const btVector3& centre);
  std::unique_ptr<Parts> parts_;
};

/// One solver on one captured set.
struct BulletSetRun {
  std::string set;
  int n = 0;
  std::string solver;
  std::string
      outcome;  ///< "ok", "fallback" (Bullet's MLCP solvers: to SI), a status of ours, "T", "C"
  /// max|min(f, w)|, w = d'+ + allowance; with friction max|z_c - P_K(z_c - w~_c)| over the
  /// contacts (certificate.h). In long double; -1: no answer.
  double residual = -1.0;
  double scaled_residual =
      -1.0;                     ///< max|min(A_ii f, w)|, m/s; of a cone its unit-free residual |q|
  double seconds = -1.0;        ///< of the fastest call: setup, solve and write-back
  double solve_seconds = -1.0;  ///< of the solve alone, ours only
  int negative_impulses = 0;
};

struct BulletSetsOptions {
  std::vector<std::string> sets = BulletScene::names();
  double friction = 0.0;     ///< mu
  double tolerance = 1e-11;  ///< asked of our solvers
  int repeats = 20;
  tools::ChildLimits limits = {.seconds = 20.0};
};

/// Bullet's solvers (SI 10, 50, 200, 1000, NNCG 200, Dantzig, Lemke; with friction also SI 200 and
/// 1000 with two friction directions, since Bullet's default has one) and all of ours that take the
/// problem, each in a child process from the same state with zeroed impulses.
[[nodiscard]] std::vector<BulletSetRun> run_bullet_sets(const BulletSetsOptions& options,
                                                        std::ostream* progress);

[[nodiscard]] std::string bullet_sets_csv(const std::vector<BulletSetRun>& runs);
/// A row a solver, a column a set: residual in m/s / microseconds.
[[nodiscard]] std::string bullet_sets_text(const std::vector<BulletSetRun>& runs);

}  // namespace signorini::bench
