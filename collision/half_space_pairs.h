#pragma once

#include <signorini/collision/narrow.h>

#include <vector>

namespace signorini::collision::narrow {

/// The vertices, with gap <= margin, of the face of the box that faces the plane most.
[[nodiscard]] double distance(const Box& a, const Pose& pose_a, const HalfSpace& b,
                              const Pose& pose_b);
[[nodiscard]] bool test(const Box& a, const Pose& pose_a, const HalfSpace& b, const Pose& pose_b);
void find(const Box& a, const Pose& pose_a, const HalfSpace& b, const Pose& pose_b, double margin,
          std::vector<Contact>& contacts);

/// Planes that face each other (|N_A + N_B| <= 1e-12): their gap. Else they meet somewhere and no
/// translation parts them: -infinity. No contacts: both are immovable.
[[nodiscard]] double distance(const HalfSpace& a, const Pose& pose_a, const HalfSpace& b,
                              const Pose& pose_b);
[[nodiscard]] bool test(const HalfSpace& a, const Pose& pose_a, const HalfSpace& b,
                        const Pose& pose_b);
void find(const HalfSpace& a, const Pose& pose_a, const HalfSpace& b, const Pose& pose_b,
          double margin, std::vector<Contact>& contacts);

}  // namespace signorini::collision::narrow
