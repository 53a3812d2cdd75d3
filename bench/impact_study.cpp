#include "bench/impact_study.h"

#include <signorini/core/response/assembly.h>
#include <signorini/core/response/energy_safe.h>
#include <signorini/core/response/friction_cones.h>
#include <signorini/core/response/reflections.h>
#include <signorini/core/response/tangent_rows.h>

#include "bench/random_impact.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <limits>
#include <stdexcept>
#include <unistd.h>

namespace signorini::bench {
namespace {

constexpr double kGain = 1e-12;           // what energy-safe promises, relative
constexpr double kIdentity = 1e-12;       // two sums of some hundred terms of the same numbers,
constexpr double kOfTheTerms = 1e-14;     // and what their rounding is of the terms, f.u
constexpr double kTolerance = 1e-12;      // of the LCPs and of the check that f is admissible
constexpr double kConeTolerance = 1e-10;  // the same with friction
constexpr int kMostReflections = 500;     // what needs more is answered by the plastic impulses
constexpr double kSeparatingShare = 0.3;
constexpr std::size_t kMostComplaints = 20;

/// The sizes of the terms f.(u- + u+) / 2 that the gain is summed from, J.
double size_of_terms(const RandomImpact& impact, const State& after, const ImpactReport& report) {
  double sum = 0.0;
  for (std::size_t i = 0; i < impact.contacts.size(); ++i) {
    const Contact& contact = impact.contacts[i];
    sum += 0.5 * report.contact_impulses[i].norm() *
           (slip_velocity(impact.bodies, impact.state, contact).norm() +
            slip_velocity(impact.bodies, after, contact).norm());
  }
  return sum;
}

bool has_driven_body(const RandomImpact& impact) {
  return std::any_of(impact.bodies.begin(), impact.bodies.end(),
                     [](const Body& body) { return body.kind == BodyKind::kKinematic; });
}

bool shown_infeasible(lcp::Status status) {
  return status == lcp::Status::kInfeasible || status == lcp::Status::kNoSolutionBelow;
}

/// Of (normal, tangential >= 0) from {tangential <= mu normal}, apart from what the solvers use.
double distance_from_cone(double normal, double tangential, double mu) {
  if (normal >= 0.0 && tangential <= mu * normal) {
    return 0.0;
  }
  return mu * tangential <= -normal ? std::hypot(normal, tangential)
                                    : (tangential - mu * normal) / std::hypot(1.0, mu);
}

/// Every impulse in its cone and no contact approaching, to what the law allows itself and, since
/// its impulses were turned into the world's axes and are turned back here, their rounding once
/// more.
bool is_in_cones(const RandomImpact& impact, const ImpactReport& report) {
  const auto count = static_cast<lcp::Index>(impact.contacts.size());
  ConeProblem cones;
  assemble_cones(impact.bodies, impact.state, impact.contacts, lcp::Vector::Zero(count), cones);
  lcp::Vector z(cones.problem.size());
  lcp::Vector diagonal;
  cones.A().diagonal(diagonal);
  double worst = 0.0;  // m/s
  for (std::size_t i = 0; i < impact.contacts.size(); ++i) {
    const Vec3& f = report.contact_impulses[i];
    const int row = cones.normal_row[i];
    const double normal = f.dot(impact.contacts[i].normal);
    z[row] = normal;
    const Vec3 tangential = f - normal * impact.contacts[i].normal;
    if (cones.friction[i] > 0.0) {
      z[row + 1] = f.dot(cones.frames[i].t1);
      z[row + 2] = f.dot(cones.frames[i].t2);
    }
    const double outside = distance_from_cone(normal, tangential.norm(), cones.friction[i]);
    worst = std::max(worst, diagonal[row] * outside);
  }
  const double rounding = velocity_allowed(cones, z, 0.0);
  const double allowed = std::max(velocity_allowed(cones, z, kConeTolerance), 1.25 * rounding);
  lcp::Vector after(z.size());
  cones.A().multiply(z.data(), after.data());
  after += cones.problem.q;
  for (std::size_t i = 0; i < impact.contacts.size(); ++i) {
    worst = std::max(worst, -after[cones.normal_row[i]]);
  }
  return worst <= allowed;
}

class Study {
 public:
  explicit Study(const ImpactOptions& options) : options_(options) {
    for (const ImpactLaw law : options.laws) {
      if (has_friction() && law != ImpactLaw::kNewton && law != ImpactLaw::kReflections) {
        continue;
      }
      for (const bool safe : {false, true}) {
        if (!safe && !options.plain_forms) {
          continue;
        }
        ImpactRow row;
        row.law = law;
        row.energy_safe = safe;
        row.worst_gain = -std::numeric_limits<double>::infinity();
        counts_.rows.push_back(row);
      }
    }
    gains_.resize(counts_.rows.size());
  }

  void run_impact(int index) {
    const RandomImpact impact = draw_random_impact(options_.seed, index, options_.impact);
    NormalRows rows;
    assemble_normals(impact.bodies, impact.state, impact.contacts, rows);
    separating_ += (rows.d_dot.array() > 0.0).count();
    counts_.contacts += static_cast<int>(impact.contacts.size());
    ++counts_.impacts;
    for (std::size_t r = 0; r < counts_.rows.size(); ++r) {
      ImpactSettings settings;
      settings.law = counts_.rows[r].law;
      settings.energy_safe = counts_.rows[r].energy_safe;
      settings.friction = has_friction();
      settings.max_passes = kMostReflections;
      settings.lcp.tolerance = has_friction() ? kConeTolerance : kTolerance;
      settings.lcp.recorder = options_.recorder;
      State state = impact.state;
      ImpactReport report;
      resolve_impact(impact.bodies, impact.contacts, settings, state, report);
      ++counts_.rows[r].statuses[report.status];
      if (lcp::is_solved(report.status)) {
        measure(index, impact, rows, state, report, r);
      } else if (settings.energy_safe) {
        count_unanswered(index, impact, report);
      }
    }
  }

  ImpactCounts finish() {
    if (counts_.contacts > 0) {
      counts_.separating_share = static_cast<double>(separating_) / counts_.contacts;
    }
    counts_.worst_safe_gain = -std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < counts_.rows.size(); ++r) {
      ImpactRow& row = counts_.rows[r];
      row.gained = static_cast<int>(gains_[r].size());
      if (!gains_[r].empty()) {
        const auto middle = gains_[r].begin() + gains_[r].size() / 2;
        std::nth_element(gains_[r].begin(), middle, gains_[r].end());
        row.median_gain = *middle;
      }
      if (row.energy_safe) {
        counts_.worst_safe_gain = std::max(counts_.worst_safe_gain, row.worst_gain);
      } else if (row.law == ImpactLaw::kNewton) {
        counts_.newton_gains = row.gained;
      } else if (row.law == ImpactLaw::kNotes) {
        counts_.notes_gains = row.gained;
      }
    }
    return std::move(counts_);
  }

 private:
  [[nodiscard]] bool has_friction() const { return options_.impact.most_friction > 0.0; }

  [[nodiscard]] bool is_answer_admissible(const RandomImpact& impact, const NormalRows& rows,
                                          const ImpactReport& report) const {
    return has_friction() ? is_in_cones(impact, report)
                          : is_admissible(rows, report.impulses, kTolerance);
  }

  void measure(int index, const RandomImpact& impact, const NormalRows& rows, const State& after,
               const ImpactReport& report, std::size_t r) {
    ImpactRow& row = counts_.rows[r];
    const double gain = report.relative_energy_gain();
    row.worst_gain = std::max(row.worst_gain, gain);
    if (!(gain <= kGain)) {
      gains_[r].push_back(gain);
    }
    row.reduced += (report.theta.array() > 0.0 && report.theta.array() < 1.0).any() ? 1 : 0;
    row.replaced += (report.theta.array() == 0.0).any() ? 1 : 0;
    const double before = report.d_dot_before.cwiseAbs().maxCoeff();
    if (before > 0.0) {
      row.worst_approach = std::max(row.worst_approach, -report.d_dot_after.minCoeff() / before);
    }
    const double size = report.energy_before + report.energy_after + std::abs(report.driver_work) +
                        kOfTheTerms / kIdentity * size_of_terms(impact, after, report);
    const double difference = std::abs(report.energy_gain() - report.gain_from_impulses);
    const double identity = size > 0.0 ? difference / size : difference;
    row.worst_identity = std::max(row.worst_identity, identity);
    const bool admissible = is_answer_admissible(impact, rows, report);
    row.inadmissible += admissible ? 0 : 1;
    if (!(identity <= kIdentity) || (row.energy_safe && !(gain <= kGain && admissible))) {
      complain(index, row,
               fmt::format("gain {:.3g}, approach {:.3g}, identity {:.3g}", gain,
                           -report.d_dot_after.minCoeff(), identity));
    }
  }

  void count_unanswered(int index, const RandomImpact& impact, const ImpactReport& report) {
    if (has_driven_body(impact) && shown_infeasible(report.status)) {
      ++counts_.squeezed;
      return;
    }
    if (has_friction()) {
      ++counts_.unsolved_coulomb;
      return;
    }
    ++counts_.unanswered;
    complaint(fmt::format("impact {}: no answer: {}; {}", index, lcp::to_string(report.status),
                          report.plastic_result.detail));
  }

  void complain(int index, const ImpactRow& row, const std::string& what) {
    complaint(fmt::format("impact {}: {}{}: {}", index, to_string(row.law),
                          row.energy_safe ? ", energy-safe" : "", what));
  }

  void complaint(const std::string& text) {
    if (counts_.complaints.size() < kMostComplaints) {
      counts_.complaints.push_back(text);
    }
  }

  ImpactOptions options_;
  ImpactCounts counts_;
  std::vector<std::vector<double>> gains_;  // above kGain, one list a row
  Eigen::Index separating_ = 0;
};

void show_progress(int done, int all) {
  if (isatty(STDERR_FILENO) != 0 && (done % 100 == 0 || done == all)) {
    fmt::print(stderr, "\rimpacts: {} of {}{}", done, all, done == all ? "\n" : "");
  }
}

std::string statuses_text(const ImpactRow& row) {
  std::string text;
  for (const auto& [status, count] : row.statuses) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", lcp::to_string(status), count);
  }
  return text;
}

void print_table(const ImpactCounts& counts, std::ostream& out) {
  fmt::print(out, "{} impacts, {} contacts, {:.1f} % of them separating before the impact\n\n",
             counts.impacts, counts.contacts, 100.0 * counts.separating_share);
  fmt::print(out, "{:<11} {:<12} {:>7} {:>7} {:>11} {:>11} {:>8} {:>8} {:>6} {:>13} {:>10}\n",
             "law", "form", "solved", "gained", "worst gain", "median gain", "0<theta<1", "theta=0",
             "f bad", "worst approach", "identity");
  for (const ImpactRow& row : counts.rows) {
    fmt::print(out,
               "{:<11} {:<12} {:>7} {:>7} {:>11.3g} {:>11.3g} {:>8} {:>8} {:>6} {:>13.2g} "
               "{:>10.2g}\n",
               to_string(row.law), row.energy_safe ? "energy-safe" : "plain", row.solved(),
               row.gained, row.worst_gain, row.median_gain, row.reduced, row.replaced,
               row.inadmissible, row.worst_approach, row.worst_identity);
  }
  fmt::print(out, "\n");
  for (const ImpactRow& row : counts.rows) {
    fmt::print(out, "{}, {}: {}\n", to_string(row.law), row.energy_safe ? "energy-safe" : "plain",
               statuses_text(row));
  }
}

void print_verdict(const ImpactCounts& counts, std::ostream& out) {
  fmt::print(
      out,
      "\nunanswered {}, Coulomb unsolved {}, squeezed by driven bodies {}; worst energy-safe "
      "gain {:.3g}: {}\n",
      counts.unanswered, counts.unsolved_coulomb, counts.squeezed, counts.worst_safe_gain,
      counts.passed() ? "PASS" : "FAIL");
  for (const std::string& complaint : counts.complaints) {
    fmt::print(out, "{}\n", complaint);
  }
}

}  // namespace

int ImpactRow::solved() const {
  int sum = 0;
  for (const auto& [status, count] : statuses) {
    sum += lcp::is_solved(status) ? count : 0;
  }
  return sum;
}

bool ImpactCounts::passed() const {
  const bool rows_hold = std::all_of(rows.begin(), rows.end(), [](const ImpactRow& row) {
    return row.worst_identity <= kIdentity &&
           (!row.energy_safe || (row.gained == 0 && row.inadmissible == 0));
  });
  return rows_hold && unanswered == 0 && (contacts == 0 || separating_share >= kSeparatingShare);
}

std::string ImpactCounts::to_csv() const {
  std::string csv =
      "law,energy_safe,impacts,solved,gained,worst_gain,median_gain,theta_between,theta_zero,"
      "inadmissible,worst_approach,worst_identity\r\n";
  for (const ImpactRow& row : rows) {
    csv += fmt::format("\"{}\",{},{},{},{},{},{},{},{},{},{},{}\r\n", to_string(row.law),
                       row.energy_safe ? 1 : 0, impacts, row.solved(), row.gained, row.worst_gain,
                       row.median_gain, row.reduced, row.replaced, row.inadmissible,
                       row.worst_approach, row.worst_identity);
  }
  return csv;
}

ImpactCounts run_impact_study(const ImpactOptions& options, std::ostream& out) {
  if (options.impacts < 0) {
    throw std::invalid_argument("impacts: must be >= 0, got " + std::to_string(options.impacts));
  }
  Study study(options);
  if (options.first < 0) {
    throw std::invalid_argument("first: must be >= 0, got " + std::to_string(options.first));
  }
  for (int index = 0; index < options.impacts; ++index) {
    study.run_impact(options.first + index);
    show_progress(index + 1, options.impacts);
  }
  ImpactCounts counts = study.finish();
  print_table(counts, out);
  print_verdict(counts, out);
  return counts;
}

}  // namespace signorini::bench
