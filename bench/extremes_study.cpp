#include "bench/extremes_study.h"

#include <signorini/lcp/certificate.h>
#include <signorini/lcp/solve_recorder.h>

#include "bench/thread_time.h"
#include "tools/byte_archive.h"
#include "tools/child_process.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <ostream>
#include <sstream>
#include <utility>

namespace signorini::bench {

void visit_fields(auto& archive, tools::Reflects<ExtremesRow> auto& row) {
  archive(row.axis, row.value, row.mass_ratio, row.contestant, row.is_ours, row.verdict, row.error,
          row.residual, row.status, row.seconds, row.reason);
}

namespace {

constexpr double kPassError = 1e-6;
constexpr double kDegradedError = 1e-2;

/// Judges every `solved` once more, by the full certificate.
class SecondOpinion final : public lcp::SolveRecorder {
 public:
  std::string record(const lcp::SolveRecord& solve) override {
    if (lcp::is_solved(solve.result.status)) {
      const lcp::Certificate certificate = lcp::certify(solve.problem, solve.result.z);
      const lcp::Status status =
          lcp::judge(certificate, solve.settings.tolerance, lcp::Status::kStalled);
      wrong_ += lcp::is_solved(status) ? 0 : 1;
    }
    return {};
  }
  [[nodiscard]] int wrong() const { return wrong_; }
  void forget() { wrong_ = 0; }

 private:
  int wrong_ = 0;
};

/// Told of all solves of our contestants: cells run one after the other, each in its own process.
SecondOpinion& second_opinion() {
  static SecondOpinion opinion;
  return opinion;
}

/// What a child says of a cell.
struct Played {
  double error = 0.0;
  double residual = 0.0;
  int status = 0;
  int wrong = 0;
  double seconds = 0.0;

  [[nodiscard]] std::string to_text() const {
    return fmt::format("{} {} {} {} {}", error, residual, status, wrong, seconds);
  }
  static Played from_text(const std::string& text) {
    Played played;
    std::istringstream in(text);
    std::string error;
    std::string residual;  // streams do not read nan and inf
    in >> error >> residual >> played.status >> played.wrong >> played.seconds;
    played.error = std::stod(error);
    played.residual = std::stod(residual);
    return played;
  }
};

Played play(const ExtremeScene& extreme, const Contestant& contestant) {
  second_opinion().forget();
  const std::unique_ptr<ScenePlayer> player = contestant.start(extreme.scene);
  Played played;
  for (int k = 1; k <= extreme.steps && std::isfinite(played.error); ++k) {
    const double start = thread_seconds();
    player->step();
    played.seconds += thread_seconds() - start;
    const double error = scene_error(extreme, k, player->poses(), player->velocities());
    played.error = error <= played.error ? played.error : error;
  }
  played.residual = player->worst_residual();
  played.status = static_cast<int>(player->status());
  played.wrong = second_opinion().wrong();
  return played;
}

ExtremeVerdict judge_cell(const ExtremesRow& row, int wrong) {
  if (!std::isfinite(row.error)) {
    return ExtremeVerdict::kNotANumber;
  }
  if (wrong > 0) {
    return ExtremeVerdict::kWrongSolved;
  }
  const bool solved = !row.is_ours || lcp::is_solved(row.status);
  if (solved && row.error <= kPassError) {
    return ExtremeVerdict::kPass;
  }
  return row.error <= kDegradedError ? ExtremeVerdict::kDegraded : ExtremeVerdict::kFail;
}

ExtremesRow run_cell(const ExtremeCell& cell, const ExtremeContestant& contestant, double cap) {
  ExtremesRow row{.axis = cell.axis,
                  .value = cell.value,
                  .mass_ratio = cell.mass_ratio,
                  .contestant = contestant.player.name,
                  .is_ours = contestant.player.is_ours};
  row.error = row.residual = std::numeric_limits<double>::quiet_NaN();
  const tools::ChildAnswer answer = tools::run_in_child(
      [&](const std::function<void()>& loaded) {
        const ExtremeScene extreme = cell.make(contestant.has_friction);
        loaded();
        return play(extreme, contestant.player).to_text();
      },
      {.seconds = cap});
  row.reason = answer.reason;
  if (answer.end != tools::ChildEnd::kAnswered) {
    row.verdict =
        answer.end == tools::ChildEnd::kTimedOut ? ExtremeVerdict::kTime : ExtremeVerdict::kCrashed;
    return row;
  }
  const Played played = Played::from_text(answer.answer);
  row.error = played.error;
  row.residual = played.residual;
  row.status = static_cast<lcp::Status>(played.status);
  row.seconds = played.seconds;
  row.verdict = judge_cell(row, played.wrong);
  return row;
}

/// The cells of one axis: its values, each with as many letters as it has mass ratios.
using AxisCells = std::vector<std::vector<const ExtremeCell*>>;

AxisCells by_value(const std::vector<ExtremeCell>& cells, const std::string& axis) {
  AxisCells values;
  for (const ExtremeCell& cell : cells) {
    if (cell.axis != axis) {
      continue;
    }
    if (values.empty() || values.back().front()->value != cell.value) {
      values.emplace_back();
    }
    values.back().push_back(&cell);
  }
  return values;
}

constexpr int kNameWidth = 30;
constexpr int kColumn = 7;

void print_head(const std::string& axis, const AxisCells& values, std::ostream& out) {
  out << fmt::format("\n{}\n{:{}}", axis, "", kNameWidth);
  for (const auto& cells : values) {
    out << fmt::format("{:<{}}", fmt::format("{:g}", cells.front()->value), kColumn);
  }
  out << "\n";
}

/// A contestant on an axis: a job, and a line of the map.
struct Line {
  std::string axis;
  AxisCells values;
  const ExtremeContestant* contestant;

  [[nodiscard]] std::string name() const { return axis + ": " + contestant->player.name; }
  [[nodiscard]] std::vector<ExtremesRow> run(double cap) const {
    std::vector<ExtremesRow> rows;
    for (const auto& same_value : values) {
      for (const ExtremeCell* cell : same_value) {
        rows.push_back(run_cell(*cell, *contestant, cap));
      }
    }
    return rows;
  }
};

/// Axis by axis, the contestants that take part in it.
std::vector<Line> lines_of(const ExtremesOptions& options, const std::vector<ExtremeCell>& cells,
                           const std::vector<ExtremeContestant>& contestants) {
  std::vector<Line> lines;
  std::string last;
  for (const ExtremeCell& cell : cells) {
    if (cell.axis == last || cell.axis.find(options.axis) == std::string::npos) {
      continue;
    }
    last = cell.axis;
    const AxisCells values = by_value(cells, cell.axis);
    for (const ExtremeContestant& contestant : contestants) {
      if (contestant.player.name.find(options.contestant) != std::string::npos &&
          (contestant.has_friction || values.front().front()->takes_no_friction)) {
        lines.push_back({cell.axis, values, &contestant});
      }
    }
  }
  return lines;
}

void print_line(const Line& line, const std::vector<ExtremesRow>& rows, std::ostream& out) {
  out << fmt::format("{:{}}", line.contestant->player.name, kNameWidth);
  std::size_t next = 0;
  for (const auto& same_value : line.values) {
    std::string letters;
    for (std::size_t i = 0; i < same_value.size(); ++i) {
      letters += letter(rows[next++].verdict);
    }
    out << fmt::format("{:<{}}", letters, kColumn);
  }
  out << "\n";
}

std::string what_it_was(const ExtremesRow& row) {
  return fmt::format("{} = {:g}, mass ratio {:g}: {} (error {:.1e}, residual {:.1e}, {}){}",
                     row.axis, row.value, row.mass_ratio, letter(row.verdict), row.error,
                     row.residual, lcp::to_string(row.status),
                     row.reason.empty() ? "" : ": " + row.reason);
}

void print_summary(const ExtremesReport& report, const std::vector<ExtremeContestant>& contestants,
                   std::ostream& out) {
  out << fmt::format("\npassed of cells, mass ratio up to\n{:{}}{:>12}{:>12}{:>12}\n", "",
                     kNameWidth, "1e4", "1e9", "all");
  for (const ExtremeContestant& contestant : contestants) {
    out << fmt::format("{:{}}", contestant.player.name, kNameWidth);
    for (const double ratio : {1e4, 1e9, std::numeric_limits<double>::infinity()}) {
      const ExtremesReport::Count count = report.count(contestant.player.name, ratio);
      out << fmt::format("{:>12}", fmt::format("{}/{}", count.passed, count.cells));
    }
    out << "\n";
  }
  for (const ExtremesRow& row : report.rows) {
    if (row.contestant == kReferencePosition && row.verdict != ExtremeVerdict::kPass) {
      out << "reference, no pass: " << what_it_was(row) << "\n";
    } else if (row.is_ours && is_defect(row.verdict)) {
      out << "defect, " << row.contestant << ": " << what_it_was(row) << "\n";
    }
  }
}

ExtremeContestant dial(const char* position) {
  TimeStepSettings settings;
  settings.accuracy = Accuracy::named(position);
  settings.lcp.recorder = &second_opinion();
  return {our_stepper(std::string("dial: ") + position, settings)};
}

ExtremeContestant by_solver(const std::string& name, FrictionModel model,
                            bool has_friction = true) {
  TimeStepSettings settings;
  settings.lcp.recorder = &second_opinion();
  settings.friction_model = model;
  if (model == FrictionModel::kCone) {
    settings.cone_solver = name;
    settings.solver = "auto";
  } else {
    settings.solver = name;
  }
  const std::string what = has_friction ? std::string(to_string(model)) : "no friction";
  return {our_stepper(name + ", " + what, settings), has_friction};
}

}  // namespace

char letter(ExtremeVerdict verdict) {
  return "PdFtNXW"[static_cast<int>(verdict)];
}

std::vector<ExtremeContestant> extreme_contestants() {
  std::vector<ExtremeContestant> all;
  for (const char* position : {"preview", "game", "engineering", "reference"}) {
    all.push_back(dial(position));
  }
  for (const char* name : {"auto", "alart-curnier", "cone-interior-point", "sticking", "nsgs"}) {
    all.push_back(by_solver(name, FrictionModel::kCone));
  }
  all.push_back(by_solver("lemke", FrictionModel::kPyramid));
  for (const char* name : {"dantzig", "pgs", "pgs-float", "symmetric-pgs", "symmetric-pgs-float",
                           "psor", "psor-float", "nncg", "nncg-float"}) {
    all.push_back(by_solver(name, FrictionModel::kBox));
  }
  for (const char* name : {"interior-point", "block-pivoting", "structured-lemke", "apgd",
#ifdef SIGNORINI_HAS_GMP
                           "exact"
#endif
       }) {
    all.push_back(by_solver(name, FrictionModel::kBox, false));
  }
#ifdef SIGNORINI_PEER_BULLET
  for (const int iterations : {10, 1000}) {
    all.push_back({bullet_stepper(iterations)});
  }
#endif
  return all;
}

ExtremesReport::Count ExtremesReport::count(const std::string& contestant,
                                            double mass_ratio) const {
  Count count;
  for (const ExtremesRow& row : rows) {
    if (row.contestant == contestant && row.mass_ratio <= mass_ratio) {
      ++count.cells;
      count.passed += row.verdict == ExtremeVerdict::kPass ? 1 : 0;
    }
  }
  return count;
}

bool ExtremesReport::passed() const {
  const bool defects = std::any_of(rows.begin(), rows.end(), [](const ExtremesRow& row) {
    return row.is_ours && is_defect(row.verdict);
  });
  const Count all = count(kReferencePosition, 1e4);
  const Count most = count(kReferencePosition, 1e9);
  return !defects && failure.empty() && all.passed == all.cells &&
         10 * most.passed >= 9 * most.cells;
}

std::string ExtremesReport::to_csv() const {
  std::string csv =
      "axis,value,mass ratio,contestant,verdict,error,residual,status,seconds,reason\n";
  for (const ExtremesRow& row : rows) {
    csv += fmt::format("\"{}\",{:g},{:g},\"{}\",{},{:.3e},{:.3e},{},{:.4f},\"{}\"\n", row.axis,
                       row.value, row.mass_ratio, row.contestant, letter(row.verdict), row.error,
                       row.residual, lcp::to_string(row.status), row.seconds, row.reason);
  }
  return csv;
}

std::vector<tools::Job> extremes_jobs(const ExtremesOptions& options,
                                      const std::vector<ExtremeCell>& cells,
                                      const std::vector<ExtremeContestant>& contestants) {
  std::vector<tools::Job> jobs;
  for (Line& line : lines_of(options, cells, contestants)) {
    const std::string name = line.name();
    jobs.push_back({name, [line = std::move(line), cap = options.cap] {
                      return tools::to_bytes(line.run(cap));
                    }});
  }
  return jobs;
}

ExtremesReport run_extremes_study(const ExtremesOptions& options,
                                  const std::vector<ExtremeCell>& cells,
                                  const std::vector<ExtremeContestant>& contestants,
                                  std::ostream& out) {
  const std::vector<Line> lines = lines_of(options, cells, contestants);
  const std::vector<tools::Job> jobs = extremes_jobs(options, cells, contestants);
  const tools::JobListResult result = tools::run_job_list(jobs, options.jobs);
  ExtremesReport report;
  report.is_leader = result.is_leader;
  if (!result.is_leader) {
    return report;
  }
  report.is_interrupted = result.is_interrupted;
  report.failure = result.first_failure(jobs);
  out << result.remark()
      << ". P pass, d degraded, F fail, t out of time, N not a number, X crash,\n"
      << "W wrongly solved; under each value mass ratios 1, 1e4 and 1e9, the heavy body on top (on "
         "the\naxes of the mass ratio: one).\n";
  std::string axis;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!result.jobs[i].is_done) {
      continue;
    }
    if (lines[i].axis != axis) {
      axis = lines[i].axis;
      print_head(axis, lines[i].values, out);
    }
    const auto rows = tools::from_bytes<std::vector<ExtremesRow>>(result.jobs[i].bytes);
    print_line(lines[i], rows, out);
    report.rows.insert(report.rows.end(), rows.begin(), rows.end());
  }
  print_summary(report, contestants, out);
  if (report.is_interrupted) {
    out << "PARTIAL: interrupted; the same command goes on where it was\n";
  }
  if (!report.failure.empty()) {
    out << "a job failed: " << report.failure << "\n";
  }
  return report;
}

}  // namespace signorini::bench
