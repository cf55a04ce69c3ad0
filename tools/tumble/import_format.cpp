// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <map>
#include <string_view>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/lower_extension.hpp"
#include "scenarios/recordings/tables/csv_text.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "scenarios/regular_file.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/import_options.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;

const std::vector<std::string> kFormats = {"csv", "kitti",   "mcap",    "pcd", "odometry",
                                           "ply", "rosbag1", "rosbag2", "tum", "vtk"};

std::string format_of_folder(const std::filesystem::path& folder) {
  const std::map<std::string, std::string> known = {{".ply", "ply"},    {".pcd", "pcd"},     {".bin", "kitti"},
                                                    {".vtk", "vtk"},    {".bag", "rosbag1"}, {".mcap", "rosbag2"},
                                                    {".db3", "rosbag2"}};
  if (std::filesystem::exists(folder / "metadata.yaml")) return "rosbag2";
  std::string found;
  bool tables = false;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string ending = scenarios::lower_extension(entry.path());
    tables = tables || ending == ".csv";
    const auto format = known.find(ending);
    if (format == known.end() || format->second == found) continue;
    if (!found.empty()) {
      throw BadInput(
          fmt::format("{}: this folder contains files of the formats {} and {}; select one format with --format",
                      folder.string(), found, format->second));
    }
    found = format->second;
  }
  if (found.empty() && std::filesystem::exists(folder / "recording.h5"))
    throw BadInput(fmt::format("{}: this folder is an output of 'tumble run'; state its recording: {}", folder.string(),
                               (folder / "recording.h5").string()));
  if (found.empty() && tables) return "csv";
  if (found.empty())
    throw BadInput(fmt::format("{}: this folder contains no .ply, .pcd, .vtk, .bin, .bag, .mcap, .db3 or .csv file",
                               folder.string()));
  return found;
}

/// The Python package, and not `tumble import`, reads the tables of known data sets.
void require_no_data_set(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  const bool repoimu = line.find(";Vicon Orientation;") != std::string::npos;
  if (!repoimu && line.find("raw_angular_rate_x_deg_per_s") == std::string::npos) return;
  throw BadInput(
      fmt::format("{}: this is a file of {}; convert it with the Python package: tumble.write(\"out.h5\", "
                  "tumble.{}(\"{}\"))",
                  file.string(), repoimu ? "RepoIMU" : "AirbrakesV2", repoimu ? "read_repoimu" : "read_airbrakes",
                  file.filename().string()));
}

std::string format_of_csv(const std::filesystem::path& file) {
  require_no_data_set(file);
  try {
    return scenarios::pose_format(file);
  } catch (const BadInput&) {
    return "csv";  // no table of poses
  }
}

std::string format_of_content(const std::filesystem::path& file) {
  std::array<char, 16> first{};
  std::ifstream(file, std::ios::binary).read(first.data(), first.size());
  const std::string_view start(first.data(), first.size());
  if (start.starts_with("#ROSBAG V")) return "rosbag1";
  if (start.starts_with("\x89MCAP")) return "mcap";
  if (start.starts_with("SQLite format 3")) return "rosbag2";
  return start.starts_with("\x89HDF\r\n") ? "recording" : "";
}

std::string format_of_text(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line) &&
         (line.find_first_not_of(" \t\r") == std::string::npos || scenarios::is_comment(line)))
    continue;
  return line.find_first_of(",;\t") == std::string::npos ? scenarios::pose_format(file) : format_of_csv(file);
}

}  // namespace

std::string format_of(const ImportOptions& options) {
  if (!options.format.empty()) require_known("format", options.format, kFormats);
  std::error_code error;
  const bool folder = std::filesystem::is_directory(options.path, error);
  // A pipe can be read only once, so it is not opened here.
  if (!folder && options.format != "tum" && std::filesystem::exists(options.path, error))
    scenarios::require_regular_file(options.path);
  if (!options.format.empty()) return options.format;
  if (folder) return format_of_folder(options.path);
  const std::string ending = scenarios::lower_extension(options.path);
  const bool exists = std::filesystem::exists(options.path, error);
  if (const std::string content = exists ? format_of_content(options.path) : ""; !content.empty()) return content;
  if (!options.columns.empty() && options.imu.empty()) return "csv";
  if (ending == ".csv") return format_of_csv(options.path);
  if (ending == ".bag") return "rosbag1";
  if (ending == ".db3" || ending == ".zstd") return "rosbag2";
  if (ending == ".mcap") return "mcap";
  if (ending == ".hdf5" || ending == ".h5") return "recording";
  if (exists && (ending.empty() || ending == ".txt")) return format_of_text(options.path);
  if (ending == ".tum" || ending == ".txt" || ending == ".kitti") return scenarios::pose_format(options.path);
  throw BadInput(fmt::format(
      "{}: the file name does not reveal the format; give --format (csv, kitti, mcap, rosbag1, rosbag2 or tum)",
      options.path.string()));
}

}  // namespace tumble::tools
