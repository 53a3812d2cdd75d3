#include "bench/fuzz_problems.h"

#include "bench/exactness_families.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace signorini::bench {
namespace {

using lcp::FactoredMatrix;
using lcp::Index;
using lcp::Matrix;
using lcp::Problem;
using lcp::SparseMatrix;
using lcp::Vector;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Every random number of one problem.
class Dice {
 public:
  Dice(std::uint64_t seed, std::int64_t index) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                           static_cast<std::uint32_t>(index),
                           static_cast<std::uint32_t>(index >> 32), 0xf022U};
    random_.seed(sequence);
  }
  int integer(int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random_);
  }
  bool percent(int chance) { return integer(1, 100) <= chance; }
  double normal() { return std::normal_distribution<double>()(random_); }
  double uniform() { return std::uniform_real_distribution<double>()(random_); }
  /// 10^u, u uniform in [-most, most].
  double power(double most) { return std::pow(10.0, most * (2.0 * uniform() - 1.0)); }
  Matrix matrix(Index rows, Index columns) {
    return Matrix::NullaryExpr(rows, columns, [this] { return normal(); });
  }
  Vector vector(Index n) {
    return Vector::NullaryExpr(n, [this] { return normal(); });
  }
  std::mt19937_64 generator() { return std::mt19937_64(random_()); }

 private:
  std::mt19937_64 random_;
};

int draw_size(Dice& dice) {
  return dice.percent(90) ? dice.integer(1, 8) : dice.integer(9, 30);
}

// Where a problem starts.

FuzzProblem made_of(lcp::MatrixForm M, Vector q, std::string recipe) {
  FuzzProblem made;
  made.problem.M = std::move(M);
  made.problem.q = std::move(q);
  made.recipe = std::move(recipe);
  return made;
}

FuzzProblem from_family(Dice& dice) {
  const auto families = exactness_families();
  const ExactnessFamily& family =
      families[static_cast<std::size_t>(dice.integer(0, static_cast<int>(families.size()) - 1))];
  Draw draw(dice.generator());
  return {family.draw(draw), std::string(family.name)};
}

FuzzProblem random_psd(Dice& dice) {
  const int n = draw_size(dice);
  const Matrix G = dice.matrix(dice.integer(1, n), n);
  return made_of(Matrix(G.transpose() * G), dice.vector(n), "random psd");
}

FuzzProblem random_any(Dice& dice) {
  const int n = draw_size(dice);
  return made_of(dice.matrix(n, n), dice.vector(n), "random any");
}

FuzzProblem near_zero(Dice& dice) {
  static constexpr std::array kValues = {0.0,    -0.0,   1e-300, -1e-300, 5e-324, 2.2e-16,
                                         1e-150, -1e-16, 1e150,  1e300,   1.0,    -1.0};
  const auto pick = [&dice] {
    return kValues[static_cast<std::size_t>(dice.integer(0, static_cast<int>(kValues.size()) - 1))];
  };
  const int n = dice.percent(60) ? 1 : 2;
  const Matrix M = Matrix::NullaryExpr(n, n, pick);
  return made_of(M, Vector::NullaryExpr(n, pick), "near zero");
}

FuzzProblem random_factored(Dice& dice) {
  FactoredMatrix A;
  const int blocks = dice.integer(1, 4);
  const double spread = dice.percent(30) ? dice.uniform() * 150.0 : 3.0;
  for (int b = 0; b < blocks; ++b) {
    const int d = dice.percent(50) ? 6 : dice.integer(1, 6);
    const double mass = dice.power(spread);
    if (dice.percent(60)) {
      const Vector inverse = Vector::NullaryExpr(d, [&] { return mass * dice.power(1.0); });
      A.mass.add_inverse(Matrix(inverse.asDiagonal()));
    } else {
      const Matrix G = dice.matrix(d, d);
      A.mass.add_mass(mass * (G * G.transpose() + Matrix::Identity(d, d)));
    }
  }
  const int n = draw_size(dice);
  const bool compliant = dice.percent(15);
  std::vector<std::pair<int, Vector>> last;
  for (int i = 0; i < n; ++i) {
    A.add_row(compliant && dice.percent(50) ? dice.power(6.0) : 0.0);
    if (last.empty() || !dice.percent(25)) {  // else the row before, again
      last.clear();
      const int first = dice.integer(0, blocks - 1);
      const int second = dice.integer(0, blocks - 1);
      for (const int b : {first, second}) {
        if (last.empty() || b != first) {
          last.emplace_back(b, dice.vector(A.mass.dimension(b)));
        }
      }
      if (dice.percent(5)) {
        last.clear();  // a row that moves nothing
      }
    }
    for (const auto& [block, values] : last) {
      A.add_entry(block, values);
    }
  }
  Vector q = dice.vector(n);
  if (dice.percent(50)) {  // q in the range of J, as contacts have it
    const Vector v = dice.vector(A.degrees_of_freedom());
    const Vector none = Vector::Zero(n);
    A.times(v.data(), none.data(), q.data());
  }
  return made_of(std::move(A), std::move(q), "random factored");
}

// What is done to it. Each returns what it did, empty if it does not apply.

/// Calls f with every number of a dense or sparse M. @return false for a factored one.
template <typename F>
bool for_each_entry(lcp::MatrixForm& M, F&& f) {
  if (auto* dense = std::get_if<Matrix>(&M)) {
    for (Index j = 0; j < dense->cols(); ++j) {
      for (Index i = 0; i < dense->rows(); ++i) {
        f(i, j, (*dense)(i, j));
      }
    }
    return true;
  }
  if (auto* sparse = std::get_if<SparseMatrix>(&M)) {
    for (Index j = 0; j < sparse->outerSize(); ++j) {
      for (SparseMatrix::InnerIterator it(*sparse, j); it; ++it) {
        f(it.row(), j, it.valueRef());
      }
    }
    return true;
  }
  return false;
}

const char* scale_units(Dice& dice, Problem& problem) {
  const double most = dice.percent(90) ? 150.0 : 300.0;
  const double of_q = dice.power(most);
  const double of_M = dice.power(most);
  problem.q *= of_q;
  for_each_entry(problem.M, [of_M](Index, Index, double& value) { value *= of_M; });
  return "units scaled";
}

const char* scale_rows(Dice& dice, Problem& problem) {
  const double most = dice.percent(70) ? 6.0 : 70.0;
  const Vector d = Vector::NullaryExpr(problem.size(), [&dice, most] { return dice.power(most); });
  const bool scaled =
      for_each_entry(problem.M, [&d](Index i, Index j, double& value) { value *= d[i] * d[j]; });
  if (scaled) {
    problem.q.array() *= d.array();
  }
  return scaled ? "rows scaled" : "";
}

const char* repeat_row(Dice& dice, Problem& problem) {
  if (std::holds_alternative<FactoredMatrix>(problem.M) || problem.size() < 2) {
    return "";
  }
  Matrix M = lcp::to_dense(problem.M);
  const Index from = dice.integer(0, static_cast<int>(problem.size()) - 1);
  const Index to = dice.integer(0, static_cast<int>(problem.size()) - 1);
  M.col(to) = Vector(M.col(from));
  M.row(to) = Eigen::RowVectorXd(M.row(from));
  problem.q[to] = dice.percent(70) ? problem.q[from] : -problem.q[from];
  problem.M = std::move(M);
  return "row repeated";
}

const char* zero_rows(Dice& dice, Problem& problem) {
  std::vector<bool> zero(problem.size());
  for (Index i = 0; i < problem.size(); ++i) {
    zero[i] = dice.percent(30);
  }
  const bool done = for_each_entry(problem.M, [&zero](Index i, Index j, double& value) {
    value = zero[i] || zero[j] ? 0.0 : value;
  });
  return done ? "zero rows" : "";
}

const char* perturb(Dice& dice, Problem& problem) {
  const double size = dice.percent(50) ? 2.3e-16 : 1e-9;
  const bool done = for_each_entry(
      problem.M, [&](Index, Index, double& value) { value *= 1.0 + size * dice.integer(-1, 1); });
  return done ? "perturbed" : "";
}

const char* make_sparse(Dice&, Problem& problem) {
  if (const auto* dense = std::get_if<Matrix>(&problem.M)) {
    problem.M = SparseMatrix(Matrix(*dense).sparseView());
    return "sparse";
  }
  return "";
}

const char* zero_q(Dice&, Problem& problem) {
  problem.q.setZero();
  return "q = 0";
}

/// q = w - M z for a complementary pair, rounded: a solution nearly exists.
const char* solvable_q(Dice& dice, Problem& problem) {
  Vector z(problem.size());
  Vector w(problem.size());
  for (Index i = 0; i < problem.size(); ++i) {
    const bool active = dice.percent(60);
    z[i] = active ? std::abs(dice.normal()) : 0.0;
    w[i] = active || dice.percent(30) ? 0.0 : std::abs(dice.normal());
  }
  Vector Mz(problem.size());
  lcp::multiply(problem.M, z.data(), Mz.data());
  problem.q = w - Mz;
  return "q solvable";
}

const char* not_finite(Dice& dice, Problem& problem) {
  constexpr std::array kValues = {kNaN, kInfinity, -kInfinity};
  const double value = kValues[static_cast<std::size_t>(dice.integer(0, 2))];
  const Index row = dice.integer(0, static_cast<int>(problem.size()) - 1);
  const Index at = dice.integer(0, static_cast<int>(problem.size()) - 1);
  if (dice.percent(40) || !for_each_entry(problem.M, [&](Index i, Index j, double& entry) {
        entry = i == row && j == at ? value : entry;
      })) {
    problem.q[row] = value;
  }
  return "not finite";
}

const char* bounds(Dice& dice, Problem& problem) {
  const Index n = problem.size();
  problem.lower = Vector::Zero(n);
  problem.upper = Vector::Constant(n, kInfinity);
  for (Index i = 0; i < n; ++i) {
    switch (dice.integer(0, 6)) {
      case 0: problem.lower[i] = -kInfinity; break;  // free
      case 1: problem.upper[i] = std::abs(dice.normal()); break;
      case 2: problem.lower[i] = problem.upper[i] = dice.normal(); break;  // fixed
      case 3:
        problem.lower[i] = -dice.power(dice.percent(80) ? 2.0 : 150.0);
        problem.upper[i] = dice.power(dice.percent(80) ? 2.0 : 150.0);
        break;
      default: break;
    }
  }
  if (dice.percent(4)) {
    problem.lower[0] = 1.0;
    problem.upper[0] = -1.0;
    return "crossed bounds";
  }
  return "bounds";
}

const char* free_rows(Dice& dice, Problem& problem) {
  problem.lower = Vector::Zero(problem.size());
  problem.lower.head(dice.integer(1, static_cast<int>(problem.size()))).setConstant(-kInfinity);
  return "free rows";
}

double friction(Dice& dice) {
  constexpr std::array kValues = {0.0, 1e-10, 0.3, 1.0, 1e6};
  return dice.percent(60) ? dice.uniform() : kValues[static_cast<std::size_t>(dice.integer(0, 4))];
}

/// The same for a cone, whose residual must not shrink with mu.
double cone_friction(Dice& dice) {
  constexpr std::array kValues = {0.0, 1e-10, 0.3, 1.0, 1e6, 1e9, 1e12};
  return dice.percent(60) ? dice.uniform() : kValues[static_cast<std::size_t>(dice.integer(0, 6))];
}

const char* limits(Dice& dice, Problem& problem) {
  const int n = static_cast<int>(problem.size());
  for (int row = 1; row < n; ++row) {
    if (dice.percent(40)) {
      const int normal = dice.integer(0, row - 1);
      const bool coupled = std::any_of(problem.limits.begin(), problem.limits.end(),
                                       [normal](const auto& l) { return l.row == normal; });
      if (!coupled) {
        problem.limits.push_back({row, normal, friction(dice)});
      }
    }
  }
  return problem.limits.empty() ? "" : "coupled limits";
}

/// Tangential rows that nothing moves: their w is exactly 0, as axis-aligned scenes have it.
void still_tangents(Dice& dice, Problem& problem) {
  std::vector<bool> still(problem.size());
  for (lcp::FrictionCone& cone : problem.cones) {
    for (int k = 1; k < cone.dimension; ++k) {
      still[cone.normal_row + k] = true;
      problem.q[cone.normal_row + k] = 0.0;
    }
    cone.coefficient = dice.percent(50) ? 0.0 : cone.coefficient;
  }
  for_each_entry(problem.M, [&still](Index i, Index j, double& value) {
    value = still[i] || still[j] ? 0.0 : value;
  });
}

const char* cones(Dice& dice, Problem& problem) {
  const int n = static_cast<int>(problem.size());
  const int dimension = dice.percent(70) ? 3 : 2;
  for (int row = 0; row + dimension <= n;) {
    if (dice.percent(85)) {
      problem.cones.push_back({row, dimension, cone_friction(dice)});
      row += dimension;
    } else {
      ++row;
    }
  }
  problem.friction_law =
      dice.percent(60) ? lcp::FrictionLaw::kCoulomb : lcp::FrictionLaw::kAssociated;
  if (problem.cones.empty()) {
    return "";
  }
  if (dice.percent(10)) {
    still_tangents(dice, problem);
    return "cones with still tangents";
  }
  return "cones";
}

struct Change {
  int percent;
  const char* (*apply)(Dice& dice, Problem& problem);
};

constexpr std::array kDataChanges = {
    Change{12, &solvable_q},  Change{8, &repeat_row},   Change{6, &zero_rows},
    Change{8, &perturb},      Change{10, &scale_rows},  Change{3, &zero_q},
    Change{15, &scale_units}, Change{25, &make_sparse}, Change{2, &not_finite},
};

constexpr std::array kRowChanges = {Change{12, &bounds}, Change{6, &free_rows}, Change{10, &limits},
                                    Change{14, &cones}};

void note(const char* what, FuzzProblem& made) {
  if (*what != '\0') {
    made.recipe += std::string(", ") + what;
  }
}

FuzzProblem start(Dice& dice) {
  const int kind = dice.integer(1, 100);
  return kind <= 40   ? from_family(dice)
         : kind <= 60 ? random_psd(dice)
         : kind <= 68 ? random_any(dice)
         : kind <= 72 ? near_zero(dice)
                      : random_factored(dice);
}

}  // namespace

FuzzProblem draw_fuzz_problem(std::uint64_t seed, std::int64_t index) {
  Dice dice(seed, index);
  FuzzProblem made = start(dice);
  for (const Change& change : kDataChanges) {
    if (dice.percent(change.percent)) {
      note(change.apply(dice, made.problem), made);
    }
  }
  int chosen = dice.integer(1, 100);  // at most one of the row changes, so that solvers take many
  for (const Change& change : kRowChanges) {
    if (chosen > 0 && chosen <= change.percent) {
      note(change.apply(dice, made.problem), made);
    }
    chosen -= change.percent;
  }
  return made;
}

}  // namespace signorini::bench
