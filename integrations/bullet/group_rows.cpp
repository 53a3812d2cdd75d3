#include <signorini/integrations/bullet/group_rows.h>

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace signorini::bullet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Eigen::Vector3d ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
btVector3 theirs(const double* v) {
  return {btScalar(v[0]), btScalar(v[1]), btScalar(v[2])};
}

/// Joints that nothing limits carry a bound of Bullet's largest number.
double bound(btScalar limit) {
  return std::abs(limit) >= BT_LARGE_FLOAT ? std::copysign(kInfinity, double(limit))
                                           : double(limit);
}

/// W of a body: 1/m and I^-1 between its linear and angular factors. Symmetric to the bit.
Matrix6 inverse_mass(const btSolverBody& body) {
  const Eigen::Vector3d linear = ours(body.m_linearFactor);
  const Eigen::Vector3d angular = ours(body.m_angularFactor);
  const btMatrix3x3& inverse = body.m_originalBody->getInvInertiaTensorWorld();
  Matrix6 W = Matrix6::Zero();
  for (int i = 0; i < 3; ++i) {
    W(i, i) = linear[i] * double(body.m_originalBody->getInvMass()) * linear[i];
    for (int j = 0; j <= i; ++j) {
      const double mean = 0.5 * (double(inverse[i][j]) + double(inverse[j][i]));
      W(3 + i, 3 + j) = angular[i] * mean * angular[j];
      W(3 + j, 3 + i) = W(3 + i, 3 + j);
    }
  }
  return W;
}

/// Columns R with W = R R^T, as many as W has directions in which it moves.
int root_columns(const Matrix6& W, Matrix6& root) {
  constexpr double kNothing = 1e-14;  // of the largest: rounding of the inverse inertia
  root.setZero();
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    if (W(i, i) > 0.0) {
      root(i, count++) = std::sqrt(W(i, i));
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(W.bottomRightCorner<3, 3>());
  const double most = eigen.eigenvalues().cwiseAbs().maxCoeff();
  for (int i = 0; i < 3; ++i) {
    if (eigen.eigenvalues()[i] > kNothing * most) {
      root.block<3, 1>(3, count++) =
          std::sqrt(eigen.eigenvalues()[i]) * eigen.eigenvectors().col(i);
    }
  }
  return count;
}

bool is_full(const Matrix6& W) {
  return W.diagonal().minCoeff() > 0.0 &&
         Eigen::LLT<Eigen::Matrix3d>(W.bottomRightCorner<3, 3>()).info() == Eigen::Success;
}

/// The end-of-step velocity that a row is short of, as q.
double row_q(const btSolverConstraint& row) {
  return -double(row.m_rhs) / double(row.m_jacDiagABInv);
}

/// What torques add in the step to the row's velocity.
double torque_part(const btSolverConstraint& row,
                   const btAlignedObjectArray<btSolverBody>& bodies) {
  const auto part = [](const btSolverBody& body, const btVector3& arm) {
    return body.m_originalBody != nullptr ? double(arm.dot(body.m_externalTorqueImpulse)) : 0.0;
  };
  return part(bodies[row.m_solverBodyIdA], row.m_relpos1CrossNormal) +
         part(bodies[row.m_solverBodyIdB], row.m_relpos2CrossNormal);
}

/// The direction of a friction row, whichever of its bodies can move.
btVector3 direction(const btSolverConstraint& row) {
  return row.m_contactNormal1.isZero() ? -row.m_contactNormal2 : row.m_contactNormal1;
}

}  // namespace

bool GroupRows::is_movable(int body) const {
  const btSolverBody& solver_body = (*pools_.bodies)[body];
  return solver_body.m_originalBody != nullptr && solver_body.m_originalBody->getInvMass() > 0 &&
         !(solver_body.m_linearFactor.isZero() && solver_body.m_angularFactor.isZero());
}

/// False for a row along directions in which no body of its may move.
bool GroupRows::moves_something(const btSolverConstraint& row) const {
  const auto moves = [&](int id, const btVector3& linear, const btVector3& angular) {
    const btSolverBody& body = (*pools_.bodies)[id];
    return bodies_[id].island != -1 &&
           !((linear * body.m_linearFactor).isZero() && (angular * body.m_angularFactor).isZero());
  };
  return row.m_jacDiagABInv != 0 &&
         (moves(row.m_solverBodyIdA, row.m_contactNormal1, row.m_relpos1CrossNormal) ||
          moves(row.m_solverBodyIdB, row.m_contactNormal2, row.m_relpos2CrossNormal));
}

int GroupRows::root_of(int body) {
  while (bodies_[body].parent != body) {
    bodies_[body].parent = bodies_[bodies_[body].parent].parent;
    body = bodies_[body].parent;
  }
  return body;
}

void GroupRows::join(const btSolverConstraint& row) {
  if (bodies_[row.m_solverBodyIdA].island != -1 && bodies_[row.m_solverBodyIdB].island != -1) {
    const int a = root_of(row.m_solverBodyIdA);
    const int b = root_of(row.m_solverBodyIdB);
    bodies_[std::max(a, b)].parent = std::min(a, b);
  }
}

int GroupRows::island_of(const btSolverConstraint& row) const {
  const int a = bodies_[row.m_solverBodyIdA].island;
  return a >= 0 ? a : bodies_[row.m_solverBodyIdB].island;
}

void GroupRows::sort_rows(const btConstraintArray& rows, Members& members) const {
  members.start.assign(island_count_ + 1, 0);
  for (int i = 0; i < rows.size(); ++i) {
    if (const int island = island_of(rows[i]); island >= 0) {
      ++members.start[island + 1];
    }
  }
  for (int island = 0; island < island_count_; ++island) {
    members.start[island + 1] += members.start[island];
  }
  members.items.resize(members.start.back());
  for (int i = rows.size() - 1; i >= 0; --i) {  // filled from behind: starts end as they should
    if (const int island = island_of(rows[i]); island >= 0) {
      members.items[--members.start[island + 1]] = i;
    }
  }
  for (int island = 0; island < island_count_; ++island) {
    members.start[island] = members.start[island + 1];
  }
  members.start[island_count_] = static_cast<int>(members.items.size());
}

void GroupRows::read(const SolverPools& pools) {
  pools_ = pools;
  bodies_.resize(pools.bodies->size());
  for (int i = 0; i < pools.bodies->size(); ++i) {
    bodies_[i] = {.parent = i, .island = is_movable(i) ? 0 : -1, .block = -1};
  }
  for (int i = 0; i < pools.joints->size(); ++i) {
    join((*pools.joints)[i]);
  }
  for (int i = 0; i < pools.contacts->size(); ++i) {
    join((*pools.contacts)[i]);
  }
  // Islands are numbered by their first bodies; a root is the first body of its set.
  island_count_ = 0;
  for (int i = 0; i < pools.bodies->size(); ++i) {
    if (bodies_[i].island != -1) {
      const int root = root_of(i);
      bodies_[i].island = root == i ? island_count_++ : bodies_[root].island;
    }
  }
  sort_rows(*pools.joints, joints_);
  sort_rows(*pools.contacts, contacts_);
  sort_rows(*pools.rolling, rolling_);
  row_of_contact_.assign(pools.contacts->size(), -1);
  has_rolling_.assign(pools.contacts->size(), false);
  for (int i = 0; i < pools.rolling->size(); ++i) {
    has_rolling_[(*pools.rolling)[i].m_frictionIndex] = true;
  }
}

void GroupRows::start(IslandProblem& out) {
  if (!std::holds_alternative<lcp::FactoredMatrix>(out.problem.M)) {
    out.problem.M = lcp::FactoredMatrix();
  }
  std::get<lcp::FactoredMatrix>(out.problem.M).clear();
  out.problem.cones.clear();
  out.problem.limits.clear();
  out.rows.clear();
  out.blocks.clear();
  out.contact_count = 0;
  out.joint_row_count = 0;
  out.bad.clear();
  q_.clear();
  lower_.clear();
  upper_.clear();
  warm_.clear();
}

int GroupRows::block_of(int body, IslandProblem& out) {
  if (bodies_[body].island == -1) {
    return -1;
  }
  if (bodies_[body].block < 0) {
    auto& A = std::get<lcp::FactoredMatrix>(out.problem.M);
    IslandProblem::BodyBlock& block = out.blocks.emplace_back();
    block.solver_body = body;
    Matrix6 W = inverse_mass((*pools_.bodies)[body]);
    if (!W.allFinite()) {
      out.bad = "inverse mass or inertia of a body is not finite";
      W.setIdentity();
    }
    block.has_root = !is_full(W);
    if (block.has_root) {
      const int count = root_columns(W, block.root);
      bodies_[body].block = A.mass.add_inverse(Matrix6::Identity().topLeftCorner(count, count));
    } else {
      bodies_[body].block = A.mass.add_inverse(W);
    }
    touched_.push_back(body);
  }
  return bodies_[body].block;
}

void GroupRows::add_entry(int body, const btVector3& linear, const btVector3& angular,
                          IslandProblem& out) {
  const int block = block_of(body, out);
  if (block < 0) {
    return;
  }
  auto& A = std::get<lcp::FactoredMatrix>(out.problem.M);
  Vector6 values;
  values << ours(linear), ours(angular);
  if (out.blocks[block].has_root) {
    values = (out.blocks[block].root.transpose() * values).eval();
  }
  A.add_entry(block, values.head(A.mass.dimension(block)));
}

int GroupRows::add_row(btSolverConstraint& row, double q, double lower, double upper,
                       IslandProblem& out) {
  auto& A = std::get<lcp::FactoredMatrix>(out.problem.M);
  double compliance = double(row.m_cfm) / double(row.m_jacDiagABInv);
  if (!(compliance >= 0.0 && std::isfinite(compliance))) {
    out.bad = "cfm of a row must be finite and >= 0, got " + std::to_string(double(row.m_cfm));
    compliance = 0.0;
  }
  const int number = A.add_row(compliance);
  add_entry(row.m_solverBodyIdA, row.m_contactNormal1, row.m_relpos1CrossNormal, out);
  add_entry(row.m_solverBodyIdB, row.m_contactNormal2, row.m_relpos2CrossNormal, out);
  out.rows.push_back(&row);
  q_.push_back(q);
  lower_.push_back(lower);
  upper_.push_back(upper);
  warm_.push_back(0.0);
  return number;
}

void GroupRows::add_contact(int contact, FrictionModel friction, const FrictionImpulses* last,
                            IslandProblem& out) {
  btSolverConstraint& normal = (*pools_.contacts)[contact];
  normal.m_appliedImpulse = btScalar(0);
  for (int i = normal.m_frictionIndex; i < normal.m_frictionIndex + 2; ++i) {
    (*pools_.friction)[i].m_appliedImpulse = btScalar(0);
  }
  if (!moves_something(normal)) {
    return;
  }
  const int row = add_row(normal, row_q(normal), 0.0, kInfinity, out);
  ++out.contact_count;
  row_of_contact_[contact] = row;
  const auto& point = *static_cast<const btManifoldPoint*>(normal.m_originalContactPoint);
  if (last != nullptr) {
    warm_[row] = double(point.m_appliedImpulse);
  }
  if (has_rolling_[contact]) {
    friction = FrictionModel::kBox;  // limits name normal rows that are in no cone
  }
  int tangents = 0;
  double coefficient = 0.0;
  for (int i = normal.m_frictionIndex; i < normal.m_frictionIndex + 2; ++i) {
    btSolverConstraint& tangent = (*pools_.friction)[i];
    if (!(tangent.m_friction > 0) || !moves_something(tangent)) {
      continue;
    }
    const btVector3 along = direction(tangent);
    coefficient = double(tangent.m_friction);
    const int number = add_row(tangent, row_q(tangent) + torque_part(tangent, *pools_.bodies),
                               -kInfinity, kInfinity, out);
    ++tangents;
    if (last != nullptr) {
      warm_[number] = double((*last)[contact].dot(along) / along.length2());
    }
    if (friction == FrictionModel::kBox) {
      out.problem.limits.push_back({.row = number, .normal_row = row, .coefficient = coefficient});
    }
  }
  if (friction == FrictionModel::kCone && tangents > 0) {
    out.problem.cones.push_back(
        {.normal_row = row, .dimension = 1 + tangents, .coefficient = coefficient});
  }
}

void GroupRows::assemble(int island, FrictionModel friction, const FrictionImpulses* last,
                         IslandProblem& out) {
  start(out);
  for (int k = joints_.start[island]; k < joints_.start[island + 1]; ++k) {
    btSolverConstraint& row = (*pools_.joints)[joints_.items[k]];
    row.m_appliedImpulse = btScalar(0);
    if (moves_something(row)) {
      add_row(row, row_q(row), bound(row.m_lowerLimit), bound(row.m_upperLimit), out);
    }
  }
  out.joint_row_count = static_cast<int>(out.rows.size());
  for (int k = contacts_.start[island]; k < contacts_.start[island + 1]; ++k) {
    add_contact(contacts_.items[k], friction, last, out);
  }
  for (int k = rolling_.start[island]; k < rolling_.start[island + 1]; ++k) {
    btSolverConstraint& row = (*pools_.rolling)[rolling_.items[k]];
    row.m_appliedImpulse = btScalar(0);
    if (row.m_friction > 0 && row_of_contact_[row.m_frictionIndex] >= 0 && moves_something(row)) {
      const int number =
          add_row(row, row_q(row) + torque_part(row, *pools_.bodies), -kInfinity, kInfinity, out);
      out.problem.limits.push_back({.row = number,
                                    .normal_row = row_of_contact_[row.m_frictionIndex],
                                    .coefficient = double(row.m_friction)});
    }
  }
  finish(out);
}

void GroupRows::assemble_push(int island, IslandProblem& out) {
  start(out);
  for (int k = contacts_.start[island]; k < contacts_.start[island + 1]; ++k) {
    btSolverConstraint& row = (*pools_.contacts)[contacts_.items[k]];
    if (row.m_rhsPenetration != 0 && moves_something(row)) {
      add_row(row, -double(row.m_rhsPenetration) / double(row.m_jacDiagABInv), 0.0, kInfinity, out);
      ++out.contact_count;
    }
  }
  finish(out);
}

void GroupRows::finish(IslandProblem& out) {
  const auto copy = [](const std::vector<double>& from, lcp::Vector& to) {
    to = lcp::Vector::Map(from.data(), static_cast<lcp::Index>(from.size()));
  };
  if (!out.rows.empty()) {  // else there is nothing to solve, and a push has often no rows
    copy(q_, out.problem.q);
    copy(lower_, out.problem.lower);
    copy(upper_, out.problem.upper);
    copy(warm_, out.warm_start);
  }
  for (const int body : touched_) {
    bodies_[body].block = -1;
  }
  touched_.clear();
}

template <typename Give>
void GroupRows::give(const IslandProblem& island, const lcp::Vector& z, const Give& give_body) {
  const auto& A = std::get<lcp::FactoredMatrix>(island.problem.M);
  momentum_.resize(A.degrees_of_freedom());
  A.transpose_times(z.data(), momentum_.data());
  for (std::size_t k = 0; k < island.blocks.size(); ++k) {
    const IslandProblem::BodyBlock& block = island.blocks[k];
    const int number = static_cast<int>(k);
    const double* p = momentum_.data() + A.mass.offset(number);
    Vector6 velocity;
    if (block.has_root) {
      const int count = A.mass.dimension(number);
      velocity = block.root.leftCols(count) * Eigen::Map<const Eigen::VectorXd>(p, count);
    } else {
      A.mass.apply_inverse(number, p, velocity.data());
    }
    give_body((*pools_.bodies)[block.solver_body], theirs(velocity.data()),
              theirs(velocity.data() + 3));
  }
}

void GroupRows::write(const IslandProblem& island, const lcp::Vector& z) {
  for (std::size_t i = 0; i < island.rows.size(); ++i) {
    island.rows[i]->m_appliedImpulse = btScalar(z[static_cast<lcp::Index>(i)]);
  }
  give(island, z, [](btSolverBody& body, const btVector3& linear, const btVector3& angular) {
    body.internalGetDeltaLinearVelocity() = linear;
    body.internalGetDeltaAngularVelocity() = angular;
  });
}

void GroupRows::write_push(const IslandProblem& island, const lcp::Vector& z) {
  for (std::size_t i = 0; i < island.rows.size(); ++i) {
    island.rows[i]->m_appliedPushImpulse = btScalar(z[static_cast<lcp::Index>(i)]);
  }
  give(island, z, [](btSolverBody& body, const btVector3& linear, const btVector3& angular) {
    body.internalGetPushVelocity() = linear;
    body.internalGetTurnVelocity() = angular;
  });
}

}  // namespace signorini::bullet
