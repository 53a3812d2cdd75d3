#include <signorini/core/response/joint_stiffness.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace signorini {
namespace {

void add(const Vec3& force, const Vec3& arm, JointLoad& load) {
  load.stiffness +=
      arm.dot(force) * Mat3::Identity() - 0.5 * (force * arm.transpose() + arm * force.transpose());
  load.arm_squared = std::max(load.arm_squared, arm.squaredNorm());
}

/// S in body axes, or zero.
Mat3 excess(const Body& body, const BodyState& state, const JointLoad& load) {
  const Mat3 R = state.q.toRotationMatrix();
  const Mat3 wanted = R.transpose() * load.stiffness * R - body.inertia -
                      body.mass * load.arm_squared * Mat3::Identity();
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(0.5 * (wanted + wanted.transpose()));
  const Vec3 positive = eigen.eigenvalues().cwiseMax(0.0);
  return eigen.eigenvectors() * positive.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

int stiffen(const Bodies& bodies, const State& state, const Joints& joints,
            const std::vector<JointReport>& before, double step, std::vector<JointLoad>& loads,
            Bodies& stiff) {
  loads.assign(bodies.size(), {});
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Joint& joint = joints[i];
    if (joint.kind == JointKind::kBall || joint.kind == JointKind::kHinge) {
      const Vec3 force = step * before[i].impulse;
      add(force, state[joint.body_a].q * joint.anchor_a, loads[joint.body_a]);
      add(-force, state[joint.body_b].q * joint.anchor_b, loads[joint.body_b]);
    }
  }
  int count = 0;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    if (!bodies[k].is_dynamic() || loads[k].stiffness.isZero(0.0)) {
      continue;
    }
    const Mat3 added = excess(bodies[k], state[k], loads[k]);
    if (!added.isZero(0.0)) {
      if (count++ == 0) {
        stiff = bodies;
      }
      stiff[k].inertia += 0.5 * (added + added.transpose());
    }
  }
  return count;
}

}  // namespace signorini
