#include "bench/scaling_study.h"

#include <signorini/core/response/accuracy.h>

#include "bench/memory_bandwidth.h"
#include "bench/scaling_archive.h"
#include "bench/scaling_csv.h"
#include "bench/scaling_scenes.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <ostream>
#include <stdexcept>

namespace signorini::bench {
namespace {

constexpr int kLeastBodies = 10;
constexpr int kMostBodies = 100000;
constexpr double kBandwidthWeight = 100.0;  // of its job, in bodies

std::vector<int> sizes(int most) {
  std::vector<int> all;
  for (int decade = kLeastBodies; decade <= most; decade *= 10) {
    all.push_back(decade);
    if (3 * decade <= most) {
      all.push_back(3 * decade);
    }
  }
  return all;
}

/// By size, so that what is interrupted has all scenes up to a size.
std::vector<ScalingCase> cases(const ScalingOptions& options) {
  std::vector<ScalingCase> all;
  for (const int bodies : sizes(options.max_bodies)) {
    for (const std::string_view scene : scaling_scene_names()) {
      if (options.scenes.empty() ||
          std::ranges::find(options.scenes, scene) != options.scenes.end()) {
        all.push_back({std::string(scene), bodies});
      }
    }
  }
  return all;
}

bool has_bullet(const ScalingOptions& options) {
#ifdef SIGNORINI_PEER_BULLET
  return options.bullet_iterations > 0;
#else
  static_cast<void>(options);
  return false;
#endif
}

std::vector<double> bandwidths(const std::vector<int>& threads) {
  std::vector<double> all;
  all.reserve(threads.size());
  for (const int count : threads) {
    all.push_back(measure_memory_bandwidth(count));
  }
  return all;
}

/// The slope of the least-squares line through (log bodies, log cost), NaN of fewer than two.
double exponent(const std::vector<std::pair<double, double>>& points) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  const auto large = std::ranges::count_if(points, [](auto& p) { return p.first >= kGrowthFrom; });
  for (const auto& [bodies, cost] : points) {
    if (large >= 2 && bodies < kGrowthFrom) {
      continue;
    }
    const double u = std::log(bodies);
    const double v = std::log(cost);
    n += 1.0;
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

}  // namespace

void validate(const ScalingOptions& options) {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument(what); };
  if (options.max_bodies < kLeastBodies || options.max_bodies > kMostBodies) {
    refuse(fmt::format("bodies: must be in [{}, {}], got {}", kLeastBodies, kMostBodies,
                       options.max_bodies));
  }
  for (const std::string& scene : options.scenes) {
    (void)make_scaling_scene(scene, 1);
  }
  (void)Accuracy::named(options.run.accuracy);
  if (options.run.steps < 1) {
    refuse(fmt::format("steps: must be at least 1, got {}", options.run.steps));
  }
  if (options.run.threads.empty() || options.run.threads.front() != 1 ||
      !std::ranges::is_sorted(options.run.threads, std::less_equal())) {
    refuse("threads: must start with 1 and increase");
  }
  if (!(options.run.cpu_seconds > 0.0) || options.run.bytes == 0) {
    refuse("limits: must be > 0");
  }
}

std::vector<ScalingRow> planned_rows(const ScalingOptions& options) {
  std::vector<ScalingRow> rows;
  for (const ScalingCase& one : cases(options)) {
    for (const int threads : options.run.threads) {
      rows.push_back({.scene = one.scene,
                      .bodies = one.bodies,
                      .engine = kOurEngine,
                      .accuracy = options.run.accuracy,
                      .threads = threads,
                      .steps = options.run.steps});
    }
  }
  return rows;
}

std::vector<tools::Job> scaling_jobs(const ScalingOptions& options) {
  std::vector<tools::Job> jobs;
  jobs.push_back({"memory bandwidth",
                  [threads = options.run.threads] { return tools::to_bytes(bandwidths(threads)); },
                  kBandwidthWeight});
  for (const ScalingCase& one : cases(options)) {
    const std::string name = fmt::format("{} of {}", one.scene, one.bodies);
    jobs.push_back(
        {name, [one, run = options.run] { return tools::to_bytes(run_scaling_case(one, run)); },
         static_cast<double>(one.bodies)});
#ifdef SIGNORINI_PEER_BULLET
    if (has_bullet(options)) {
      jobs.push_back({name + ", Bullet",
                      [one, run = options.run, iterations = options.bullet_iterations] {
                        return tools::to_bytes(
                            std::vector<ScalingRow>{run_bullet_scaling_case(one, iterations, run)});
                      },
                      0.1 * one.bodies});
    }
#endif
  }
  return jobs;
}

ScalingReport run_scaling_study(const ScalingOptions& options) {
  validate(options);
  const std::vector<tools::Job> jobs = scaling_jobs(options);
  const tools::JobListResult result = tools::run_job_list(jobs, options.jobs);
  ScalingReport report;
  report.is_leader = result.is_leader;
  if (!result.is_leader) {
    return report;
  }
  report.is_interrupted = result.is_interrupted;
  report.failure = result.first_failure(jobs);
  report.remark = result.remark();
  std::map<int, double> bandwidth;
  if (result.jobs[0].is_done) {
    const auto measured = tools::from_bytes<std::vector<double>>(result.jobs[0].bytes);
    for (std::size_t i = 0; i < measured.size(); ++i) {
      bandwidth[options.run.threads[i]] = measured[i];
    }
  }
  for (std::size_t i = 1; i < jobs.size(); ++i) {
    if (!result.jobs[i].is_done) {
      continue;
    }
    for (ScalingRow& row : tools::from_bytes<std::vector<ScalingRow>>(result.jobs[i].bytes)) {
      if (const auto known = bandwidth.find(row.threads); known != bandwidth.end()) {
        row.costs.bandwidth = known->second;
      }
      report.rows.push_back(std::move(row));
    }
  }
  return report;
}

std::vector<ScalingGrowth> ScalingReport::growth() const {
  std::map<std::pair<std::string, std::string>, std::vector<const ScalingRow*>> series;
  for (const ScalingRow& row : rows) {
    if (row.threads == 1 && row.failure.empty()) {
      series[{row.scene, row.engine}].push_back(&row);
    }
  }
  std::vector<ScalingGrowth> all;
  for (const auto& [key, members] : series) {
    for (const auto& [name, cost] : kScalingCosts) {
      if (name == "residual" || name == "error" || name == "bandwidth") {
        continue;
      }
      std::vector<std::pair<double, double>> points;
      for (const ScalingRow* row : members) {
        if (row->costs.*cost > 0.0) {
          points.emplace_back(row->bodies, row->costs.*cost);
        }
      }
      if (points.size() >= 2) {
        all.push_back({key.first, key.second, name, exponent(points)});
      }
    }
  }
  return all;
}

bool ScalingReport::passed() const {
  return failure.empty() && std::ranges::none_of(rows, &ScalingRow::is_wrong);
}

std::string ScalingReport::to_csv() const {
  return write_scaling_csv(rows);
}

}  // namespace signorini::bench
