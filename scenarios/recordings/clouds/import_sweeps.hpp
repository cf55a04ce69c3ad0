// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Returns the files with the extension `ending` (in any case) in natural order ("9" before "10"), without hidden
/// files. All file names must have the stem `stem`. If `stem` is empty, all file names must have one common stem.
std::vector<std::filesystem::path> sweep_files(const std::filesystem::path& folder, const std::string& ending,
                                               const std::string& stem);

/// Returns the part of a file name before the numbers at its end, for example "lidar" for "lidar_000012".
std::string stem_of(const std::filesystem::path& file);

/// Reads the time stamps at the end of file names. A time stamp has one of these forms:
/// - seconds and nanoseconds: "1617333602.223639727" or "cloud_1617333602_223639727"
/// - a time since 1970 with 13 digits (ms), 16 digits (us) or 19 digits (ns)
///
/// Returns nothing if the file names contain only numbers like "000012".
std::vector<std::int64_t> stamps_in_names(const std::vector<std::filesystem::path>& files);

/// Reads a file with one time stamp per line. A time stamp is decimal seconds, an integer of 13, 16 or 19 digits (ms,
/// us, ns), or a date in UTC, as in KITTI's raw data.
std::vector<std::int64_t> read_stamps(const std::filesystem::path& file, std::vector<std::string>* disorder = nullptr);

std::int64_t median_step_ns(const std::vector<std::int64_t>& times_ns);

}  // namespace tumble::scenarios
