// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/recording_file.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kBytesRead = 16;

constexpr std::pair<std::string_view, const char*> kFirstBytes[] = {
    {"#ROSBAG V", "a ROS 1 bag"}, {"\x89MCAP0", "an MCAP file"}, {"SQLite format 3", "a ROS 2 bag (SQLite)"}};
constexpr std::pair<std::string_view, const char*> kEndings[] = {
    {".csv", "a table"}, {".tum", "a trajectory"}, {".txt", "a text file"}, {".kitti", "a trajectory"}};

const char* kind_of(const std::filesystem::path& path) {
  std::array<char, kBytesRead> bytes{};
  std::ifstream stream = open_regular_file(path);
  stream.read(bytes.data(), bytes.size());
  const std::string_view begin(bytes.data(), static_cast<std::size_t>(stream.gcount()));
  for (const auto& [first, kind] : kFirstBytes) {
    if (begin.starts_with(first)) return kind;
  }
  if (begin.starts_with("\x89HDF")) return nullptr;
  for (const auto& [ending, kind] : kEndings) {
    if (path.extension() == ending) return kind;
  }
  return nullptr;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& kind) {
  throw BadInput(
      fmt::format("{}: the path is {}, but must be a recording (FILE.h5); 'tumble import {} -o FILE.h5' converts bags, "
                  "sweeps and tables",
                  path.string(), kind, path.string()));
}

}  // namespace

void require_recording_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) refuse(path, "a folder");
  if (const char* const kind = kind_of(path)) refuse(path, kind);
}

}  // namespace tumble::scenarios
