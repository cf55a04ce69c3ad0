// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tumble::fuzz {

/// Saved runs of TumblingOdometry (T) and RollingOdometry (R), and saved maps (M). A file contains the letter, then the
/// bytes after the header. The reader computes the header, because a fuzzer would never find the checksum.
void saved_run(const std::filesystem::path& file);

/// Returns valid files with their names.
std::vector<std::pair<std::string, std::string>> saved_run_seeds();

}  // namespace tumble::fuzz
