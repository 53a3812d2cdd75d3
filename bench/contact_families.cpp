#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bench/contact_families.h>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini::bench {
namespace {

using Vec3 = Eigen::Vector3d;
using Random = std::mt19937_64;

using Touch = FamilyScene::Touch;

constexpr int kGround = FamilyScene::kGround;

struct Arrangement {
  std::vector<Vec3> centres;
  std::vector<Touch> touches;
};

/// Four contacts at the corners of the rectangle [x0, x1] x [y0, y1] at height z.
void add_face(Arrangement& a, int below, int above, double x0, double x1, double y0, double y1,
              double z) {
  for (const double x : {x0, x1}) {
    for (const double y : {y0, y1}) {
      a.touches.push_back({below, above, Vec3(x, y, z), Vec3::UnitZ()});
    }
  }
}

Arrangement tower(int boxes, int contacts_a_face, Random& random) {
  std::normal_distribution<double> normal;
  Arrangement a;
  for (int i = 0; i < boxes; ++i) {
    const double x = 0.03 * normal(random);
    const double y = 0.03 * normal(random);
    a.centres.emplace_back(x, y, 0.5 + i);
  }
  for (int i = 0; i < boxes; ++i) {
    Vec3 low = a.centres[i].array() - 0.5;
    Vec3 high = a.centres[i].array() + 0.5;
    if (i > 0) {
      low = low.cwiseMax((a.centres[i - 1].array() - 0.5).matrix());
      high = high.cwiseMin((a.centres[i - 1].array() + 0.5).matrix());
    }
    const double z = i;
    add_face(a, i - 1, i, low.x(), high.x(), low.y(), high.y(), z);
    if (contacts_a_face == 8) {
      const double mx = 0.5 * (low.x() + high.x());
      const double my = 0.5 * (low.y() + high.y());
      for (const auto& [x, y] : {std::pair(mx, low.y()), std::pair(mx, high.y()),
                                 std::pair(low.x(), my), std::pair(high.x(), my)}) {
        a.touches.push_back({i - 1, i, Vec3(x, y, z), Vec3::UnitZ()});
      }
    }
  }
  return a;
}

/// Rows of bricks, each half a brick off the row below; a pyramid gets one brick narrower a row, a
/// wall keeps its width and its bricks touch side by side.
Arrangement bricks(int size, bool wall) {
  Arrangement a;
  std::vector<int> below;
  for (int r = 0; r < size; ++r) {
    std::vector<int> row;
    for (int j = 0; j < (wall ? size : size - r); ++j) {
      const int me = static_cast<int>(a.centres.size());
      const double cx = j + (wall ? 0.5 * (r % 2) : 0.5 * r);
      a.centres.emplace_back(cx, 0.0, r + 0.5);
      if (r == 0) {
        add_face(a, kGround, me, cx - 0.5, cx + 0.5, -0.5, 0.5, 0.0);
      }
      for (const int b : below) {
        const double low = std::max(cx, a.centres[b].x()) - 0.5;
        const double high = std::min(cx, a.centres[b].x()) + 0.5;
        if (high - low > 1e-9) {
          add_face(a, b, me, low, high, -0.5, 0.5, r);
        }
      }
      if (wall && j > 0) {
        for (const double y : {-0.5, 0.5}) {
          for (const double h : {0.0, 1.0}) {
            a.touches.push_back({row.back(), me, Vec3(cx - 0.5, y, r + h), Vec3::UnitX()});
          }
        }
      }
      row.push_back(me);
    }
    below = row;
  }
  return a;
}

Arrangement pyramid3d(int layers) {
  Arrangement a;
  std::map<std::pair<int, int>, int> below;
  for (int r = 0; r < layers; ++r) {
    std::map<std::pair<int, int>, int> layer;
    for (int i = 0; i < layers - r; ++i) {
      for (int j = 0; j < layers - r; ++j) {
        const int me = static_cast<int>(a.centres.size());
        const double cx = i + 0.5 * r;
        const double cy = j + 0.5 * r;
        a.centres.emplace_back(cx, cy, r + 0.5);
        layer[{i, j}] = me;
        if (r == 0) {
          add_face(a, kGround, me, cx - 0.5, cx + 0.5, cy - 0.5, cy + 0.5, 0.0);
          continue;
        }
        for (const int p : {0, 1}) {
          for (const int q : {0, 1}) {
            add_face(a, below.at({i + p, j + q}), me, cx - 0.5 + 0.5 * p, cx + 0.5 * p,
                     cy - 0.5 + 0.5 * q, cy + 0.5 * q, r);
          }
        }
      }
    }
    below = layer;
  }
  return a;
}

/// A loose pile in a box: the `contacts` closest pairs touch (gap and overlap are ignored), in
/// random order.
Arrangement spheres(int contacts, Random& random) {
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  Arrangement a;
  const int count = std::max(2, static_cast<int>(std::lround(contacts / 3.5)));
  const int side = static_cast<int>(std::ceil(std::cbrt(count) - 1e-9));
  for (int i = 0; i < count; ++i) {
    const int z = i / (side * side);
    const double offset = z % 2 == 1 ? 0.5 : 0.0;
    const double x = i % side + offset + 0.2 * uniform(random);
    const double y = (i / side) % side + offset + 0.2 * uniform(random);
    a.centres.emplace_back(x, y, 0.5 + 0.8 * z + 0.1 * uniform(random));
  }
  std::vector<std::pair<double, Touch>> candidates;
  const double wall = side - 0.5;
  for (int i = 0; i < count; ++i) {
    const Vec3& p = a.centres[i];
    for (int j = i + 1; j < count; ++j) {
      const Vec3 d = a.centres[j] - p;
      const double distance = d.norm();
      if (distance < 1.9) {
        candidates.push_back({distance - 1.0, {i, j, p + 0.5 * d, d / distance}});
      }
    }
    const std::array<std::pair<Vec3, double>, 5> sides = {
        std::pair(Vec3(0, 0, 1), p.z() - 0.7), std::pair(Vec3(1, 0, 0), p.x()),
        std::pair(Vec3(-1, 0, 0), wall - p.x()), std::pair(Vec3(0, 1, 0), p.y()),
        std::pair(Vec3(0, -1, 0), wall - p.y())};
    for (const auto& [normal, gap] : sides) {
      candidates.push_back({gap, {kGround, i, p - 0.5 * normal, normal}});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& one, const auto& other) { return one.first < other.first; });
  candidates.resize(std::min<std::size_t>(candidates.size(), contacts));
  for (auto& candidate : candidates) {
    a.touches.push_back(candidate.second);
  }
  std::shuffle(a.touches.begin(), a.touches.end(), random);
  return a;
}

Arrangement arrange(const FamilySpec& spec, Random& random) {
  if (spec.family == "tower4") return tower(spec.size, 4, random);
  if (spec.family == "tower8") return tower(spec.size, 8, random);
  if (spec.family == "pyramid2d") return bricks(spec.size, false);
  if (spec.family == "wall") return bricks(spec.size, true);
  if (spec.family == "pyramid3d") return pyramid3d(spec.size);
  if (spec.family == "spheres") return spheres(spec.size, random);
  std::string known;
  for (const std::string_view name : family_names()) {
    known.append(" ").append(name);
  }
  throw std::invalid_argument("family: must be one of" + known + ", got " +
                              std::string(spec.family));
}

double mass_of(const FamilySpec& spec, int body, Random& random) {
  if (spec.family.starts_with("tower")) {
    return body % 2 == 1 ? spec.mass_ratio : 1.0;
  }
  return std::pow(spec.mass_ratio, std::uniform_real_distribution<double>()(random));
}

/// v*: gravity of one time step, and unless at rest noise and a fall of every seventh body.
lcp::Vector free_velocity(const FamilySpec& spec, int bodies, Random& random) {
  std::normal_distribution<double> normal;
  lcp::Vector v = lcp::Vector::Zero(6 * bodies);
  for (int i = 0; i < bodies; ++i) {
    if (!spec.at_rest) {
      for (int k = 0; k < 6; ++k) {
        v[6 * i + k] = 0.1 * normal(random);
      }
      v[6 * i + 2] -= i % 7 == 6 ? 1.0 : 0.0;
    }
    v[6 * i + 2] -= 9.81 * 0.01;
  }
  return v;
}

constexpr std::array<std::string_view, 6> kFamilies = {"tower4", "tower8",    "pyramid2d",
                                                       "wall",   "pyramid3d", "spheres"};

}  // namespace

std::span<const std::string_view> family_names() {
  return kFamilies;
}

lcp::FactoredMatrix FamilyScene::inverse_mass() const {
  lcp::FactoredMatrix A;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    lcp::Vector inverse(6);
    inverse << Vec3::Constant(1.0 / masses[i]), Vec3::Constant(1.0 / inertias[i]);
    A.mass.add_inverse(lcp::Matrix(inverse.asDiagonal()));
  }
  return A;
}

void FamilyScene::add_row(const Touch& touch, const Vec3& direction, lcp::FactoredMatrix& A) const {
  A.add_row();
  for (const auto& [body, sign] : {std::pair(touch.below, -1.0), std::pair(touch.above, 1.0)}) {
    if (body != kGround) {
      const Vec3 arm = touch.point - centres[body];
      lcp::Vector values(6);
      values << sign * direction, sign * arm.cross(direction);
      A.add_entry(body, values);
    }
  }
}

lcp::Vector FamilyScene::free_row_velocities(const lcp::FactoredMatrix& A) const {
  lcp::Vector velocities(A.rows());
  const lcp::Vector none = lcp::Vector::Zero(A.rows());
  A.times(free_velocity.data(), none.data(), velocities.data());
  return velocities;
}

FamilyScene make_family_scene(const FamilySpec& spec) {
  if (spec.size < 1) {
    throw std::invalid_argument("size: must be >= 1, got " + std::to_string(spec.size));
  }
  if (!(spec.mass_ratio >= 1.0) || !std::isfinite(spec.mass_ratio)) {
    throw std::invalid_argument("mass_ratio: must be finite and >= 1, got " +
                                std::to_string(spec.mass_ratio));
  }
  Random random(spec.seed);
  Arrangement arrangement = arrange(spec, random);
  const int bodies = static_cast<int>(arrangement.centres.size());
  FamilyScene scene;
  scene.centres = std::move(arrangement.centres);
  scene.touches = std::move(arrangement.touches);
  for (int i = 0; i < bodies; ++i) {
    const double mass = mass_of(spec, i, random);
    scene.masses.push_back(mass);
    scene.inertias.push_back(mass * (spec.family == "spheres" ? 0.1 : 1.0 / 6.0));
  }
  scene.free_velocity = free_velocity(spec, bodies, random);
  return scene;
}

lcp::Problem make_family(const FamilySpec& spec) {
  const FamilyScene scene = make_family_scene(spec);
  lcp::FactoredMatrix A = scene.inverse_mass();
  for (const Touch& touch : scene.touches) {
    scene.add_row(touch, touch.normal, A);
  }
  lcp::Problem problem;
  problem.q = scene.free_row_velocities(A);
  problem.M = std::move(A);
  return problem;
}

}  // namespace signorini::bench
