#include <signorini/core/response/notes_impulse.h>

#include <cmath>
#include <limits>

namespace signorini {
namespace {

/// Where each group of unknowns starts in z.
struct Layout {
  int n;
  int bounded;  // |C|
  [[nodiscard]] int phi(int i) const { return i; }
  [[nodiscard]] int y(int i) const { return n + i; }
  [[nodiscard]] int gamma(int k) const { return 2 * n + k; }
  [[nodiscard]] int sigma(int i) const { return 2 * n + bounded + i; }
  [[nodiscard]] int tau() const { return 3 * n + bounded; }
  [[nodiscard]] int size() const { return 3 * n + bounded + 1; }
};

/// A matrix that is skew but for the entries on its diagonal.
class NearlySkew {
 public:
  explicit NearlySkew(int size) : size_(size) {}
  void add_pair(int row, int column, double value) {
    triplets_.emplace_back(row, column, value);
    triplets_.emplace_back(column, row, -value);
  }
  void add_diagonal(int row, double value) { triplets_.emplace_back(row, row, value); }
  [[nodiscard]] lcp::SparseMatrix form() const {
    lcp::SparseMatrix matrix(size_, size_);
    matrix.setFromTriplets(triplets_.begin(), triplets_.end());
    return matrix;
  }

 private:
  int size_;
  std::vector<Eigen::Triplet<double>> triplets_;
};

lcp::SparseMatrix assemble(const NormalRows& rows, const lcp::Vector& diagonal,
                           const std::vector<int>& bounded) {
  const int n = rows.A.rows();
  const Layout at{n, static_cast<int>(bounded.size())};
  NearlySkew M(at.size());
  const lcp::SparseMatrix A = rows.A.form();
  for (int j = 0; j < n; ++j) {
    double column_sum = 0.0;
    for (lcp::SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      const double b = entry.value() / diagonal[j];
      M.add_pair(at.sigma(static_cast<int>(entry.row())), at.phi(j), -b);
      column_sum += b;
    }
    M.add_pair(at.tau(), at.phi(j), column_sum / n);
  }
  for (int i = 0; i < n; ++i) {
    M.add_diagonal(at.y(i), 1.0);
    M.add_pair(at.sigma(i), at.y(i), 1.0);
    M.add_pair(at.tau(), at.y(i), -1.0 / n);
  }
  for (int k = 0; k < at.bounded; ++k) {
    M.add_pair(at.y(bounded[k]), at.gamma(k), 1.0);
  }
  return M.form();
}

}  // namespace

NotesProblem notes_problem(const NormalRows& rows, const ContactSet& contacts, double threshold,
                           bool bound_every_contact) {
  const int n = rows.A.rows();
  NotesProblem notes;
  rows.A.diagonal(notes.diagonal);
  notes.upper.setConstant(n, std::numeric_limits<double>::infinity());
  lcp::Vector target = rows.d_dot;
  std::vector<int> bounded;
  for (int i = 0; i < n; ++i) {
    const bool colliding = rows.d_dot[i] < -threshold;
    if (colliding) {
      target[i] = -contacts[i].material.restitution * rows.d_dot[i];
    }
    if (colliding || bound_every_contact) {
      notes.upper[i] = std::abs(rows.d_dot[i]);
      bounded.push_back(i);
    }
  }
  const Layout at{n, static_cast<int>(bounded.size())};
  notes.problem.M = assemble(rows, notes.diagonal, bounded);
  notes.problem.q.setZero(at.size());
  for (int i = 0; i < n; ++i) {
    notes.problem.q[at.y(i)] = -target[i];
    notes.problem.q[at.sigma(i)] = -rows.d_dot[i];
  }
  for (int k = 0; k < at.bounded; ++k) {
    notes.problem.q[at.gamma(k)] = notes.upper[bounded[k]];
  }
  notes.problem.q[at.tau()] = rows.d_dot.mean();
  return notes;
}

lcp::Vector notes_impulses(const NotesProblem& notes, const lcp::VectorRef& z) {
  return z.head(notes.diagonal.size()).cwiseQuotient(notes.diagonal);
}

double notes_violation(const NotesProblem& notes, const NormalRows& rows, const lcp::VectorRef& f) {
  const lcp::Vector y = gap_velocities_after(rows, f);
  const double one_sided = -f.cwiseProduct(notes.diagonal).minCoeff();
  const double approach = -y.minCoeff();
  const double above = (y - notes.upper).maxCoeff();
  return std::max({one_sided, approach, above});
}

}  // namespace signorini
