#pragma once

#include "bench/stack_scenes.h"

namespace signorini::bench {

/// Structures that stand by friction alone, in the plane y = 0: whether they stand is known from
/// limit_analysis.h. Stones and cards have 1000 kg/m^3 and one mu for all contacts.

/// Floors of leaning pairs of cards, floors, floors - 1, ... 1 of them, each floor on cards that
/// lie from one pair's top to the next one's: floors (3 floors + 1)/2 cards. A card is 1 m high,
/// 0.04 m thick and 20 degrees off the vertical; its foot and its top are cut level, and upright
/// where it meets the other one, so that all contacts are faces. Watched: the right card at the
/// top.
[[nodiscard]] SteppedScene card_house_scene(int floors, double friction, double step,
                                            double seconds);

/// Half a ring of equal stones, radii 1 m and 1.3 m. Watched: the stone at the crown.
[[nodiscard]] SteppedScene arch_scene(int stones, double friction, double step, double seconds);

}  // namespace signorini::bench
