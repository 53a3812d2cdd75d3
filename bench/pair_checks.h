#pragma once

#include "tests/collision/random_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace signorini::bench {

/// What is asked of the queries of one pair at one pose.
enum class PairProperty : unsigned char {
  kNoNaN,          ///< nothing that is returned is NaN, every refusal is a std::invalid_argument
  kUnitNormal,     ///< ||N| - 1| <= 1e-12
  kPoints,         ///< P_A - P_B = gap N, P_A in A, P_B in B
  kNothingMissed,  ///< a contact where the distance is at most the margin
  kNothingBeyond,  ///< no contact where it is more; no gap above the margin
  kCertified,      ///< the least gap is the shapes' separation along N, by support functions alone
  kNoBetter,       ///< no direction of many tried parts the shapes further than the distance says
  kParts,          ///< moved by -gap along N the shapes touch
  kTest,           ///< test = (distance <= 0)
  kExchange,       ///< A and B exchanged: the same distance
  kRigidMotion,    ///< both carried along: the same distance
};
inline constexpr int kPairProperties = 11;
[[nodiscard]] std::string_view to_string(PairProperty property);

/// By property: how far (m) the answer is off, relative to what is allowed; more than 1 is wrong.
using PairVerdict = std::array<double, kPairProperties>;

/// Of the smaller size: what a distance that is found by a search may be off. penetration() keeps
/// directions within 1e-8 of the best one (separation.cpp), of which any may be returned.
inline constexpr double kOfSearch = 1e-8;
/// Of the smaller size. preference_tolerance(): a face is preferred to a direction along which the
/// shapes are this much further apart; a corner this far beside a face counts as over it; a face's
/// contact set may begin this far above the distance. So one of these for a gap; two for a point,
/// which may lie beside two sides of a face at once (at a right angle the square root of two, at 60
/// degrees two), and for shapes that were moved until their two points meet, each of which may lie
/// outside.
inline constexpr double kPreference = 1e-6;

/// Collects a verdict.
class VerdictBook {
 public:
  /// NaN is wrong by any measure.
  void off_by(PairProperty property, double metres, double allowed) {
    double& worst = verdict_[static_cast<std::size_t>(property)];
    const double off = metres / allowed;
    worst = std::isnan(off) ? kWrong : std::max(worst, off);
  }
  void require(PairProperty property, bool holds) {
    if (!holds) {
      verdict_[static_cast<std::size_t>(property)] = kWrong;
    }
  }
  [[nodiscard]] const PairVerdict& verdict() const { return verdict_; }

 private:
  static constexpr double kWrong = std::numeric_limits<double>::infinity();
  PairVerdict verdict_{};
};

struct JudgedPair {
  PairVerdict verdict{};
  double distance = 0.0;  ///< what signed_distance() says, m
};

/// Judges distance, test and find of one pair by properties that need no second implementation:
/// for any unit n, s(n) = -h_A(-n) - h_B(n) <= d by the support functions h, and d <= |P_A - P_B|
/// for any two points of the shapes, so that s(N) = gap = N.(P_A - P_B) proves d where they are
/// apart. Where they overlap d = max s(n): N itself and 40 directions around it and at random are
/// tried.
///
/// Allowed of a distance, of the smaller size: 1e-9 between sphere, box and half-space, 1e-8
/// between pairs that are found by a search (convex_pairs.h); and 200 roundings of the pair's
/// numbers. Where faces are preferred by a tolerance (box_separation.h, separation.h: 1e-6) once
/// that tolerance more of a gap, and twice of a point, of the least gap beside the separation along
/// N and the distance, and of the distance of shapes that were moved to touch.
[[nodiscard]] JudgedPair judge_pair(const collision::testing::PlacedPair& pair, double margin,
                                    collision::testing::Random& random);

/// The pair moved along its normal until it kisses: the gap is 0, or up to 1e-9 of the size from
/// it, or a few roundings. Unchanged where it has no finite distance.
[[nodiscard]] collision::testing::PlacedPair kissing(const collision::testing::PlacedPair& pair,
                                                     collision::testing::Random& random);

}  // namespace signorini::bench
