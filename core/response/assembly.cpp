#include <signorini/core/response/assembly.h>
#include <signorini/core/response/single_impulse.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

namespace signorini {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr int kNoRow = -1;
constexpr int kMoves = 3;  // columns
constexpr int kTurns = 6;

/// Whether a force at the point along N turns the body, see BodyColumns: |r x N|^2/J_min > eps/m,
/// with the bound J_min >= 4 det J/(tr J)^2, so that it may say yes where the answer is no.
bool turns(const Body& body, const BodyState& state, const Vec3& point, const Vec3& normal) {
  const double turned = (point - state.x).cross(normal).squaredNorm();
  const double trace = body.inertia.trace();
  return turned * body.mass * trace * trace >
         4.0 * std::numeric_limits<double>::epsilon() * body.inertia.determinant();
}

/// kNoRow, kMoves or kTurns of every body.
void count_columns(const Bodies& bodies, const State& state, const ContactSet& contacts,
                   const BodyPairs& joined, BodyColumns columns, std::vector<int>& count) {
  count.assign(bodies.size(), kNoRow);
  const auto mark = [&](int body, int needs) {
    if (bodies[body].is_dynamic()) {
      count[body] = std::max(count[body], needs);
    }
  };
  const auto needs = [&](const Contact& contact, int body, const Vec3& point) {
    const bool six = columns == BodyColumns::kSix || contact.material.friction > 0.0 ||
                     count[body] == kTurns || !bodies[body].is_dynamic();
    return six || turns(bodies[body], state[body], point, contact.normal) ? kTurns : kMoves;
  };
  for (const Contact& contact : contacts) {
    mark(contact.body_a, needs(contact, contact.body_a, contact.point_a));
    mark(contact.body_b, needs(contact, contact.body_b, contact.point_b));
  }
  for (const auto& [a, b] : joined) {
    mark(a, kTurns);
    mark(b, kTurns);
  }
}

/// blockdiag(I / m, J^-1), or its first three columns and rows.
int add_inverse_mass(const Body& body, const BodyState& state, int columns, lcp::BlockMass& mass) {
  Mat6 block = Mat6::Zero();
  block.topLeftCorner<3, 3>().diagonal().setConstant(inverse_mass(body));
  if (columns == kMoves) {
    return mass.add_inverse(block.topLeftCorner<3, 3>());
  }
  block.bottomRightCorner<3, 3>() = inverse_inertia_world(body, state);
  return mass.add_inverse(block);
}

int find_root(std::vector<int>& parent, int i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

}  // namespace

void velocities_of(const Bodies& bodies, const State& state, std::vector<Velocity>& velocities) {
  velocities.clear();
  velocities.reserve(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    velocities.push_back(velocity(bodies[k], state[k]));
  }
}

std::vector<Velocity> velocities_of(const Bodies& bodies, const State& state) {
  std::vector<Velocity> velocities;
  velocities_of(bodies, state, velocities);
  return velocities;
}

double gap_velocity(const std::vector<Velocity>& velocities, const State& state,
                    const Contact& contact) {
  const int a = contact.body_a;
  const int b = contact.body_b;
  const Vec3 u_a = velocities[a].at(contact.point_a - state[a].x);
  const Vec3 u_b = velocities[b].at(contact.point_b - state[b].x);
  return contact.normal.dot(u_a - u_b);
}

double gap_velocity(const Bodies& bodies, const State& state, const Contact& contact) {
  const int a = contact.body_a;
  const int b = contact.body_b;
  const Vec3 u_a = velocity(bodies[a], state[a]).at(contact.point_a - state[a].x);
  const Vec3 u_b = velocity(bodies[b], state[b]).at(contact.point_b - state[b].x);
  return contact.normal.dot(u_a - u_b);
}

lcp::Vector gap_velocities(const Bodies& bodies, const State& state, const ContactSet& contacts) {
  lcp::Vector d_dot(contacts.size());
  if (contacts.empty()) {
    return d_dot;
  }
  const std::vector<Velocity> velocities = velocities_of(bodies, state);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    d_dot[i] = gap_velocity(velocities, state, contacts[i]);
  }
  return d_dot;
}

void gap_velocities(const std::vector<Velocity>& velocities, const State& state,
                    const ContactSet& contacts, std::vector<double>& d_dot) {
  d_dot.clear();
  d_dot.reserve(contacts.size());
  for (const Contact& contact : contacts) {
    d_dot.push_back(gap_velocity(velocities, state, contact));
  }
}

void check_dynamic(const Bodies& bodies, const ContactSet& contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    if (!bodies[contact.body_a].is_dynamic() && !bodies[contact.body_b].is_dynamic()) {
      throw std::invalid_argument(
          "contact " + std::to_string(i) + ": body_a " + std::to_string(contact.body_a) +
          " and body_b " + std::to_string(contact.body_b) + ": at least one must be dynamic");
    }
  }
}

void start_rows(const Bodies& bodies, const State& state, const ContactSet& contacts,
                NormalRows& rows, const BodyPairs& joined, BodyColumns columns) {
  check_dynamic(bodies, contacts);
  rows.A.clear();
  count_columns(bodies, state, contacts, joined, columns, rows.block_of_body);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    int& block = rows.block_of_body[k];
    if (block != kNoRow) {
      block = add_inverse_mass(bodies[k], state[k], block, rows.A.mass);
    }
  }
}

void add_row(const State& state, const Contact& contact, const Vec3& direction, const Vec3& point_a,
             const Vec3& point_b, NormalRows& rows) {
  const auto add_body = [&](int body, const Vec3& along, const Vec3& point) {
    const int block = rows.block_of_body[body];
    if (block == kNoRow) {
      return;
    }
    if (rows.A.mass.dimension(block) == kMoves) {
      rows.A.add_entry(block, along);
      return;
    }
    Vec6 values;
    values << along, (point - state[body].x).cross(along);
    rows.A.add_entry(block, values);
  };
  rows.A.add_row();
  add_body(contact.body_a, direction, point_a);
  add_body(contact.body_b, -direction, point_b);
}

void assemble_normals(const Bodies& bodies, const State& state, const ContactSet& contacts,
                      NormalRows& rows, const BodyPairs& joined, BodyColumns columns) {
  start_rows(bodies, state, contacts, rows, joined, columns);
  for (const Contact& contact : contacts) {
    add_row(state, contact, contact.normal, contact.point_a, contact.point_b, rows);
  }
  rows.d_dot = gap_velocities(bodies, state, contacts);
}

lcp::Vector gap_velocities_after(const NormalRows& rows, const lcp::VectorRef& f) {
  lcp::Vector d_dot(rows.d_dot.size());
  rows.A.multiply(f.data(), d_dot.data());
  return d_dot + rows.d_dot;
}

void apply_impulses(const Bodies& bodies, const ContactSet& contacts, const lcp::VectorRef& f,
                    State& state) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    apply_impulse(bodies, contacts[i], f[i], state);
  }
}

void add_body_pairs(const ContactSet& contacts, BodyPairs& pairs) {
  for (const Contact& contact : contacts) {
    pairs.emplace_back(contact.body_a, contact.body_b);
  }
}

std::vector<int> connected_sets(const Bodies& bodies, const ContactSet& contacts) {
  BodyPairs pairs;
  add_body_pairs(contacts, pairs);
  return LinkedSets().find(bodies, pairs);
}

const std::vector<int>& LinkedSets::find(const Bodies& bodies, const BodyPairs& links) {
  parent_.resize(bodies.size());
  std::iota(parent_.begin(), parent_.end(), 0);
  for (const auto& [a, b] : links) {
    if (bodies[a].is_dynamic() && bodies[b].is_dynamic()) {
      parent_[find_root(parent_, a)] = find_root(parent_, b);
    }
  }
  number_of_root_.assign(bodies.size(), -1);
  set_of_link_.clear();
  int sets = 0;
  for (const auto& [a, b] : links) {
    int& number = number_of_root_[find_root(parent_, bodies[a].is_dynamic() ? a : b)];
    if (number < 0) {
      number = sets++;
    }
    set_of_link_.push_back(number);
  }
  return set_of_link_;
}

}  // namespace signorini
