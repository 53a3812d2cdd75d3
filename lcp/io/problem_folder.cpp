#include <signorini/lcp/io/key_values.h>
#include <signorini/lcp/io/matrix_market.h>
#include <signorini/lcp/io/problem_folder.h>
#include <signorini/lcp/io/text_lines.h>
#include <signorini/lcp/io/whole_file.h>
#include <signorini/lcp/number_text.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

namespace signorini::lcp {
namespace {

using Path = std::filesystem::path;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxInt = std::numeric_limits<int>::max();
constexpr int kBodyFreedom = 6;

std::string shape_text(Index rows, Index columns) {
  return std::to_string(rows) + " x " + std::to_string(columns);
}

bool is_there(const Path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

// Reading.

void read_counts(const KeyValues& description, ProblemFolder& folder) {
  static const std::map<std::string, int> kDimensions = {
      {"lcp", 1}, {"mlcp", 1}, {"fc2d", 2}, {"fc3d", 3}, {"general", 1}};
  folder.kind = description.text("kind");
  const auto kind = kDimensions.find(folder.kind);
  if (kind == kDimensions.end()) {
    description.fail("kind",
                     "expected lcp, mlcp, fc2d, fc3d or general, found " + in_quotes(folder.kind));
  }
  const int size = description.count("size");
  folder.dimension = description.count("dimension", kind->second);
  if (folder.dimension != kind->second) {
    description.fail("dimension", "expected " + std::to_string(kind->second) + " for kind " +
                                      folder.kind + ", found " + std::to_string(folder.dimension));
  }
  folder.free = description.count("free", 0);
  if (folder.free > (folder.kind == "mlcp" ? size : 0)) {
    description.fail("free", "expected at most " +
                                 std::to_string(folder.kind == "mlcp" ? size : 0) + " for kind " +
                                 folder.kind + " and size " + std::to_string(size) + ", found " +
                                 std::to_string(folder.free));
  }
  const int contacts = (size - folder.free) / folder.dimension;
  folder.contacts = description.count("contacts", contacts);
  if (std::int64_t{folder.contacts} * folder.dimension + folder.free != size) {
    description.fail(
        "size", "expected contacts * dimension + free = " + std::to_string(folder.contacts) +
                    " * " + std::to_string(folder.dimension) + " + " + std::to_string(folder.free) +
                    ", found " + std::to_string(size));
  }
}

/// @throws InputError unless the file's matrix has this shape
void expect_shape(const Path& file, Index rows, Index columns, Index expected_rows,
                  Index expected_columns, const std::string& why) {
  if (rows != expected_rows || columns != expected_columns) {
    throw InputError(file, 0,
                     "expected " + shape_text(expected_rows, expected_columns) + " (" + why +
                         "), found " + shape_text(rows, columns));
  }
}

Vector read_sized(const Path& file, int size) {
  Vector read = read_vector(file);
  expect_shape(file, read.size(), 1, size, 1, "problem.txt: size " + std::to_string(size));
  return read;
}

void read_given(const Path& path, const KeyValues& description, int size, Problem& problem) {
  problem.q = read_sized(path / "q.mtx", size);
  const CoordinateMatrix W = read_coordinate_matrix(path / "W.mtx");
  if (W.rows != W.columns) {
    throw InputError(path / "W.mtx", 0,
                     "expected a square matrix, found " + shape_text(W.rows, W.columns));
  }
  expect_shape(path / "W.mtx", W.rows, W.columns, size, size,
               "problem.txt: size " + std::to_string(size));
  problem.M = to_sparse(W);
  if (!description.has("storage") || description.text("storage") == "sparse") {
    return;
  }
  if (description.text("storage") != "dense") {
    description.fail("storage",
                     "expected dense or sparse, found " + in_quotes(description.text("storage")));
  }
  if (std::int64_t{size} * size > kMaxInt) {
    description.fail("storage", "dense: " + std::to_string(size) + " rows are too many");
  }
  problem.M = Matrix(std::get<SparseMatrix>(problem.M));
}

/// Calls `f`, and blames what it refuses on the file.
template <typename F>
auto blaming(const Path& file, F&& f) {
  try {
    return f();
  } catch (const std::invalid_argument& error) {
    throw InputError(file, 0, error.what());
  }
}

std::vector<int> body_sizes(const CoordinateMatrix& M, int bodies) {
  const bool known = bodies >= 0 && M.rows == std::int64_t{kBodyFreedom} * bodies;
  return std::vector<int>(known ? bodies : 0, kBodyFreedom);
}

/// H.mtx; its rows are checked against what `why` says, its columns against the size.
SparseMatrix read_columns(const Path& path, Index freedom, int size, const std::string& why) {
  const CoordinateMatrix columns = read_coordinate_matrix(path / "H.mtx");
  expect_shape(path / "H.mtx", columns.rows, columns.columns, freedom, size,
               why + ", problem.txt: size " + std::to_string(size));
  return to_sparse(columns);
}

Vector read_compliance(const Path& path, int size) {
  const Path file = path / "compliance.mtx";
  if (!is_there(file)) {
    return {};
  }
  Vector compliance = read_sized(file, size);
  for (Index i = 0; i < compliance.size(); ++i) {
    if (compliance[i] < 0.0) {
      throw InputError(file, 0,
                       "row " + std::to_string(i + 1) + ": expected a compliance >= 0, found " +
                           number_text(compliance[i]));
    }
  }
  return compliance;
}

void read_with_masses(const Path& path, int size, int bodies, Problem& problem) {
  const Vector f = read_vector(path / "f.mtx");
  const Vector w = read_sized(path / "w.mtx", size);
  const CoordinateMatrix M = read_coordinate_matrix(path / "M.mtx");
  const std::string f_has = "f.mtx has " + std::to_string(f.size()) + " rows";
  expect_shape(path / "M.mtx", M.rows, M.columns, f.size(), f.size(), f_has);
  const SparseMatrix H = read_columns(path, f.size(), size, f_has);

  const MassBlocks blocks = connected_blocks(M, body_sizes(M, bodies));
  FactoredMatrix A;
  const std::vector<Matrix> masses = blaming(path / "M.mtx", [&] {
    std::vector<Matrix> dense = dense_blocks(M, blocks);
    add_masses(dense, blocks, A.mass);
    return dense;
  });
  add_rows(H, blocks, read_compliance(path, size), A);
  problem.q = velocities_without_impulses(H, masses, blocks, f, w);
  for (Index i = 0; i < size; ++i) {
    if (!std::isfinite(problem.q[i])) {
      throw InputError(path, 0,
                       "q = H^T M^-1 f + w: row " + std::to_string(i + 1) + " is not finite");
    }
  }
  problem.M = std::move(A);
}

/// blocks.txt: `dimension inverse|factor`, a line a block.
struct StoredBlocks {
  std::vector<int> sizes;
  std::vector<bool> is_factor;
  int freedom = 0;
};

StoredBlocks read_stored_blocks(const Path& file) {
  TextLines lines(file);
  StoredBlocks blocks;
  while (lines.next_nonblank()) {
    const int size = lines.integer("dimension", 1, kMaxMassBlock);
    const std::string kind(lines.word());
    if (kind != "inverse" && kind != "factor") {
      lines.fail("expected inverse or factor, found " +
                 (kind.empty() ? "the end of the line" : in_quotes(kind)));
    }
    lines.expect_end_of_line("the block");
    if (blocks.freedom > kMaxInt - size) {
      lines.fail("more than " + std::to_string(kMaxInt) + " degrees of freedom");
    }
    blocks.sizes.push_back(size);
    blocks.is_factor.push_back(kind == "factor");
    blocks.freedom += size;
  }
  return blocks;
}

/// Minv.mtx or L.mtx, of which only the blocks of its kind may have entries.
std::vector<Matrix> read_stored_values(const Path& file, const StoredBlocks& stored,
                                       const MassBlocks& blocks, bool is_factor) {
  bool any = false;
  for (const bool kind : stored.is_factor) {
    any = any || kind == is_factor;
  }
  if (!any) {
    return {};
  }
  const CoordinateMatrix M = read_coordinate_matrix(file);
  expect_shape(file, M.rows, M.columns, stored.freedom, stored.freedom,
               "the sum of blocks.txt is " + std::to_string(stored.freedom));
  for (const CoordinateMatrix::Entry& entry : M.entries) {
    if (stored.is_factor[blocks.block[entry.row]] != is_factor) {
      throw InputError(file, entry.line,
                       "row " + std::to_string(entry.row + 1) + " belongs to a block that " +
                           "blocks.txt gives by its " + (is_factor ? "inverse" : "factor"));
    }
  }
  return blaming(file, [&] { return dense_blocks(M, blocks); });
}

void read_with_stored_blocks(const Path& path, int size, Problem& problem) {
  problem.q = read_sized(path / "q.mtx", size);
  const StoredBlocks stored = read_stored_blocks(path / "blocks.txt");
  const MassBlocks blocks = consecutive_blocks(stored.sizes);
  const std::vector<Matrix> inverses = read_stored_values(path / "Minv.mtx", stored, blocks, false);
  const std::vector<Matrix> factors = read_stored_values(path / "L.mtx", stored, blocks, true);
  FactoredMatrix A;
  for (std::size_t b = 0; b < stored.sizes.size(); ++b) {
    const Path file = path / (stored.is_factor[b] ? "L.mtx" : "Minv.mtx");
    try {
      if (stored.is_factor[b]) {
        A.mass.add_factor(factors[b]);
      } else {
        A.mass.add_inverse(inverses[b]);
      }
    } catch (const std::invalid_argument& error) {
      throw InputError(file, 0, block_text(blocks.rows[b]) + ": " + error.what());
    }
  }
  const SparseMatrix H = read_columns(path, stored.freedom, size,
                                      "the sum of blocks.txt is " + std::to_string(stored.freedom));
  add_rows(H, blocks, read_compliance(path, size), A);
  problem.M = std::move(A);
}

bool is_factored(const Path& path, const KeyValues& description) {
  const bool has_W = is_there(path / "W.mtx");
  if (!description.has("form")) {
    return !has_W && is_there(path / "M.mtx");
  }
  if (description.text("form") != "factored") {
    description.fail("form", "expected factored, found " + in_quotes(description.text("form")));
  }
  if (has_W) {
    description.fail("form", "factored, but the folder has a W.mtx");
  }
  return true;
}

void read_matrix(const Path& path, const KeyValues& description, int size, ProblemFolder& folder) {
  if (!is_factored(path, description)) {
    if (is_there(path / "compliance.mtx")) {
      throw InputError(path / "compliance.mtx", 0,
                       "expected none in the given form, whose W.mtx has it on its diagonal");
    }
    read_given(path, description, size, folder.problem);
    return;
  }
  folder.bodies = description.count("bodies", -1);
  if (is_there(path / "blocks.txt")) {
    read_with_stored_blocks(path, size, folder.problem);
  } else {
    read_with_masses(path, size, folder.bodies, folder.problem);
  }
  const int freedom = std::get<FactoredMatrix>(folder.problem.M).degrees_of_freedom();
  if (folder.bodies >= 0 && freedom != std::int64_t{kBodyFreedom} * folder.bodies) {
    description.fail("bodies", "expected the " + std::to_string(freedom) +
                                   " rows of M.mtx / 6, found " + std::to_string(folder.bodies));
  }
}

void read_law(const KeyValues& description, Problem& problem) {
  if (!description.has("friction_law")) {
    return;
  }
  const std::string& law = description.text("friction_law");
  if (law != "coulomb" && law != "associated") {
    description.fail("friction_law", "expected coulomb or associated, found " + in_quotes(law));
  }
  problem.friction_law = law == "coulomb" ? FrictionLaw::kCoulomb : FrictionLaw::kAssociated;
}

/// mu.mtx: one cone a contact.
void read_contacts(const Path& path, ProblemFolder& folder) {
  const Vector mu = read_vector(path / "mu.mtx");
  expect_shape(path / "mu.mtx", mu.size(), 1, folder.contacts, 1,
               "problem.txt: contacts " + std::to_string(folder.contacts));
  for (int c = 0; c < folder.contacts; ++c) {
    if (mu[c] < 0.0) {
      throw InputError(path / "mu.mtx", 0,
                       "contact " + std::to_string(c + 1) +
                           ": expected a friction coefficient >= 0, found " + number_text(mu[c]));
    }
    folder.problem.cones.push_back({c * folder.dimension, folder.dimension, mu[c]});
  }
}

double read_coefficient(TextLines& lines) {
  const double mu = lines.number("friction coefficient");
  if (mu < 0.0) {
    lines.fail("friction coefficient: expected a number >= 0, found " + number_text(mu));
  }
  lines.expect_end_of_line("the friction coefficient");
  return mu;
}

void read_general(const Path& path, int size, Problem& problem) {
  for (const auto& [name, bounds] :
       {std::pair("lower.mtx", &problem.lower), std::pair("upper.mtx", &problem.upper)}) {
    if (is_there(path / name)) {
      *bounds = read_bounds(path / name);
      expect_shape(path / name, bounds->size(), 1, size, 1,
                   "problem.txt: size " + std::to_string(size));
    }
  }
  if (is_there(path / "limits.txt")) {
    TextLines lines(path / "limits.txt");
    while (lines.next_nonblank()) {
      const int row = lines.integer("row", 1, size) - 1;
      const int normal_row = lines.integer("normal row", 1, size) - 1;
      problem.limits.push_back({row, normal_row, read_coefficient(lines)});
    }
  }
  if (is_there(path / "cones.txt")) {
    TextLines lines(path / "cones.txt");
    while (lines.next_nonblank()) {
      const int normal_row = lines.integer("normal row", 1, size) - 1;
      const int dimension = lines.integer("dimension", 2, 3);
      problem.cones.push_back({normal_row, dimension, read_coefficient(lines)});
    }
  }
  blaming(path, [&] { check_shapes(problem); });
}

/// Files that mean something in a general problem only, so that none is passed over in silence.
void refuse_general_files(const Path& path, const std::string& kind) {
  for (const char* name : {"lower.mtx", "upper.mtx", "limits.txt", "cones.txt"}) {
    if (is_there(path / name)) {
      throw InputError(path / name, 0, "expected none for kind " + kind + ", only for general");
    }
  }
}

}  // namespace

ProblemFolder read_problem_folder(const Path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) {
    throw InputError(path, 0,
                     std::filesystem::exists(path, error)
                         ? "expected a problem folder, found a file"
                         : "expected a problem folder, found no such file or folder");
  }
  const KeyValues description(path / "problem.txt");
  ProblemFolder folder;
  read_counts(description, folder);
  const int size = folder.contacts * folder.dimension + folder.free;
  read_matrix(path, description, size, folder);
  read_law(description, folder.problem);
  if (folder.kind == "general") {
    read_general(path, size, folder.problem);
  } else {
    refuse_general_files(path, folder.kind);
  }
  if (folder.kind == "mlcp") {
    folder.problem.lower = Vector::Zero(size);
    folder.problem.lower.head(folder.free).setConstant(-kInfinity);
  }
  if (folder.dimension > 1) {
    read_contacts(path, folder);
  }
  return folder;
}

Problem read_problem(const Path& path) {
  return read_problem_folder(path).problem;
}

// Writing.

namespace {

using Texts = std::map<std::string, std::string>;

bool all_are(const Vector& bounds, double value) {
  return (bounds.array() == value).all();  // true for none
}

/// The number of leading free rows where all others are 0 <= z_i, else -1.
Index leading_free_rows(const Problem& problem) {
  if (!all_are(problem.upper, kInfinity)) {
    return -1;
  }
  Index free = 0;
  while (free < problem.lower.size() && problem.lower[free] == -kInfinity) {
    ++free;
  }
  return all_are(problem.lower.tail(problem.lower.size() - free), 0.0) ? free : -1;
}

/// The dimension of the cones where they follow one another and cover all rows, else 0.
int dimension_of_contacts(const Problem& problem) {
  const int dimension = problem.cones.empty() ? 0 : problem.cones.front().dimension;
  int row = 0;
  for (const FrictionCone& cone : problem.cones) {
    if (cone.normal_row != row || cone.dimension != dimension) {
      return 0;
    }
    row += dimension;
  }
  return row == problem.size() ? dimension : 0;
}

void write_contacts(const Problem& problem, int dimension, Texts& texts) {
  Vector mu(problem.cones.size());
  for (std::size_t c = 0; c < problem.cones.size(); ++c) {
    mu[static_cast<Index>(c)] = problem.cones[c].coefficient;
  }
  texts["problem.txt"] += std::string("kind ") + (dimension == 3 ? "fc3d" : "fc2d") + "\nsize " +
                          std::to_string(problem.size()) + "\ncontacts " +
                          std::to_string(problem.cones.size()) + "\ndimension " +
                          std::to_string(dimension) + "\n";
  texts["mu.mtx"] = matrix_market_text(mu);
}

void write_general(const Problem& problem, Texts& texts) {
  texts["problem.txt"] += "kind general\nsize " + std::to_string(problem.size()) + "\n";
  if (problem.lower.size() > 0) {
    texts["lower.mtx"] = matrix_market_text(problem.lower);
  }
  if (problem.upper.size() > 0) {
    texts["upper.mtx"] = matrix_market_text(problem.upper);
  }
  for (const CoupledLimit& limit : problem.limits) {
    std::string& text = texts["limits.txt"];
    text += std::to_string(limit.row + 1) + " " + std::to_string(limit.normal_row + 1) + " ";
    append_number(limit.coefficient, text);
    text += '\n';
  }
  for (const FrictionCone& cone : problem.cones) {
    std::string& text = texts["cones.txt"];
    text += std::to_string(cone.normal_row + 1) + " " + std::to_string(cone.dimension) + " ";
    append_number(cone.coefficient, text);
    text += '\n';
  }
}

void write_kind(const Problem& problem, Texts& texts) {
  std::string& description = texts["problem.txt"];
  const std::string size = std::to_string(problem.size());
  const bool plain = problem.limits.empty() && problem.cones.empty();
  const Index free = plain ? leading_free_rows(problem) : -1;
  if (free >= 0) {
    description += std::string("kind ") + (free > 0 ? "mlcp" : "lcp") + "\nsize " + size +
                   "\ncontacts " + std::to_string(problem.size() - free) + "\ndimension 1\nfree " +
                   std::to_string(free) + "\n";
    return;
  }
  const int dimension = problem.limits.empty() ? dimension_of_contacts(problem) : 0;
  if (dimension > 0) {
    write_contacts(problem, dimension, texts);
  } else {
    write_general(problem, texts);
  }
  if (!problem.cones.empty()) {
    description += std::string("friction_law ") +
                   (problem.friction_law == FrictionLaw::kCoulomb ? "coulomb\n" : "associated\n");
  }
}

void write_stored_blocks(const BlockMass& mass, Texts& texts) {
  std::vector<Eigen::Triplet<double>> inverses;
  std::vector<Eigen::Triplet<double>> factors;
  std::string& lines = texts["blocks.txt"];
  for (int b = 0; b < mass.block_count(); ++b) {
    lines += std::to_string(mass.dimension(b)) + (mass.is_factor(b) ? " factor\n" : " inverse\n");
    std::vector<Eigen::Triplet<double>>& entries = mass.is_factor(b) ? factors : inverses;
    const auto values = mass.stored(b);
    for (int j = 0; j < mass.dimension(b); ++j) {
      for (int i = 0; i < mass.dimension(b); ++i) {
        if (values(i, j) != 0.0) {
          entries.emplace_back(mass.offset(b) + i, mass.offset(b) + j, values(i, j));
        }
      }
    }
  }
  const auto text = [&mass](const std::vector<Eigen::Triplet<double>>& entries) {
    SparseMatrix matrix(mass.degrees_of_freedom(), mass.degrees_of_freedom());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix_market_text(matrix);
  };
  if (lines.find("inverse") != std::string::npos) {
    texts["Minv.mtx"] = text(inverses);
  }
  if (lines.find("factor") != std::string::npos) {
    texts["L.mtx"] = text(factors);
  }
}

void write_matrix(const Problem& problem, Texts& texts) {
  texts["q.mtx"] = matrix_market_text(problem.q);
  const auto* A = std::get_if<FactoredMatrix>(&problem.M);
  if (A == nullptr) {
    const auto* dense = std::get_if<Matrix>(&problem.M);
    texts["problem.txt"] += dense ? "storage dense\n" : "";
    texts["W.mtx"] =
        dense ? matrix_market_text(*dense) : matrix_market_text(std::get<SparseMatrix>(problem.M));
    return;
  }
  texts["problem.txt"] += "form factored\n";
  write_stored_blocks(A->mass, texts);
  texts["H.mtx"] = matrix_market_text(transposed_jacobian(*A));
  Vector compliance(problem.size());
  for (int i = 0; i < A->rows(); ++i) {
    compliance[i] = A->compliance(i);
  }
  if (!all_are(compliance, 0.0)) {
    texts["compliance.mtx"] = matrix_market_text(compliance);
  }
}

}  // namespace

void write_problem_folder(const Problem& problem, const Path& folder, const Texts& beside) {
  check_shapes(problem);
  if (std::filesystem::exists(folder)) {
    throw std::runtime_error(folder.string() + ": not written: exists");
  }
  Texts texts = beside;
  texts["problem.txt"].clear();
  write_kind(problem, texts);
  write_matrix(problem, texts);
  const SignalsHeld held;
  const Path partial = partial_name(folder);
  try {
    std::filesystem::create_directory(partial);
    for (const auto& [name, text] : texts) {
      write_whole_file(partial / name, text);
    }
    std::filesystem::rename(partial, folder);
  } catch (const std::exception& error) {
    std::error_code ignored;
    std::filesystem::remove_all(partial, ignored);
    throw std::runtime_error(folder.string() + ": not written: " + error.what());
  }
}

}  // namespace signorini::lcp
