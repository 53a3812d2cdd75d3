#pragma once

#include <signorini/lcp/io/factored_form.h>
#include <signorini/lcp/io/input_error.h>
#include <signorini/lcp/problem.h>

#include <filesystem>
#include <map>
#include <string>

namespace signorini::lcp {

/// A problem as a folder of text files; docs/problem-folders.md is the format. M is given (W.mtx,
/// q.mtx) or factored (H.mtx with M.mtx, or with blocks.txt and Minv.mtx, L.mtx).
struct ProblemFolder {
  /// "lcp": w = M z + q, 0 <= z ⊥ w >= 0. "mlcp": the first `free` rows are equalities w_i = 0 with
  /// free z_i; problem.lower says so. "fc3d", "fc2d": contact c has the friction cone
  /// problem.cones[c] over the rows d c .. d c + d - 1. "general": bounds, coupled limits and cones
  /// in any mixture.
  std::string kind;
  Problem problem;
  int dimension = 1;  ///< rows a contact: 3 for fc3d, 2 for fc2d, else 1
  int contacts = 0;   ///< of lcp, mlcp, fc2d, fc3d; the rows of a general problem
  int free = 0;       ///< free rows of an mlcp, else 0
  int bodies = -1;    ///< of the factored form, -1 if the folder does not say
};

/// Reads a folder. In the factored form with M.mtx the blocks of M are its bodies' 6 x 6 blocks
/// (where bodies says that there are rows / 6 of them), joined where M couples them; without
/// bodies, the connected parts of M's pattern. A diagonal block is kept as its inverse, each number
/// rounded once; any other as its Cholesky factor, which stays positive definite whatever the
/// rounding. q is summed in long double, with M^-1 from a Cholesky factor in long double, and
/// rounded once. With blocks.txt everything is read to the bit.
///
/// @throws InputError for everything that is missing, malformed or contradictory: problem.txt's
/// size, contacts, dimension, free and bodies against the matrices, too. Memory stays proportional
/// to the bytes of the files, with at most kMaxMassBlock^2 numbers a block of M.
[[nodiscard]] ProblemFolder read_problem_folder(const std::filesystem::path& folder);

/// read_problem_folder(), the problem alone.
[[nodiscard]] Problem read_problem(const std::filesystem::path& folder);

/// Writes a new folder from which read_problem_folder() gives the same problem: M (in its form), q,
/// bounds, limits, cones and law to the bit, except that exact zeros of a sparse M or of J are left
/// out and that the blocks of a row of J come in ascending order. The kind is the narrowest that
/// says it all. Written whole or not at all: into a folder beside it, which is renamed.
///
/// What is not finite in M or q is written, so that it can be looked at, but cannot be read back.
///
/// @param beside more files for the folder, by name
/// @throws std::invalid_argument where check_shapes() does. @throws std::runtime_error if the
/// folder exists or cannot be written; nothing is left then.
void write_problem_folder(const Problem& problem, const std::filesystem::path& folder,
                          const std::map<std::string, std::string>& beside = {});

}  // namespace signorini::lcp
