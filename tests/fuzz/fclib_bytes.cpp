#include <signorini/lcp/io/fclib.h>
#include <signorini/lcp/io/hdf5_file.h>

#include "byte_reader.h"
#include "lcp_bytes.h"
#include "tests/lcp/temporary_folder.h"

#include <array>
#include <string>
#include <vector>

namespace signorini::testing {
namespace {

constexpr std::array kLocal = {"spacedim", "W/m", "W/n",      "W/nz",      "W/nzmax",
                               "W/p",      "W/i", "W/x",      "vectors/q", "vectors/mu",
                               "V/m",      "R/m", "vectors/s"};
constexpr std::array kGlobal = {
    "spacedim", "M/m",       "M/n",       "M/nz",       "M/nzmax", "M/p",
    "M/i",      "M/x",       "H/m",       "H/n",        "H/p",     "H/i",
    "H/x",      "vectors/f", "vectors/w", "vectors/mu", "G/m",     "signorini_blocks"};

/// Two contacts in the plane, the matrix given or factored.
lcp::FclibProblem valid(bool factored) {
  lcp::FclibProblem fclib;
  lcp::Problem& problem = fclib.problem;
  problem.q = lcp::Vector{{-1.0, 0.25, -2.0, 0.5}};
  problem.cones = {{0, 2, 0.5}, {2, 2, 0.0}};
  if (!factored) {
    problem.M = lcp::SparseMatrix(lcp::Matrix(2.0 * lcp::Matrix::Identity(4, 4)).sparseView());
    return fclib;
  }
  lcp::FactoredMatrix A;
  A.mass.add_inverse(lcp::Matrix::Identity(3, 3));
  for (int i = 0; i < 4; ++i) {
    A.add_row();
    A.add_entry(0, lcp::Vector::LinSpaced(3, i, 1.0));
  }
  problem.M = std::move(A);
  return fclib;
}

/// Puts another data set into the place of one: whole or real numbers, of any shape.
void replace(hid_t file, const std::string& name, ByteReader& bytes) {
  if (H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0) {
    H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  }
  const int rank = bytes.below(3);
  std::array<hsize_t, 2> shape{};
  hsize_t count = 1;
  for (int k = 0; k < rank; ++k) {
    shape[k] = bytes.byte() % 12;
    count *= shape[k];
  }
  const bool real = bytes.below(2) == 1;
  std::vector<double> numbers(count);
  std::vector<int> whole(count);
  for (hsize_t k = 0; k < count; ++k) {
    numbers[k] = bytes.number();
    whole[k] = bytes.byte() >= 250 ? 1'000'000'000 : static_cast<int>(bytes.byte() % 8) - 2;
  }
  const lcp::Hdf5Handle space(
      rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, shape.data(), nullptr), H5Sclose);
  const hid_t type = real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT;
  const lcp::Hdf5Handle made(
      H5Dcreate2(file, name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  if (made.good() && count > 0) {
    const void* from = real ? static_cast<const void*>(numbers.data()) : whole.data();
    H5Dwrite(made.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, from);
  }
}

}  // namespace

void judge_fclib_bytes(const std::uint8_t* data, std::size_t size) {
  ByteReader bytes(data, size);
  const lcp::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "problem.hdf5";
  const bool global = bytes.below(2) == 1;
  lcp::write_fclib(valid(global), path);
  {
    const lcp::Hdf5Session quiet;
    const lcp::Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    for (int changes = 1 + bytes.below(4); changes > 0 && !bytes.at_end(); --changes) {
      const std::string name = global ? kGlobal[bytes.below(static_cast<int>(kGlobal.size()))]
                                      : kLocal[bytes.below(static_cast<int>(kLocal.size()))];
      replace(file.get(), (global ? "/fclib_global/" : "/fclib_local/") + name, bytes);
    }
  }
  lcp::FclibProblem read;
  try {
    read = lcp::read_fclib(path);
  } catch (const lcp::InputError& error) {
    require(error.what()[0] != '\0', "an InputError has a text");
    return;
  }
  lcp::check_shapes(read.problem);
  try {
    lcp::write_fclib(read, folder.path() / "again.hdf5");
  } catch (const std::invalid_argument&) {
    return;  // what FCLIB cannot say: a friction coefficient that is not finite, say
  }
  require(lcp::read_fclib(folder.path() / "again.hdf5").problem.q == read.problem.q,
          "a problem is read back as it was written");
}

}  // namespace signorini::testing
