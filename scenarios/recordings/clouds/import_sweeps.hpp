// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Returns the files with the extension `ending` (in any case) in natural order ("9" before "10"), without hidden
/// files. All files must have the stem `stem`, or the same stem if `stem` is empty.
std::vector<std::filesystem::path> sweep_files(const std::filesystem::path& folder, const std::string& ending,
                                               const std::string& stem);

/// The stem is the part before the last numbers of a file name: "lidar" in "lidar_000012".
std::string stem_of(const std::filesystem::path& file);

/// A time stamp at the end of a file name has one of these forms:
/// - seconds and nanoseconds: "1617333602.223639727" or "cloud_1617333602_223639727"
/// - a time since 1970 with 13 digits (ms), 16 digits (us) or 19 digits (ns)
///
/// Returns nothing if the file names contain only numbers like "000012".
std::vector<std::int64_t> stamps_in_names(const std::vector<std::filesystem::path>& files);

/// A time stamp is decimal seconds, an integer of 13, 16 or 19 digits (ms, us, ns), or a date in UTC, as in KITTI's raw
/// data.
std::vector<std::int64_t> read_stamps(const std::filesystem::path& file, std::vector<std::string>* disorder = nullptr);

std::int64_t median_step_ns(const std::vector<std::int64_t>& times_ns);

}  // namespace tumble::scenarios
