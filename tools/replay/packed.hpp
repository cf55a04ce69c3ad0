// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/replay/replay.hpp"

/// `packed` converts a replay to the bytes of a page (fields: README.md).
namespace tumble::tools {

struct PackedReplay {
  std::string head;                 ///< JSON with the arrays and their positions in `bytes`
  std::vector<std::uint8_t> bytes;  ///< little endian; each array starts at a multiple of 4
};

/// Packs a replay as integers with scales. Positions of world and points are int16 (1/32767 of the farthest), attitudes
/// are int16 (1/32767), and rates are int16. Times are uint32 microseconds, and errors are uint8 (255: unknown).
/// Positions of tracks are float32, relative to the origin in the head.
PackedReplay packed(const Replay& replay);

}  // namespace tumble::tools
