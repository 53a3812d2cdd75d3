#include <signorini/lcp/packed_rows.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace signorini::lcp {
namespace {

constexpr int kAloneInARow = 32;  // rows on one block alone that a processor may have in flight
constexpr int kTaskRecords = 16;  // some 0.2 microseconds of work

/// To T; beyond its range an infinity, which is what a bound beyond it means.
template <typename T>
T narrow(double value) {
  constexpr double most = std::numeric_limits<T>::max();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return static_cast<T>(value > most ? infinity : value < -most ? -infinity : value);
}

std::size_t padded(std::size_t count, std::size_t multiple) {
  return (count + multiple - 1) / multiple * multiple;
}

}  // namespace

template <typename T>
void PackedRows<T>::set(const FactoredMatrix& A, std::span<SweepRow> rows, double relaxation,
                        RowOrder order, InstructionSet instructions) {
  kernels_ = &sweep_kernels<T>(instructions);
  scaled_.set(A, rows);
  groups_.set(scaled_, rows, order);
  place_.resize(rows.size());
  unscale_.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    unscale_[i] = 1.0 / (scaled_.kappa() * scaled_.rows()[i].scale);
  }
  make_runs();
  for (Run& run : runs_) {
    run.records.numbers = numbers_.data() + run.numbers;
    run.records.blocks = blocks_.data() + run.blocks;
    run.records.normals =
        run.records.kind == RowKind::kCoupled ? normals_.data() + run.normals : nullptr;
    for (int record = 0; record < run.records.count; ++record) {
      fill(run, record, A, rows, relaxation);
    }
  }
}

/// Gives every group its place and sizes what the groups are written to. A run ends with its
/// colour.
template <typename T>
void PackedRows<T>::make_runs() {
  runs_.clear();
  blocks_.clear();
  color_runs_.clear();
  std::size_t x_count = 0;
  std::size_t numbers = 0;
  std::size_t normals = 0;
  std::size_t general = 0;
  int alone = 0;       // rows on one block alone, of this colour
  int most_alone = 0;  // of any colour
  const auto groups = groups_.groups();
  const auto starts = groups_.color_starts();
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const auto& group = groups[k];
    const bool starts_color =
        color_runs_.size() < starts.size() && static_cast<int>(k) == starts[color_runs_.size()];
    const bool goes_on = !starts_color && !runs_.empty() && runs_.back().general == group.general &&
                         (group.general || (runs_.back().records.form == group.form &&
                                            runs_.back().records.kind == group.kind));
    if (starts_color) {
      color_runs_.push_back(static_cast<int>(runs_.size()));
      alone = 0;
    }
    if (!goes_on) {
      x_count = padded(x_count, kLanes);
      Run run{};
      run.records.form = group.form;
      run.records.kind = group.general ? RowKind::kContact : group.kind;
      run.records.first = static_cast<std::int32_t>(x_count);
      run.general = group.general;
      run.first_group = static_cast<int>(k);
      run.numbers = group.general ? general : numbers;
      run.blocks = blocks_.size();
      run.normals = normals;
      runs_.push_back(run);
    }
    ++runs_.back().records.count;
    for (int r = 0; r < rows_of(group.form); ++r) {
      place_[group.rows[r]] = static_cast<int>(x_count) + r;
    }
    x_count += lanes_of(group.form);
    if (group.general) {
      ++general;
      continue;
    }
    append_blocks(group, alone);
    const bool is_rest = color_runs_.size() == starts.size();  // in one thread, one after the other
    alone = is_rest ? alone % kAloneInARow : alone;
    most_alone = std::max(most_alone, alone);
    numbers += record_layout(group.form, group.kind).size;
    normals += group.kind == RowKind::kCoupled ? lanes_of(group.form) : 0;
  }
  color_runs_.resize(starts.size(), static_cast<int>(runs_.size()));
  x_count_ = padded(x_count, kBlockStride);
  const int alone_blocks = std::max(most_alone + kLanes, kAloneInARow + kLanes);
  state_.assign(x_count_ + scaled_.velocity_count() + kBlockStride * alone_blocks, T(0));
  w_.assign(x_count_, T(0));
  numbers_.assign(numbers, T(0));
  normals_.assign(normals, -1);
  general_rows_.resize(general);
  make_tasks();
}

/// The second block of a row on one block alone is one behind the others, which stays 0: another
/// one for each such row of a colour, so that no two threads write it, and no row waits for another
/// to have written its zeros.
template <typename T>
void PackedRows<T>::append_blocks(const RowGroups::Group& group, int& alone) {
  for (int k = 0; k < blocks_of(group.form) / 2; ++k) {
    const auto& row = scaled_.rows()[group.rows[k]];
    blocks_.push_back(row.blocks[0]);
    blocks_.push_back(row.blocks[1] >= 0 ? row.blocks[1]
                                         : scaled_.velocity_count() + kBlockStride * alone++);
  }
}

template <typename T>
void PackedRows<T>::make_tasks() {
  tasks_.clear();
  color_tasks_.assign(1, 0);
  for (std::size_t color = 0; color + 1 < color_runs_.size(); ++color) {
    for (int run = color_runs_[color]; run < color_runs_[color + 1]; ++run) {
      const int count = runs_[run].records.count;
      for (int first = 0; first < count; first += kTaskRecords) {
        tasks_.push_back({run, first, std::min(kTaskRecords, count - first)});
      }
    }
    color_tasks_.push_back(static_cast<int>(tasks_.size()));
  }
}

template <typename T>
void PackedRows<T>::fill(const Run& run, int record, const FactoredMatrix& A,
                         std::span<const SweepRow> rows, double relaxation) {
  const auto& group = groups_.groups()[run.first_group + record];
  if (run.general) {
    general_rows_[run.numbers + record] = general_row(group.rows[0], A, rows, relaxation);
    return;
  }
  const RecordLayout at = record_layout(group.form, group.kind);
  T* numbers = numbers_.data() + run.numbers + static_cast<std::size_t>(at.size) * record;
  const int count = rows_of(group.form);
  for (int r = 0; r < count; ++r) {
    const int row = group.rows[r];
    scaled_.pack(scaled_.rows()[row], numbers + kRowNumbers * r);
    const GeneralRow data = general_row(row, A, rows, relaxation);
    numbers[at.q + r] = data.q;
    numbers[at.step + r] = data.step;
    if (group.kind != RowKind::kContact) {
      numbers[at.lower + r] = data.lower;
      numbers[at.upper + r] = data.upper;
      numbers[at.compliance + r] = data.compliance;
    }
    if (group.kind == RowKind::kCoupled) {
      normals_[run.normals + lanes_of(group.form) * record + r] = data.normal_place;
    }
  }
  if (count > 1 && group.form != RowForm::kPacket) {
    fill_columns(numbers, at, count);
  }
}

template <typename T>
void PackedRows<T>::fill_columns(T* record, const RecordLayout& at, int count) {
  for (int k = 0; k < count; ++k) {
    for (int r = 0; r < k; ++r) {
      T product = 0;
      for (int j = 0; j < kRowNumbers; ++j) {
        product += record[kRowNumbers * r + j] * record[kRowNumbers * k + j];
      }
      record[at.columns + kLanes * k + r] = record[at.step + r] * product;
      record[at.columns + kLanes * r + k] = record[at.step + k] * product;
    }
  }
}

/// A row in scaled coordinates.
template <typename T>
typename PackedRows<T>::GeneralRow PackedRows<T>::general_row(int row, const FactoredMatrix& A,
                                                              std::span<const SweepRow> rows,
                                                              double relaxation) const {
  const SweepRow& data = rows[row];
  const double s = scaled_.rows()[row].scale;
  const double x_of_z = scaled_.kappa() * s;
  const double inverse = s * data.inverse * s;
  GeneralRow general;
  general.q = narrow<T>(scaled_.kappa() * (data.q / s));
  general.inverse = narrow<T>(inverse);
  general.step = narrow<T>(-relaxation * inverse);
  general.lower = narrow<T>(x_of_z * data.lower);
  general.upper = narrow<T>(x_of_z * data.upper);
  general.compliance = narrow<T>(A.compliance(row) / s / s);
  general.row = row;
  general.normal_place = -1;
  if (data.normal_row >= 0) {
    general.normal_place = place_[data.normal_row];
    general.upper = narrow<T>(data.coefficient * (s / scaled_.rows()[data.normal_row].scale));
  }
  return general;
}

template <typename T>
void PackedRows<T>::start(const Vector& z) {
  for (Index i = 0; i < z.size(); ++i) {
    state_[place_[i]] = narrow<T>(z[i] * scaled_.kappa() * scaled_.rows()[i].scale);
  }
}

template <typename T>
void PackedRows<T>::read(Vector& z) const {
  for (Index i = 0; i < z.size(); ++i) {
    z[i] = static_cast<double>(state_[place_[i]]) * unscale_[i];
  }
}

template <typename T>
double PackedRows<T>::squared_length(std::span<const T> difference) const {
  double sum = 0.0;
  for (const T d : difference.first(x_count_)) {
    sum += static_cast<double>(d) * static_cast<double>(d);
  }
  return sum;
}

template <typename T>
void PackedRows<T>::refresh(Vector& w) {
  std::fill(state_.begin() + x_count_, state_.end(), T(0));
  const auto general_of = [this](const Run& run) {
    return std::span(general_rows_).subspan(run.numbers, run.records.count);
  };
  for (const Run& run : runs_) {
    if (!run.general) {
      kernels_->add(run.records, u(), x());
      continue;
    }
    for (const GeneralRow& row : general_of(run)) {
      add_general(row, state_[place_[row.row]]);
    }
  }
  for (const Run& run : runs_) {
    if (!run.general) {
      kernels_->products(run.records, u(), x(), w_.data());
      continue;
    }
    for (const GeneralRow& row : general_of(run)) {
      w_[place_[row.row]] = general_product(row);
    }
  }
  const double kappa = scaled_.kappa();
  for (Index i = 0; i < w.size(); ++i) {
    w[i] = static_cast<double>(w_[place_[i]]) / kappa * scaled_.rows()[i].scale;
  }
}

template <typename T>
void PackedRows<T>::forward() {
  sweep(false);
}

template <typename T>
void PackedRows<T>::backward() {
  sweep(true);
}

template <typename T>
void PackedRows<T>::sweep(bool backward) {
  if (team_ != nullptr && team_->size() > 1 && !tasks_.empty()) {
    return sweep_on_team(backward);
  }
  const int count = static_cast<int>(runs_.size());
  for (int k = 0; k < count; ++k) {
    const Run& run = runs_[backward ? count - 1 - k : k];
    sweep(run, 0, run.records.count, backward);
  }
}

/// Colour by colour, each member of the team its share; then, or backwards before, the rest.
template <typename T>
void PackedRows<T>::sweep_on_team(bool backward) {
  const auto sweep_rest = [&](int member) {
    const int rest = color_runs_.back();
    const int count = static_cast<int>(runs_.size()) - rest;
    for (int k = 0; member == 0 && k < count; ++k) {
      const Run& run = runs_[rest + (backward ? count - 1 - k : k)];
      sweep(run, 0, run.records.count, backward);
    }
  };
  auto work = [&](int member) {
    if (backward) {
      sweep_rest(member);
      team_->wait();
    }
    const int colors = color_count();
    for (int c = 0; c < colors; ++c) {
      const int color = backward ? colors - 1 - c : c;
      const std::int64_t first = color_tasks_[color];
      const std::int64_t count = color_tasks_[color + 1] - first;
      for (std::int64_t k = first + count * member / team_->size();
           k < first + count * (member + 1) / team_->size(); ++k) {
        sweep(runs_[tasks_[k].run], tasks_[k].first, tasks_[k].count, backward);
      }
      team_->wait();
    }
    if (!backward) {
      sweep_rest(member);
    }
  };
  team_->run(work);
}

/// `count` records of a run.
template <typename T>
void PackedRows<T>::sweep(const Run& run, int first, int count, bool backward) {
  if (run.general) {
    for (int k = 0; k < count; ++k) {
      step_general(general_rows_[run.numbers + first + (backward ? count - 1 - k : k)]);
    }
    return;
  }
  RowRun<T> part = run.records;
  const std::ptrdiff_t lanes = lanes_of(part.form);
  part.numbers += std::ptrdiff_t{record_layout(part.form, part.kind).size} * first;
  part.blocks += std::ptrdiff_t{blocks_of(part.form)} * first;
  part.normals = part.normals == nullptr ? nullptr : part.normals + lanes * first;
  part.first += static_cast<std::int32_t>(lanes * first);
  part.count = count;
  kernels_->sweep(part, u(), x(), backward);
}

/// w of a row.
template <typename T>
T PackedRows<T>::general_product(const GeneralRow& row) const {
  T sum = row.q + row.compliance * state_[place_[row.row]];
  for (const auto& entry : scaled_.entries(scaled_.rows()[row.row])) {
    const double* g = scaled_.numbers() + entry.product;
    const T* velocity = state_.data() + x_count_ + entry.offset;
    for (int k = 0; k < entry.dimension; ++k) {
      sum += static_cast<T>(g[k]) * velocity[k];
    }
  }
  return sum;
}

template <typename T>
void PackedRows<T>::add_general(const GeneralRow& row, T change) {
  for (const auto& entry : scaled_.entries(scaled_.rows()[row.row])) {
    const double* g = scaled_.numbers() + entry.update;
    T* velocity = u() + entry.offset;
    for (int k = 0; k < entry.dimension; ++k) {
      velocity[k] += static_cast<T>(g[k]) * change;
    }
  }
}

template <typename T>
void PackedRows<T>::step_general(const GeneralRow& row) {
  T& mine = state_[place_[row.row]];
  T lower = row.lower;
  T upper = row.upper;
  if (row.normal_place >= 0) {
    upper *= std::max(state_[row.normal_place], T(0));
    lower = -upper;
  }
  const T w = general_product(row);
  const T moved = row.inverse > T(0) ? std::clamp(mine + row.step * w, lower, upper)
                                     : pushed_to_bound(mine, w, lower, upper);
  const T change = moved - mine;
  if (change != T(0)) {
    mine = moved;
    add_general(row, change);
  }
}

template class PackedRows<double>;
template class PackedRows<float>;

}  // namespace signorini::lcp
