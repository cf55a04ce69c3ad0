// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Returns the files of a folder with the extension `ending` (".ply", in any case) in natural order ("9" before "10";
/// leading zeros are ignored), without hidden files. The stem of a file name is the part before its last numbers
/// ("lidar" in "lidar_000012"). All files must have the stem `stem`, or the same stem if `stem` is empty. Throws
/// BadInput for a missing folder, if no file matches, or if the files have several stems.
std::vector<std::filesystem::path> sweep_files(const std::filesystem::path& folder, const std::string& ending,
                                               const std::string& stem);

/// Returns the stem of a file name: the part before its last numbers.
std::string stem_of(const std::filesystem::path& file);

/// Returns the time stamps at the end of the file names. A time stamp is seconds and nanoseconds
/// ("1617333602.223639727", "cloud_1617333602_223639727", fewer decimals after a point), or a number of 13, 16 or 19
/// digits since 1970 (ms, us, ns). Returns nothing if the names contain only numbers like "000012". Throws BadInput
/// with the file if only some names contain time stamps.
std::vector<std::int64_t> stamps_in_names(const std::vector<std::filesystem::path>& files);

/// Reads time stamps from a text file, one per line; '#' starts a comment. A time stamp is decimal seconds, an integer
/// of 13, 16 or 19 digits (ms, us, ns), or a date in UTC, as in KITTI's raw data. Throws BadInput with file and line
/// for an invalid time stamp. A time stamp that does not increase also throws, unless `disorder` is set: `disorder`
/// then receives a message for each such time stamp, and an empty text for each other time stamp.
std::vector<std::int64_t> read_stamps(const std::filesystem::path& file, std::vector<std::string>* disorder = nullptr);

/// Returns the median step of increasing times (the larger of two middle values), or 0 for fewer than two times.
std::int64_t median_step_ns(const std::vector<std::int64_t>& times_ns);

}  // namespace tumble::scenarios
