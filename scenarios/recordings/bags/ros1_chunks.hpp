// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace tumble::scenarios {

struct Ros1Chunk {
  std::string compression;  ///< "none", "lz4", "bz2"
  std::uint32_t unpacked_bytes = 0;
  std::string data;
};

bool has_lz4_chunks(const std::filesystem::path& file);

std::uint64_t bytes_unpacked(const std::filesystem::path& file);

/// Copies a bag that passed `check_ros1_bag`. The function `change` may modify each chunk; chunk positions and index of
/// the copy are updated.
void copy_ros1_bag(const std::filesystem::path& from, const std::filesystem::path& to,
                   const std::function<void(Ros1Chunk&)>& change);

/// Decompresses an LZ4 frame of any kind, because the ROS 1 library only supports LZ4 frames with independent blocks.
void unpack_lz4(Ros1Chunk& chunk);

}  // namespace tumble::scenarios

namespace tumble::scenarios::ros1 {

enum Op : std::uint8_t { kMessage = 2, kFile = 3, kIndex = 4, kChunk = 5, kChunkInfo = 6, kConnection = 7 };

}  // namespace tumble::scenarios::ros1
