#pragma once

#include <signorini/lcp/io/input_error.h>
#include <signorini/lcp/problem.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace signorini::lcp {

/// A problem of the Frictional Contact Library, FCLIB (Acary, Bremond, Koziara, Perignon, FCLIB: a
/// collection of discrete 3D frictional contact problems, Inria RT-444, 2014), an HDF5 file in one
/// of two forms, with contact c on the rows d c .. d c + d - 1 (normal first), d = spacedim:
///
///     local   /fclib_local:   u = W r + V l + q,   0 = V^T r + R l + s
///     global  /fclib_global:  M v = H r + G l + f,   u = H^T v + w,   0 = G^T v + b
///
/// both with r in the cone K(mu) and u + mu |u_T| n in its dual, complementary (Coulomb in De
/// Saxce's form). V, R, s and G, b, the part of the equality constraints, are optional.
///
/// `problem` has the rows (l, r): the free rows of the constraints, then the contacts. The local
/// form is M = [R V^T; V W] and q = (s, q); the global one is factored, J = [G^T; H^T] and q =
/// J M^-1 f + (b, w). A file with spacedim 1, which FCLIB's own writer refuses, is ours for
/// frictionless problems: rows 0 <= r ⊥ u >= 0, mu = 0.
struct FclibProblem {
  Problem problem;
  std::string title, description, math_info;  ///< /fclib_.../info; empty: absent
  std::optional<Vector> solution;             ///< z = (l, r) of /solution
  std::vector<Vector> guesses;                ///< the same of /guesses/1, 2, ...
  /// What reading had to decide, one line each; normally none.
  std::vector<std::string> notes;
};

/// Reads an FCLIB file. Matrices are in compressed columns (nz = -1), compressed rows (-2) or
/// triplets (nz >= 0); repeated entries are summed. Triplets: fclib.h says that p holds rows and i
/// columns, while CSparse, in which FCLIB's own merit function takes them and Siconos writes them,
/// has rows in i and columns in p. We follow CSparse unless only the other reading fits the sizes,
/// and say so in notes. The blocks of M are its connected parts, or those of
/// /fclib_global/signorini_blocks, as we write it.
///
/// @throws InputError "FILE: DATASET: expected ..., found ..." for whatever is missing, malformed,
/// truncated or contradictory, and for a mass matrix with a connected part of more than
/// kMaxMassBlock rows
[[nodiscard]] FclibProblem read_fclib(const std::filesystem::path& file);

/// Writes a file that read_fclib() reads back, whole or not at all, replacing one that exists. The
/// form is global where problem.M is factored without compliance (M is then the inverse of the
/// inverse masses, rounded once; f = 0, w and b are q), else local (M and q to the bit).
///
/// @throws std::invalid_argument for what FCLIB cannot say: bounds other than free rows before all
/// others, coupled limits, the associated friction law, cones of mixed dimension or on some rows
/// only, and with free rows a local form that is not [R V^T; V W], or numbers that are not finite.
/// @throws std::runtime_error naming the file if it cannot be written
void write_fclib(const FclibProblem& fclib, const std::filesystem::path& file);

}  // namespace signorini::lcp
