// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "scenarios/recordings/bags/bag_storage.hpp"

/// ROS 2 bags that were packed by Zstandard while they were recorded. Private to scenarios/recordings/bags.
namespace tumble::scenarios {

/// Files of which each is one row of Zstandard frames ("bag_0.db3.zstd"): unpacked into a folder for temporary files,
/// which is gone with the reader, also when a signal ends the program. `open` is given the unpacked ones. Throws
/// BadInput with the file: damaged, truncated, more comes out than the disk holds or than 64 MiB and 200 times the
/// file.
std::unique_ptr<BagReader> open_packed_files(
    const std::vector<std::filesystem::path>& files,
    const std::function<std::unique_ptr<BagReader>(const std::vector<std::filesystem::path>&)>& open);

/// A bag of which each message is a Zstandard frame that states its size, 64 MiB and 200 times its own at most. Reading
/// throws BadInput beginning with `place` of one that is damaged.
std::unique_ptr<BagReader> with_packed_messages(std::unique_ptr<BagReader> bag, std::string place);

}  // namespace tumble::scenarios
