// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tumble::scenarios::ros1 {

enum Op : std::uint8_t { kMessage = 2, kFile = 3, kIndex = 4, kChunk = 5, kChunkInfo = 6, kConnection = 7 };

}  // namespace tumble::scenarios::ros1
