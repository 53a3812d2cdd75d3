#include <signorini/lcp/integer_tableau.h>

#include <numeric>

namespace signorini::lcp {
namespace {

/// The least s > 0 for which s times every number of the row is an integer.
mpz_class common_denominator(const ExactProblem& problem, int row) {
  mpz_class scale = problem.q[row].get_den();
  for (int j = 0; j < problem.n; ++j) {
    scale = lcm(scale, problem.at(row, j).get_den());
  }
  return scale;
}

mpz_class times(const mpz_class& scale, const mpq_class& value) {
  return scale / value.get_den() * value.get_num();  // no remainder
}

/// The sign of a b - c d.
int compare_products(const mpz_class& a, const mpz_class& b, const mpz_class& c,
                     const mpz_class& d) {
  const mpz_class difference = a * b - c * d;
  return sgn(difference);
}

}  // namespace

IntegerTableau::IntegerTableau(const ExactProblem& problem)
    : n_(problem.n),
      entries_(static_cast<std::size_t>(n_) * (n_ + 1)),
      right_(n_),
      determinant_(1),
      basic_(n_),
      nonbasic_(n_ + 1),
      row_of_(2 * n_ + 1, -1),
      column_of_(2 * n_ + 1, -1) {
  std::iota(basic_.begin(), basic_.end(), 0);
  std::iota(nonbasic_.begin(), nonbasic_.end(), n_);
  for (int i = 0; i < n_; ++i) {
    row_of_[i] = i;
    const mpz_class scale = common_denominator(problem, i);
    for (int j = 0; j < n_; ++j) {
      entry(i, j) = -times(scale, problem.at(i, j));
    }
    entry(i, n_) = -scale;
    right_[i] = times(scale, problem.q[i]);
  }
  for (int j = 0; j <= n_; ++j) {
    column_of_[n_ + j] = j;
  }
  first_basic_ = basic_;
}

bool IntegerTableau::start_from(const std::vector<char>& wanted, const std::vector<int>& cover,
                                const Deadline& deadline) {
  for (int j = 0; j < n_; ++j) {
    if (wanted[j] == 0) {
      continue;
    }
    // z_j replaces any w_i that has to leave: a zero M_jj is no obstacle.
    int row = 0;
    while (row < n_ && (basic_[row] >= n_ || wanted[basic_[row]] == 0 ||
                        sgn(entry(row, column_of_[n_ + j])) == 0)) {
      ++row;
    }
    if (row == n_ || !exchange(row, n_ + j, deadline)) {
      return false;
    }
  }
  // The cover is what B_0 makes of the given one: the column of z0 is that one times -D.
  for (int row = 0; row < n_; ++row) {
    entry(row, column_of_[covering_variable()]) = -cover[row] * determinant_;
  }
  first_basic_ = basic_;
  return true;
}

int IntegerTableau::first_leaving_row() const {
  int smallest = 0;
  for (int i = 1; i < n_; ++i) {
    // q_i / d_i against the smallest so far; d_i = -T_i,z0. Among equals the later row is smaller
    // in its perturbation: (0, .., 0, e^i) / d_i.
    if (compare_products(right_[i], entry(smallest, n_), right_[smallest], entry(i, n_)) >= 0) {
      smallest = i;
    }
  }
  return sgn(right_[smallest]) < 0 ? smallest : -1;
}

const mpz_class& IntegerTableau::perturbation(int row, int k) const {
  const int variable = first_basic_[k];
  if (column_of_[variable] >= 0) {
    return entry(row, column_of_[variable]);
  }
  return row_of_[variable] == row ? determinant_ : zero_;
}

int IntegerTableau::compare_ratios(int row, int other, int column) const {
  return compare_products(right_[row], entry(other, column), right_[other], entry(row, column));
}

bool IntegerTableau::is_lexicographically_less(int row, int other, int column) const {
  for (int k = 0; k < n_; ++k) {
    const int order = compare_products(perturbation(row, k), entry(other, column),
                                       perturbation(other, k), entry(row, column));
    if (order != 0) {
      return order < 0;
    }
  }
  return false;  // unreachable: the rows of a basis inverse are independent
}

int IntegerTableau::leaving_row(int entering) const {
  const int column = column_of_[entering];
  int leaving = -1;
  for (int i = 0; i < n_; ++i) {
    if (sgn(entry(i, column)) <= 0) {
      continue;
    }
    if (leaving < 0) {
      leaving = i;
      continue;
    }
    const int order = compare_ratios(i, leaving, column);
    if (order < 0 ||
        (order == 0 && basic_[leaving] != covering_variable() &&
         (basic_[i] == covering_variable() || is_lexicographically_less(i, leaving, column)))) {
      leaving = i;
    }
  }
  return leaving;
}

void IntegerTableau::update_row(int row, int pivot_row, int column) {
  const mpz_class& pivot = entry(pivot_row, column);
  const mpz_class& factor = entry(row, column);
  for (int j = 0; j <= n_; ++j) {
    if (j == column) {
      continue;
    }
    mpz_class& value = entry(row, j);
    value *= pivot;
    mpz_submul(value.get_mpz_t(), factor.get_mpz_t(), entry(pivot_row, j).get_mpz_t());
    mpz_divexact(value.get_mpz_t(), value.get_mpz_t(), determinant_.get_mpz_t());
  }
}

void IntegerTableau::swap_variables(int row, int column) {
  row_of_[nonbasic_[column]] = row;
  row_of_[basic_[row]] = -1;
  column_of_[basic_[row]] = column;
  column_of_[nonbasic_[column]] = -1;
  std::swap(basic_[row], nonbasic_[column]);
}

bool IntegerTableau::exchange(int row, int entering, const Deadline& deadline) {
  const int column = column_of_[entering];
  const bool is_negative = sgn(entry(row, column)) < 0;  // only on the way to the first basis
  if (is_negative) {
    for (int j = 0; j <= n_; ++j) {
      entry(row, j) = -entry(row, j);
    }
  }
  for (int i = 0; i < n_; ++i) {
    if (deadline.passed()) {
      return false;
    }
    if (i != row) {
      update_row(i, row, column);
    }
  }
  // From here on the basis changes: b, D and the pivot's own column, which become those of the
  // leaving variable (negated with its row).
  if (is_negative) {
    right_[row] = -right_[row];
  }
  const mpz_class pivot = entry(row, column);
  for (int i = 0; i < n_; ++i) {
    if (i == row) {
      continue;
    }
    right_[i] = right_[i] * pivot - entry(i, column) * right_[row];
    mpz_divexact(right_[i].get_mpz_t(), right_[i].get_mpz_t(), determinant_.get_mpz_t());
    if (!is_negative) {
      entry(i, column) = -entry(i, column);
    }
  }
  entry(row, column) = is_negative ? mpz_class(-determinant_) : determinant_;
  determinant_ = pivot;
  swap_variables(row, column);
  return true;
}

std::vector<mpq_class> IntegerTableau::values() const {
  std::vector<mpq_class> z(n_);
  for (int j = 0; j < n_; ++j) {
    if (is_basic(n_ + j)) {
      z[j] = mpq_class(right_[row_of_[n_ + j]], determinant_);
      z[j].canonicalize();
    }
  }
  return z;
}

std::vector<mpq_class> IntegerTableau::direction(int entering) const {
  std::vector<mpz_class> integers(n_);
  mpz_class divisor = 0;
  for (int j = 0; j < n_; ++j) {
    if (is_basic(n_ + j)) {
      integers[j] = -entry(row_of_[n_ + j], column_of_[entering]);
    } else if (entering == n_ + j) {
      integers[j] = determinant_;
    }
    divisor = gcd(divisor, integers[j]);
  }
  std::vector<mpq_class> z(n_);
  for (int j = 0; j < n_; ++j) {
    z[j] = divisor == 0 ? mpz_class(0) : mpz_class(integers[j] / divisor);
  }
  return z;
}

}  // namespace signorini::lcp
