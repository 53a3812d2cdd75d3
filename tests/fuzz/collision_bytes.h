#pragma once

#include <cstddef>
#include <cstdint>

namespace signorini::collision::testing {

/// Reads two shapes, poses, velocities and a margin from the bytes, asks every query of the pair,
/// and aborts with a message where an answer breaks a promise: refusals are std::invalid_argument
/// alone; distance, test and find agree; contacts are finite, their normals unit, their points gap
/// apart along them, their ids different; A and B exchanged give the same; contact times lie in the
/// duration, and shapes that start apart do not overlap before them.
void judge_bytes(const std::uint8_t* data, std::size_t size);

}  // namespace signorini::collision::testing
