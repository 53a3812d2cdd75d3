#include <signorini/core/response/assembly.h>
#include <signorini/core/response/friction_pyramid.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace signorini {
namespace {

// cos and sin of 2 pi j/k; exact at multiples of 90 degrees, exactly opposite half a turn apart.
std::vector<Eigen::Vector2d> pyramid_directions(int sides) {
  std::vector<Eigen::Vector2d> directions(sides);
  for (int j = 0; j < sides / 2; ++j) {
    const double angle = 2.0 * std::numbers::pi * j / sides;
    directions[j] = {4 * j == sides ? 0.0 : std::cos(angle), std::sin(angle)};
    directions[j + sides / 2] = -directions[j];
  }
  return directions;
}

// Where a row of A over [normals; t1, t2 of each frictional contact; joints] goes in z: itself for
// a normal, the k directions with their cosines or sines for a tangent, behind lambda for a joint.
struct Target {
  int row;
  double factor;
};

std::vector<std::vector<Target>> expansion(int normals, int frictional, int joints,
                                           const std::vector<Eigen::Vector2d>& directions) {
  const int sides = static_cast<int>(directions.size());
  std::vector<std::vector<Target>> targets(normals + 2 * frictional + joints);
  for (int i = 0; i < normals; ++i) {
    targets[i].push_back({i, 1.0});
  }
  for (int c = 0; c < frictional; ++c) {
    for (int axis = 0; axis < 2; ++axis) {
      for (int j = 0; j < sides; ++j) {
        if (directions[j][axis] != 0.0) {
          targets[normals + 2 * c + axis].push_back({normals + sides * c + j, directions[j][axis]});
        }
      }
    }
  }
  for (int j = 0; j < joints; ++j) {
    targets[normals + 2 * frictional + j].push_back({normals + (sides + 1) * frictional + j, 1.0});
  }
  return targets;
}

// M of PyramidProblem from A over [normals; tangents].
lcp::SparseMatrix expand(const lcp::SparseMatrix& A, const ContactSet& contacts,
                         const std::vector<int>& frictional,
                         const std::vector<Eigen::Vector2d>& directions) {
  const int normals = static_cast<int>(contacts.size());
  const int m = static_cast<int>(frictional.size());
  const int sides = static_cast<int>(directions.size());
  const int joints = static_cast<int>(A.rows()) - normals - 2 * m;
  const auto targets = expansion(normals, m, joints, directions);
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < A.outerSize(); ++column) {
    for (lcp::SparseMatrix::InnerIterator it(A, column); it; ++it) {
      for (const Target& to_row : targets[it.row()]) {
        for (const Target& to_column : targets[column]) {
          entries.emplace_back(to_row.row, to_column.row,
                               to_row.factor * to_column.factor * it.value());
        }
      }
    }
  }
  for (int c = 0; c < m; ++c) {
    const int i = frictional[c];
    const int lambda = normals + sides * m + c;
    const double scale = A.coeff(i, i);
    entries.emplace_back(lambda, i, scale * contacts[i].material.friction);
    for (int j = 0; j < sides; ++j) {
      const int beta = normals + sides * c + j;
      entries.emplace_back(lambda, beta, -scale);
      entries.emplace_back(beta, lambda, 1.0);
    }
  }
  const int size = normals + (sides + 1) * m + joints;
  lcp::SparseMatrix M(size, size);
  M.setFromTriplets(entries.begin(), entries.end());
  return M;
}

void check_arguments(const ContactSet& contacts, const lcp::VectorRef& allowance, int sides) {
  if (allowance.size() != static_cast<lcp::Index>(contacts.size())) {
    throw std::invalid_argument("allowance: must have one number a contact (" +
                                std::to_string(contacts.size()) + "), got " +
                                std::to_string(allowance.size()));
  }
  if (sides < 4 || sides % 2 != 0) {
    throw std::invalid_argument("sides: must be even and >= 4, got " + std::to_string(sides));
  }
}

}  // namespace

void assemble_pyramid(const Bodies& bodies, const State& free_state, const ContactSet& contacts,
                      const lcp::VectorRef& allowance, int sides, PyramidProblem& out,
                      std::span<const JointRow> joints, BodyColumns columns) {
  check_arguments(contacts, allowance, sides);
  NormalRows rows;
  BodyPairs joined;
  add_body_pairs(joints, joined);
  assemble_normals(bodies, free_state, contacts, rows, joined, columns);
  out.columns = rows.A.degrees_of_freedom();
  const int normals = static_cast<int>(contacts.size());
  out.sides = sides;
  out.frictional.clear();
  out.frames.clear();
  std::vector<Eigen::Vector2d> slips;  // along t1 and t2
  for (int i = 0; i < normals; ++i) {
    if (contacts[i].material.friction > 0.0) {
      const Vec3 slip = slip_velocity(bodies, free_state, contacts[i]);
      const TangentFrame frame = friction_frame(contacts[i], slip);
      add_tangent_row(free_state, contacts[i], frame.t1, rows);
      add_tangent_row(free_state, contacts[i], frame.t2, rows);
      out.frictional.push_back(i);
      out.frames.push_back(frame);
      slips.emplace_back(frame.t1.dot(slip), frame.t2.dot(slip));
    }
  }

  add_joint_rows(joints, rows);

  const int m = static_cast<int>(out.frictional.size());
  out.problem = {};
  out.problem.q =
      lcp::Vector::Zero(normals + (sides + 1) * m + static_cast<lcp::Index>(joints.size()));
  if (!joints.empty()) {
    set_joint_bounds(velocities_of(bodies, free_state), joints, out.problem);
  }
  out.problem.q.head(normals) = rows.d_dot + allowance;
  if (m == 0) {
    out.problem.M = std::move(rows.A);
    return;
  }
  const std::vector<Eigen::Vector2d> directions = pyramid_directions(sides);
  for (int c = 0; c < m; ++c) {
    for (int j = 0; j < sides; ++j) {
      out.problem.q[normals + sides * c + j] = directions[j].dot(slips[c]);
    }
  }
  out.problem.M = expand(rows.A.form(), contacts, out.frictional, directions);
}

void contact_impulses(const PyramidProblem& pyramid, const ContactSet& contacts,
                      const lcp::VectorRef& z, std::vector<Vec3>& impulses) {
  const int normals = static_cast<int>(contacts.size());
  impulses.resize(normals);
  for (int i = 0; i < normals; ++i) {
    impulses[i] = z[i] * contacts[i].normal;
  }
  const std::vector<Eigen::Vector2d> directions = pyramid_directions(pyramid.sides);
  for (std::size_t c = 0; c < pyramid.frictional.size(); ++c) {
    Eigen::Vector2d friction = Eigen::Vector2d::Zero();
    for (int j = 0; j < pyramid.sides; ++j) {
      friction += z[normals + pyramid.sides * static_cast<int>(c) + j] * directions[j];
    }
    const TangentFrame& frame = pyramid.frames[c];
    impulses[pyramid.frictional[c]] += friction[0] * frame.t1 + friction[1] * frame.t2;
  }
}

std::vector<Vec3> contact_impulses(const PyramidProblem& pyramid, const ContactSet& contacts,
                                   const lcp::VectorRef& z) {
  std::vector<Vec3> impulses;
  contact_impulses(pyramid, contacts, z, impulses);
  return impulses;
}

}  // namespace signorini
