// Nanoseconds a row of one projected Gauss-Seidel sweep over packed rows, by family, size, number
// type, order of the rows and instruction set. An argument is a pattern of Google Benchmark:
//
//     signorini-sweeps-bench --benchmark_filter='sweep/spheres/.*/avx2'

#include <signorini/lcp/packed_rows.h>

#include "bench/contact_families.h"

#include <benchmark/benchmark.h>
#include <map>
#include <string>
#include <vector>

namespace signorini::bench {
namespace {

using lcp::InstructionSet;
using lcp::RowOrder;

struct Scene {
  const char* family;
  int size;
};

// Some 1000 and some 10,000 rows of each.
constexpr Scene kScenes[] = {{"tower4", 250},   {"tower4", 2500},  {"pyramid2d", 16},
                             {"pyramid2d", 50}, {"pyramid3d", 6},  {"pyramid3d", 12},
                             {"spheres", 1000}, {"spheres", 10000}};

const lcp::Problem& problem_of(const Scene& scene) {
  static std::map<std::string, lcp::Problem> made;
  const std::string key = scene.family + std::to_string(scene.size);
  if (!made.contains(key)) {
    made[key] = make_family({.family = scene.family, .size = scene.size});
  }
  return made[key];
}

std::vector<lcp::SweepRow> contact_rows(const lcp::Problem& problem) {
  std::vector<lcp::SweepRow> rows(problem.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].q = problem.q[static_cast<lcp::Index>(i)];
    rows[i].lower = 0.0;
    rows[i].upper = std::numeric_limits<double>::infinity();
  }
  return rows;
}

template <typename T>
void sweep(benchmark::State& state, const Scene& scene, RowOrder order, InstructionSet set) {
  const lcp::Problem& problem = problem_of(scene);
  auto rows = contact_rows(problem);
  lcp::PackedRows<T> packed;
  packed.set(std::get<lcp::FactoredMatrix>(problem.M), rows, 1.0, order, set);
  packed.start(lcp::Vector::Zero(problem.size()));
  for (auto _ : state) {
    packed.forward();
    benchmark::ClobberMemory();
  }
  const auto done = static_cast<double>(state.iterations()) * static_cast<double>(problem.size());
  state.counters["n"] = static_cast<double>(problem.size());
  state.counters["colours"] = packed.color_count();
  state.counters["ns/row"] =
      benchmark::Counter(done * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Packing the rows, what a solve pays before its first sweep.
template <typename T>
void set(benchmark::State& state, const Scene& scene, RowOrder order) {
  const lcp::Problem& problem = problem_of(scene);
  auto rows = contact_rows(problem);
  lcp::PackedRows<T> packed;
  for (auto _ : state) {
    packed.set(std::get<lcp::FactoredMatrix>(problem.M), rows, 1.0, order);
  }
  const auto done = static_cast<double>(state.iterations()) * static_cast<double>(problem.size());
  state.counters["n"] = static_cast<double>(problem.size());
  state.counters["ns/row"] =
      benchmark::Counter(done * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <typename T>
void add(const std::string& type) {
  for (const Scene& scene : kScenes) {
    const std::string name = std::string("/") + scene.family + "/" + std::to_string(scene.size);
    for (const RowOrder order : {RowOrder::kNatural, RowOrder::kColoured}) {
      const std::string kind = (order == RowOrder::kNatural ? "/natural/" : "/coloured/") + type;
      for (const InstructionSet instructions : lcp::available_instruction_sets()) {
        std::string label = "sweep" + name;
        label.append(kind).append("/").append(lcp::to_string(instructions));
        benchmark::RegisterBenchmark(label.c_str(), [=](benchmark::State& state) {
          sweep<T>(state, scene, order, instructions);
        });
      }
      std::string label = "set" + name;
      label += kind;
      benchmark::RegisterBenchmark(label.c_str(),
                                   [=](benchmark::State& state) { set<T>(state, scene, order); });
    }
  }
}

}  // namespace
}  // namespace signorini::bench

int main(int argc, char** argv) {
  signorini::bench::add<double>("double");
  signorini::bench::add<float>("float");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 64;
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
