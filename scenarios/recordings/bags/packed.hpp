// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/recordings/bags/bag_storage.hpp"

namespace tumble::scenarios {

std::string packed_lz4(std::string_view plain);

/// Decompresses an LZ4 block. The buffer grows with the decompressed data, so a wrong size in the file cannot exhaust
/// the memory.
std::string unpacked_lz4(std::string_view packed, std::uint64_t bytes);
std::string unpacked_zstd(std::string_view packed, std::uint64_t bytes);

/// Returns the CRC-32 of zlib (IEEE 802.3, reflected) of `bytes`, as a continuation of the checksum `before` of earlier
/// bytes.
std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before = 0);

/// Decompresses files such as "bag_0.db3.zstd" to a temporary folder. The temporary folder is removed when the reader
/// is destroyed or when a signal ends the program. Throws BadInput if the data are damaged, disk space is missing, or
/// the output exceeds both 64 MiB and 200 times the file's size.
std::unique_ptr<BagReader> open_packed_files(
    const std::vector<std::filesystem::path>& files,
    const std::function<std::unique_ptr<BagReader>(const std::vector<std::filesystem::path>&)>& open);

std::unique_ptr<BagReader> with_packed_messages(std::unique_ptr<BagReader> bag, std::string place);

}  // namespace tumble::scenarios
