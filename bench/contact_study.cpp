#include "bench/contact_study.h"

#include "bench/mesh_checks.h"
#include "bench/shape_kinds.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <ostream>
#include <stdexcept>

namespace signorini::bench {
namespace {

using collision::testing::PlacedPair;
using collision::testing::Placement;
using collision::testing::Random;
using collision::testing::ShapeKind;

PlacedPair pose_of(Random& random, const KindPair& kinds, long number) {
  constexpr Placement kPlacements[] = {Placement::kAnywhere, Placement::kAligned,
                                       Placement::kNearlyAligned};
  return collision::testing::random_pair(random, kinds.a.kind, kinds.b.kind,
                                         kPlacements[number % 3]);
}

/// @param draw (random, number): a pair; judge (pair, margin, random): a JudgedPair of it
template <class Draw, class Judge>
ContactStudyRow run(const std::string& name, const ContactStudyOptions& options, Draw&& draw,
                    Judge&& judge) {
  ContactStudyRow row;
  row.pair = name;
  Random random(options.seed);
  for (long k = 0; k < options.poses; ++k) {
    PlacedPair pair = draw(random, k);
    if (k % 2 == 1) {
      pair = kissing(pair, random);
      ++row.kissing;
    }
    const double margin =
        k % 4 < 2 ? 0.0 : pair.size * collision::testing::log_uniform(random, -6.0, 0.0);
    const auto [verdict, distance] = judge(pair, margin, random);
    ++row.poses;
    row.overlapping += distance <= 0.0 ? 1 : 0;
    for (int p = 0; p < kPairProperties; ++p) {
      row.worst[p] = std::max(row.worst[p], verdict[p]);
      if (verdict[p] > 1.0) {
        ++row.wrong[p];
        if (row.first_wrong.empty()) {
          row.first_wrong = fmt::format("pose {}: {} off by {:.3g} of what is allowed\n{}", k,
                                        to_string(static_cast<PairProperty>(p)), verdict[p],
                                        collision::testing::describe(pair));
        }
      }
    }
  }
  return row;
}

ContactStudyRow run_pair(const KindPair& kinds, const ContactStudyOptions& options) {
  return run(
      kinds.name(), options,
      [&](Random& random, long number) { return pose_of(random, kinds, number); }, judge_pair);
}

/// A over a terrain, or in it.
PlacedPair pose_on(const Terrain& terrain, double cell, PlacedPair pair, Random& random) {
  const double extent = collision::bounding_radius(pair.a, Pose{});
  const auto aside = [&] { return 1.7 * cell * collision::testing::uniform(random, -1.0, 1.0); };
  const double above = collision::testing::uniform(random, -1.0, 2.0) * extent;
  pair.pose_a.position = pair.pose_b * Vec3(aside(), aside(), above);
  pair.b = terrain.mesh;
  pair.size = std::min(extent, *std::max_element(terrain.radii.begin(), terrain.radii.end()));
  pair.rounding =
      std::numeric_limits<double>::epsilon() * (extent + 4.0 * cell + pair.pose_b.position.norm());
  return pair;
}

/// A shape of this kind against a triangle mesh whose cells are a thirtieth to thirty times as
/// large.
ContactStudyRow run_on_mesh(const NamedShapeKind& kind, const ContactStudyOptions& options) {
  const KindPair kinds{kind, {ShapeKind::kBox, "mesh"}};
  Terrain terrain;
  return run(
      kinds.name(), options,
      [&](Random& random, long number) {
        const PlacedPair pair = pose_of(random, kinds, number);
        const double cell = collision::bounding_radius(pair.a, Pose{}) *
                            collision::testing::log_uniform(random, -1.5, 1.5);
        terrain = random_terrain(random, cell);
        return pose_on(terrain, cell, pair, random);
      },
      [&](const PlacedPair& pair, double margin, Random& random) {
        return judge_on_terrain(pair, terrain, margin, random);
      });
}

void print(const ContactStudyRow& row, std::ostream& out) {
  out << fmt::format("{:<22}{:>9}{:>9}{:>9}", row.pair, row.poses, row.kissing, row.overlapping);
  for (int p = 0; p < kPairProperties; ++p) {
    out << fmt::format("{:>10}", row.wrong[p]);
  }
  out << fmt::format("{:>8.2f}\n", *std::max_element(row.worst.begin(), row.worst.end()));
  if (!row.first_wrong.empty()) {
    out << "  first: " << row.first_wrong;
  }
  out.flush();
}

}  // namespace

bool ContactStudyReport::passed() const {
  return std::all_of(rows.begin(), rows.end(), [](const ContactStudyRow& row) {
    return std::accumulate(row.wrong.begin(), row.wrong.end(), 0L) == 0;
  });
}

std::string ContactStudyReport::to_csv() const {
  std::string csv = "pair,poses,kissing,overlapping";
  for (int p = 0; p < kPairProperties; ++p) {
    csv += fmt::format(",wrong: {0},worst: {0}", to_string(static_cast<PairProperty>(p)));
  }
  csv += "\n";
  for (const ContactStudyRow& row : rows) {
    csv += fmt::format("{},{},{},{}", row.pair, row.poses, row.kissing, row.overlapping);
    for (int p = 0; p < kPairProperties; ++p) {
      csv += fmt::format(",{},{:.4g}", row.wrong[p], row.worst[p]);
    }
    csv += "\n";
  }
  return csv;
}

ContactStudyReport run_contact_study(const ContactStudyOptions& options, std::ostream& out) {
  ContactStudyReport report;
  out << fmt::format(
      "poses at which a property was wrong; worst: as a fraction of what is allowed\n"
      "{:<22}{:>9}{:>9}{:>9}",
      "pair", "poses", "kissing", "overlap");
  for (int p = 0; p < kPairProperties; ++p) {
    out << fmt::format("{:>10}", to_string(static_cast<PairProperty>(p)));
  }
  out << fmt::format("{:>8}\n", "worst");
  std::string known;
  const auto study = [&](const std::string& name, auto&& run_it) {
    known += (known.empty() ? "" : ", ") + name;
    if (options.pair.empty() || options.pair == name) {
      report.rows.push_back(run_it());
      print(report.rows.back(), out);
    }
  };
  for (const KindPair& kinds : shape_pairs()) {
    study(kinds.name(), [&] { return run_pair(kinds, options); });
  }
  for (const NamedShapeKind& kind : kShapeKinds) {
    if (kind.kind != ShapeKind::kHalfSpace) {
      study(std::string(kind.name) + "-mesh", [&] { return run_on_mesh(kind, options); });
    }
  }
  if (report.rows.empty()) {
    throw std::invalid_argument("pair: must be one of " + known + ", got " + options.pair);
  }
  return report;
}

}  // namespace signorini::bench
