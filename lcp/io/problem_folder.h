#pragma once

#include <signorini/lcp/io/input_error.h>
#include <signorini/lcp/problem.h>

#include <filesystem>
#include <string>

namespace signorini::lcp {

/// A contact problem as a folder of text files, in one of two forms.
///
/// Given: W.mtx (n x n, coordinate) and q.mtx (n x 1). Factored, without W.mtx: M.mtx, H.mtx,
/// f.mtx, w.mtx with M v = H r + f, u = H^T v + w, hence A = H^T M^-1 H and q = H^T M^-1 f + w.
/// Both with problem.txt, lines `key value`: kind, size, contacts, dimension, free, and for the
/// factored form `form factored` and bodies. mu.mtx (contacts x 1) belongs to fc2d and fc3d.
struct ProblemFolder {
  /// "lcp": w = M z + q, 0 <= z ⊥ w >= 0. "mlcp": the first `free` rows are equalities w_i = 0 with
  /// free z_i; problem.lower says so. "fc3d", "fc2d": Coulomb friction, rows d c .. d c + d - 1 of
  /// contact c are normal and tangential; problem has M and q, its bounds say nothing of the cones.
  std::string kind;
  Problem problem;
  Vector mu;          ///< friction coefficients, one a contact; empty for lcp and mlcp
  int dimension = 1;  ///< rows a contact: 3 for fc3d, 2 for fc2d, else 1
  int contacts = 0;
  int free = 0;     ///< free rows of an mlcp, else 0
  int bodies = -1;  ///< of the factored form, -1 if the folder does not say
};

/// Reads a folder, both forms. In the factored form the blocks of M are its bodies' 6 x 6 blocks
/// (where bodies says that there are rows / 6 of them), joined where M couples them; without
/// bodies, the connected parts of M's pattern. A diagonal block is kept as its inverse, each number
/// rounded once; any other as its Cholesky factor, which stays positive definite whatever the
/// rounding. q is summed in long double, with M^-1 from a Cholesky factor in long double, and
/// rounded once.
///
/// @throws InputError for everything that is missing, malformed or contradictory: problem.txt's
/// size, contacts, dimension, free and bodies against the matrices, too. Memory stays proportional
/// to the bytes of the files, with at most kMaxMassBlock^2 numbers a block of M.
[[nodiscard]] ProblemFolder read_problem_folder(const std::filesystem::path& folder);

/// The largest connected block of M that is read, in rows.
inline constexpr int kMaxMassBlock = 256;

/// read_problem_folder() for solvers of problem.h. @throws InputError also for fc2d and fc3d.
[[nodiscard]] Problem read_problem(const std::filesystem::path& folder);

/// Writes a new folder that read_problem_folder() reads back: M and q to the bit in the given form;
/// in the factored form J and q to the bit and W to rounding (with f = 0, w = q). Written whole or
/// not at all: into a folder beside it, which is renamed.
///
/// @throws std::invalid_argument for what the format cannot say: compliance, coupled limits, bounds
/// other than those of `kind`. @throws std::runtime_error if the folder exists or cannot be
/// written; nothing is left then.
void write_problem_folder(const ProblemFolder& problem, const std::filesystem::path& folder);

}  // namespace signorini::lcp
