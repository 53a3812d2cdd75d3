#pragma once

#include <signorini/integrations/bullet/settings.h>
#include <signorini/lcp/problem.h>

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <Eigen/Core>
#include <string>
#include <vector>

namespace signorini::bullet {

/// What Bullet's set-up makes of one group: its bodies, and its rows by kind. Borrowed.
struct SolverPools {
  btAlignedObjectArray<btSolverBody>* bodies;
  btConstraintArray* joints;
  btConstraintArray* contacts;
  btConstraintArray* friction;  ///< of contact c: from contacts[c].m_frictionIndex on
  btConstraintArray* rolling;   ///< m_frictionIndex names the contact
};

/// One island of a group, a connected set of movable bodies, as a problem of lcp:
///
///     w = J W J^T z + compliance z + q,
///
/// z: the impulses, N s (N m s for angular rows), q: minus the relative velocities that Bullet's
/// set-up asks of its rows (m/s, rad/s), that is -m_rhs / m_jacDiagABInv; compliance = m_cfm /
/// m_jacDiagABInv. These are the equations that Bullet's sequential impulses converge to; only
/// the slip of friction rows is completed by what torques add to it in the step, which Bullet's
/// set-up leaves out.
/// W holds one block a movable body, with its linear and angular factors on both sides.
struct IslandProblem {
  lcp::Problem problem;    ///< M factored; joint rows, then contacts (N, T1, T2), then rolling
  lcp::Vector warm_start;  ///< impulses of the last step: of the contacts; joints 0
  std::vector<btSolverConstraint*> rows;  ///< where the impulses go, row by row
  int contact_count = 0;
  int joint_row_count = 0;
  /// The first number of Bullet's that cannot be worked with, as text, or empty. The problem is
  /// then of no use.
  std::string bad;

  /// One body's part of W: the velocity that an impulse p gives is W p, or root root^T p.
  struct BodyBlock {
    int solver_body;
    bool has_root;  ///< the body cannot move in every direction; root has only those it can
    Eigen::Matrix<double, 6, 6> root;
  };
  std::vector<BodyBlock> blocks;
};

/// The contact point's friction impulse of the last step in world axes, N s: Bullet turns a
/// contact's friction directions in every step.
using FrictionImpulses = std::vector<btVector3>;

/// Reads the rows of a group, island by island, and writes the impulses back. Allocates nothing
/// once capacity was reached.
class GroupRows {
 public:
  /// Finds movable bodies and islands. The pools must stay as they are until the last write.
  void read(const SolverPools& pools);
  [[nodiscard]] int island_count() const { return island_count_; }

  /// The island's rows. Left out, because they cannot act: rows between immovable bodies, rows
  /// that move nothing, tangents without friction.
  /// @param last null (no warm start), or friction impulses by contact
  void assemble(int island, FrictionModel friction, const FrictionImpulses* last,
                IslandProblem& out);
  /// The rows of the split impulse: 0 <= z ⊥ J W J^T z - v >= 0 for the contacts that Bullet pushes
  /// apart from their velocities, v the speed at which they are to separate.
  void assemble_push(int island, IslandProblem& out);

  /// Gives the bodies W J^T z, and the rows their impulses.
  void write(const IslandProblem& island, const lcp::Vector& z);
  /// The same for the push velocities.
  void write_push(const IslandProblem& island, const lcp::Vector& z);

 private:
  struct BodyPart {
    int parent = 0;   // union-find
    int island = -1;  // -1: immovable
    int block = -1;   // in the island being assembled
  };
  /// Rows of an island, as ranges of sorted lists.
  struct Members {
    std::vector<int> start;  // one more than there are islands
    std::vector<int> items;
  };

  [[nodiscard]] bool is_movable(int body) const;
  [[nodiscard]] bool moves_something(const btSolverConstraint& row) const;
  [[nodiscard]] int root_of(int body);
  void join(const btSolverConstraint& row);
  [[nodiscard]] int island_of(const btSolverConstraint& row) const;
  void sort_rows(const btConstraintArray& rows, Members& members) const;
  void start(IslandProblem& out);
  int block_of(int body, IslandProblem& out);
  void add_entry(int body, const btVector3& linear, const btVector3& angular, IslandProblem& out);
  int add_row(btSolverConstraint& row, double q, double lower, double upper, IslandProblem& out);
  void add_contact(int contact, FrictionModel friction, const FrictionImpulses* last,
                   IslandProblem& out);
  void finish(IslandProblem& out);
  template <typename Give>
  void give(const IslandProblem& island, const lcp::Vector& z, const Give& give_body);

  SolverPools pools_{};
  std::vector<BodyPart> bodies_;
  int island_count_ = 0;
  Members joints_, contacts_, rolling_;
  std::vector<int> row_of_contact_;
  std::vector<bool> has_rolling_;  // by contact
  std::vector<int> touched_;       // bodies with a block, to reset
  std::vector<double> q_, lower_, upper_, warm_;
  std::vector<double> momentum_;
};

}  // namespace signorini::bullet
