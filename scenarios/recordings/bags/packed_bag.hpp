// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "scenarios/recordings/bags/bag_storage.hpp"

namespace tumble::scenarios {

/// Decompresses files such as "bag_0.db3.zstd" to a temporary folder, which is removed with the reader, even if a
/// signal ends the program. Throws BadInput if the data are damaged, disk space is missing, or the output exceeds both
/// 64 MiB and 200 times the file's size.
std::unique_ptr<BagReader> open_packed_files(
    const std::vector<std::filesystem::path>& files,
    const std::function<std::unique_ptr<BagReader>(const std::vector<std::filesystem::path>&)>& open);

std::unique_ptr<BagReader> with_packed_messages(std::unique_ptr<BagReader> bag, std::string place);

}  // namespace tumble::scenarios
