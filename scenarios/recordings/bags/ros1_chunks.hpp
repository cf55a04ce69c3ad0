// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

/// ros1_chunks.hpp copies ROS 1 bags and decompresses their chunks.
namespace tumble::scenarios {

/// Ros1Chunk is a chunk of a bag as stored in the file.
struct Ros1Chunk {
  std::string compression;           ///< "none", "lz4", "bz2"
  std::uint32_t unpacked_bytes = 0;  ///< uncompressed size of `data`
  std::string data;
};

/// Returns true if a chunk of the bag has LZ4 compression. The bag must have passed `check_ros1_bag`.
bool has_lz4_chunks(const std::filesystem::path& file);

/// Returns the size of the bag after decompression of its LZ4 chunks [bytes]. The bag must have passed
/// `check_ros1_bag`.
std::uint64_t bytes_unpacked(const std::filesystem::path& file);

/// Copies a bag that passed `check_ros1_bag`. Calls `change` for each chunk, which may modify it; chunk positions and
/// the index are then updated. The cost is proportional to the number of bytes; one chunk is in memory at a time.
/// Throws BadInput, with the offset in `from`, if the bag is damaged.
void copy_ros1_bag(const std::filesystem::path& from, const std::filesystem::path& to,
                   const std::function<void(Ros1Chunk&)>& change);

/// Decompresses a chunk that contains any LZ4 frame (linked blocks, checksums, content size); the ROS 1 library only
/// supports independent blocks. Throws BadInput if the chunk is damaged, or its size differs from that in its header.
void unpack_lz4(Ros1Chunk& chunk);

}  // namespace tumble::scenarios
