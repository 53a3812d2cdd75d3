#include <signorini/lcp/io/fclib.h>
#include <signorini/lcp/io/hdf5_file.h>

#include "tests/lcp/temporary_folder.h"

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double draw(std::mt19937_64& random) {
  return std::normal_distribution<double>()(random);
}

Vector random_vector(Index n, std::mt19937_64& random) {
  return Vector::NullaryExpr(n, [&] { return draw(random); });
}

/// G^T G with G 4 x n.
Matrix random_gram(Index n, std::mt19937_64& random) {
  const Matrix G = Matrix::NullaryExpr(4, n, [&] { return draw(random); });
  return G.transpose() * G;
}

Problem cones(int dimension, int contacts, int free = 0) {
  std::mt19937_64 random(dimension + 10 * contacts);
  Problem problem;
  const Index n = free + dimension * contacts;
  problem.M = random_gram(n, random);
  problem.q = random_vector(n, random);
  for (int c = 0; c < contacts; ++c) {
    problem.cones.push_back({free + c * dimension, dimension, 0.1 * c});
  }
  if (free > 0) {
    problem.lower = Vector::Zero(n);
    problem.lower.head(free).setConstant(-kInfinity);
  }
  return problem;
}

Problem factored(int free) {
  std::mt19937_64 random(3);
  FactoredMatrix A;
  A.mass.add_inverse(Matrix(Vector::LinSpaced(6, 0.5, 2.0).asDiagonal()));
  A.mass.add_mass(random_gram(4, random) + Matrix::Identity(4, 4));
  Problem problem = cones(3, 2, free);
  for (Index i = 0; i < problem.size(); ++i) {
    A.add_row();
    A.add_entry(0, random_vector(6, random));
    if (i % 2 == 0) {
      A.add_entry(1, random_vector(4, random));
    }
  }
  problem.M = std::move(A);
  return problem;
}

FclibProblem read_back(const FclibProblem& fclib) {
  const TemporaryFolder folder;
  write_fclib(fclib, folder.path() / "problem.hdf5");
  EXPECT_EQ(entries_in(folder.path()), 1) << "a partial file was left";
  return read_fclib(folder.path() / "problem.hdf5");
}

void expect_same_rows(const Problem& a, const Problem& b) {
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.friction_law, b.friction_law);
  ASSERT_EQ(a.cones.size(), b.cones.size());
  for (std::size_t c = 0; c < a.cones.size(); ++c) {
    EXPECT_EQ(a.cones[c].normal_row, b.cones[c].normal_row);
    EXPECT_EQ(a.cones[c].dimension, b.cones[c].dimension);
    EXPECT_EQ(a.cones[c].coefficient, b.cones[c].coefficient);
  }
}

TEST(Fclib, LocalFormRoundTripsToTheBit) {
  for (const Problem& problem : {cones(3, 3), cones(2, 4), cones(3, 2, 4), cones(3, 0)}) {
    FclibProblem original;
    original.problem = problem;
    original.title = "a title";
    original.description = "a description\nof two lines";
    std::mt19937_64 random(1);
    original.solution = random_vector(problem.size(), random);
    original.guesses = {random_vector(problem.size(), random),
                        random_vector(problem.size(), random)};
    const FclibProblem read = read_back(original);
    EXPECT_EQ(to_dense(read.problem.M), to_dense(problem.M));
    expect_same_rows(read.problem, problem);
    EXPECT_EQ(read.title, original.title);
    EXPECT_EQ(read.description, original.description);
    EXPECT_EQ(read.math_info, "");
    EXPECT_EQ(read.solution, original.solution);
    EXPECT_EQ(read.guesses, original.guesses);
    EXPECT_TRUE(read.notes.empty());
  }
}

TEST(Fclib, FrictionlessProblemsHaveSpacedimOne) {
  FclibProblem original;
  std::mt19937_64 random(2);
  original.problem.M = random_gram(5, random);
  original.problem.q = random_vector(5, random);
  const FclibProblem read = read_back(original);
  EXPECT_TRUE(read.problem.is_lcp());
  EXPECT_EQ(to_dense(read.problem.M), to_dense(original.problem.M));
}

TEST(Fclib, GlobalFormRoundTripsWithItsBlocks) {
  for (const int free : {0, 3}) {
    FclibProblem original;
    original.problem = factored(free);
    std::mt19937_64 random(1);
    original.solution = random_vector(original.problem.size(), random);
    const FclibProblem read = read_back(original);
    expect_same_rows(read.problem, original.problem);
    EXPECT_EQ(read.solution, original.solution);
    const auto& A = std::get<FactoredMatrix>(read.problem.M);
    ASSERT_EQ(A.mass.block_count(), 2);
    EXPECT_EQ(A.mass.dimension(0), 6);
    // M is the inverse of the inverse mass: two roundings of numbers of size 1 and a Cholesky
    // factor of a 4 x 4 matrix with a condition number below 100.
    const Matrix W = to_dense(original.problem.M);
    EXPECT_LE((to_dense(read.problem.M) - W).cwiseAbs().maxCoeff(),
              1e-13 * W.cwiseAbs().maxCoeff());
  }
}

TEST(Fclib, ComplianceIsWrittenInTheLocalForm) {
  FclibProblem original;
  original.problem = factored(0);
  auto& A = std::get<FactoredMatrix>(original.problem.M);
  FactoredMatrix compliant;
  compliant.mass = A.mass;
  for (int i = 0; i < A.rows(); ++i) {
    compliant.add_row(0.5);
    for (const FactoredMatrix::Entry& entry : A.entries(i)) {
      compliant.add_entry(entry.block,
                          Eigen::Map<const Vector>(A.values(entry), A.mass.dimension(entry.block)));
    }
  }
  A = std::move(compliant);
  const FclibProblem read = read_back(original);
  EXPECT_TRUE(std::holds_alternative<SparseMatrix>(read.problem.M));
  EXPECT_EQ(to_dense(read.problem.M), to_dense(original.problem.M));
}

TEST(Fclib, RefusesToWriteWhatItCannotSay) {
  const TemporaryFolder folder;
  const auto refused = [&folder](const std::function<void(Problem&)>& change, int free = 0) {
    FclibProblem fclib;
    fclib.problem = cones(3, 2, free);
    change(fclib.problem);
    EXPECT_THROW(write_fclib(fclib, folder.path() / "x.hdf5"), std::invalid_argument);
    EXPECT_EQ(entries_in(folder.path()), 0);
  };
  refused([](Problem& p) { p.friction_law = FrictionLaw::kAssociated; });
  refused([](Problem& p) { p.cones.pop_back(); });
  refused([](Problem& p) { p.cones[1].dimension = 2; });
  refused([](Problem& p) { std::swap(p.cones[0], p.cones[1]); });
  refused([](Problem& p) { p.cones.clear(), p.upper = Vector::Ones(6); });
  refused([](Problem& p) { p.cones.clear(), p.limits.push_back({1, 0, 0.5}); });
  refused([](Problem& p) { p.q[2] = kInfinity; });
  refused([](Problem& p) { std::get<Matrix>(p.M)(0, 5) += 1.0; }, 2);
  FclibProblem short_solution;
  short_solution.problem = cones(3, 2);
  short_solution.solution = Vector::Zero(5);
  EXPECT_THROW(write_fclib(short_solution, folder.path() / "x.hdf5"), std::invalid_argument);
  EXPECT_EQ(entries_in(folder.path()), 0);
}

TEST(Fclib, NothingIsLeftWhereTheFileCannotBeMade) {
  const TemporaryFolder folder;
  FclibProblem fclib;
  fclib.problem = cones(3, 1);
  EXPECT_THROW(write_fclib(fclib, folder.path() / "no" / "x.hdf5"), std::runtime_error);
  std::filesystem::create_directory(folder.path() / "x.hdf5");
  EXPECT_THROW(write_fclib(fclib, folder.path() / "x.hdf5"), std::runtime_error);
  EXPECT_EQ(entries_in(folder.path()), 1);
}

/// One contact in the plane, W = [2 1; 1 3] with the zero written, in any encoding. What a test
/// wants to be wrong it replaces through `change`.
struct LocalFile {
  int spacedim = 2;
  int m = 2, n = 2, nz = -1, nzmax = 4;
  std::vector<int> p = {0, 2, 4};
  std::vector<int> i = {0, 1, 0, 1};
  std::vector<double> x = {2.0, 1.0, 1.0, 3.0};
  std::vector<double> q = {-1.0, 0.5};
  std::vector<double> mu = {0.25};
  std::string left_out;

  void write(const std::filesystem::path& path) const {
    const Hdf5Session session;
    Hdf5Writer file(path);
    const auto wanted = [this](const char* name) { return left_out != name; };
    file.group("/fclib_local");
    file.group("/fclib_local/W");
    file.group("/fclib_local/vectors");
    if (wanted("spacedim")) file.integer("/fclib_local/spacedim", spacedim);
    if (wanted("m")) file.integer("/fclib_local/W/m", m);
    if (wanted("n")) file.integer("/fclib_local/W/n", n);
    if (wanted("nz")) file.integer("/fclib_local/W/nz", nz);
    if (wanted("nzmax")) file.integer("/fclib_local/W/nzmax", nzmax);
    if (wanted("p")) file.integers("/fclib_local/W/p", p);
    if (wanted("i")) file.integers("/fclib_local/W/i", i);
    if (wanted("x")) file.numbers("/fclib_local/W/x", x);
    if (wanted("q")) file.numbers("/fclib_local/vectors/q", q);
    if (wanted("mu")) file.numbers("/fclib_local/vectors/mu", mu);
    file.commit();
  }
};

FclibProblem read_file(const LocalFile& local) {
  const TemporaryFolder folder;
  local.write(folder.path() / "x.hdf5");
  return read_fclib(folder.path() / "x.hdf5");
}

/// A nonsymmetric 2 x 2 matrix, so that rows cannot pass for columns.
const Matrix kW{{2.0, 0.0}, {5.0, 3.0}};

TEST(Fclib, ReadsColumnsRowsAndTriplets) {
  LocalFile columns;
  columns.x = {2.0, 5.0, 0.0, 3.0};
  EXPECT_EQ(to_dense(read_file(columns).problem.M), kW);
  LocalFile rows = columns;
  rows.nz = -2;
  rows.x = {2.0, 0.0, 5.0, 3.0};
  EXPECT_EQ(to_dense(read_file(rows).problem.M), kW);
  LocalFile triplets;
  triplets.nz = 4;
  triplets.p = {1, 0, 0, 0};  // columns, as CSparse has it
  triplets.i = {1, 0, 1, 1};
  triplets.x = {3.0, 2.0, 4.0, 1.0};  // the repeated entry is summed
  EXPECT_EQ(to_dense(read_file(triplets).problem.M), kW);
  LocalFile spare = columns;  // more room than entries
  spare.nzmax = 6;
  spare.i.insert(spare.i.end(), {99, -7});
  spare.x.insert(spare.x.end(), {0.0, 0.0});
  EXPECT_EQ(to_dense(read_file(spare).problem.M), kW);
}

TEST(Fclib, TripletsWithRowsInPAreReadWhereNothingElseFits) {
  const TemporaryFolder folder;
  FclibProblem fclib;
  fclib.problem = factored(0);
  const auto path = folder.path() / "x.hdf5";
  {
    // H is 2 x 3 (two degrees of freedom, one contact), its entry (2, 3) = 7 given as p, i = 1, 2.
    const Hdf5Session session;
    Hdf5Writer file(path);
    const std::string g = "/fclib_global";
    file.group(g);
    file.integer(g + "/spacedim", 3);
    for (const bool is_mass : {true, false}) {
      const std::string matrix = g + (is_mass ? "/M" : "/H");
      const int count = is_mass ? 2 : 1;
      file.group(matrix);
      file.integer(matrix + "/m", 2);
      file.integer(matrix + "/n", is_mass ? 2 : 3);
      file.integer(matrix + "/nz", count);
      file.integer(matrix + "/nzmax", count);
      file.integers(matrix + "/p", is_mass ? std::vector<int>{0, 1} : std::vector<int>{1});
      file.integers(matrix + "/i", is_mass ? std::vector<int>{0, 1} : std::vector<int>{2});
      file.numbers(matrix + "/x",
                   is_mass ? std::vector<double>{1.0, 4.0} : std::vector<double>{7.0});
    }
    file.group(g + "/vectors");
    file.numbers(g + "/vectors/f", std::vector<double>{3.0, 8.0});
    file.numbers(g + "/vectors/w", std::vector<double>{0.0, 0.0, 1.0});
    file.numbers(g + "/vectors/mu", std::vector<double>{0.5});
    file.commit();
  }
  const FclibProblem read = read_fclib(path);
  ASSERT_EQ(read.notes.size(), 1U);
  EXPECT_EQ(read.notes[0],
            "/fclib_global/H: triplets read with rows in p and columns in i, the only fit");
  EXPECT_EQ(read.problem.q, Vector(Eigen::Vector3d(0.0, 0.0, 15.0)));  // 7 * 8 / 4 + 1
  EXPECT_EQ(to_dense(read.problem.M)(2, 2), 12.25);
}

struct BadFile {
  const char* name;
  void (*change)(LocalFile&);
  std::string message;
};

void PrintTo(const BadFile& bad, std::ostream* stream) {
  *stream << bad.name;
}

class RefusesFile : public testing::TestWithParam<BadFile> {};

TEST_P(RefusesFile, NamingDataSetValueAndExpectation) {
  const TemporaryFolder folder;
  LocalFile local;
  GetParam().change(local);
  const auto path = folder.path() / "x.hdf5";
  local.write(path);
  try {
    (void)read_fclib(path);
    ADD_FAILURE() << "was read";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), path.string() + ": /fclib_local/" + GetParam().message);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Fclib, RefusesFile,
    testing::Values(
        BadFile{"NoSpacedim", [](LocalFile& f) { f.left_out = "spacedim"; },
                "spacedim: expected this data set, found none"},
        BadFile{"SpacedimFour", [](LocalFile& f) { f.spacedim = 4; },
                "spacedim: expected an integer from 1 to 3, found 4"},
        BadFile{"SpacedimAgainstRows", [](LocalFile& f) { f.spacedim = 3; },
                "spacedim: expected a divisor of the 2 contact rows, found 3"},
        BadFile{"NoX", [](LocalFile& f) { f.left_out = "x"; },
                "W/x: expected this data set, found none"},
        BadFile{"NegativeRows", [](LocalFile& f) { f.m = -1; },
                "W/m: expected an integer from 0 to 2147483647, found -1"},
        BadFile{"NotSquare",
                [](LocalFile& f) {
                  f.n = 3, f.p = {0, 2, 4, 4};
                },
                "W/n: expected 2 (as many columns as rows), found 3"},
        BadFile{"UnknownEncoding", [](LocalFile& f) { f.nz = -3; },
                "W/nz: expected an integer from -2 to 2147483647, found -3"},
        BadFile{"PointersTooShort",
                [](LocalFile& f) {
                  f.p = {0, 4};
                },
                "W/p: expected 3 integers (/fclib_local/W/n + 1 is 3), found 2"},
        BadFile{"PointersDescend",
                [](LocalFile& f) {
                  f.p = {0, 3, 2};
                },
                "W/p: pointer 3: expected an integer from 3 to 4, found 2"},
        BadFile{"PointersBeyondTheEnd",
                [](LocalFile& f) {
                  f.p = {0, 2, 5};
                },
                "W/p: pointer 3: expected an integer from 2 to 4, found 5"},
        BadFile{"PointersStartLate",
                [](LocalFile& f) {
                  f.p = {1, 2, 4};
                },
                "W/p: pointer 1: expected an integer from 0 to 0, found 1"},
        BadFile{"IndexTooLarge", [](LocalFile& f) { f.i[1] = 2; },
                "W/i: index 2: expected an integer from 0 to 1, found 2"},
        BadFile{"IndexNegative", [](LocalFile& f) { f.i[3] = -1; },
                "W/i: index 4: expected an integer from 0 to 1, found -1"},
        BadFile{"NzmaxTooLarge", [](LocalFile& f) { f.nzmax = 2000000000; },
                "W/i: expected 2000000000 integers (/fclib_local/W/nzmax is 2000000000), found 4"},
        BadFile{"ValueIsNan",
                [](LocalFile& f) { f.x[2] = std::numeric_limits<double>::quiet_NaN(); },
                "W/x: number 3: expected a finite number, found nan"},
        BadFile{"TripletOutOfRange",
                [](LocalFile& f) {
                  f.nz = 4, f.p = {0, 0, 1, 9}, f.i = {0, 1, 0, 1};
                },
                "W/p: index 4: expected an integer from 0 to 1, found 9"},
        BadFile{"QTooShort", [](LocalFile& f) { f.q = {1.0}; },
                "vectors/q: expected 2 numbers (/fclib_local/W/m is 2), found 1"},
        BadFile{"NoMu", [](LocalFile& f) { f.left_out = "mu"; },
                "vectors/mu: expected this data set, found none"},
        BadFile{"MuNegative", [](LocalFile& f) { f.mu = {-0.5}; },
                "vectors/mu: contact 1: expected a friction coefficient >= 0, found -0.5"},
        BadFile{"MuWithoutCones",
                [](LocalFile& f) {
                  f.spacedim = 1, f.mu = {0.0, 0.5};
                },
                "vectors/mu: contact 2: expected 0 (spacedim is 1), found 0.5"}),
    [](const auto& tested) { return std::string(tested.param.name); });

/// Writes a data set of another kind under a name that read_fclib() expects.
void replace(const std::filesystem::path& path, const std::string& name,
             const std::function<void(hid_t)>& write) {
  const Hdf5Session session;
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), &H5Fclose);
  ASSERT_TRUE(file.good());
  ASSERT_GE(H5Ldelete(file.get(), name.c_str(), H5P_DEFAULT), 0);
  write(file.get());
}

std::string error_of(const std::filesystem::path& path) {
  try {
    (void)read_fclib(path);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(path.string().size() + 2);
  }
  return "was read";
}

TEST(Fclib, DataSetsOfAnotherKindAreRefused) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.hdf5";
  const auto with = [&](const std::string& name, hid_t type, std::vector<hsize_t> shape) {
    LocalFile().write(path);
    replace(path, name, [&](hid_t file) {
      const Hdf5Handle space(
          H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), &H5Sclose);
      const Hdf5Handle data(
          H5Dcreate2(file, name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
          &H5Dclose);
      const std::vector<char> zeros(1000, 0);
      hsize_t count = 1;
      for (const hsize_t size : shape) {
        count *= size;
      }
      if (count * H5Tget_size(type) <= zeros.size()) {
        H5Dwrite(data.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data());
      }
    });
    return error_of(path);
  };
  EXPECT_EQ(with("/fclib_local/W/p", H5T_NATIVE_DOUBLE, {3}),
            "/fclib_local/W/p: expected integers, found another type");
  EXPECT_EQ(with("/fclib_local/W/x", H5T_C_S1, {4}),
            "/fclib_local/W/x: expected numbers, found another type");
  EXPECT_EQ(with("/fclib_local/W/x", H5T_NATIVE_DOUBLE, {2, 2}),
            "/fclib_local/W/x: expected a list (rank 1), found rank 2");
  EXPECT_EQ(with("/fclib_local/W/x", H5T_NATIVE_DOUBLE, {1000000000}),
            "/fclib_local/W/x: declares 1000000000 numbers, the file stores 0 bytes of them");
  LocalFile().write(path);
  replace(path, "/fclib_local/W/nz", [](hid_t file) {
    const Hdf5Handle group(
        H5Gcreate2(file, "/fclib_local/W/nz", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), &H5Gclose);
  });
  EXPECT_EQ(error_of(path), "/fclib_local/W/nz: expected a data set, found something else");
  LocalFile().write(path);
  replace(path, "/fclib_local", [](hid_t) {});
  EXPECT_EQ(error_of(path), "/: expected a group fclib_local or fclib_global, found neither");
  LocalFile().write(path);
  replace(path, "/fclib_local/W/x", [](hid_t file) {
    H5Lcreate_soft("/fclib_local/W/x", file, "/fclib_local/W/x", H5P_DEFAULT, H5P_DEFAULT);
  });
  EXPECT_EQ(error_of(path), "/fclib_local/W/x: expected this data set, found none");
}

TEST(Fclib, OtherIntegerAndFloatTypesAreRead) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.hdf5";
  LocalFile().write(path);
  replace(path, "/fclib_local/W/p", [](hid_t file) {
    const hsize_t count = 3;
    const std::int64_t values[] = {0, 2, 4};
    const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), &H5Sclose);
    const Hdf5Handle data(H5Dcreate2(file, "/fclib_local/W/p", H5T_STD_I64BE, space.get(),
                                     H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                          &H5Dclose);
    H5Dwrite(data.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  });
  EXPECT_EQ(to_dense(read_fclib(path).problem.M), (Matrix{{2.0, 1.0}, {1.0, 3.0}}));
}

TEST(Fclib, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.hdf5";
  LocalFile().write(path);
  const std::string whole = read_text(path);
  for (std::size_t length = 0; length < whole.size(); length += 97) {
    folder.write("x.hdf5", whole.substr(0, length));
    EXPECT_THROW((void)read_fclib(path), InputError) << "of " << length << " bytes";
  }
  EXPECT_THROW((void)read_fclib(folder.path()), InputError);
  EXPECT_THROW((void)read_fclib(folder.path() / "absent"), InputError);
}

/// Reads 300 files of which a byte is wrong.
void read_damaged_files() {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.hdf5";
  LocalFile().write(path);
  const std::string whole = read_text(path);
  std::mt19937_64 random(7);
  for (int k = 0; k < 300; ++k) {
    std::string damaged = whole;
    damaged[random() % damaged.size()] ^= static_cast<char>(1 + random() % 255);
    folder.write("x.hdf5", damaged);
    try {
      check_shapes(read_fclib(path).problem);
    } catch (const InputError&) {
    }
  }
}

// In a process of its own: HDF5 itself loses what it opened in a damaged file.
TEST(Fclib, FlippedBytesAreReadOrRefused) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto read_and_leave = [] {
    read_damaged_files();
    std::_Exit(0);
  };
  EXPECT_EXIT(read_and_leave(), testing::ExitedWithCode(0), "");
}

/// h5dump, if it is installed, sees the layout of FCLIB.
TEST(Fclib, H5dumpSeesTheLayout) {
  if (std::system("h5dump --version >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "no h5dump";
  }
  const TemporaryFolder folder;
  FclibProblem fclib;
  fclib.problem = factored(2);
  fclib.title = "two bodies";
  fclib.solution = Vector::Ones(8);
  fclib.guesses = {Vector::Zero(8)};
  write_fclib(fclib, folder.path() / "global.hdf5");
  fclib.problem.M = to_dense(fclib.problem.M);
  write_fclib(fclib, folder.path() / "local.hdf5");
  const auto contents = [&folder](const std::string& name) {
    const std::string out = (folder.path() / "out").string();
    const std::string file = (folder.path() / name).string();
    EXPECT_EQ(std::system(("h5dump -n " + file + " >" + out).c_str()), 0);
    return read_text(out);
  };
  const std::string global = contents("global.hdf5");
  for (const char* name : {"/fclib_global/spacedim",
                           "/fclib_global/M/nzmax",
                           "/fclib_global/M/m",
                           "/fclib_global/M/n",
                           "/fclib_global/M/nz",
                           "/fclib_global/M/p",
                           "/fclib_global/M/i",
                           "/fclib_global/M/x",
                           "/fclib_global/H/x",
                           "/fclib_global/G/x",
                           "/fclib_global/vectors/f",
                           "/fclib_global/vectors/w",
                           "/fclib_global/vectors/b",
                           "/fclib_global/vectors/mu",
                           "/fclib_global/info/title",
                           "/solution/v",
                           "/solution/u",
                           "/solution/r",
                           "/solution/l",
                           "/guesses/number_of_guesses",
                           "/guesses/1/r"}) {
    EXPECT_NE(global.find(std::string("dataset    ") + name + "\n"), std::string::npos) << name;
  }
  const std::string local = contents("local.hdf5");
  for (const char* name : {"/fclib_local/spacedim", "/fclib_local/W/x", "/fclib_local/V/p",
                           "/fclib_local/R/i", "/fclib_local/vectors/q", "/fclib_local/vectors/s",
                           "/fclib_local/vectors/mu", "/solution/u", "/solution/l"}) {
    EXPECT_NE(local.find(std::string("dataset    ") + name + "\n"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace signorini::lcp
