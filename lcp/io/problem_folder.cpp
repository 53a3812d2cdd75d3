#include <signorini/lcp/io/matrix_market.h>
#include <signorini/lcp/io/problem_folder.h>
#include <signorini/lcp/io/text_lines.h>
#include <signorini/lcp/io/whole_file.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

namespace signorini::lcp {
namespace {

using Path = std::filesystem::path;
using WideMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using WideVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxInt = std::numeric_limits<int>::max();
constexpr int kBodyFreedom = 6;

std::string shape_text(Index rows, Index columns) {
  return std::to_string(rows) + " x " + std::to_string(columns);
}

/// problem.txt: `key value` lines.
class Description {
 public:
  explicit Description(const Path& file) : file_(file) {
    TextLines lines(file);
    while (lines.next_nonblank()) {
      const std::string key(lines.word());
      const std::string value(lines.word());
      if (value.empty()) {
        lines.fail(key + ": expected a value, found the end of the line");
      }
      lines.expect_end_of_line("the value of " + key);
      if (!values_.emplace(key, Value{value, lines.line_number()}).second) {
        lines.fail(key + ": was given before, in line " + std::to_string(values_[key].line));
      }
    }
  }

  [[nodiscard]] bool has(const std::string& key) const { return values_.contains(key); }

  [[nodiscard]] const std::string& text(const std::string& key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) {
      throw InputError(file_, 0, key + ": expected this key, found none");
    }
    return found->second.text;
  }

  /// An integer >= 0, or `otherwise` where the key is absent.
  [[nodiscard]] int count(const std::string& key, int otherwise) const {
    return has(key) ? count(key) : otherwise;
  }

  [[nodiscard]] int count(const std::string& key) const {
    const std::string& value = text(key);
    const bool digits = value.find_first_not_of("0123456789") == std::string::npos;
    if (!digits || value.size() > 10 || std::stoll(value) > kMaxInt) {
      fail(key, "expected an integer from 0 to " + std::to_string(kMaxInt) + ", found " +
                    in_quotes(value));
    }
    return std::stoi(value);
  }

  /// @throws InputError at the line of the key
  [[noreturn]] void fail(const std::string& key, const std::string& message) const {
    const auto found = values_.find(key);
    throw InputError(file_, found == values_.end() ? 0 : found->second.line, key + ": " + message);
  }

 private:
  struct Value {
    std::string text;
    int line;
  };
  Path file_;
  std::map<std::string, Value> values_;
};

void read_counts(const Description& description, ProblemFolder& folder) {
  static const std::map<std::string, int> kDimensions = {
      {"lcp", 1}, {"mlcp", 1}, {"fc2d", 2}, {"fc3d", 3}};
  folder.kind = description.text("kind");
  const auto kind = kDimensions.find(folder.kind);
  if (kind == kDimensions.end()) {
    description.fail("kind", "expected lcp, mlcp, fc2d or fc3d, found " + in_quotes(folder.kind));
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

void read_given(const Path& path, int size, Problem& problem) {
  const std::string why = "problem.txt: size " + std::to_string(size);
  problem.q = read_vector(path / "q.mtx");
  expect_shape(path / "q.mtx", problem.q.size(), 1, size, 1, why);
  const CoordinateMatrix W = read_coordinate_matrix(path / "W.mtx");
  if (W.rows != W.columns) {
    throw InputError(path / "W.mtx", 0,
                     "expected a square matrix, found " + shape_text(W.rows, W.columns));
  }
  expect_shape(path / "W.mtx", W.rows, W.columns, size, size, why);
  problem.M = to_sparse(W);
}

/// The partition of M's rows into connected blocks.
struct Partition {
  std::vector<std::vector<int>> rows;  // of each block, ascending
  std::vector<int> block;              // of each row
  std::vector<int> position;           // of each row within its block
};

int root_of(std::vector<int>& parent, int row) {
  while (parent[row] != row) {
    row = parent[row] = parent[parent[row]];
  }
  return row;
}

Partition partition(const CoordinateMatrix& M, int bodies) {
  std::vector<int> parent(M.rows);
  std::iota(parent.begin(), parent.end(), 0);
  const auto join = [&parent](int a, int b) {
    const int root_a = root_of(parent, a);
    const int root_b = root_of(parent, b);
    parent[std::max(root_a, root_b)] = std::min(root_a, root_b);
  };
  if (bodies >= 0 && M.rows == std::int64_t{kBodyFreedom} * bodies) {
    for (int row = 0; row < M.rows; ++row) {
      join(row, row - row % kBodyFreedom);
    }
  }
  for (const CoordinateMatrix::Entry& entry : M.entries) {
    if (entry.value != 0.0) {
      join(entry.row, entry.column);
    }
  }
  Partition result;
  result.block.resize(M.rows);
  result.position.resize(M.rows);
  for (int row = 0; row < M.rows; ++row) {
    const int root = root_of(parent, row);
    if (root == row) {
      result.block[row] = static_cast<int>(result.rows.size());
      result.rows.emplace_back();
    }
    result.block[row] = result.block[root];
    std::vector<int>& rows = result.rows[result.block[row]];
    result.position[row] = static_cast<int>(rows.size());
    rows.push_back(row);
  }
  return result;
}

std::string block_text(const std::vector<int>& rows) {
  return "block of rows " + std::to_string(rows.front() + 1) + " to " +
         std::to_string(rows.back() + 1);
}

std::vector<Matrix> dense_blocks(const Path& file, const CoordinateMatrix& M,
                                 const Partition& parts) {
  std::int64_t numbers = 0;
  for (const std::vector<int>& rows : parts.rows) {
    if (rows.size() > kMaxMassBlock) {
      throw InputError(file, 0,
                       block_text(rows) + ": " + std::to_string(rows.size()) +
                           " coupled rows, expected at most " + std::to_string(kMaxMassBlock));
    }
    numbers += static_cast<std::int64_t>(rows.size() * rows.size());
  }
  if (numbers > kMaxInt) {
    throw InputError(file, 0, "its blocks have more than " + std::to_string(kMaxInt) + " numbers");
  }
  std::vector<Matrix> blocks;
  for (const std::vector<int>& rows : parts.rows) {
    blocks.emplace_back(Matrix::Zero(rows.size(), rows.size()));
  }
  for (const CoordinateMatrix::Entry& entry : M.entries) {
    if (entry.value == 0.0) {
      continue;  // couples nothing, so it may lie outside the blocks
    }
    Matrix& block = blocks[parts.block[entry.row]];
    const int i = parts.position[entry.row];
    const int j = parts.position[entry.column];
    block(i, j) = entry.value;
    if (M.symmetric) {
      block(j, i) = entry.value;
    }
  }
  return blocks;
}

/// A diagonal block by its inverse, each number rounded once (a Cholesky factor would round twice);
/// any other by its factor, positive definite by construction.
void add_block(const Matrix& block, BlockMass& mass) {
  if (!block.isDiagonal(0.0)) {
    mass.add_mass(block);
    return;
  }
  const Vector inverse = block.diagonal().cwiseInverse();
  if (!((block.diagonal().array() > 0.0).all() && inverse.allFinite())) {
    throw std::invalid_argument("BlockMass: mass: must be positive definite");
  }
  mass.add_inverse(inverse.asDiagonal().toDenseMatrix());
}

/// M^-1 f in long double.
WideVector solve_blocks(const std::vector<Matrix>& blocks, const Partition& parts,
                        const Vector& f) {
  WideVector v(f.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const WideMatrix block = blocks[b].cast<long double>();
    const WideVector force = f(parts.rows[b]).cast<long double>();
    v(parts.rows[b]) = WideVector(block.llt().solve(force));
  }
  return v;
}

/// The rows of J = H^T: a column of H cut into the blocks it touches.
void add_rows(const SparseMatrix& H, const Partition& parts, FactoredMatrix& A) {
  for (Index i = 0; i < H.outerSize(); ++i) {
    A.add_row();
    std::map<int, Vector> entries;
    for (SparseMatrix::InnerIterator it(H, i); it; ++it) {
      const int block = parts.block[it.row()];
      Vector& values =
          entries.try_emplace(block, Vector::Zero(A.mass.dimension(block))).first->second;
      values[parts.position[it.row()]] = it.value();
    }
    for (const auto& [block, values] : entries) {
      A.add_entry(block, values);
    }
  }
}

void read_factored(const Path& path, int size, int bodies, Problem& problem) {
  const Vector f = read_vector(path / "f.mtx");
  const Vector w = read_vector(path / "w.mtx");
  const CoordinateMatrix M = read_coordinate_matrix(path / "M.mtx");
  const CoordinateMatrix columns = read_coordinate_matrix(path / "H.mtx");
  const Index freedom = f.size();
  const std::string f_has = "f.mtx has " + std::to_string(freedom) + " rows";
  const std::string size_is = "problem.txt: size " + std::to_string(size);
  expect_shape(path / "w.mtx", w.size(), 1, size, 1, size_is);
  expect_shape(path / "M.mtx", M.rows, M.columns, freedom, freedom, f_has);
  expect_shape(path / "H.mtx", columns.rows, columns.columns, freedom, size,
               f_has + ", " + size_is);
  const SparseMatrix H = to_sparse(columns);

  const Partition parts = partition(M, bodies);
  const std::vector<Matrix> blocks = dense_blocks(path / "M.mtx", M, parts);
  FactoredMatrix A;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    try {
      add_block(blocks[b], A.mass);
    } catch (const std::invalid_argument& error) {
      throw InputError(path / "M.mtx", 0, block_text(parts.rows[b]) + ": " + error.what());
    }
  }
  add_rows(H, parts, A);

  const WideVector v = solve_blocks(blocks, parts, f);
  problem.q.resize(size);
  for (Index i = 0; i < size; ++i) {
    long double sum = w[i];
    for (SparseMatrix::InnerIterator it(H, i); it; ++it) {
      sum += it.value() * v[it.row()];
    }
    problem.q[i] = static_cast<double>(sum);
    if (!std::isfinite(problem.q[i])) {
      throw InputError(path, 0,
                       "q = H^T M^-1 f + w: row " + std::to_string(i + 1) + " is not finite");
    }
  }
  problem.M = std::move(A);
}

bool is_factored(const Path& path, const Description& description) {
  std::error_code error;
  const bool has_W = std::filesystem::exists(path / "W.mtx", error);
  if (!description.has("form")) {
    return !has_W && std::filesystem::exists(path / "M.mtx", error);
  }
  if (description.text("form") != "factored") {
    description.fail("form", "expected factored, found " + in_quotes(description.text("form")));
  }
  if (has_W) {
    description.fail("form", "factored, but the folder has a W.mtx");
  }
  return true;
}

void read_friction(const Path& path, ProblemFolder& folder) {
  folder.mu = read_vector(path / "mu.mtx");
  expect_shape(path / "mu.mtx", folder.mu.size(), 1, folder.contacts, 1,
               "problem.txt: contacts " + std::to_string(folder.contacts));
  for (Index c = 0; c < folder.mu.size(); ++c) {
    if (folder.mu[c] < 0.0) {
      throw InputError(path / "mu.mtx", 0,
                       "contact " + std::to_string(c + 1) +
                           ": expected a friction coefficient >= 0, found " +
                           std::to_string(folder.mu[c]));
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
  const Description description(path / "problem.txt");
  ProblemFolder folder;
  read_counts(description, folder);
  const int size = folder.contacts * folder.dimension + folder.free;
  if (is_factored(path, description)) {
    folder.bodies = description.count("bodies", -1);
    read_factored(path, size, folder.bodies, folder.problem);
    const int freedom = std::get<FactoredMatrix>(folder.problem.M).degrees_of_freedom();
    if (folder.bodies >= 0 && freedom != std::int64_t{kBodyFreedom} * folder.bodies) {
      description.fail("bodies", "expected the " + std::to_string(freedom) +
                                     " rows of M.mtx / 6, found " + std::to_string(folder.bodies));
    }
  } else {
    read_given(path, size, folder.problem);
  }
  if (folder.kind == "mlcp") {
    folder.problem.lower = Vector::Zero(size);
    folder.problem.lower.head(folder.free).setConstant(-kInfinity);
  }
  if (folder.dimension > 1) {
    read_friction(path, folder);
  }
  return folder;
}

Problem read_problem(const Path& path) {
  ProblemFolder folder = read_problem_folder(path);
  if (folder.dimension > 1) {
    throw InputError(path / "problem.txt", 0,
                     "kind: " + folder.kind +
                         " has friction cones, which no solver here takes yet; expected lcp or "
                         "mlcp");
  }
  return std::move(folder.problem);
}

namespace {

void check_writable(const ProblemFolder& folder) {
  const Problem& problem = folder.problem;
  check_shapes(problem);
  if (!problem.limits.empty()) {
    throw std::invalid_argument("ProblemFolder: problem.limits: the format has no coupled limits");
  }
  for (Index i = 0; i < problem.size(); ++i) {
    const double lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    const double upper = problem.upper.size() > 0 ? problem.upper[i] : kInfinity;
    if (lower != (i < folder.free ? -kInfinity : 0.0) || upper != kInfinity) {
      throw std::invalid_argument("ProblemFolder: bounds of row " + std::to_string(i) +
                                  ": the format has no such bounds for kind " + folder.kind +
                                  " with " + std::to_string(folder.free) + " free rows");
    }
  }
  if (std::int64_t{folder.contacts} * folder.dimension + folder.free != problem.size()) {
    throw std::invalid_argument("ProblemFolder: contacts * dimension + free: must be " +
                                std::to_string(problem.size()));
  }
  if (folder.mu.size() != (folder.dimension > 1 ? folder.contacts : 0)) {
    throw std::invalid_argument("ProblemFolder: mu: " + std::to_string(folder.mu.size()) +
                                " numbers for " + std::to_string(folder.contacts) +
                                " contacts of dimension " + std::to_string(folder.dimension));
  }
  if (const auto* A = std::get_if<FactoredMatrix>(&problem.M)) {
    for (int i = 0; i < A->rows(); ++i) {
      if (A->compliance(i) != 0.0) {
        throw std::invalid_argument("ProblemFolder: compliance of row " + std::to_string(i) +
                                    ": the format has none");
      }
    }
  }
}

/// M = W^-1, block by block, in long double, rounded once.
SparseMatrix mass_matrix(const BlockMass& mass) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (int b = 0; b < mass.block_count(); ++b) {
    const int d = mass.dimension(b);
    WideMatrix inverse(d, d);
    for (int j = 0; j < d; ++j) {
      const WideVector unit = WideVector::Unit(d, j);
      mass.apply_inverse(b, unit.data(), inverse.col(j).data());
    }
    const WideMatrix block = inverse.llt().solve(WideMatrix::Identity(d, d));
    for (int j = 0; j < d; ++j) {
      for (int i = j; i < d; ++i) {
        const auto value = static_cast<double>(block(i, j));
        triplets.emplace_back(mass.offset(b) + i, mass.offset(b) + j, value);
        if (i != j) {
          triplets.emplace_back(mass.offset(b) + j, mass.offset(b) + i, value);
        }
      }
    }
  }
  SparseMatrix M(mass.degrees_of_freedom(), mass.degrees_of_freedom());
  M.setFromTriplets(triplets.begin(), triplets.end());
  return M;
}

SparseMatrix transposed_jacobian(const FactoredMatrix& A) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (int i = 0; i < A.rows(); ++i) {
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      for (int k = 0; k < A.mass.dimension(entry.block); ++k) {
        triplets.emplace_back(A.mass.offset(entry.block) + k, i, A.values(entry)[k]);
      }
    }
  }
  SparseMatrix H(A.degrees_of_freedom(), A.rows());
  H.setFromTriplets(triplets.begin(), triplets.end());
  return H;
}

/// File names and their text.
std::map<std::string, std::string> folder_texts(const ProblemFolder& folder) {
  const Problem& problem = folder.problem;
  std::map<std::string, std::string> texts;
  std::string& description = texts["problem.txt"];
  description = "kind " + folder.kind + "\nsize " + std::to_string(problem.size()) + "\ncontacts " +
                std::to_string(folder.contacts) + "\ndimension " +
                std::to_string(folder.dimension) + "\nfree " + std::to_string(folder.free) + "\n";
  if (const auto* A = std::get_if<FactoredMatrix>(&problem.M)) {
    description += "form factored\n";
    if (folder.bodies >= 0) {
      description += "bodies " + std::to_string(folder.bodies) + "\n";
    }
    texts["M.mtx"] = matrix_market_text(mass_matrix(A->mass));
    texts["H.mtx"] = matrix_market_text(transposed_jacobian(*A));
    texts["f.mtx"] = matrix_market_text(Vector(Vector::Zero(A->degrees_of_freedom())));
    texts["w.mtx"] = matrix_market_text(problem.q);
  } else {
    const auto* sparse = std::get_if<SparseMatrix>(&problem.M);
    texts["W.mtx"] = matrix_market_text(
        sparse ? *sparse : SparseMatrix(std::get<Matrix>(problem.M).sparseView(1.0, 0.0)));
    texts["q.mtx"] = matrix_market_text(problem.q);
  }
  if (folder.dimension > 1) {
    texts["mu.mtx"] = matrix_market_text(folder.mu);
  }
  return texts;
}

}  // namespace

void write_problem_folder(const ProblemFolder& problem, const Path& folder) {
  check_writable(problem);
  if (std::filesystem::exists(folder)) {
    throw std::runtime_error(folder.string() + ": not written: exists");
  }
  const std::map<std::string, std::string> texts = folder_texts(problem);
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
