#include <signorini/core/model/contact_kinematics.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace signorini {
namespace {

// Relative to the unit entries of the system: the sine between "not parallel" edges, and, in
// metres, the radius plus gap over which a sharp feature may still turn its normal.
constexpr double kRankThreshold = 1e-9;
// The sine below which a principal direction counts as being along N.
constexpr double kAlongNormal = 1e-9;

// Velocities in the tangent plane.
struct TangentRates {
  Vec3 n_a;  // w_A x N
  Vec3 n_b;  // w_B x N
  Vec3 u_t;  // tangential part of u_A - u_B
};

// What follows from them.
struct NormalMotion {
  Vec3 n;    // N'
  Vec3 s_a;  // the contact point's velocity over A
  Vec3 s_b;  // and over B
  bool degenerate = false;
};

struct PrincipalDirection {
  Vec3 direction;
  double radius;
};

struct PrincipalDirections {
  PrincipalDirection along;
  PrincipalDirection across;
  bool degenerate = false;
};

PrincipalDirections principal_directions(const LocalSurface& surface, const Vec3& N) {
  const Vec3 tangent = surface.direction - N.dot(surface.direction) * N;
  const double length = tangent.norm();
  const bool isotropic = surface.radius_along == surface.radius_across;
  const bool usable = length > kAlongNormal;
  const Vec3 t = usable ? Vec3(tangent / length) : N.unitOrthogonal();
  return {{t, surface.radius_along}, {N.cross(t), surface.radius_across}, !usable && !isotropic};
}

Mat3 finite_radii(const PrincipalDirections& surface) {
  Mat3 rho = Mat3::Zero();
  for (const PrincipalDirection& p : {surface.along, surface.across}) {
    if (std::isfinite(p.radius)) {
      rho += p.radius * p.direction * p.direction.transpose();
    }
  }
  return rho;
}

NormalMotion on_face(const Contact& contact, const TangentRates& rates) {
  const bool owner_is_a = contact.owner == NormalOwner::kFaceA;
  NormalMotion motion;
  motion.n = owner_is_a ? rates.n_a : rates.n_b;
  const PrincipalDirections other =
      principal_directions(owner_is_a ? contact.surface_b : contact.surface_a, contact.normal);
  const Vec3 slip = contact.gap * motion.n - rates.u_t;  // s_A - s_B
  if (owner_is_a) {
    motion.s_b = finite_radii(other) * (motion.n - rates.n_b);
    motion.s_a = slip + motion.s_b;
  } else {
    motion.s_a = finite_radii(other) * (rates.n_a - motion.n);
    motion.s_b = motion.s_a - slip;
  }
  motion.degenerate = other.degenerate;
  return motion;
}

// Unknowns n and, for every flat direction t of a surface, the wandering speed along it:
//
//     (rho_A + rho_B + d) n - sum_A t s + sum_B t s = u_T + rho_A n_A + rho_B n_B
//     t.n = n_X.t
//
// in coordinates of the tangent plane, the rho without their infinite radii.
NormalMotion between_surfaces(const Contact& contact, const LocalSurface& surface_a,
                              const LocalSurface& surface_b, const TangentRates& rates) {
  const Vec3& N = contact.normal;
  const PrincipalDirections a = principal_directions(surface_a, N);
  const PrincipalDirections b = principal_directions(surface_b, N);
  const Mat3 rho_a = finite_radii(a);
  const Mat3 rho_b = finite_radii(b);
  Eigen::Matrix<double, 3, 2> T;
  T.col(0) = N.unitOrthogonal();
  T.col(1) = N.cross(T.col(0));

  struct FlatDirection {
    Vec3 t;
    double sign;  // of its wandering speed in the first equation
    double rate;  // n_X.t
  };
  std::vector<FlatDirection> flats;
  flats.reserve(4);
  for (const PrincipalDirection& p : {a.along, a.across}) {
    if (!std::isfinite(p.radius)) flats.push_back({p.direction, -1.0, rates.n_a.dot(p.direction)});
  }
  for (const PrincipalDirection& p : {b.along, b.across}) {
    if (!std::isfinite(p.radius)) flats.push_back({p.direction, 1.0, rates.n_b.dot(p.direction)});
  }

  using System = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
  using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
  const int size = 2 + static_cast<int>(flats.size());
  System system = System::Zero(size, size);
  Unknowns right(size);
  const Eigen::Matrix2d H = T.transpose() * (rho_a + rho_b + contact.gap * Mat3::Identity()) * T;
  const double scale = std::max(1.0, H.cwiseAbs().maxCoeff());  // m; keeps every entry within 1
  system.topLeftCorner<2, 2>() = H / scale;
  right.head<2>() = T.transpose() * (rates.u_t + rho_a * rates.n_a + rho_b * rates.n_b) / scale;
  for (int i = 2; i < size; ++i) {
    const FlatDirection& flat = flats[i - 2];
    system.block<2, 1>(0, i) = flat.sign * T.transpose() * flat.t;
    system.block<1, 2>(i, 0) = flat.t.transpose() * T;
    right[i] = flat.rate;
  }
  Eigen::CompleteOrthogonalDecomposition<System> factor;
  factor.setThreshold(kRankThreshold);
  factor.compute(system);
  const Unknowns solution = factor.solve(right);

  NormalMotion motion;
  motion.n = T * solution.head<2>();
  motion.s_a = rho_a * (rates.n_a - motion.n);
  motion.s_b = rho_b * (motion.n - rates.n_b);
  for (int i = 2; i < size; ++i) {
    (flats[i - 2].sign < 0.0 ? motion.s_a : motion.s_b) += scale * solution[i] * flats[i - 2].t;
  }
  motion.degenerate = a.degenerate || b.degenerate || factor.rank() < size;
  return motion;
}

NormalMotion normal_motion(const Contact& contact, const TangentRates& rates) {
  switch (contact.owner) {
    case NormalOwner::kFaceA:
    case NormalOwner::kFaceB: return on_face(contact, rates);
    case NormalOwner::kEdgeEdge:
      return between_surfaces(contact, LocalSurface::edge(contact.surface_a.direction),
                              LocalSurface::edge(contact.surface_b.direction), rates);
    case NormalOwner::kCurved:
      return between_surfaces(contact, contact.surface_a, contact.surface_b, rates);
  }
  throw std::invalid_argument("contact: owner: not one of face A, face B, edge-edge, curved");
}

}  // namespace

GapKinematics gap_kinematics(const Contact& contact, const BodyState& a, const Velocity& velocity_a,
                             const BodyState& b, const Velocity& velocity_b) {
  const Vec3& N = contact.normal;
  const Vec3 u = velocity_a.at(contact.point_a - a.x) - velocity_b.at(contact.point_b - b.x);
  GapKinematics gap;
  gap.d = contact.gap;
  gap.d_dot = N.dot(u);
  const TangentRates rates{velocity_a.angular.cross(N), velocity_b.angular.cross(N),
                           u - gap.d_dot * N};
  const NormalMotion motion = normal_motion(contact, rates);
  gap.normal_dot = motion.n;
  gap.curvature_acceleration =
      motion.n.dot(rates.u_t) - motion.s_a.dot(rates.n_a) + motion.s_b.dot(rates.n_b);
  gap.wander_a = motion.s_a;
  gap.wander_b = motion.s_b;
  gap.degenerate = motion.degenerate;
  return gap;
}

ContactClass classify(double d_dot, double threshold) {
  if (d_dot < -threshold) {
    return ContactClass::kColliding;
  }
  return d_dot > threshold ? ContactClass::kSeparating : ContactClass::kResting;
}

}  // namespace signorini
