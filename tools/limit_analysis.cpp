#include "tools/limit_analysis.h"

#include <signorini/core/response/tangent_rows.h>

#include <ClpSimplex.hpp>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace signorini {
namespace {

constexpr double kResolution = 1e-9;  // of mu
constexpr double kMostFriction = 1e3;
constexpr double kTolerance = 1e-10;  // of the programmes, in the heaviest weight
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The programme's coefficients, by row and column.
struct Coefficients {
  std::vector<int> rows;
  std::vector<int> columns;
  std::vector<double> values;

  void add(int row, int column, double value) {
    rows.push_back(row);
    columns.push_back(column);
    values.push_back(value);
  }
};

/// Columns: f_i and t_i of every contact, then s. Rows: six a dynamic body, then two a contact.
class Statics {
 public:
  Statics(const Bodies& bodies, const State& state, const ContactSet& contacts, const Vec3& gravity,
          const Vec3& across)
      : bodies_(bodies), state_(state), contact_count_(static_cast<int>(contacts.size())) {
    set_weights(gravity);
    for (int i = 0; i < contact_count_; ++i) {
      const Contact& contact = contacts[i];
      const Vec3 tangent = across.cross(contact.normal).normalized();
      const Vec3 middle = friction_point(contact);
      add_force(contact.body_a, contact.point_a, contact.normal, 2 * i);
      add_force(contact.body_b, contact.point_b, -contact.normal, 2 * i);
      add_force(contact.body_a, middle, tangent, 2 * i + 1);
      add_force(contact.body_b, middle, -tangent, 2 * i + 1);
    }
  }

  /// s(mu) in the heaviest weight; infinity where no forces carry the weights at all.
  [[nodiscard]] double excess(double mu) const {
    const int s_column = 2 * contact_count_;
    Coefficients all = equilibrium_;
    std::vector<double> least = weights_;
    std::vector<double> most = weights_;
    std::vector<double> lower(s_column + 1, -kInfinity);
    lower[s_column] = 0.0;
    for (int i = 0; i < contact_count_; ++i) {
      lower[2 * i] = 0.0;
      for (const double sign : {1.0, -1.0}) {  // sign t - mu f - s <= 0
        const int row = static_cast<int>(most.size());
        all.add(row, 2 * i, -mu);
        all.add(row, 2 * i + 1, sign);
        all.add(row, s_column, -1.0);
        least.push_back(-kInfinity);
        most.push_back(0.0);
      }
    }
    const std::vector<double> upper(lower.size(), kInfinity);
    std::vector<double> objective(lower.size(), 0.0);
    objective[s_column] = 1.0;
    const CoinPackedMatrix matrix(true, all.rows.data(), all.columns.data(), all.values.data(),
                                  static_cast<CoinBigIndex>(all.values.size()));
    ClpSimplex clp;
    clp.setLogLevel(0);
    clp.setPrimalTolerance(kTolerance);
    clp.setDualTolerance(kTolerance);
    clp.loadProblem(matrix, lower.data(), upper.data(), objective.data(), least.data(),
                    most.data());
    clp.initialSolve();
    if (clp.isProvenPrimalInfeasible()) {
      return kInfinity;
    }
    if (!clp.isProvenOptimal()) {
      throw std::runtime_error("limit analysis: Clp ended with status " +
                               std::to_string(clp.status()));
    }
    return clp.objectiveValue();
  }

 private:
  void set_weights(const Vec3& gravity) {
    double heaviest = 0.0;
    for (const Body& body : bodies_) {
      heaviest = std::max(heaviest, body.is_dynamic() ? body.mass : 0.0);
    }
    for (const Body& body : bodies_) {
      first_row_.push_back(static_cast<int>(weights_.size()));
      if (body.is_dynamic()) {
        const Vec3 weight = -body.mass / heaviest * gravity.normalized();
        weights_.insert(weights_.end(), {weight.x(), weight.y(), weight.z(), 0.0, 0.0, 0.0});
      }
    }
  }

  void add_force(int body, const Vec3& point, const Vec3& force, int column) {
    if (!bodies_[body].is_dynamic()) {
      return;
    }
    const Vec3 moment = (point - state_[body].x).cross(force);
    for (int j = 0; j < 3; ++j) {
      equilibrium_.add(first_row_[body] + j, column, force[j]);
      equilibrium_.add(first_row_[body] + 3 + j, column, moment[j]);
    }
  }

  const Bodies& bodies_;
  const State& state_;
  int contact_count_;
  std::vector<int> first_row_;   // of each body
  std::vector<double> weights_;  // what the forces must carry
  Coefficients equilibrium_;
};

}  // namespace

LimitAnalysis critical_friction(const Bodies& bodies, const State& state,
                                const ContactSet& contacts, const Vec3& gravity,
                                const Vec3& across) {
  const Statics statics(bodies, state, contacts, gravity, across);
  LimitAnalysis limit;
  const auto stands = [&](double mu) {
    ++limit.programmes;
    return statics.excess(mu) <= 10.0 * kTolerance;
  };
  double falls = 0.0;
  double holds = 1.0;
  while (!stands(holds)) {
    if (holds > kMostFriction) {
      limit.friction = kInfinity;
      return limit;
    }
    falls = holds;
    holds *= 2.0;
  }
  while (holds - falls > kResolution) {
    const double middle = 0.5 * (falls + holds);
    (stands(middle) ? holds : falls) = middle;
  }
  limit.friction = holds;
  return limit;
}

}  // namespace signorini
