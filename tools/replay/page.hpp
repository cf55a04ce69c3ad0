// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/replay/replay.hpp"

namespace tumble::tools {

struct PackedReplay {
  std::string head;                 ///< JSON with array positions
  std::vector<std::uint8_t> bytes;  ///< little endian, in multiples of 4
};

/// Packs a replay as integers with scales: int16 for positions of world and points, attitudes and rates; uint32
/// microseconds for times; uint8 for errors (255: unknown).
PackedReplay packed(const Replay& replay);

std::string replay_page(const Replay& replay);

}  // namespace tumble::tools
