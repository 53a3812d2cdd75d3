#pragma once

#include <signorini/lcp/factored_matrix.h>
#include <signorini/lcp/problem.h>
#include <signorini/lcp/sparse_cholesky.h>

#include <string_view>

namespace signorini::bench {

/// What a contact problem costs at the very least: one sparse analysis, factorisation and solve of
/// A_aa, the rows with z > 0 of a solution, by a general sparse Cholesky. An exact solver that
/// knew the answer's active set could not do with less.
struct FactorizationFloor {
  int rows = 0;  ///< active
  double seconds =
      0.0;  ///< CPU time of analysis, factorisation and one solve, the least of the repetitions
  double factor_seconds = 0.0;       ///< the factorisation of these alone
  lcp::SparseCholeskyCounts counts;  ///< of A_aa's factor
};

/// Measures it. A_aa is formed outside of the measured time and made definite by 1e-10 of its
/// diagonal (redundant contacts). @param z a solution; rows with z_i > 0 are active
/// @param back_end a name of lcp::make_sparse_cholesky(); the reference is "cholmod"
/// @throws std::runtime_error if A_aa cannot be factored
[[nodiscard]] FactorizationFloor measure_factorization_floor(const lcp::FactoredMatrix& A,
                                                             const lcp::Vector& z,
                                                             std::string_view back_end,
                                                             int repetitions = 3);

/// The same floor in body space: CPU seconds of one sparse analysis, factorisation and solve of
/// I + G^T D G (whitened_rows.h) with D = 0 but on active rows, by reference_back_end(). It has a
/// row a degree of freedom of the bodies however many contacts are redundant, so that it is the
/// lower floor of the two where boxes lie on boxes. Measured once.
/// @param z a solution; active are rows with z_i > 0, and all rows of a cone whose normal is
/// @return 0 where M is not factored @throws std::runtime_error if the matrix cannot be factored
[[nodiscard]] double measure_body_space_floor(const lcp::Problem& problem, const lcp::Vector& z);

/// "cholmod" where the build has it, else "eigen".
[[nodiscard]] std::string_view reference_back_end();

}  // namespace signorini::bench
