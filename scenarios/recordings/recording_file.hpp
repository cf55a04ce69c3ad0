// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

inline constexpr const char* kRecordingFormat = "tumble recording";
inline constexpr int kRecordingVersion = 1;

struct RecordingInfo {
  int format_version = kRecordingVersion;
  std::string scenario;  ///< empty for a real recording
  std::uint64_t seed = 0;
  std::string situation_yaml;  ///< simulation setup in YAML
  std::string tumble_version;
  std::string engine_version;  ///< version of MuJoCo
  std::string attribution;     ///< author and licence
  std::int64_t origin_ns = 0;  ///< source stamp of time 0; 0: unknown
  std::string digest;          ///< of all sensor and truth data
  bool has_truth = false;
};

/// The time stamps in exported files start 1 000 000 000 s after 1970 if the recording has no `origin_ns`, because ROS
/// treats a stamp of 0 as missing.
inline constexpr std::int64_t kExportOrigin_ns = 1'000'000'000'000'000'000;

/// Replaces an origin before 1970 by kExportOrigin_ns, because bags cannot store time stamps before 1970.
inline std::int64_t export_origin_ns(std::int64_t origin_ns) {
  return origin_ns > 0 ? origin_ns : kExportOrigin_ns;
}

/// Returns the XXH3 digest (128 bit) of every field of the sensors and the truth.
std::string digest(const sim::Sensors& sensors, const sim::Truth* truth);
std::string digest(const sim::Sensors& sensors, const std::vector<PointStore>& points, const sim::Truth* truth);
std::string digest(const sim::Truth& truth);
std::string digest(const StoredTruth& truth);

/// Writes a recording as HDF5 (scenarios/recordings/FORMAT.md) to a temporary file, and renames the complete file.
/// Throws BadInput if the folder is not writable or the disk is full. After an error, no partial file remains.
void write_recording(const std::filesystem::path& path, const RecordingInfo& info, const sim::Sensors& sensors,
                     const sim::Truth* truth);

/// Writes a recording whose points are on disk. The file is bit-identical to the file of a recording with equal points
/// in memory.
void write_recording(const std::filesystem::path& path, const RecordingInfo& info, const sim::Sensors& sensors,
                     const std::vector<PointStore>& points, const sim::Truth* truth);

/// read_info() and the other readers throw BadInput, with path and reason, if the file is damaged or not HDF5, or if a
/// dataset has a wrong shape. Also throws BadInput if the format version or the digest does not match.
RecordingInfo read_info(const std::filesystem::path& path);
sim::Sensors read_sensors(const std::filesystem::path& path);
sim::Sensors read_sensors(const std::filesystem::path& path, const std::filesystem::path& scratch,
                          std::vector<PointStore>& points);
sim::Truth read_truth(const std::filesystem::path& path);
/// Reads the truth of a recording. The rows of the truth are stored on disk in the folder `scratch`, so that only one
/// MiB of the truth is in memory.
StoredTruth read_truth(const std::filesystem::path& path, const std::filesystem::path& scratch);

/// Throws BadInput if `path` is not a regular file, or if its first 16 bytes or its extension indicate another format
/// than HDF5.
void require_recording_file(const std::filesystem::path& path);

}  // namespace tumble::scenarios
