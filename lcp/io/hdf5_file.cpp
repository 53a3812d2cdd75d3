#include <signorini/lcp/io/hdf5_file.h>
#include <signorini/lcp/io/whole_file.h>
#include <signorini/lcp/number_text.h>

#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace signorini::lcp {
namespace {

constexpr std::int64_t kMaxCount = std::numeric_limits<int>::max();
constexpr std::int64_t kMaxCompression = 1100;  // deflate's own bound is 1032
constexpr std::size_t kMaxText = 1 << 20;

std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

std::filesystem::path regular_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(file, 0, "no such file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(file, 0, "not a regular file");
  }
  return file;
}

std::string range_text(std::int64_t least, std::int64_t most) {
  return "an integer from " + std::to_string(least) + " to " + std::to_string(most);
}

}  // namespace

Hdf5Session::Hdf5Session() {
  library_mutex().lock();
  H5Eget_auto2(H5E_DEFAULT, &print_, &print_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Session::~Hdf5Session() {
  H5Eset_auto2(H5E_DEFAULT, print_, print_data_);
  library_mutex().unlock();
}

Hdf5Reader::Hdf5Reader(std::filesystem::path file)
    : file_(regular_file(file)),
      handle_(H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose) {
  if (!handle_.good()) {
    throw InputError(file_, 0, "expected a whole HDF5 file, found something else or a part of one");
  }
}

void Hdf5Reader::fail(const std::string& name, const std::string& message) const {
  throw InputError(file_, 0, name + ": " + message);
}

bool Hdf5Reader::has(const std::string& name) const {
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    if (H5Lexists(handle_.get(), part.c_str(), H5P_DEFAULT) <= 0 ||
        H5Oexists_by_name(handle_.get(), part.c_str(), H5P_DEFAULT) <= 0) {
      return false;
    }
    if (end == std::string::npos) {
      return true;
    }
  }
}

Hdf5Handle Hdf5Reader::open(const std::string& name, bool integers_only,
                            std::int64_t& count) const {
  if (!has(name)) {
    fail(name, "expected this data set, found none");
  }
  const hid_t data = H5Dopen2(handle_.get(), name.c_str(), H5P_DEFAULT);
  if (data < 0) {
    fail(name, "expected a data set, found something else");
  }
  const auto refuse = [&](const std::string& message) {
    H5Dclose(data);
    fail(name, message);
  };
  const Hdf5Handle space(H5Dget_space(data), &H5Sclose);
  const Hdf5Handle type(H5Dget_type(data), &H5Tclose);
  const Hdf5Handle creation(H5Dget_create_plist(data), &H5Pclose);
  if (!space.good() || !type.good() || !creation.good()) {
    refuse("expected a readable data set, found a damaged one");
  }
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind != H5T_INTEGER && (integers_only || kind != H5T_FLOAT)) {
    refuse(std::string("expected ") + (integers_only ? "integers" : "numbers") +
           ", found another type");
  }
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0 || rank > 1) {
    refuse("expected a list (rank 1), found rank " + std::to_string(rank));
  }
  count = H5Sget_simple_extent_npoints(space.get());
  const auto stored = static_cast<std::int64_t>(H5Dget_storage_size(data));
  const auto size = static_cast<std::int64_t>(H5Tget_size(type.get()));
  std::error_code error;
  const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(file_, error));
  const std::int64_t factor = H5Pget_nfilters(creation.get()) > 0 ? kMaxCompression : 1;
  if (count < 0 || count > kMaxCount || size <= 0 || stored > bytes ||
      count * size > stored * factor) {
    refuse("declares " + std::to_string(count) + " numbers, the file stores " +
           std::to_string(stored) + " bytes of them");
  }
  return {data, &H5Dclose};
}

std::int64_t Hdf5Reader::count(const std::string& name) const {
  std::int64_t count = 0;
  const Hdf5Handle data = open(name, false, count);
  return count;
}

std::vector<int> Hdf5Reader::integers(const std::string& name, std::int64_t count,
                                      const std::string& count_is) const {
  std::int64_t found = 0;
  const Hdf5Handle data = open(name, true, found);
  if (found != count) {
    fail(name, "expected " + std::to_string(count) + " integers (" + count_is + "), found " +
                   std::to_string(found));
  }
  std::vector<std::int64_t> wide(static_cast<std::size_t>(count));
  if (H5Dread(data.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, wide.data()) < 0) {
    fail(name, "expected readable integers, found a damaged data set");
  }
  std::vector<int> values(wide.size());
  for (std::size_t k = 0; k < wide.size(); ++k) {
    if (wide[k] < std::numeric_limits<int>::min() || wide[k] > kMaxCount) {
      fail(name, "integer " + std::to_string(k + 1) + ": expected " +
                     range_text(std::numeric_limits<int>::min(), kMaxCount) + ", found " +
                     std::to_string(wide[k]));
    }
    values[k] = static_cast<int>(wide[k]);
  }
  return values;
}

int Hdf5Reader::integer(const std::string& name, int least, int most) const {
  const int value = integers(name, 1, "a single value").front();
  if (value < least || value > most) {
    fail(name, "expected " + range_text(least, most) + ", found " + std::to_string(value));
  }
  return value;
}

Vector Hdf5Reader::numbers(const std::string& name, std::int64_t count,
                           const std::string& count_is) const {
  std::int64_t found = 0;
  const Hdf5Handle data = open(name, false, found);
  if (found != count) {
    fail(name, "expected " + std::to_string(count) + " numbers (" + count_is + "), found " +
                   std::to_string(found));
  }
  Vector values(count);
  if (H5Dread(data.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    fail(name, "expected readable numbers, found a damaged data set");
  }
  for (Index k = 0; k < count; ++k) {
    if (!std::isfinite(values[k])) {
      fail(name, "number " + std::to_string(k + 1) + ": expected a finite number, found " +
                     number_text(values[k]));
    }
  }
  return values;
}

std::string Hdf5Reader::text(const std::string& name) const {
  if (!has(name)) {
    return {};
  }
  const Hdf5Handle data(H5Dopen2(handle_.get(), name.c_str(), H5P_DEFAULT), &H5Dclose);
  if (!data.good()) {
    return {};
  }
  const Hdf5Handle space(H5Dget_space(data.get()), &H5Sclose);
  const Hdf5Handle type(H5Dget_type(data.get()), &H5Tclose);
  if (!type.good() || H5Tget_class(type.get()) != H5T_STRING ||
      H5Tis_variable_str(type.get()) > 0 || !space.good() ||
      H5Sget_simple_extent_npoints(space.get()) != 1 || H5Tget_size(type.get()) > kMaxText) {
    return {};
  }
  std::string value(H5Tget_size(type.get()), '\0');
  if (H5Dread(data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data()) < 0) {
    return {};
  }
  return value.substr(0, value.find('\0'));
}

Hdf5Writer::Hdf5Writer(std::filesystem::path file)
    : file_(std::move(file)), partial_(partial_name(file_)) {
  if (std::error_code error;
      std::filesystem::exists(file_, error) && !std::filesystem::is_regular_file(file_, error)) {
    throw std::runtime_error(file_.string() + ": not written: exists and is not a regular file");
  }
  id_ = H5Fcreate(partial_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  check(id_ >= 0, "the file cannot be made");
}

Hdf5Writer::~Hdf5Writer() {
  if (id_ >= 0) {
    H5Fclose(id_);
  }
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

void Hdf5Writer::check(bool good, const std::string& what) const {
  if (!good) {
    throw std::runtime_error(file_.string() + ": not written: " + what);
  }
}

void Hdf5Writer::group(const std::string& name) {
  const Hdf5Handle made(H5Gcreate2(id_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                        &H5Gclose);
  check(made.good(), name);
}

void Hdf5Writer::write(const std::string& name, hid_t type, hsize_t count, const void* values) {
  const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), &H5Sclose);
  const Hdf5Handle data(
      H5Dcreate2(id_, name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      &H5Dclose);
  check(data.good(), name);
  const char nothing = 0;  // an empty list still needs an address
  check(
      H5Dwrite(data.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, count > 0 ? values : &nothing) >= 0,
      name);
}

void Hdf5Writer::integers(const std::string& name, std::span<const int> values) {
  write(name, H5T_NATIVE_INT, values.size(), values.data());
}

void Hdf5Writer::numbers(const std::string& name, std::span<const double> values) {
  write(name, H5T_NATIVE_DOUBLE, values.size(), values.data());
}

void Hdf5Writer::text(const std::string& name, const std::string& value) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), &H5Tclose);
  check(H5Tset_size(type.get(), value.size() + 1) >= 0, name);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), &H5Sclose);
  const Hdf5Handle data(
      H5Dcreate2(id_, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      &H5Dclose);
  check(data.good() &&
            H5Dwrite(data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, value.c_str()) >= 0,
        name);
}

void Hdf5Writer::commit() {
  const hid_t id = std::exchange(id_, -1);
  check(H5Fclose(id) >= 0, "the file cannot be closed");
  std::error_code error;
  std::filesystem::rename(partial_, file_, error);
  check(!error, error.message());
}

}  // namespace signorini::lcp
