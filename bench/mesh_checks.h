#pragma once

#include "bench/pair_checks.h"

#include <vector>

namespace signorini::bench {

/// A height field of 18 triangles, and each of them as a convex solid.
struct Terrain {
  collision::Shape mesh;
  std::vector<collision::ConvexHull> prisms;  ///< a triangle, thickened to both sides
  std::vector<Vec3> centres;                  ///< of the prisms, m
  std::vector<double> radii;                  ///< about them, m
  double thickness = 0.0;                     ///< to each side, m: 1e-7 of a cell
};

/// Cells of about `scale`; flat in half of the draws, and rough up to a cell's width else.
[[nodiscard]] Terrain random_terrain(collision::testing::Random& random, double scale);

/// Judges a convex shape A against a terrain (pair.b) by its prisms, which the queries of two
/// convex shapes measure and judge_pair() judges in turn: with r the least distance of A from a
/// prism,
/// - no NaN, |N| = 1, P_A - P_B = gap N, P_A in A, P_B on the surface, no gap above the margin;
/// - a contact where r is at most the margin, none where it is more ("missed", "beyond");
/// - d = r where they are apart, and the least gap always ("certified");
/// - test = (d <= 0), and as r says ("test"); the same d for B and A, and in another frame.
/// "No better" and "parts" are not asked: of several triangles no one direction is the best.
///
/// Allowed: 2 thicknesses where r counts, and besides as of pairs that are found by a search.
[[nodiscard]] JudgedPair judge_on_terrain(const collision::testing::PlacedPair& pair,
                                          const Terrain& terrain, double margin,
                                          collision::testing::Random& random);

}  // namespace signorini::bench
