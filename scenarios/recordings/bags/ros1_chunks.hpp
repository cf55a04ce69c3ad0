// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

/// Chunks of ROS 1 bags, packed and unpacked. Private to scenarios/recordings/bags.
namespace tumble::scenarios {

/// A chunk as it stands in the file.
struct Ros1Chunk {
  std::string compression;           ///< "none", "lz4", "bz2"
  std::uint32_t unpacked_bytes = 0;  ///< of its data once unpacked
  std::string data;
};

/// Whether a chunk of the bag is packed with LZ4. The bag must have passed `check_ros1_bag`.
bool has_lz4_chunks(const std::filesystem::path& file);

/// What the chunks of the bag that are packed with LZ4 state to hold once unpacked, and the rest of it as it stands,
/// bytes. As for `has_lz4_chunks`.
std::uint64_t bytes_unpacked(const std::filesystem::path& file);

/// Copies a bag that has passed `check_ros1_bag`, each chunk as `change` leaves it; positions that name chunks and the
/// index are made to fit. O(bytes), a chunk in memory. Throws BadInput with the offset in `from`.
void copy_ros1_bag(const std::filesystem::path& from, const std::filesystem::path& to,
                   const std::function<void(Ros1Chunk&)>& change);

/// Unpacks a chunk that is an LZ4 frame of any kind (linked blocks, checksums, content size), which ROS's own library
/// does not do: it knows frames of independent blocks alone. Throws BadInput when it is damaged or does not give the
/// bytes that it promises.
void unpack_lz4(Ros1Chunk& chunk);

}  // namespace tumble::scenarios
