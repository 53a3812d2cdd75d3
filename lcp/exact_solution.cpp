#include <signorini/lcp/exact_solution.h>
#include <signorini/lcp/integer_tableau.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace signorini::lcp {
namespace {

bool proves_infeasible(const ExactProblem& problem, const std::vector<mpq_class>& y) {
  mpq_class q_dot_y = 0;
  for (int i = 0; i < problem.n; ++i) {
    q_dot_y += problem.q[i] * y[i];
  }
  if (sgn(q_dot_y) >= 0) {
    return false;
  }
  for (int j = 0; j < problem.n; ++j) {
    mpq_class column = 0;
    for (int i = 0; i < problem.n; ++i) {
      column += problem.at(i, j) * y[i];
    }
    if (sgn(column) > 0) {
      return false;
    }
  }
  return true;
}

/// Pivots from the basis where z0 has just entered to the end of the path.
ExactEnding follow_path(IntegerTableau& tableau, int entering, int max_pivots,
                        const Deadline& deadline, ExactSolution& solution) {
  while (tableau.is_basic(tableau.covering_variable())) {
    const int row = tableau.leaving_row(entering);
    if (row < 0) {
      solution.ray = tableau.direction(entering);
      return ExactEnding::kRay;
    }
    if (solution.pivots == max_pivots) {
      return ExactEnding::kPivotLimit;
    }
    const int leaving = tableau.basic_variable(row);
    if (!tableau.exchange(row, entering, deadline)) {
      return ExactEnding::kTimeLimit;
    }
    ++solution.pivots;
    if (leaving != tableau.covering_variable()) {
      entering = tableau.complement(leaving);
    }
  }
  return ExactEnding::kSolution;
}

ExactEnding run(IntegerTableau& tableau, int max_pivots, const Deadline& deadline,
                ExactSolution& solution) {
  const int first = tableau.first_leaving_row();
  if (first < 0) {
    return ExactEnding::kSolution;  // q >= 0: z = 0
  }
  if (max_pivots == 0) {
    return ExactEnding::kPivotLimit;
  }
  const int leaving = tableau.basic_variable(first);
  if (!tableau.exchange(first, tableau.covering_variable(), deadline)) {
    return ExactEnding::kTimeLimit;
  }
  ++solution.pivots;
  return follow_path(tableau, tableau.complement(leaving), max_pivots, deadline, solution);
}

/// A random complementary basis, with a random cover. @return false if it is singular
bool start_elsewhere(IntegerTableau& tableau, std::minstd_rand& random, const Deadline& deadline) {
  constexpr int kLargestCover = 8;
  constexpr unsigned long kShares = 7;  // rows are wanted with a chance of 1/8 .. 7/8
  const auto share = 1 + random() / 16 % kShares;
  std::vector<char> wanted(tableau.size());
  std::vector<int> cover(tableau.size());
  for (int i = 0; i < tableau.size(); ++i) {
    wanted[i] = random() / 16 % (kShares + 1) < share ? 1 : 0;
    cover[i] = 1 + static_cast<int>(random() / 16 % kLargestCover);
  }
  return tableau.start_from(wanted, cover, deadline);
}

/// x 2^-exponent with 1/2 <= |result| < 1, rounded to the 64 bits of a long double, to odd: the
/// last bit is set if anything was cut off, so that the one rounding to double that follows is
/// right.
long double leading_bits(const mpq_class& x, long& exponent) {
  const mpz_class numerator = abs(x.get_num());
  const long shift = 66 - static_cast<long>(mpz_sizeinbase(numerator.get_mpz_t(), 2)) +
                     static_cast<long>(mpz_sizeinbase(x.get_den().get_mpz_t(), 2));
  mpz_class scaled = numerator;
  mpz_class divisor = x.get_den();
  if (shift >= 0) {
    scaled <<= static_cast<unsigned long>(shift);
  } else {
    divisor <<= static_cast<unsigned long>(-shift);
  }
  mpz_class quotient;
  mpz_class remainder;
  mpz_fdiv_qr(quotient.get_mpz_t(), remainder.get_mpz_t(), scaled.get_mpz_t(), divisor.get_mpz_t());
  const long bits = static_cast<long>(mpz_sizeinbase(quotient.get_mpz_t(), 2));  // 66 or 67
  const mpz_class head = quotient >> static_cast<unsigned long>(bits - 64);
  const bool is_cut =
      remainder != 0 || mpz_class(head << static_cast<unsigned long>(bits - 64)) != quotient;
  exponent = bits - shift;
  const unsigned long integer = mpz_get_ui(head.get_mpz_t()) | (is_cut ? 1ul : 0ul);
  return std::ldexp(static_cast<long double>(integer), -64);
}

}  // namespace

ExactSolution solve_exactly(const Problem& problem, int max_pivots, const Deadline& deadline,
                            int restarts) {
  const ExactProblem exact = to_rational(problem);
  IntegerTableau tableau(exact);
  ExactSolution solution;
  solution.ending = run(tableau, max_pivots, deadline, solution);
  solution.z = tableau.values();
  if (solution.ending != ExactEnding::kRay) {
    return solution;
  }
  solution.ray_proves_infeasible = proves_infeasible(exact, solution.ray);
  std::minstd_rand random(1);
  while (!solution.ray_proves_infeasible && solution.restarts < restarts && !deadline.passed()) {
    ++solution.restarts;
    ExactSolution again;
    again.pivots = solution.pivots;
    IntegerTableau other(exact);
    if (!start_elsewhere(other, random, deadline)) {
      continue;
    }
    again.ending = run(other, max_pivots, deadline, again);
    again.restarts = solution.restarts;
    solution.pivots = again.pivots;
    if (again.ending == ExactEnding::kSolution) {
      again.z = other.values();
      return again;
    }
    if (again.ending == ExactEnding::kRay) {
      again.ray_proves_infeasible = proves_infeasible(exact, again.ray);
    }
    if (again.ray_proves_infeasible) {
      again.z = std::move(solution.z);
      return again;
    }
  }
  return solution;
}

double to_nearest_double(const mpq_class& x) {
  if (x == 0) {
    return 0.0;
  }
  long exponent = 0;
  const long double fraction = leading_bits(x, exponent);
  const int bounded = static_cast<int>(std::clamp(exponent, -10000l, 10000l));
  return sgn(x) * static_cast<double>(std::ldexp(fraction, bounded));
}

bool scale_ray(const std::vector<mpq_class>& ray, Vector& rounded) {
  const mpq_class& largest = *std::max_element(ray.begin(), ray.end());
  long exponent = 0;
  leading_bits(largest, exponent);
  mpq_class unit = 1;
  mpq_div_2exp(unit.get_mpq_t(), unit.get_mpq_t(), static_cast<unsigned long>(exponent));
  rounded.resize(static_cast<Index>(ray.size()));
  bool is_exact = true;
  for (std::size_t i = 0; i < ray.size(); ++i) {
    const mpq_class scaled = ray[i] * unit;
    rounded[static_cast<Index>(i)] = to_nearest_double(scaled);
    is_exact = is_exact && mpq_class(rounded[static_cast<Index>(i)]) == scaled;
  }
  return is_exact;
}

}  // namespace signorini::lcp
