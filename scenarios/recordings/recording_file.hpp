// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/recordings/point_store.hpp"
#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Name and version of the file format, in the attributes `format` and `format_version`.
inline constexpr const char* kRecordingFormat = "tumble recording";
inline constexpr int kRecordingVersion = 1;

/// Metadata of a recording file.
struct RecordingInfo {
  int format_version = kRecordingVersion;
  std::string scenario;  ///< "" for a real recording
  std::uint64_t seed = 0;
  std::string situation_yaml;  ///< resolved situation; "" for a real recording
  std::string tumble_version;
  std::string engine_version;  ///< version of MuJoCo
  std::string attribution;     ///< author and licence of a real recording; "" for a simulated one
  std::int64_t origin_ns = 0;  ///< stamp of a real recording's time 0 in its source's clock; 0: unknown
  std::string digest;          ///< digest of all sensor and truth data, 32 hexadecimal digits
  bool has_truth = false;
};

/// Returns the XXH3 digest (128 bit) of every field of sensors and truth in a fixed order: equal data, equal digest.
std::string digest(const sim::Sensors& sensors, const sim::Truth* truth);
/// The same for points on disk, one store per lidar.
std::string digest(const sim::Sensors& sensors, const std::vector<PointStore>& points, const sim::Truth* truth);
/// The same for the truth only.
std::string digest(const sim::Truth& truth);
std::string digest(const StoredTruth& truth);

/// Writes a recording as HDF5 (scenarios/recordings/FORMAT.md) to a temporary file in the same folder, then renames it.
/// `truth` may be null. format_version, digest and has_truth of `info` are set by the writer. The file is composed in
/// memory, which doubles the memory use. Throws BadInput if the folder is not writable or the disk is full (no partial
/// file remains). Throws std::invalid_argument for inconsistent data (find_problem in recording_check.hpp).
void write_recording(const std::filesystem::path& path, const RecordingInfo& info, const sim::Sensors& sensors,
                     const sim::Truth* truth);

/// The same for points on disk; produces the same bytes. The file is written directly to disk after reserving its
/// maximum size. Memory holds the sensors without points, the truth, and some MiB.
void write_recording(const std::filesystem::path& path, const RecordingInfo& info, const sim::Sensors& sensors,
                     const std::vector<PointStore>& points, const sim::Truth* truth);

/// Reads the metadata. Each reader opens only its own group. All throw BadInput with path and reason: missing, not
/// HDF5, truncated, missing or wrongly shaped dataset, other format version, inconsistent lengths, digest mismatch.
RecordingInfo read_info(const std::filesystem::path& path);
sim::Sensors read_sensors(const std::filesystem::path& path);
/// The same, with the points on disk in `scratch`, one store per lidar; the records then have none.
sim::Sensors read_sensors(const std::filesystem::path& path, const std::filesystem::path& scratch,
                          std::vector<PointStore>& points);
sim::Truth read_truth(const std::filesystem::path& path);
/// The same, with the rows on disk in `scratch`; memory holds one MiB at a time.
StoredTruth read_truth(const std::filesystem::path& path, const std::filesystem::path& scratch);

}  // namespace tumble::scenarios
