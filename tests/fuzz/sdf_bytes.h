#pragma once

#include <cstddef>
#include <cstdint>

namespace signorini::testing {

/// The text of an SDFormat or URDF file, as it is: the reader refuses with InputError alone, what
/// it takes is fit to run, and is read the same again. (Of odd length: unsupported things are
/// skipped.)
void judge_sdf_bytes(const std::uint8_t* data, std::size_t size);

}  // namespace signorini::testing
