// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/replay/replay.hpp"

/// A replay as bytes: what the page carries (README.md has every field).
namespace tumble::tools {

struct PackedReplay {
  std::string head;                 ///< JSON: what there is and where in `bytes`
  std::vector<std::uint8_t> bytes;  ///< little endian, each array at a multiple of 4
};

/// Whole numbers times a scale: positions of the world and of points as int16 (a 32767th of the farthest), attitudes as
/// int16 (a 32767th), rates as int16, times as uint32 microseconds, errors as uint8 (255: not known). Positions of
/// tracks are float32 from the head's origin.
PackedReplay packed(const Replay& replay);

}  // namespace tumble::tools
