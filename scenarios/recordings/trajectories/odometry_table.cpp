// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/table_file.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "scenarios/recordings/whole_seconds.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kFirst = "header.stamp.sec";
/// A header with all columns of drivers has about 2 kB.
constexpr std::size_t kHeaderMax_bytes = 64 * 1024;

/// The columns to read, in the order of reading.
constexpr std::array<const char*, 9> kOdometryColumns = {
    kFirst,
    "header.stamp.nanosec",
    "pose.pose.position.x",
    "pose.pose.position.y",
    "pose.pose.position.z",
    "pose.pose.orientation.x",
    "pose.pose.orientation.y",
    "pose.pose.orientation.z",
    "pose.pose.orientation.w",
};

/// Returns the first line, or an empty text if the file is not a regular file. Reads at most one byte more than the
/// limit, because a file may have no line ends.
std::string odometry_header(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return "";
  std::ifstream stream(file, std::ios::binary);
  std::string line(kHeaderMax_bytes + 2, '\0');
  stream.getline(line.data(), static_cast<std::streamsize>(line.size()));
  line.resize(std::min(line.find('\0'), line.size()));
  if (line.ends_with('\r')) line.pop_back();
  return line;
}

std::vector<std::string> names_in(const std::string& header) {
  std::vector<std::string> names(1);
  for (const char c : header) {
    if (c == ',')
      names.emplace_back();
    else
      names.back() += c;
  }
  return names;
}

/// Returns the position of each of kOdometryColumns.
std::array<std::size_t, kOdometryColumns.size()> places_in(const std::filesystem::path& file,
                                                           const std::vector<std::string>& names) {
  std::array<std::size_t, kOdometryColumns.size()> places{};
  for (std::size_t k = 0; k < kOdometryColumns.size(); ++k) {
    const auto count = std::count(names.begin(), names.end(), kOdometryColumns[k]);
    if (count != 1) {
      throw BadInput(fmt::format("{}:1: column {} occurs {} times in the header; it must occur once", file.string(),
                                 kOdometryColumns[k], count));
    }
    places[k] = static_cast<std::size_t>(std::find(names.begin(), names.end(), kOdometryColumns[k]) - names.begin());
  }
  return places;
}

}  // namespace

bool is_odometry(const std::filesystem::path& file) {
  return odometry_header(file).starts_with(std::string(kFirst) + ",");
}

std::vector<ReferencePose> read_odometry_poses(const std::filesystem::path& file) {
  require_regular_file(file);
  const std::string header = odometry_header(file);
  if (header.size() > kHeaderMax_bytes) {
    throw BadInput(fmt::format("{}:1: the header has more than {} bytes", file.string(), kHeaderMax_bytes));
  }
  const std::vector<std::string> names = names_in(header);
  const auto places = places_in(file, names);
  const Table table = Table::read(file, ',', header, names.size());
  std::vector<ReferencePose> poses;
  for (const Table::Row& row : table.rows) {
    const auto fail = [&](const std::string& what) {
      throw BadInput(file.string() + ":" + std::to_string(row.line) + ": " + what);
    };
    const std::int64_t seconds = table.integer(row, places[0]), rest_ns = table.integer(row, places[1]);
    if (seconds < 0 || seconds > kSecondsMax || rest_ns < 0 || rest_ns >= kSecond_ns)
      fail(fmt::format("the time stamp {} s {} ns is invalid", seconds, rest_ns));
    ReferencePose pose;
    pose.time_ns = seconds * kSecond_ns + rest_ns;
    for (int i = 0; i < 3; ++i) pose.p_WA_m[i] = table.number(row, places[static_cast<std::size_t>(2 + i)]);
    for (int i = 0; i < 4; ++i) pose.q_WA.coeffs()[i] = table.number(row, places[static_cast<std::size_t>(5 + i)]);
    if (const std::string problem = problem_of(pose, poses.empty() ? nullptr : &poses.back()); !problem.empty())
      fail(problem);
    poses.push_back(pose);
  }
  if (poses.size() < 2)
    throw BadInput(fmt::format("{}: has {} poses; it needs at least 2", file.string(), poses.size()));
  return poses;
}

}  // namespace tumble::scenarios
