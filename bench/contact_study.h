#pragma once

#include "bench/pair_checks.h"

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

struct ContactStudyOptions {
  long poses = 1000000;  ///< of each pair, > 0
  std::uint64_t seed = 1;
  std::string pair = {};  ///< "sphere-box": this one alone; empty: every pair
};

/// One pair of kinds of shapes.
struct ContactStudyRow {
  std::string pair;
  long poses = 0;
  long kissing = 0;                             ///< of them moved until they kiss
  long overlapping = 0;                         ///< of them with distance <= 0
  std::array<long, kPairProperties> wrong{};    ///< poses at which a property failed
  std::array<double, kPairProperties> worst{};  ///< the largest fraction of what is allowed
  std::string first_wrong;                      ///< the shapes and poses, and what failed
};

struct ContactStudyReport {
  std::vector<ContactStudyRow> rows;
  [[nodiscard]] bool passed() const;
  [[nodiscard]] std::string to_csv() const;
};

/// Random and near-degenerate poses of every pair of convex shapes, judged by judge_pair(): free
/// turns, aligned and nearly aligned ones, sizes 1e-3 to 1e3, coordinates up to 1e6, half of them
/// moved until they kiss.
/// @throws std::invalid_argument for an unknown pair, naming those there are
[[nodiscard]] ContactStudyReport run_contact_study(const ContactStudyOptions& options,
                                                   std::ostream& out);

}  // namespace signorini::bench
