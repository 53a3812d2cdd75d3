#pragma once

#include <cstddef>
#include <cstdint>

namespace signorini::testing {

/// Each reads an input from the bytes and aborts with a message where a promise is broken.

/// The files of a problem folder, one behind the other with a zero byte between: the reader refuses
/// with InputError alone, and what it takes it writes and reads back to the same bits.
void judge_folder_bytes(const std::uint8_t* data, std::size_t size);
/// An FCLIB file, some of whose data sets are replaced by others of any type, shape and content:
/// the same. (Not any bytes: what the HDF5 library makes of those is its own affair.)
void judge_fclib_bytes(const std::uint8_t* data, std::size_t size);
/// A small problem for Lemke with bounds and limits: it ends, refuses with std::invalid_argument
/// alone; "solved", residuals and rays hold by a judge apart (plain_problem.h), "infeasible"
/// against the exact solver too.
void judge_lemke_bytes(const std::uint8_t* data, std::size_t size);
/// A sequence of calls of the C API on few handles: no call crashes, errors have a text, what was
/// refused changed nothing, and whatever is said of an answer, of a problem or of contacts, holds
/// by a judge apart that knows what was handed in alone (stated_problem.h, stated_contacts.h).
void judge_c_bytes(const std::uint8_t* data, std::size_t size);

}  // namespace signorini::testing
