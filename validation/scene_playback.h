#pragma once

#include <signorini/validation/playback.h>
#include <signorini/validation/scene_run.h>

#include <cstddef>

namespace signorini::validation {

/// Of more bodies the report draws nothing: their numbers are written in 16 bits.
inline constexpr std::size_t kMostPlayedBodies = 65535;

/// What the report draws of a scene and its runs: every shape (a compound as its parts, triangles
/// of meshes thinned to about 20,000 by merging vertices in cells of a grid), and of each run the
/// frames that its track kept, of whose contacts the strongest if they are more than 8000 in
/// all.
[[nodiscard]] Playback make_playback(const Scene& scene, const Runs& runs);

}  // namespace signorini::validation
