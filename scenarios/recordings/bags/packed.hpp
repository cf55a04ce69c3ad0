// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// Chunks of bags, packed and unpacked, and their checksum. Private to scenarios/recordings/bags.
namespace tumble::scenarios {

/// An LZ4 frame of the bytes: blocks of 4 MiB at most that stand alone, no checksums.
std::string packed_lz4(std::string_view plain);

/// What an LZ4 frame of any kind (linked blocks, checksums, content size) or a row of Zstandard frames holds, which
/// must be `bytes` bytes. Memory grows with what comes out, never by what is promised. Throws BadInput without a place
/// when it is damaged or does not give the bytes that it promises.
std::string unpacked_lz4(std::string_view packed, std::uint64_t bytes);
std::string unpacked_zstd(std::string_view packed, std::uint64_t bytes);

/// CRC-32 as zlib has it (IEEE 802.3, reflected), continued from `before`.
std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before = 0);

}  // namespace tumble::scenarios
