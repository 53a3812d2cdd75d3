#pragma once

#include "bench/extreme_scenes.h"
#include "bench/scene_player.h"
#include "tools/job_list.h"

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace signorini::bench {

/// What a cell came to.
enum class ExtremeVerdict : std::uint8_t {
  kPass,         ///< certificate met at every step, or to rounding, and scene error <= 1e-6
  kDegraded,     ///< scene error <= 1e-2, and the status says what it is
  kFail,         ///< else
  kTime,         ///< fail: ended at the cap
  kNotANumber,   ///< fail, and a defect: NaN or infinity in the state
  kCrashed,      ///< fail, and a defect: a signal, an exception
  kWrongSolved,  ///< fail, and a defect: a `solved` that the certificate does not bear out
};

/// 'P', 'd', 'F', 't', 'N', 'X' or 'W'.
[[nodiscard]] char letter(ExtremeVerdict verdict);
[[nodiscard]] constexpr bool is_defect(ExtremeVerdict verdict) {
  return verdict >= ExtremeVerdict::kNotANumber;
}

/// An engine, at one setting.
struct ExtremeContestant {
  Contestant player;
  bool has_friction = true;
};

/// The dial at its four positions, every solver by name in the widest of the models that it takes
/// (cone, pyramid for Lemke, box, no friction), with a tolerance of 1e-8, and Bullet.
[[nodiscard]] std::vector<ExtremeContestant> extreme_contestants();

struct ExtremesOptions {
  double cap = 1.0;                 ///< CPU seconds of a cell, > 0
  std::string axis = {};            ///< only axes whose names contain this; empty: all
  std::string contestant = {};      ///< the same of contestants
  tools::JobListOptions jobs = {};  ///< a job: a contestant on the cells of an axis
};

struct ExtremesRow {
  std::string axis;
  double value = 0.0;
  double mass_ratio = 1.0;
  std::string contestant;
  bool is_ours = true;
  ExtremeVerdict verdict = ExtremeVerdict::kFail;
  double error = 0.0;     ///< worst scene_error() of all steps
  double residual = 0.0;  ///< worst unit-free residual of all steps; NaN: not known
  lcp::Status status = lcp::Status::kNotRun;  ///< worst of all steps; not run: not known
  double seconds = 0.0;                       ///< CPU time of all steps
  std::string reason = {};                    ///< of a crash
};

struct ExtremesReport {
  std::vector<ExtremesRow> rows;
  bool is_interrupted = false;  ///< cells are missing
  bool is_leader = true;        ///< else another rank has the rows
  std::string failure = {};     ///< of the first job that failed

  /// Cells of this contestant up to a mass ratio, and those of them that it passed.
  struct Count {
    int cells = 0;
    int passed = 0;
  };
  [[nodiscard]] Count count(const std::string& contestant, double mass_ratio) const;
  /// No defect of ours, no job failed, and the reference position passes every cell up to a mass
  /// ratio of 1e4 and 90 % of all up to 1e9.
  [[nodiscard]] bool passed() const;
  [[nodiscard]] std::string to_csv() const;
};

/// The name of the contestant whose cells are claimed.
inline constexpr const char* kReferencePosition = "dial: reference";

/// Plays the cells, each in a child process under the cap, prints the map axis by axis, then what
/// each contestant passed and the cells of the reference position that are no pass. Finished jobs
/// are kept (ExtremesOptions::jobs) until the caller forgets them.
[[nodiscard]] ExtremesReport run_extremes_study(const ExtremesOptions& options,
                                                const std::vector<ExtremeCell>& cells,
                                                const std::vector<ExtremeContestant>& contestants,
                                                std::ostream& out);

/// The jobs of the study, to be forgotten once the report is written.
[[nodiscard]] std::vector<tools::Job> extremes_jobs(
    const ExtremesOptions& options, const std::vector<ExtremeCell>& cells,
    const std::vector<ExtremeContestant>& contestants);

}  // namespace signorini::bench
