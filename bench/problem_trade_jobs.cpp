#include "bench/problem_trade_jobs.h"

#include "tools/byte_archive.h"

#include <algorithm>
#include <fmt/format.h>

namespace signorini::bench {

// The answer z stays behind: its certificate says what it is.
void visit_fields(auto& archive, tools::Reflects<PeerRun> auto& run) {
  archive(run.verdict, run.claim, run.said, run.certificate, run.seconds, run.first_seconds,
          run.repeats, run.iterations, run.pivots, run.factorizations);
}
void visit_fields(auto& archive, tools::Reflects<PeersRow> auto& row) {
  archive(row.problem, row.form, row.family, row.column, row.n, row.mass_ratio, row.at_rest,
          row.solver, row.library, row.run, row.floor_seconds);
}

namespace {

using SeriesRows = std::vector<std::vector<PeersRow>>;  // [position of the dial][problem]

std::string run_series(std::span<const PeerProblem> series, const PeersContestant& contestant,
                       PeersOptions options, const std::vector<double>& dial) {
  SeriesRows rows;
  for (const double tolerance : dial) {
    options.settings.tolerance = tolerance;
    rows.push_back(run_peers_series(series, contestant, options));
  }
  return tools::to_bytes(rows);
}

}  // namespace

ProblemTrade::ProblemTrade(const PeerProblemOptions& problems, const PeersOptions& options,
                           std::vector<double> dial)
    : options_(options),
      dial_(std::move(dial)),
      contestants_(peers_contestants(all_peers(), options)) {
  for (PeerProblem& problem : peer_problems(problems)) {
    ++problem_count_;
    const auto is_it = [&](const Series& one) {
      return one.problems.front().series == problem.series &&
             one.problems.front().form == problem.form;
    };
    const auto found = std::find_if(series_.begin(), series_.end(), is_it);
    if (found == series_.end()) {
      series_.emplace_back().problems.push_back(std::move(problem));
    } else {
      found->problems.push_back(std::move(problem));
    }
  }
}

std::vector<tools::Job> ProblemTrade::jobs() const {
  std::vector<tools::Job> jobs;
  for (const Series& series : series_) {
    for (const PeersContestant& contestant : contestants_) {
      jobs.push_back({fmt::format("problems {} ({}): {}", series.problems.front().series,
                                  series.problems.front().form, contestant.name()),
                      [this, &series, &contestant] {
                        return run_series(series.problems, contestant, options_, dial_);
                      }});
    }
  }
  return jobs;
}

std::vector<DialRuns> ProblemTrade::runs(const std::vector<tools::JobResult>& results) const {
  std::vector<DialRuns> dial;
  for (const double tolerance : dial_) {
    dial.push_back({tolerance, {}});
  }
  std::size_t job = 0;
  for (const Series& series : series_) {
    std::vector<SeriesRows> solvers;
    for (std::size_t i = 0; i < contestants_.size(); ++i, ++job) {
      if (results[job].is_done) {
        solvers.push_back(tools::from_bytes<SeriesRows>(results[job].bytes));
      }
    }
    for (std::size_t position = 0; position < dial.size(); ++position) {
      for (std::size_t problem = 0; problem < series.problems.size(); ++problem) {
        for (SeriesRows& solver : solvers) {
          dial[position].result.rows.push_back(std::move(solver[position][problem]));
        }
      }
    }
  }
  return dial;
}

}  // namespace signorini::bench
