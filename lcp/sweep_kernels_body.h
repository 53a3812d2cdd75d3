// The kernels of sweep_kernels.h, included by one source file an instruction set, which defines
// SIGNORINI_KERNELS, the name of its namespace.

#include <signorini/lcp/sweep_kernels.h>

namespace signorini::lcp::SIGNORINI_KERNELS {
namespace {

#define SIGNORINI_INLINE [[gnu::always_inline]] inline

template <typename T>
struct Vectors {
  typedef T Four __attribute__((vector_size(4 * sizeof(T))));
  typedef T Two __attribute__((vector_size(2 * sizeof(T))));
};
template <typename T>
using Two = typename Vectors<T>::Two;

/// Four numbers in registers of two, where the processor has none of four.
template <typename T>
struct Halves {
  Two<T> low, high;
  SIGNORINI_INLINE T operator[](int k) const { return k < 2 ? low[k] : high[k - 2]; }
  SIGNORINI_INLINE Halves operator-() const { return {-low, -high}; }
  SIGNORINI_INLINE friend Halves operator+(Halves a, Halves b) {
    return {a.low + b.low, a.high + b.high};
  }
  SIGNORINI_INLINE friend Halves operator-(Halves a, Halves b) {
    return {a.low - b.low, a.high - b.high};
  }
  SIGNORINI_INLINE friend Halves operator*(Halves a, Halves b) {
    return {a.low * b.low, a.high * b.high};
  }
  SIGNORINI_INLINE Halves& operator+=(Halves b) { return *this = *this + b; }
};

template <typename T>
struct Widest {
  using Four = typename Vectors<T>::Four;
};
#ifndef __AVX__
template <>
struct Widest<double> {
  using Four = Halves<double>;
};
#endif
template <typename T>
using Four = typename Widest<T>::Four;

template <typename V, typename T>
SIGNORINI_INLINE V load(const T* from) {
  V v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
template <typename V, typename T>
SIGNORINI_INLINE void store(T* to, V v) {
  __builtin_memcpy(to, &v, sizeof v);
}

// What four numbers can do beside arithmetic, for a register and for halves.

/// a where it is larger, else b, which a NaN in b survives.
template <typename V>
SIGNORINI_INLINE V larger(V a, V b) {
  return a > b ? a : b;
}
template <typename T>
SIGNORINI_INLINE Halves<T> larger(Halves<T> a, Halves<T> b) {
  return {larger(a.low, b.low), larger(a.high, b.high)};
}
template <typename V>
SIGNORINI_INLINE V smaller(V a, V b) {
  return a < b ? a : b;
}
template <typename T>
SIGNORINI_INLINE Halves<T> smaller(Halves<T> a, Halves<T> b) {
  return {smaller(a.low, b.low), smaller(a.high, b.high)};
}
template <typename V>
SIGNORINI_INLINE V where_equal(V a, V b, V equal, V other) {
  return a == b ? equal : other;
}
template <typename T>
SIGNORINI_INLINE Halves<T> where_equal(Halves<T> a, Halves<T> b, Halves<T> equal, Halves<T> other) {
  return {where_equal(a.low, b.low, equal.low, other.low),
          where_equal(a.high, b.high, equal.high, other.high)};
}

template <int kLane, typename V>
SIGNORINI_INLINE V splat(V v) {
  return __builtin_shufflevector(v, v, kLane, kLane, kLane, kLane);
}
template <int kLane, typename T>
SIGNORINI_INLINE Halves<T> splat(Halves<T> v) {
  const Two<T> half = kLane < 2 ? v.low : v.high;
  const Two<T> both = __builtin_shufflevector(half, half, kLane % 2, kLane % 2);
  return {both, both};
}
/// into, with lane kLane of from.
template <int kLane, typename V>
SIGNORINI_INLINE V with_lane(V into, V from) {
  return __builtin_shufflevector(into, from, kLane == 0 ? 4 : 0, kLane == 1 ? 5 : 1,
                                 kLane == 2 ? 6 : 2, kLane == 3 ? 7 : 3);
}
template <int kLane, typename T>
SIGNORINI_INLINE Halves<T> with_lane(Halves<T> into, Halves<T> from) {
  Two<T>& half = kLane < 2 ? into.low : into.high;
  half = __builtin_shufflevector(half, kLane < 2 ? from.low : from.high, kLane % 2 == 0 ? 2 : 0,
                                 kLane % 2 == 1 ? 3 : 1);
  return into;
}

template <typename T>
SIGNORINI_INLINE Four<T> four(T value) {
  if constexpr (__is_same(Four<T>, Halves<T>)) {
    const Two<T> both = {value, value};
    return {both, both};
  } else {
    return Four<T>{value, value, value, value};
  }
}
template <typename T>
SIGNORINI_INLINE Four<T> join(Two<T> low, Two<T> high) {
  if constexpr (__is_same(Four<T>, Halves<T>)) {
    return {low, high};
  } else {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3);
  }
}
template <typename T>
SIGNORINI_INLINE Two<T> low_of(Four<T> v) {
  if constexpr (__is_same(Four<T>, Halves<T>)) {
    return v.low;
  } else {
    return __builtin_shufflevector(v, v, 0, 1);
  }
}
template <typename T>
SIGNORINI_INLINE Two<T> high_of(Four<T> v) {
  if constexpr (__is_same(Four<T>, Halves<T>)) {
    return v.high;
  } else {
    return __builtin_shufflevector(v, v, 2, 3);
  }
}

/// Twelve numbers: of a row, or of the velocities of its two blocks.
template <typename T>
struct Twelve {
  Four<T> first, second, ends;
};

template <typename T>
SIGNORINI_INLINE Twelve<T> load_row(const T* g) {
  return {load<Four<T>>(g), load<Four<T>>(g + 4), load<Four<T>>(g + 8)};
}
template <typename T>
SIGNORINI_INLINE Twelve<T> load_blocks(const T* u, const std::int32_t* blocks) {
  const T* one = u + blocks[0];
  const T* two = u + blocks[1];
  return {load<Four<T>>(one), load<Four<T>>(two),
          join<T>(load<Two<T>>(one + 4), load<Two<T>>(two + 4))};
}
template <typename T>
SIGNORINI_INLINE void store_blocks(T* u, const std::int32_t* blocks, const Twelve<T>& v) {
  T* one = u + blocks[0];
  T* two = u + blocks[1];
  store(one, v.first);
  store(two, v.second);
  store(one + 4, low_of<T>(v.ends));
  store(two + 4, high_of<T>(v.ends));
}
template <typename T>
SIGNORINI_INLINE void add_row(Twelve<T>& v, const T* g, Four<T> factor) {
  const Twelve<T> row = load_row(g);
  v.first += row.first * factor;
  v.second += row.second * factor;
  v.ends += row.ends * factor;
}
template <typename T>
SIGNORINI_INLINE Four<T> multiply(const T* g, const Twelve<T>& v) {
  const Twelve<T> row = load_row(g);
  return (row.first * v.first + row.second * v.second) + row.ends * v.ends;
}

/// Lane r: the sum of p_r, (p_r[0] + p_r[1]) + (p_r[2] + p_r[3]).
template <typename T>
SIGNORINI_INLINE Four<T> sums(Four<T> p0, Four<T> p1, Four<T> p2, Four<T> p3) {
  if constexpr (__is_same(Four<T>, Halves<T>)) {
    const auto pair = [](Two<T> p, Two<T> q) {
      return __builtin_shufflevector(p, q, 0, 2) + __builtin_shufflevector(p, q, 1, 3);
    };
    return {pair(p0.low, p1.low) + pair(p0.high, p1.high),
            pair(p2.low, p3.low) + pair(p2.high, p3.high)};
  } else if constexpr (sizeof(T) == 8) {  // the shuffles that AVX has of doubles
    const Four<T> a =
        __builtin_shufflevector(p0, p1, 0, 4, 2, 6) + __builtin_shufflevector(p0, p1, 1, 5, 3, 7);
    const Four<T> b =
        __builtin_shufflevector(p2, p3, 0, 4, 2, 6) + __builtin_shufflevector(p2, p3, 1, 5, 3, 7);
    return __builtin_shufflevector(a, b, 0, 1, 4, 5) + __builtin_shufflevector(a, b, 2, 3, 6, 7);
  } else {
    const Four<T> a =
        __builtin_shufflevector(p0, p1, 0, 2, 4, 6) + __builtin_shufflevector(p0, p1, 1, 3, 5, 7);
    const Four<T> b =
        __builtin_shufflevector(p2, p3, 0, 2, 4, 6) + __builtin_shufflevector(p2, p3, 1, 3, 5, 7);
    return __builtin_shufflevector(a, b, 0, 2, 4, 6) + __builtin_shufflevector(a, b, 1, 3, 5, 7);
  }
}
/// The sum of one p, (p[0] + p[2]) + (p[1] + p[3]).
template <typename T>
SIGNORINI_INLINE T sum(Four<T> p) {
  const Two<T> half = low_of<T>(p) + high_of<T>(p);
  return half[0] + half[1];
}

/// What stops the steps of four rows, as bounds of the step d, and x afterwards.
template <typename T, RowKind kKind>
struct Stops {
  Four<T> x, lower, upper, lowest, highest;

  SIGNORINI_INLINE Stops(const T* record, const RecordLayout& at, Four<T> now) : x(now) {
    if constexpr (kKind == RowKind::kContact) {
      lowest = -x;
    } else {
      lower = load<Four<T>>(record + at.lower);
      upper = load<Four<T>>(record + at.upper);
      lowest = lower - x;
      highest = upper - x;
    }
  }
  SIGNORINI_INLINE Four<T> stop(Four<T> d) const {
    const Four<T> risen = larger(lowest, d);
    return kKind == RowKind::kContact ? risen : smaller(highest, risen);
  }
  /// A step that was stopped ends on its bound to the bit.
  SIGNORINI_INLINE Four<T> moved(Four<T> d) const {
    if constexpr (kKind == RowKind::kContact) {
      return x + d;
    } else {
      return where_equal(d, highest, upper, where_equal(d, lowest, lower, x + d));
    }
  }
};

/// -omega w / M_ii of four rows, from g.u.
template <typename T, RowKind kKind>
SIGNORINI_INLINE Four<T> wanted(const T* record, const RecordLayout& at, Four<T> g_u, Four<T> x) {
  Four<T> w = g_u + load<Four<T>>(record + at.q);
  if constexpr (kKind != RowKind::kContact) {
    w += load<Four<T>>(record + at.compliance) * x;
  }
  return load<Four<T>>(record + at.step) * w;
}

/// g.u of the rows of a record on the same two blocks.
template <typename T, int kRows>
SIGNORINI_INLINE Four<T> products_of(const T* record, const Twelve<T>& v) {
  const Four<T> none = {};
  const Four<T> p0 = multiply(record, v);
  const Four<T> p1 = kRows > 1 ? multiply(record + kRowNumbers, v) : none;
  const Four<T> p2 = kRows > 2 ? multiply(record + 2 * kRowNumbers, v) : none;
  const Four<T> p3 = kRows > 3 ? multiply(record + 3 * kRowNumbers, v) : none;
  return sums<T>(p0, p1, p2, p3);
}
/// g.u of four rows, each on its own blocks.
template <typename T>
SIGNORINI_INLINE Four<T> products_of_packet(const T* record, const T* u,
                                            const std::int32_t* blocks) {
  return sums<T>(multiply(record, load_blocks(u, blocks)),
                 multiply(record + kRowNumbers, load_blocks(u, blocks + 2)),
                 multiply(record + 2 * kRowNumbers, load_blocks(u, blocks + 4)),
                 multiply(record + 3 * kRowNumbers, load_blocks(u, blocks + 6)));
}

/// The rows of a record on the same two blocks, one after the other: the step of row k changes the
/// wanted steps t of the others by column k, and u only after the last.
template <typename T, int kRows, RowKind kKind, bool kBackward>
struct Group {
  static constexpr RowForm kForm = static_cast<RowForm>(kRows - 1);
  static constexpr RecordLayout kAt = record_layout(kForm, kKind);

  const T* record;
  Twelve<T> v;
  Four<T> t;
  Four<T> d = {};

  template <int kStep>
  SIGNORINI_INLINE void step(const Stops<T, kKind>& stops) {
    if constexpr (kStep < kRows) {
      constexpr int kRow = kBackward ? kRows - 1 - kStep : kStep;
      const Four<T> stopped = stops.stop(t);
      const Four<T> change = splat<kRow>(stopped);
      d = with_lane<kRow>(d, stopped);
      if constexpr (kStep + 1 < kRows) {
        t += load<Four<T>>(record + kAt.columns + kLanes * kRow) * change;
      }
      add_row(v, record + kRowNumbers * kRow, change);
      step<kStep + 1>(stops);
    }
  }

  SIGNORINI_INLINE static void sweep(const T* record, const std::int32_t* blocks,
                                     const std::int32_t*, T* u, T* x, const T*) {
    Group group{record, load_blocks(u, blocks), {}};
    const Stops<T, kKind> stops(record, kAt, load<Four<T>>(x));
    group.t = wanted<T, kKind>(record, kAt, products_of<T, kRows>(record, group.v), stops.x);
    group.template step<0>(stops);
    store_blocks(u, blocks, group.v);
    store(x, stops.moved(group.d));
  }
};

template <typename T>
SIGNORINI_INLINE T clamped(T value, T lower, T upper) {
  const T risen = lower > value ? lower : value;
  return upper < risen ? upper : risen;
}

/// The same where a row's bounds may hang on another row's x, which may stand in this record.
template <typename T, int kRows, bool kBackward>
struct Group<T, kRows, RowKind::kCoupled, kBackward> {
  static constexpr RowForm kForm = static_cast<RowForm>(kRows - 1);
  static constexpr RecordLayout kAt = record_layout(kForm, RowKind::kCoupled);

  SIGNORINI_INLINE static void sweep(const T* record, const std::int32_t* blocks,
                                     const std::int32_t* normals, T* u, T* x, const T* all_x) {
    Twelve<T> v = load_blocks(u, blocks);
    Four<T> t = wanted<T, RowKind::kCoupled>(record, kAt, products_of<T, kRows>(record, v),
                                             load<Four<T>>(x));
    for (int k = 0; k < kRows; ++k) {
      const int row = kBackward ? kRows - 1 - k : k;
      T lower = record[kAt.lower + row];
      T upper = record[kAt.upper + row];
      if (normals[row] >= 0) {
        const T normal = all_x[normals[row]];
        upper = upper * (normal > T(0) ? normal : T(0));
        lower = -upper;
      }
      const T moved = clamped(x[row] + t[row], lower, upper);
      const T change = moved - x[row];
      x[row] = moved;
      const Four<T> changes = four(change);
      t += load<Four<T>>(record + kAt.columns + kLanes * row) * changes;
      add_row(v, record + kRowNumbers * row, changes);
    }
    store_blocks(u, blocks, v);
  }
};

template <typename T, RowKind kKind>
struct One {
  static constexpr RowForm kForm = RowForm::kOne;
  static constexpr RecordLayout kAt = record_layout(kForm, kKind);

  SIGNORINI_INLINE static void sweep(const T* record, const std::int32_t* blocks,
                                     const std::int32_t* normals, T* u, T* x, const T* all_x) {
    Twelve<T> v = load_blocks(u, blocks);
    T w = sum<T>(multiply(record, v)) + record[kAt.q];
    T moved;
    if constexpr (kKind == RowKind::kContact) {
      const T target = *x + record[kAt.step] * w;
      moved = T(0) > target ? T(0) : target;
    } else {
      w += record[kAt.compliance] * *x;
      T lower = record[kAt.lower];
      T upper = record[kAt.upper];
      if (kKind == RowKind::kCoupled && *normals >= 0) {
        const T normal = all_x[*normals];
        upper = upper * (normal > T(0) ? normal : T(0));
        lower = -upper;
      }
      moved = clamped(*x + record[kAt.step] * w, lower, upper);
    }
    const T change = moved - *x;
    *x = moved;
    add_row(v, record, four(change));
    store_blocks(u, blocks, v);
  }
};

template <typename T, RowKind kKind>
struct Packet {
  static constexpr RowForm kForm = RowForm::kPacket;
  static constexpr RecordLayout kAt = record_layout(kForm, kKind);

  SIGNORINI_INLINE static void sweep(const T* record, const std::int32_t* blocks,
                                     const std::int32_t*, T* u, T* x, const T*) {
    const Stops<T, kKind> stops(record, kAt, load<Four<T>>(x));
    const Four<T> d =
        stops.stop(wanted<T, kKind>(record, kAt, products_of_packet(record, u, blocks), stops.x));
    move<0>(record, blocks, u, d);
    store(x, stops.moved(d));
  }
  template <int kRow>
  SIGNORINI_INLINE static void move(const T* record, const std::int32_t* blocks, T* u, Four<T> d) {
    if constexpr (kRow < kLanes) {
      Twelve<T> v = load_blocks(u, blocks + 2 * kRow);
      add_row(v, record + kRowNumbers * kRow, splat<kRow>(d));
      store_blocks(u, blocks + 2 * kRow, v);
      move<kRow + 1>(record, blocks, u, d);
    }
  }
};

template <typename T, typename Record, bool kBackward>
void sweep_records(const RowRun<T>& run, T* u, T* x) {
  constexpr int kSize = Record::kAt.size;
  constexpr int kBlocks = blocks_of(Record::kForm);
  constexpr int kX = lanes_of(Record::kForm);
  for (int k = 0; k < run.count; ++k) {
    const std::ptrdiff_t i = kBackward ? run.count - 1 - k : k;
    Record::sweep(run.numbers + kSize * i, run.blocks + kBlocks * i,
                  run.normals == nullptr ? nullptr : run.normals + kX * i, u,
                  x + run.first + kX * i, x);
  }
}

template <typename T, RowKind kKind, bool kBackward>
void sweep_form(const RowRun<T>& run, T* u, T* x) {
  switch (run.form) {
    case RowForm::kOne: return sweep_records<T, One<T, kKind>, kBackward>(run, u, x);
    case RowForm::kTwo:
      return sweep_records<T, Group<T, 2, kKind, kBackward>, kBackward>(run, u, x);
    case RowForm::kThree:
      return sweep_records<T, Group<T, 3, kKind, kBackward>, kBackward>(run, u, x);
    case RowForm::kFour:
      return sweep_records<T, Group<T, 4, kKind, kBackward>, kBackward>(run, u, x);
    case RowForm::kPacket:
      if constexpr (kKind != RowKind::kCoupled) {  // such rows are packed one by one
        return sweep_records<T, Packet<T, kKind>, kBackward>(run, u, x);
      }
  }
}

template <typename T, bool kBackward>
void sweep_kind(const RowRun<T>& run, T* u, T* x) {
  switch (run.kind) {
    case RowKind::kContact: return sweep_form<T, RowKind::kContact, kBackward>(run, u, x);
    case RowKind::kBounded: return sweep_form<T, RowKind::kBounded, kBackward>(run, u, x);
    case RowKind::kCoupled: return sweep_form<T, RowKind::kCoupled, kBackward>(run, u, x);
  }
}

template <typename T>
void sweep(const RowRun<T>& run, T* u, T* x, bool backward) {
  backward ? sweep_kind<T, true>(run, u, x) : sweep_kind<T, false>(run, u, x);
}

template <typename T>
void add(const RowRun<T>& run, T* u, const T* x) {
  const bool is_packet = run.form == RowForm::kPacket;
  const int rows = rows_of(run.form);
  const int size = record_layout(run.form, run.kind).size;
  for (std::ptrdiff_t i = 0; i < run.count; ++i) {
    const std::int32_t* blocks = run.blocks + blocks_of(run.form) * i;
    const T* factors = x + run.first + lanes_of(run.form) * i;
    Twelve<T> v = load_blocks(u, blocks);
    for (int r = 0; r < rows; ++r) {
      if (is_packet && r > 0) {
        store_blocks(u, blocks + 2 * (r - 1), v);
        v = load_blocks(u, blocks + 2 * r);
      }
      add_row(v, run.numbers + size * i + kRowNumbers * r, four(factors[r]));
    }
    store_blocks(u, is_packet ? blocks + 2 * (rows - 1) : blocks, v);
  }
}

template <typename T>
void products(const RowRun<T>& run, const T* u, const T* x, T* w) {
  const bool is_packet = run.form == RowForm::kPacket;
  const int rows = rows_of(run.form);
  const RecordLayout at = record_layout(run.form, run.kind);
  for (std::ptrdiff_t i = 0; i < run.count; ++i) {
    const T* record = run.numbers + at.size * i;
    const std::int32_t* blocks = run.blocks + blocks_of(run.form) * i;
    Twelve<T> v = load_blocks(u, blocks);
    for (int r = 0; r < rows; ++r) {
      if (is_packet && r > 0) {
        v = load_blocks(u, blocks + 2 * r);
      }
      const std::ptrdiff_t mine = run.first + lanes_of(run.form) * i + r;
      const T g_u = sum<T>(multiply(record + kRowNumbers * r, v));
      const T compliant =
          run.kind == RowKind::kContact ? T(0) : record[at.compliance + r] * x[mine];
      w[mine] = g_u + record[at.q + r] + compliant;
    }
  }
}

}  // namespace

extern const SweepKernels<double> kDouble;
extern const SweepKernels<float> kFloat;
const SweepKernels<double> kDouble = {&sweep<double>, &add<double>, &products<double>};
const SweepKernels<float> kFloat = {&sweep<float>, &add<float>, &products<float>};

}  // namespace signorini::lcp::SIGNORINI_KERNELS
