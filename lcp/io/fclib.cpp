#include <signorini/lcp/io/factored_form.h>
#include <signorini/lcp/io/fclib.h>
#include <signorini/lcp/io/hdf5_file.h>
#include <signorini/lcp/io/whole_file.h>
#include <signorini/lcp/number_text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace signorini::lcp {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int kMaxInt = std::numeric_limits<int>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kCompressedColumns = -1;
constexpr int kCompressedRows = -2;

// Reading.

/// A sparse matrix as the file encodes it.
struct Encoded {
  int rows = 0;
  int columns = 0;
  int nz = 0;
  std::vector<int> p;
  std::vector<int> i;
  Vector x;
};

void check_indices(const Hdf5Reader& file, const std::string& name, const std::vector<int>& indices,
                   std::size_t used, int limit) {
  for (std::size_t k = 0; k < used; ++k) {
    if (indices[k] < 0 || indices[k] >= limit) {
      file.fail(name, "index " + std::to_string(k + 1) + ": expected an integer from 0 to " +
                          std::to_string(limit - 1) + ", found " + std::to_string(indices[k]));
    }
  }
}

void check_pointers(const Hdf5Reader& file, const std::string& name,
                    const std::vector<int>& pointers, std::int64_t entries) {
  for (std::size_t k = 0; k < pointers.size(); ++k) {
    const int least = k == 0 ? 0 : pointers[k - 1];
    const std::int64_t most = k == 0 ? 0 : entries;
    if (pointers[k] < least || pointers[k] > most) {
      file.fail(name, "pointer " + std::to_string(k + 1) + ": expected an integer from " +
                          std::to_string(least) + " to " + std::to_string(most) + ", found " +
                          std::to_string(pointers[k]));
    }
  }
}

Encoded read_encoded(const Hdf5Reader& file, const std::string& group) {
  Encoded matrix;
  matrix.rows = file.integer(group + "/m", 0, kMaxInt);
  matrix.columns = file.integer(group + "/n", 0, kMaxInt);
  matrix.nz = file.integer(group + "/nz", kCompressedRows, kMaxInt);
  const int nzmax = file.integer(group + "/nzmax", 0, kMaxInt);
  if (matrix.nz >= 0) {
    const std::string nz_is = group + "/nz is " + std::to_string(matrix.nz);
    matrix.p = file.integers(group + "/p", matrix.nz, nz_is);
    matrix.i = file.integers(group + "/i", matrix.nz, nz_is);
    // FCLIB writes nz or nzmax values, by its version.
    const std::int64_t found = file.count(group + "/x");
    if (nzmax < matrix.nz || (found != matrix.nz && found != nzmax)) {
      file.fail(group + "/x", "expected " + std::to_string(matrix.nz) + " numbers (" + nz_is +
                                  "), found " + std::to_string(found));
    }
    matrix.x = file.numbers(group + "/x", found, nz_is);
    return matrix;
  }
  const bool by_columns = matrix.nz == kCompressedColumns;
  const std::int64_t lines = by_columns ? matrix.columns : matrix.rows;
  matrix.p =
      file.integers(group + "/p", lines + 1,
                    group + (by_columns ? "/n" : "/m") + " + 1 is " + std::to_string(lines + 1));
  const std::string nzmax_is = group + "/nzmax is " + std::to_string(nzmax);
  matrix.i = file.integers(group + "/i", nzmax, nzmax_is);
  matrix.x = file.numbers(group + "/x", nzmax, nzmax_is);
  check_pointers(file, group + "/p", matrix.p, nzmax);
  check_indices(file, group + "/i", matrix.i, static_cast<std::size_t>(matrix.p.back()),
                by_columns ? matrix.rows : matrix.columns);
  return matrix;
}

bool all_below(const std::vector<int>& indices, int limit) {
  return std::ranges::all_of(indices, [limit](int k) { return k >= 0 && k < limit; });
}

/// Row and column of every entry. Triplets: see read_fclib().
Triplets entries_of(const Hdf5Reader& file, const std::string& group, const Encoded& matrix,
                    std::vector<std::string>& notes) {
  Triplets entries;
  if (matrix.nz < 0) {
    const bool by_columns = matrix.nz == kCompressedColumns;
    entries.reserve(static_cast<std::size_t>(matrix.p.back()));
    for (int line = 0; line + 1 < static_cast<int>(matrix.p.size()); ++line) {
      for (int k = matrix.p[line]; k < matrix.p[line + 1]; ++k) {
        entries.emplace_back(by_columns ? matrix.i[k] : line, by_columns ? line : matrix.i[k],
                             matrix.x[k]);
      }
    }
    return entries;
  }
  const bool as_csparse = all_below(matrix.i, matrix.rows) && all_below(matrix.p, matrix.columns);
  const bool as_header = all_below(matrix.p, matrix.rows) && all_below(matrix.i, matrix.columns);
  if (!as_csparse && !as_header) {
    check_indices(file, group + "/i", matrix.i, matrix.i.size(), matrix.rows);
    check_indices(file, group + "/p", matrix.p, matrix.p.size(), matrix.columns);
  }
  if (!as_csparse) {
    notes.push_back(group + ": triplets read with rows in p and columns in i, the only fit");
  }
  for (std::size_t k = 0; k < matrix.p.size(); ++k) {
    entries.emplace_back(as_csparse ? matrix.i[k] : matrix.p[k],
                         as_csparse ? matrix.p[k] : matrix.i[k], matrix.x[static_cast<Index>(k)]);
  }
  return entries;
}

/// A matrix that may not exist yet: its entries, its sizes checked against what is known.
struct Entries {
  int rows = 0;
  int columns = 0;
  Triplets entries;
};

void expect_size(const Hdf5Reader& file, const std::string& name, int found, int expected,
                 const std::string& why) {
  if (found != expected) {
    file.fail(name, "expected " + std::to_string(expected) + " (" + why + "), found " +
                        std::to_string(found));
  }
}

Entries read_matrix(const Hdf5Reader& file, const std::string& group,
                    std::vector<std::string>& notes) {
  if (!file.has(group)) {
    file.fail(group, "expected this group, found none");
  }
  const Encoded encoded = read_encoded(file, group);
  return {encoded.rows, encoded.columns, entries_of(file, group, encoded, notes)};
}

/// Sums repeated entries. @throws InputError unless the sums are finite
SparseMatrix to_sparse(const Hdf5Reader& file, const std::string& group, int rows, int columns,
                       const Triplets& entries) {
  if (entries.size() > static_cast<std::size_t>(kMaxInt)) {
    file.fail(group, "has more than " + std::to_string(kMaxInt) + " entries");
  }
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  if (!std::all_of(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(),
                   [](double value) { return std::isfinite(value); })) {
    file.fail(group + "/x", "repeated entries sum to a number that is not finite");
  }
  return matrix;
}

/// spacedim and mu: the cones of `contact_rows` rows after `free` others; the bounds of those.
void read_contacts(const Hdf5Reader& file, const std::string& group, int free, int contact_rows,
                   Problem& problem) {
  const int dimension = file.integer(group + "/spacedim", 1, 3);
  if (contact_rows % dimension != 0) {
    file.fail(group + "/spacedim", "expected a divisor of the " + std::to_string(contact_rows) +
                                       " contact rows, found " + std::to_string(dimension));
  }
  const int contacts = contact_rows / dimension;
  const std::string name = group + "/vectors/mu";
  const Vector mu = file.numbers(
      name, contacts,
      std::to_string(contact_rows) + " contact rows / spacedim " + std::to_string(dimension));
  for (int c = 0; c < contacts; ++c) {
    if (mu[c] < 0.0 || (dimension == 1 && mu[c] != 0.0)) {
      file.fail(name, "contact " + std::to_string(c + 1) + ": expected " +
                          (dimension == 1 ? "0 (spacedim is 1)" : "a friction coefficient >= 0") +
                          ", found " + number_text(mu[c]));
    }
    if (dimension > 1) {
      problem.cones.push_back({free + c * dimension, dimension, mu[c]});
    }
  }
  if (free > 0) {
    problem.lower = Vector::Zero(problem.size());
    problem.lower.head(free).setConstant(-kInfinity);
  }
}

void read_local(const Hdf5Reader& file, FclibProblem& fclib) {
  const std::string group = "/fclib_local";
  const Entries W = read_matrix(file, group + "/W", fclib.notes);
  expect_size(file, group + "/W/n", W.columns, W.rows, "as many columns as rows");
  const int rows = W.rows;
  const Vector q =
      file.numbers(group + "/vectors/q", rows, group + "/W/m is " + std::to_string(rows));
  int free = 0;
  Triplets entries;
  Vector s;
  if (file.has(group + "/V") || file.has(group + "/R")) {
    const Entries V = read_matrix(file, group + "/V", fclib.notes);
    const Entries R = read_matrix(file, group + "/R", fclib.notes);
    free = R.rows;
    const std::string rows_is = group + "/R/m is " + std::to_string(free);
    expect_size(file, group + "/R/n", R.columns, free, rows_is);
    expect_size(file, group + "/V/m", V.rows, rows, group + "/W/m is " + std::to_string(rows));
    expect_size(file, group + "/V/n", V.columns, free, rows_is);
    s = file.numbers(group + "/vectors/s", free, rows_is);
    entries = R.entries;
    for (const auto& entry : V.entries) {
      entries.emplace_back(free + entry.row(), entry.col(), entry.value());
      entries.emplace_back(entry.col(), free + entry.row(), entry.value());
    }
  }
  if (rows > kMaxInt - free) {
    file.fail(group + "/W/m", "too many rows: " + std::to_string(rows));
  }
  for (const auto& entry : W.entries) {
    entries.emplace_back(free + entry.row(), free + entry.col(), entry.value());
  }
  Problem& problem = fclib.problem;
  problem.M = to_sparse(file, group, free + rows, free + rows, entries);
  problem.q.resize(free + rows);
  problem.q << s, q;
  read_contacts(file, group, free, rows, problem);
}

CoordinateMatrix to_coordinates(const SparseMatrix& matrix) {
  CoordinateMatrix coordinates;
  coordinates.rows = static_cast<int>(matrix.rows());
  coordinates.columns = static_cast<int>(matrix.cols());
  for (Index j = 0; j < matrix.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(matrix, j); it; ++it) {
      coordinates.entries.push_back(
          {static_cast<int>(it.row()), static_cast<int>(j), 0, it.value()});
    }
  }
  return coordinates;
}

std::vector<int> stored_block_sizes(const Hdf5Reader& file, int freedom) {
  const std::string name = "/fclib_global/signorini_blocks";
  if (!file.has(name)) {
    return {};
  }
  std::vector<int> sizes = file.integers(name, file.count(name), "");
  std::int64_t sum = 0;
  for (const int size : sizes) {
    if (size < 1 || size > kMaxMassBlock) {
      file.fail(name, "expected sizes from 1 to " + std::to_string(kMaxMassBlock) + ", found " +
                          std::to_string(size));
    }
    sum += size;
  }
  if (sum != freedom) {
    file.fail(name, "expected sizes with the sum " + std::to_string(freedom) +
                        " (the rows of M), found " + std::to_string(sum));
  }
  return sizes;
}

void read_global(const Hdf5Reader& file, FclibProblem& fclib) {
  const std::string group = "/fclib_global";
  const Entries M = read_matrix(file, group + "/M", fclib.notes);
  const Entries H = read_matrix(file, group + "/H", fclib.notes);
  const int freedom = M.rows;
  const int rows = H.columns;
  const std::string M_is = group + "/M/m is " + std::to_string(freedom);
  const std::string H_is = group + "/H/n is " + std::to_string(rows);
  expect_size(file, group + "/M/n", M.columns, freedom, M_is);
  expect_size(file, group + "/H/m", H.rows, freedom, M_is);
  const Vector f = file.numbers(group + "/vectors/f", freedom, M_is);
  const Vector w = file.numbers(group + "/vectors/w", rows, H_is);
  int free = 0;
  Triplets columns;
  Vector b;
  if (file.has(group + "/G")) {
    const Entries G = read_matrix(file, group + "/G", fclib.notes);
    expect_size(file, group + "/G/m", G.rows, freedom, M_is);
    free = G.columns;
    b = file.numbers(group + "/vectors/b", free, group + "/G/n is " + std::to_string(free));
    columns = G.entries;
  }
  if (rows > kMaxInt - free) {
    file.fail(group + "/H/n", "too many columns: " + std::to_string(rows));
  }
  for (const auto& entry : H.entries) {
    columns.emplace_back(entry.row(), free + entry.col(), entry.value());
  }
  const SparseMatrix J = to_sparse(file, group + "/H", freedom, free + rows, columns);
  const CoordinateMatrix mass =
      to_coordinates(to_sparse(file, group + "/M", freedom, freedom, M.entries));
  const MassBlocks blocks = connected_blocks(mass, stored_block_sizes(file, freedom));
  FactoredMatrix A;
  std::vector<Matrix> masses;
  try {
    masses = dense_blocks(mass, blocks);
    add_masses(masses, blocks, A.mass);
  } catch (const std::invalid_argument& error) {
    file.fail(group + "/M", error.what());
  }
  add_rows(J, blocks, {}, A);
  Vector constant(free + rows);
  constant << b, w;
  Problem& problem = fclib.problem;
  problem.q = velocities_without_impulses(J, masses, blocks, f, constant);
  if (!problem.q.allFinite()) {
    file.fail(group, "q = H^T M^-1 f + w is not finite");
  }
  problem.M = std::move(A);
  read_contacts(file, group, free, rows, problem);
}

Index free_rows(const Problem& problem) {
  return problem.lower.size() == 0 ? 0 : (problem.lower.array() == -kInfinity).count();
}

/// z = (l, r) of a solution or guess.
Vector read_answer(const Hdf5Reader& file, const std::string& group, const Problem& problem) {
  const Index free = free_rows(problem);
  const Index rows = problem.size() - free;
  Vector z(problem.size());
  if (free > 0) {
    z.head(free) = file.numbers(group + "/l", free, "the constraints' rows");
  }
  z.tail(rows) = file.numbers(group + "/r", rows, "the contacts' rows");
  return z;
}

void read_answers(const Hdf5Reader& file, FclibProblem& fclib) {
  if (file.has("/solution")) {
    fclib.solution = read_answer(file, "/solution", fclib.problem);
  }
  if (!file.has("/guesses")) {
    return;
  }
  const int count = file.integer("/guesses/number_of_guesses", 0, kMaxInt);
  for (int k = 1; k <= count; ++k) {
    fclib.guesses.push_back(read_answer(file, "/guesses/" + std::to_string(k), fclib.problem));
  }
}

// Writing.

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("FCLIB: " + what);
}

/// Rows 0 .. free - 1 are free, the others 0 <= z_i or in cones of one dimension.
struct Layout {
  int free = 0;
  int dimension = 1;
  Vector mu;
};

Layout layout_of(const Problem& problem) {
  if (!problem.limits.empty()) {
    refuse("has no coupled limits");
  }
  if (!problem.cones.empty() && problem.friction_law != FrictionLaw::kCoulomb) {
    refuse("has Coulomb's friction law alone");
  }
  std::vector<bool> in_cone(problem.size(), false);
  for (const FrictionCone& cone : problem.cones) {
    std::fill_n(in_cone.begin() + cone.normal_row, cone.dimension, true);
  }
  Layout layout;
  layout.dimension = problem.cones.empty() ? 1 : problem.cones.front().dimension;
  for (Index i = 0; i < problem.size(); ++i) {
    const double lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    const double upper = problem.upper.size() > 0 ? problem.upper[i] : kInfinity;
    const bool is_free = !in_cone[i] && lower == -kInfinity && upper == kInfinity;
    if (is_free && i == layout.free) {
      ++layout.free;
    } else if (is_free || (!in_cone[i] && (lower != 0.0 || upper != kInfinity))) {
      refuse("has no bounds but free rows before all others; row " + std::to_string(i) + " has [" +
             number_text(lower) + ", " + number_text(upper) + "]");
    }
  }
  const Index rows = problem.size() - layout.free;
  layout.mu = Vector::Zero(rows / layout.dimension);
  for (std::size_t c = 0; c < problem.cones.size(); ++c) {
    const FrictionCone& cone = problem.cones[c];
    const Index expected = layout.free + static_cast<Index>(c) * layout.dimension;
    if (cone.dimension != layout.dimension || cone.normal_row != expected) {
      refuse("has contacts of one dimension, in the order of their rows");
    }
    layout.mu[static_cast<Index>(c)] = cone.coefficient;
  }
  if (!problem.cones.empty() &&
      static_cast<Index>(problem.cones.size()) * layout.dimension != rows) {
    refuse("has a cone at every contact or at none");
  }
  return layout;
}

std::span<const double> span_of(const Vector& vector) {
  return {vector.data(), static_cast<std::size_t>(vector.size())};
}

void write_matrix(Hdf5Writer& file, const std::string& group, const SparseMatrix& given) {
  SparseMatrix matrix = given;
  matrix.makeCompressed();
  const auto entries = static_cast<std::size_t>(matrix.nonZeros());
  file.group(group);
  file.integer(group + "/nzmax", static_cast<int>(entries));
  file.integer(group + "/m", static_cast<int>(matrix.rows()));
  file.integer(group + "/n", static_cast<int>(matrix.cols()));
  file.integer(group + "/nz", kCompressedColumns);
  file.integers(group + "/p",
                {matrix.outerIndexPtr(), static_cast<std::size_t>(matrix.outerSize() + 1)});
  file.integers(group + "/i", {matrix.innerIndexPtr(), entries});
  file.numbers(group + "/x", {matrix.valuePtr(), entries});
}

void write_info(Hdf5Writer& file, const std::string& group, const FclibProblem& fclib) {
  file.group(group);
  for (const auto& [name, text] :
       {std::pair("/title", &fclib.title), std::pair("/description", &fclib.description),
        std::pair("/math_info", &fclib.math_info)}) {
    if (!text->empty()) {
      file.text(group + name, *text);
    }
  }
}

SparseMatrix as_sparse(const MatrixForm& M) {
  if (const auto* sparse = std::get_if<SparseMatrix>(&M)) {
    return *sparse;
  }
  if (const auto* factored = std::get_if<FactoredMatrix>(&M)) {
    return factored->form();
  }
  return std::get<Matrix>(M).sparseView(1.0, 0.0);
}

bool has_compliance(const FactoredMatrix& A) {
  for (int i = 0; i < A.rows(); ++i) {
    if (A.compliance(i) != 0.0) {
      return true;
    }
  }
  return false;
}

bool is_finite(const SparseMatrix& matrix) {
  return std::all_of(matrix.valuePtr(), matrix.valuePtr() + matrix.nonZeros(),
                     [](double value) { return std::isfinite(value); });
}

void write_local(Hdf5Writer& file, const FclibProblem& fclib, const Layout& layout) {
  const std::string group = "/fclib_local";
  const Problem& problem = fclib.problem;
  SparseMatrix M = as_sparse(problem.M);
  M.makeCompressed();
  if (!is_finite(M)) {
    refuse("M is not finite");
  }
  const Index free = layout.free;
  const Index rows = problem.size() - free;
  file.group(group);
  file.integer(group + "/spacedim", layout.dimension);
  write_matrix(file, group + "/W", M.bottomRightCorner(rows, rows));
  if (free > 0) {
    const SparseMatrix V = M.bottomLeftCorner(rows, free);
    const SparseMatrix V_transpose = V.transpose();
    const SparseMatrix difference = SparseMatrix(M.topRightCorner(free, rows)) - V_transpose;
    if (difference.nonZeros() > 0 && !(difference.coeffs() == 0.0).all()) {
      refuse("has M = [R V^T; V W] in its local form; here the free rows and columns differ");
    }
    write_matrix(file, group + "/V", V);
    write_matrix(file, group + "/R", M.topLeftCorner(free, free));
  }
  file.group(group + "/vectors");
  file.numbers(group + "/vectors/q", span_of(problem.q.tail(rows)));
  file.numbers(group + "/vectors/mu", span_of(layout.mu));
  if (free > 0) {
    file.numbers(group + "/vectors/s", span_of(problem.q.head(free)));
  }
  write_info(file, group + "/info", fclib);
}

void write_global(Hdf5Writer& file, const FclibProblem& fclib, const FactoredMatrix& A,
                  const Layout& layout) {
  const std::string group = "/fclib_global";
  const Problem& problem = fclib.problem;
  const SparseMatrix M = mass_matrix(A.mass);
  const SparseMatrix H = transposed_jacobian(A);
  if (!is_finite(M) || !is_finite(H)) {
    refuse("the mass matrix or J is not finite");
  }
  const Index free = layout.free;
  const Index rows = problem.size() - free;
  file.group(group);
  file.integer(group + "/spacedim", layout.dimension);
  write_matrix(file, group + "/M", M);
  write_matrix(file, group + "/H", H.rightCols(rows));
  if (free > 0) {
    write_matrix(file, group + "/G", H.leftCols(free));
  }
  std::vector<int> sizes(A.mass.block_count());
  for (int b = 0; b < A.mass.block_count(); ++b) {
    sizes[b] = A.mass.dimension(b);
  }
  file.integers(group + "/signorini_blocks", sizes);
  file.group(group + "/vectors");
  file.numbers(group + "/vectors/f", span_of(Vector::Zero(A.degrees_of_freedom())));
  file.numbers(group + "/vectors/w", span_of(problem.q.tail(rows)));
  file.numbers(group + "/vectors/mu", span_of(layout.mu));
  if (free > 0) {
    file.numbers(group + "/vectors/b", span_of(problem.q.head(free)));
  }
  write_info(file, group + "/info", fclib);
}

/// v (global form), u, r and l of z.
void write_answer(Hdf5Writer& file, const std::string& group, const Problem& problem,
                  const FactoredMatrix* A, Index free, const Vector& z) {
  if (z.size() != problem.size() || !z.allFinite()) {
    refuse("a solution or guess has " + std::to_string(z.size()) +
           " numbers or is not finite; the problem has " + std::to_string(problem.size()) +
           " rows");
  }
  file.group(group);
  if (A != nullptr) {
    Vector p(A->degrees_of_freedom());
    Vector v(A->degrees_of_freedom());
    A->transpose_times(z.data(), p.data());
    A->apply_inverse_mass(p.data(), v.data());
    file.numbers(group + "/v", span_of(v));
  }
  Vector u(problem.size());
  multiply(problem.M, z.data(), u.data());
  u += problem.q;
  const Index rows = problem.size() - free;
  file.numbers(group + "/u", span_of(u.tail(rows)));
  file.numbers(group + "/r", span_of(z.tail(rows)));
  if (free > 0) {
    file.numbers(group + "/l", span_of(z.head(free)));
  }
}

}  // namespace

FclibProblem read_fclib(const std::filesystem::path& path) {
  const Hdf5Session session;
  const Hdf5Reader file(path);
  FclibProblem fclib;
  const bool global = file.has("/fclib_global");
  if (global == file.has("/fclib_local")) {
    file.fail("/", std::string("expected a group fclib_local or fclib_global, found ") +
                       (global ? "both" : "neither"));
  }
  const std::string group = global ? "/fclib_global" : "/fclib_local";
  if (global) {
    read_global(file, fclib);
  } else {
    read_local(file, fclib);
  }
  fclib.title = file.text(group + "/info/title");
  fclib.description = file.text(group + "/info/description");
  fclib.math_info = file.text(group + "/info/math_info");
  read_answers(file, fclib);
  return fclib;
}

void write_fclib(const FclibProblem& fclib, const std::filesystem::path& path) {
  const Problem& problem = fclib.problem;
  check_shapes(problem);
  const Layout layout = layout_of(problem);
  if (!problem.q.allFinite() || !layout.mu.allFinite()) {
    refuse("q or mu is not finite");
  }
  const auto* factored = std::get_if<FactoredMatrix>(&problem.M);
  const FactoredMatrix* A = factored && !has_compliance(*factored) ? factored : nullptr;
  const Hdf5Session session;
  const SignalsHeld held;
  Hdf5Writer file(path);
  if (A != nullptr) {
    write_global(file, fclib, *A, layout);
  } else {
    write_local(file, fclib, layout);
  }
  if (fclib.solution) {
    write_answer(file, "/solution", problem, A, layout.free, *fclib.solution);
  }
  if (!fclib.guesses.empty()) {
    file.group("/guesses");
    file.integer("/guesses/number_of_guesses", static_cast<int>(fclib.guesses.size()));
    for (std::size_t k = 0; k < fclib.guesses.size(); ++k) {
      write_answer(file, "/guesses/" + std::to_string(k + 1), problem, A, layout.free,
                   fclib.guesses[k]);
    }
  }
  file.commit();
}

}  // namespace signorini::lcp
