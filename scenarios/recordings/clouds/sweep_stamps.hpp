// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble::scenarios {

/// Files of a folder with this ending (".ply"), in natural order: "9" before "10", leading zeros do not matter; hidden
/// files are left out. The stem of a name is what stands before its last numbers ("lidar" of "lidar_000012"): it must
/// be `stem`, or, when that is empty, the same in all names. Throws BadInput: no folder, no such file in it, several
/// stems.
std::vector<std::filesystem::path> sweep_files(const std::filesystem::path& folder, const std::string& ending,
                                               const std::string& stem);

/// The stem of a file's name.
std::string stem_of(const std::filesystem::path& file);

/// Stamps that the names of the files end in, when all of them do: seconds and nanoseconds ("1617333602.223639727",
/// "cloud_1617333602_223639727", with fewer decimals behind a point), or one number of 13, 16 or 19 digits since the
/// epoch (ms, us, ns). Empty when the names hold none, as "000012". Throws BadInput with the file when some do and some
/// do not.
std::vector<std::int64_t> stamps_in_names(const std::vector<std::filesystem::path>& files);

/// Stamps of a text file, one a line, '#' begins a remark: seconds with decimals, or whole numbers of 16 or 19 digits
/// (us, ns). Throws BadInput with file and line: not a number, a stamp that does not rise.
std::vector<std::int64_t> read_stamps(const std::filesystem::path& file);

/// The middle one of the steps between rising times; 0 for fewer than two.
std::int64_t median_step_ns(const std::vector<std::int64_t>& times_ns);

}  // namespace tumble::scenarios
