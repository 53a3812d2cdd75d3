#pragma once

#include <signorini/lcp/io/input_error.h>
#include <signorini/lcp/types.h>

#include <cstdint>
#include <filesystem>
#include <hdf5.h>
#include <span>
#include <string>
#include <vector>

namespace signorini::lcp {

/// A handle of the HDF5 library, closed at the end of its life.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  Close close_;
};

/// Keeps the HDF5 library from printing its errors, and one thread at a time in it, while it lives.
class Hdf5Session {
 public:
  Hdf5Session();
  ~Hdf5Session();
  Hdf5Session(const Hdf5Session&) = delete;
  Hdf5Session& operator=(const Hdf5Session&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* print_data_ = nullptr;
};

/// An HDF5 file that is read. Names are paths from the root ("/fclib_local/W/nz"). Everything it
/// throws is an InputError "FILE: NAME: expected ..., found ...". Memory stays proportional to the
/// bytes of the file: data sets that declare more numbers than the file stores are refused
/// (compressed ones that declare over a thousand times as much).
class Hdf5Reader {
 public:
  /// @throws InputError if the file is missing, not regular, truncated or not HDF5
  explicit Hdf5Reader(std::filesystem::path file);

  [[nodiscard]] bool has(const std::string& name) const;
  /// A data set of one integer, from least to most.
  [[nodiscard]] int integer(const std::string& name, int least, int most) const;
  /// A data set of `count` integers in the range of int. @param count_is what the number follows
  /// from, for the message
  [[nodiscard]] std::vector<int> integers(const std::string& name, std::int64_t count,
                                          const std::string& count_is) const;
  /// A data set of `count` finite numbers.
  [[nodiscard]] Vector numbers(const std::string& name, std::int64_t count,
                               const std::string& count_is) const;
  /// A string data set, empty if there is none.
  [[nodiscard]] std::string text(const std::string& name) const;
  /// How many numbers a data set has.
  [[nodiscard]] std::int64_t count(const std::string& name) const;

  [[noreturn]] void fail(const std::string& name, const std::string& message) const;

 private:
  struct Data;
  /// The data set with its count, class and storage checked.
  [[nodiscard]] Hdf5Handle open(const std::string& name, bool integers_only,
                                std::int64_t& count) const;

  std::filesystem::path file_;
  Hdf5Handle handle_;
};

/// An HDF5 file that is written whole or not at all: into a file beside it, which commit() renames.
class Hdf5Writer {
 public:
  /// @throws std::runtime_error naming the file, here and in every function
  explicit Hdf5Writer(std::filesystem::path file);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void group(const std::string& name);
  void integer(const std::string& name, int value) { integers(name, std::span(&value, 1)); }
  void integers(const std::string& name, std::span<const int> values);
  void numbers(const std::string& name, std::span<const double> values);
  void text(const std::string& name, const std::string& value);
  void commit();

 private:
  void write(const std::string& name, hid_t type, hsize_t count, const void* values);
  void check(bool good, const std::string& what) const;

  std::filesystem::path file_;
  std::filesystem::path partial_;
  hid_t id_ = -1;
};

}  // namespace signorini::lcp
