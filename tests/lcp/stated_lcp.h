#pragma once

#include <signorini/lcp/problem.h>

#include <initializer_list>

namespace signorini::lcp {

inline Vector vector(std::initializer_list<double> values) {
  Vector v(static_cast<Index>(values.size()));
  Index i = 0;
  for (const double value : values) {
    v[i++] = value;
  }
  return v;
}

inline Problem lcp(const Matrix& M, const Vector& q) {
  Problem problem;
  problem.M = M;
  problem.q = q;
  return problem;
}

}  // namespace signorini::lcp
