// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Returns the files of a folder with this extension (".ply", in any case) in natural order ("9" before "10"). Leading
/// zeros and hidden files are ignored. The stem is the file name before its last numbers ("lidar" in "lidar_000012").
/// All files must have the stem `stem`, or an equal stem if `stem` is empty. Throws BadInput for a missing folder, no
/// matching file, or several stems.
std::vector<std::filesystem::path> sweep_files(const std::filesystem::path& folder, const std::string& ending,
                                               const std::string& stem);

/// Returns the stem of a file's name.
std::string stem_of(const std::filesystem::path& file);

/// Returns the time stamps at the end of the file names, if all names have a stamp. Time stamps are seconds and
/// nanoseconds ("1617333602.223639727", "cloud_1617333602_223639727", fewer decimals after a point), or one number of
/// 13, 16 or 19 digits since 1970 (ms, us, ns). The function returns nothing if names only have numbers like "000012".
/// Throws BadInput with the file if only some names have stamps.
std::vector<std::int64_t> stamps_in_names(const std::vector<std::filesystem::path>& files);

/// Reads time stamps from a text file, one per line; '#' starts a comment. Time stamps are decimal seconds, whole
/// numbers of 13, 16 or 19 digits (ms, us, ns), or dates in UTC, as in the raw data of KITTI. Throws BadInput with file
/// and line for another text, or a stamp that does not increase. If `disorder` is not null, the function accepts stamps
/// that do not increase. `disorder` then receives a message for each of these stamps, and "" for all other stamps.
std::vector<std::int64_t> read_stamps(const std::filesystem::path& file, std::vector<std::string>* disorder = nullptr);

/// Returns the upper median step of increasing times, or 0 for fewer than two times.
std::int64_t median_step_ns(const std::vector<std::int64_t>& times_ns);

}  // namespace tumble::scenarios
