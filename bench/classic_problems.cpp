#include "bench/classic_problems.h"

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace signorini::bench {
namespace {

void check(const char* name, int value, int least, int most) {
  if (value < least || value > most) {
    throw std::invalid_argument(std::string(name) + ": must be in [" + std::to_string(least) +
                                ", " + std::to_string(most) + "], got " + std::to_string(value));
  }
}

constexpr int kMostRows = 100000;  // a dense matrix above this is a mistake

lcp::Matrix murty_matrix(int n) {
  lcp::Matrix L = lcp::Matrix::Identity(n, n);
  L.triangularView<Eigen::StrictlyLower>().setConstant(2.0);
  return L;
}

}  // namespace

lcp::Problem make_murty(int n) {
  check("n", n, 1, 50);
  lcp::Problem problem;
  problem.M = murty_matrix(n);
  problem.q.resize(n);
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    sum += std::ldexp(1.0, n - i);
    problem.q[i] = -sum;
  }
  return problem;
}

lcp::Problem make_fathi(int n) {
  check("n", n, 1, kMostRows);
  const lcp::Matrix L = murty_matrix(n);
  lcp::Problem problem;
  problem.M = lcp::Matrix(L * L.transpose());
  problem.q = -lcp::Vector::Ones(n);
  return problem;
}

lcp::Problem make_random_psd(int n, int rank, std::uint64_t seed) {
  check("n", n, 1, kMostRows);
  check("rank", rank, 1, n);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  lcp::Matrix B(n, rank);
  for (int j = 0; j < rank; ++j) {
    for (int i = 0; i < n; ++i) {
      B(i, j) = normal(random);
    }
  }
  lcp::Matrix M = B * B.transpose() / rank;
  lcp::Vector z = lcp::Vector::Zero(n);
  lcp::Vector w = lcp::Vector::Zero(n);
  for (int i = 0; i < n; ++i) {
    const double size = std::abs(normal(random));
    (random() % 2 == 0 ? z : w)[i] = size;
  }
  lcp::Problem problem;
  problem.q = w - M * z;
  problem.M = std::move(M);
  return problem;
}

}  // namespace signorini::bench
