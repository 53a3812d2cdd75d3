#pragma once

namespace signorini::bench {

/// Bytes a second that a = b + s c moves over arrays far larger than the caches (McCalpin's triad:
/// 24 bytes counted a number), so many threads at once, the best of five passes. Wall time; takes
/// about a second and 384 MiB.
/// @param threads >= 1
[[nodiscard]] double measure_memory_bandwidth(int threads);

}  // namespace signorini::bench
