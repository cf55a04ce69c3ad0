// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

/// Copies and decompresses chunks of ROS 1 bags. Used only within scenarios/recordings/bags.
namespace tumble::scenarios {

/// Ros1Chunk is a chunk as stored in the file.
struct Ros1Chunk {
  std::string compression;           ///< "none", "lz4", "bz2"
  std::uint32_t unpacked_bytes = 0;  ///< uncompressed size of its data
  std::string data;
};

/// Returns true if any chunk has LZ4 compression. The bag must have passed `check_ros1_bag`.
bool has_lz4_chunks(const std::filesystem::path& file);

/// Returns the size of the bag after LZ4 chunks are decompressed to their stated sizes [bytes]. The bag must have
/// passed `check_ros1_bag`.
std::uint64_t bytes_unpacked(const std::filesystem::path& file);

/// Copies a bag that passed `check_ros1_bag`. `change` modifies each chunk; chunk positions and the index are updated.
/// The cost is proportional to the number of bytes. Only one chunk is in memory at a time. Throws BadInput with the
/// offset in `from`.
void copy_ros1_bag(const std::filesystem::path& from, const std::filesystem::path& to,
                   const std::function<void(Ros1Chunk&)>& change);

/// Decompresses a chunk with any LZ4 frame (linked blocks, checksums, content size). The ROS 1 library only supports
/// independent LZ4 blocks. Throws BadInput if the chunk is damaged or if its size differs from the stated size.
void unpack_lz4(Ros1Chunk& chunk);

}  // namespace tumble::scenarios
