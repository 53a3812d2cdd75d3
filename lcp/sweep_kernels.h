#pragma once

#include <cstddef>
#include <cstdint>

namespace signorini::lcp {

// Included by sources that are compiled for newer processors: what is inline here must be inlined
// everywhere, or the linker could pick a copy that an older processor cannot run.

/// The arithmetic of a sweep over packed rows (packed_rows.h), in one source compiled for several
/// instruction sets (instruction_set.h). All do the same additions and multiplications in the same
/// order, so that the bits are the same where none is contracted.
///
/// A row has two blocks of at most six numbers: g = (g_1, g_2), beside it the two blocks' kept
/// velocities u_1, u_2 in u, w = g_1.u_1 + g_2.u_2 + q + c x. A block of u starts at a multiple of
/// kBlockStride numbers; behind its six stand two that are not used.
inline constexpr int kBlockStride = 8;
inline constexpr int kRowNumbers = 12;  ///< of g: g_1[0..3], g_2[0..3], g_1[4..5], g_2[4..5]
inline constexpr int kLanes = 4;        ///< rows whose steps are taken side by side

/// How the rows of a record hang together.
enum class RowForm : std::uint8_t {
  kOne,  ///< one row
  kTwo,  ///< two, three or four rows on the same two blocks, one after the other
  kThree,
  kFour,
  kPacket,  ///< four rows that share no block
};

/// What stops a step.
enum class RowKind : std::uint8_t {
  kContact,  ///< 0 <= x, no compliance
  kBounded,  ///< lower <= x <= upper, and compliance
  kCoupled,  ///< as kBounded, but rows with normals[k] >= 0 have |x| <= upper max(x[normals[k]], 0)
};

[[nodiscard, gnu::always_inline]] constexpr int rows_of(RowForm form) {
  return form == RowForm::kPacket ? kLanes : static_cast<int>(form) + 1;
}
/// Numbers of x that a record owns.
[[nodiscard, gnu::always_inline]] constexpr int lanes_of(RowForm form) {
  return form == RowForm::kOne ? 1 : kLanes;
}
/// Offsets of blocks that a record owns.
[[nodiscard, gnu::always_inline]] constexpr int blocks_of(RowForm form) {
  return form == RowForm::kPacket ? 2 * kLanes : 2;
}

/// Where the numbers of a record stand. kOne: g, then q, step, lower, upper, compliance. Others: g
/// of every row, then kLanes numbers each of q, step, [lower, upper, compliance], and for rows on
/// the same blocks a column a row: column k holds step_r (g_r . g_k) in lane r, 0 in lane k.
/// step = -omega / M_ii. Lanes without a row are 0.
struct RecordLayout {
  int q, step, lower, upper, compliance, columns, size;
};
[[nodiscard, gnu::always_inline]] constexpr RecordLayout record_layout(RowForm form, RowKind kind) {
  const bool bounded = kind != RowKind::kContact;
  const int q = kRowNumbers * rows_of(form);
  if (form == RowForm::kOne) {
    return {q, q + 1, q + 2, q + 3, q + 4, 0, q + (bounded ? 8 : 4)};
  }
  const int columns = q + (bounded ? 5 : 2) * kLanes;
  const int size = columns + (form == RowForm::kPacket ? 0 : kLanes * rows_of(form));
  return {q, q + kLanes, q + 2 * kLanes, q + 3 * kLanes, q + 4 * kLanes, columns, size};
}

/// Records of one form and kind, in the order of a sweep.
template <typename T>
struct RowRun {
  RowForm form;
  RowKind kind;
  int count;                   ///< records
  const T* numbers;            ///< count records
  const std::int32_t* blocks;  ///< where the blocks start in u, blocks_of(form) a record
  const std::int32_t*
      normals;         ///< where the normals' x are, lanes_of(form) a record; kCoupled only
  std::int32_t first;  ///< where the first record's x is
};

template <typename T>
struct SweepKernels {
  /// x <- clamp(x + step w), u <- u + g dx, row by row; backward: the last row first.
  void (*sweep)(const RowRun<T>& run, T* u, T* x, bool backward);
  /// u <- u + sum over the rows of g x.
  void (*add)(const RowRun<T>& run, T* u, const T* x);
  /// w, where x stands.
  void (*products)(const RowRun<T>& run, const T* u, const T* x, T* w);
};

}  // namespace signorini::lcp
