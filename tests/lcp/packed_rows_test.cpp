#include <signorini/lcp/column_sweeps.h>
#include <signorini/lcp/packed_rows.h>

#include "tests/lcp/allocation_count.h"
#include "tests/lcp/sweep_problems.h"

#include <gtest/gtest.h>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace signorini::lcp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<SweepRow> rows_of(const Problem& problem) {
  std::vector<SweepRow> rows(problem.size());
  for (Index i = 0; i < problem.size(); ++i) {
    rows[i].q = problem.q[i];
    rows[i].lower = problem.lower.size() > 0 ? problem.lower[i] : 0.0;
    rows[i].upper = problem.upper.size() > 0 ? problem.upper[i] : kInfinity;
  }
  for (const CoupledLimit& limit : problem.limits) {
    rows[limit.row].normal_row = limit.normal_row;
    rows[limit.row].coefficient = limit.coefficient;
  }
  return rows;
}

const FactoredMatrix& matrix_of(const Problem& problem) {
  return std::get<FactoredMatrix>(problem.M);
}

/// z after a sweep there and back and another there.
template <typename T>
Vector swept(Sweeps<T>& sweeps, Index n) {
  Vector z = Vector::Zero(n);
  sweeps.start(z);
  Vector w(n);
  sweeps.refresh(w);
  sweeps.forward();
  sweeps.backward();
  sweeps.forward();
  sweeps.read(z);
  return z;
}

template <typename T>
Vector swept(const Problem& problem, RowOrder order,
             InstructionSet instructions = best_instruction_set()) {
  auto rows = rows_of(problem);
  PackedRows<T> packed;
  packed.set(matrix_of(problem), rows, 1.1, order, instructions);
  return swept(packed, problem.size());
}

struct Named {
  std::string name;
  SweepProblemSpec spec;
};

void PrintTo(const Named& kind, std::ostream* out) {
  *out << kind.name;
}

std::vector<Named> all_kinds() {
  std::vector<Named> kinds;
  for (const int rows_a_pair : {1, 2, 3, 4, 7}) {
    const std::string number = std::to_string(rows_a_pair);
    kinds.push_back({"Contacts" + number, {.rows_a_pair = rows_a_pair}});
    kinds.push_back({"Bounded" + number, {.rows_a_pair = rows_a_pair, .bounded = true}});
    kinds.push_back({"Compliant" + number, {.rows_a_pair = rows_a_pair, .compliant = true}});
    kinds.push_back(
        {"Coupled" + number, {.rows_a_pair = rows_a_pair, .compliant = true, .coupled = true}});
  }
  kinds.push_back({"Wide", {.bodies = 60, .rows = 150}});
  kinds.push_back({"VeryWide", {.bodies = 900, .rows = 3000, .rows_a_pair = 2, .coupled = true}});
  kinds.push_back({"WideBounded", {.bodies = 60, .rows = 150, .bounded = true}});
  kinds.push_back({"Articulated", {.bodies = 9, .articulated = true, .bounded = true}});
  kinds.push_back({"ArticulatedCoupled", {.bodies = 9, .articulated = true, .coupled = true}});
  kinds.push_back({"Semidefinite", {.bounded = true, .semidefinite = true}});
  kinds.push_back({"OneRow", {.bodies = 2, .rows = 1, .bounded = true}});
  // Some 100 rows a body: more than there are colours.
  kinds.push_back({"Crowded", {.bodies = 3, .rows = 150, .coupled = true}});
  for (Named& kind : kinds) {
    kind.spec.seed = 20240702;
  }
  return kinds;
}

class PackedRowsOfKind : public testing::TestWithParam<Named> {};
INSTANTIATE_TEST_SUITE_P(Kinds, PackedRowsOfKind, testing::ValuesIn(all_kinds()),
                         [](const auto& kind) { return kind.param.name; });

/// Both do the arithmetic of Gauss-Seidel in the caller's order; three sweeps of at most 150 rows
/// that follow from each other, each sum of 40 products off by eps |M||z|, leave 3 * 150 * 40 eps =
/// 4e-12 of the largest number.
TEST_P(PackedRowsOfKind, SweepTheFormedMatrixInTheCallersOrder) {
  const Problem problem = sweep_problem(GetParam().spec);
  auto rows = rows_of(problem);
  const MatrixForm formed = to_dense(problem.M);
  ColumnSweeps<double> columns;
  columns.set(formed, rows, 1.1);
  const Vector expected = swept(columns, problem.size());
  const Vector z = swept<double>(problem, RowOrder::kNatural);
  EXPECT_GT(expected.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_LE((z - expected).cwiseAbs().maxCoeff(), 4e-12 * expected.cwiseAbs().maxCoeff());
}

TEST_P(PackedRowsOfKind, GiveTheSameBitsOnEveryInstructionSetButTheFused) {
  const Problem problem = sweep_problem(GetParam().spec);
  for (const RowOrder order : {RowOrder::kNatural, RowOrder::kColoured}) {
    const Vector in_double = swept<double>(problem, order, InstructionSet::kBaseline);
    const Vector in_float = swept<float>(problem, order, InstructionSet::kBaseline);
    for (const InstructionSet set : available_instruction_sets()) {
      const Vector of_set = swept<double>(problem, order, set);
      if (set == InstructionSet::kFma) {
        EXPECT_LE((of_set - in_double).cwiseAbs().maxCoeff(),
                  4e-12 * in_double.cwiseAbs().maxCoeff());
        continue;
      }
      EXPECT_EQ(of_set, in_double) << to_string(set);
      EXPECT_EQ(swept<float>(problem, order, set), in_float) << to_string(set);
    }
  }
}

TEST_P(PackedRowsOfKind, GiveTheSameBitsOnAnyNumberOfThreads) {
  const Problem problem = sweep_problem(GetParam().spec);
  for (const RowOrder order : {RowOrder::kNatural, RowOrder::kColoured}) {
    const Vector alone = swept<double>(problem, order);
    for (const int threads : {2, 3, 4}) {
      ThreadTeam team(threads);
      auto rows = rows_of(problem);
      PackedRows<double> packed;
      packed.set(matrix_of(problem), rows, 1.1, order);
      packed.use(&team);
      EXPECT_EQ(swept(packed, problem.size()), alone) << threads << " threads";
    }
  }
}

/// As above with eps of float: 3 * 150 * 40 * 6e-8 = 1e-3.
TEST_P(PackedRowsOfKind, AreCloseInFloat) {
  const Problem problem = sweep_problem(GetParam().spec);
  for (const RowOrder order : {RowOrder::kNatural, RowOrder::kColoured}) {
    const Vector in_double = swept<double>(problem, order);
    const Vector in_float = swept<float>(problem, order);
    EXPECT_LE((in_float - in_double).cwiseAbs().maxCoeff(), 1e-3 * in_double.cwiseAbs().maxCoeff());
    EXPECT_NE(in_float, in_double);
  }
}

TEST_P(PackedRowsOfKind, RefreshGivesWOfTheCallersData) {
  const Problem problem = sweep_problem(GetParam().spec);
  for (const RowOrder order : {RowOrder::kNatural, RowOrder::kColoured}) {
    auto rows = rows_of(problem);
    PackedRows<double> packed;
    packed.set(matrix_of(problem), rows, 1.0, order);
    const Vector z = swept(packed, problem.size());
    Vector w(problem.size());
    packed.refresh(w);
    Vector expected(problem.size());
    multiply(problem.M, z.data(), expected.data());
    expected += problem.q;
    EXPECT_LE((w - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff() + 1e-12);
  }
}

/// A sweep lowers the objective of a symmetric problem with bounds, whatever the order of the rows,
/// if each row sees the steps of those before it.
TEST_P(PackedRowsOfKind, ColouredSweepsLowerTheObjective) {
  const Problem problem = sweep_problem(GetParam().spec);
  auto rows = rows_of(problem);
  PackedRows<double> packed;
  packed.set(matrix_of(problem), rows, 1.0, RowOrder::kColoured);
  EXPECT_GE(packed.color_count(), 1);
  EXPECT_LE(packed.color_count(), RowColoring::kColors);
  if (!problem.limits.empty()) {
    GTEST_SKIP() << "coupled limits have no objective";
  }
  Vector z = Vector::Zero(problem.size());
  Vector w(problem.size());
  packed.start(z);
  packed.refresh(w);
  double before = 0.0;
  for (int k = 0; k < 5; ++k) {
    packed.forward();
    packed.refresh(w);
    packed.read(z);
    const double after = 0.5 * z.dot(w + problem.q);
    EXPECT_LE(after, before + 1e-12 * std::abs(before)) << "sweep " << k;
    before = after;
  }
  EXPECT_LT(before, 0.0);
}

TEST_P(PackedRowsOfKind, AllocateNothingTheSecondTime) {
  const Problem problem = sweep_problem(GetParam().spec);
  for (const RowOrder order : {RowOrder::kNatural, RowOrder::kColoured}) {
    auto rows = rows_of(problem);
    PackedRows<float> packed;
    packed.set(matrix_of(problem), rows, 1.0, order);
    const AllocationCount allocations;
    packed.set(matrix_of(problem), rows, 1.0, order);
    EXPECT_EQ(allocations.count(), 0);
  }
}

TEST(PackedRows, SetAgainForAnotherProblemGivesItsBits) {
  const Problem large =
      sweep_problem({.bodies = 20, .rows = 90, .rows_a_pair = 3, .coupled = true});
  const Problem small = sweep_problem({.bodies = 4, .rows = 9, .bounded = true});
  PackedRows<double> packed;
  for (const Problem* problem : {&large, &small, &large}) {
    auto rows = rows_of(*problem);
    packed.set(matrix_of(*problem), rows, 1.1, RowOrder::kColoured);
    EXPECT_EQ(swept(packed, problem->size()), swept<double>(*problem, RowOrder::kColoured));
  }
}

/// Powers of two everywhere: units change no bit, in float as in double.
TEST(PackedRows, OtherUnitsChangeNoBit) {
  const Problem problem = sweep_problem({.bodies = 9, .rows = 60, .rows_a_pair = 2});
  FactoredMatrix scaled;
  const FactoredMatrix& A = matrix_of(problem);
  constexpr double kLength = 0x1p-200;
  for (int b = 0; b < A.mass.block_count(); ++b) {
    const int d = A.mass.dimension(b);
    Matrix W(d, d);
    for (int k = 0; k < d; ++k) {
      A.mass.apply_inverse(b, Vector(Vector::Unit(d, k)).data(), W.col(k).data());
    }
    scaled.mass.add_inverse(0.5 * (W + W.transpose()));
  }
  FactoredMatrix plain;
  plain.mass = scaled.mass;
  for (int i = 0; i < A.rows(); ++i) {
    scaled.add_row();
    plain.add_row();
    for (const auto& entry : A.entries(i)) {
      const Eigen::Map<const Vector> values(A.values(entry), A.mass.dimension(entry.block));
      plain.add_entry(entry.block, values);
      scaled.add_entry(entry.block, kLength * values);
    }
  }
  Problem one = problem;
  one.M = plain;
  Problem other = problem;
  other.M = scaled;
  EXPECT_EQ(swept<double>(one, RowOrder::kNatural),
            swept<double>(other, RowOrder::kNatural) * (kLength * kLength));
  EXPECT_EQ(swept<float>(one, RowOrder::kNatural),
            swept<float>(other, RowOrder::kNatural) * (kLength * kLength));
}

TEST(InstructionSet, TheFirstIsTheBaselineAndTheFusedIsOnlyChosenWhenAsked) {
  const auto sets = available_instruction_sets();
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets.front(), InstructionSet::kBaseline);
  EXPECT_NE(best_instruction_set(), InstructionSet::kFma);
  EXPECT_EQ(best_instruction_set(true), sets.back());
}

}  // namespace
}  // namespace signorini::lcp
