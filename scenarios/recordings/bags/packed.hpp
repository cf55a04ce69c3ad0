// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tumble::scenarios {

std::string packed_lz4(std::string_view plain);

/// Memory grows with the decompressed data, so a wrong size in the file cannot exhaust the memory.
std::string unpacked_lz4(std::string_view packed, std::uint64_t bytes);
std::string unpacked_zstd(std::string_view packed, std::uint64_t bytes);

/// Returns the CRC-32 of zlib (IEEE 802.3, reflected), continued from the checksum `before`.
std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before = 0);

}  // namespace tumble::scenarios
