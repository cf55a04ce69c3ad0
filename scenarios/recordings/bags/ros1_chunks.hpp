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

/// The bag must have passed `check_ros1_bag`.
bool has_lz4_chunks(const std::filesystem::path& file);

/// Returns the size of the bag after decompression of its LZ4 chunks [bytes]. The bag must have passed
/// `check_ros1_bag`.
std::uint64_t bytes_unpacked(const std::filesystem::path& file);

/// Copies a bag that passed `check_ros1_bag`. `change` may modify each chunk; chunk positions and index are updated.
/// One chunk is in memory at a time. Throws BadInput, with the offset in `from`, if the bag is damaged.
void copy_ros1_bag(const std::filesystem::path& from, const std::filesystem::path& to,
                   const std::function<void(Ros1Chunk&)>& change);

/// Decompresses any LZ4 frame, because the ROS 1 library only supports independent blocks. Throws BadInput if the chunk
/// is damaged, or its size differs from that in its header.
void unpack_lz4(Ros1Chunk& chunk);

}  // namespace tumble::scenarios
