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

/// Name and version of the file's format, as its attributes `format` and `format_version` state them.
inline constexpr const char* kRecordingFormat = "tumble recording";
inline constexpr int kRecordingVersion = 1;

/// What a recording file says of itself.
struct RecordingInfo {
  int format_version = kRecordingVersion;
  std::string scenario;  ///< "" for a real recording
  std::uint64_t seed = 0;
  std::string situation_yaml;  ///< resolved situation; "" for a real recording
  std::string tumble_version;
  std::string engine_version;  ///< MuJoCo's
  std::string attribution;     ///< of a real recording: who made it and under which licence; "" for a simulated one
  std::int64_t origin_ns = 0;  ///< of a real recording: stamp of its time 0 in the clock of its source; 0: not known
  std::string digest;          ///< of all sensor and truth data, 32 hexadecimal digits
  bool has_truth = false;
};

/// XXH3 (128 bit) over every field of sensors and truth in a fixed order: equal data, equal digest.
std::string digest(const sim::Sensors& sensors, const sim::Truth* truth);
/// The same of sensors whose points are set aside, a store for each lidar.
std::string digest(const sim::Sensors& sensors, const std::vector<PointStore>& points, const sim::Truth* truth);
/// The same over the truth alone.
std::string digest(const sim::Truth& truth);
std::string digest(const StoredTruth& truth);

/// Writes recording as HDF5 (scenarios/recordings/FORMAT.md) under a temporary name in the same folder, then renames.
/// `truth` may be null. format_version, digest and has_truth of `info` are the writer's own. The file is composed in
/// memory: as much again as the recording is needed. Throws BadInput when the folder cannot be written or the disk is
/// full (no partial file stays), std::invalid_argument when the data contradict themselves (find_problem in
/// recording_check.hpp).
void write_recording(const std::filesystem::path& path, const RecordingInfo& info, const sim::Sensors& sensors,
                     const sim::Truth* truth);

/// The same of sensors whose points are set aside: the same bytes. The file grows on the disk beside its place, and the
/// room that it needs at most is taken there first; in memory are the sensors without points, the truth and some MiB.
void write_recording(const std::filesystem::path& path, const RecordingInfo& info, const sim::Sensors& sensors,
                     const std::vector<PointStore>& points, const sim::Truth* truth);

/// Each reader opens only its own group. All throw BadInput with path and reason: absent, not HDF5, truncated, a
/// missing or mis-shaped dataset, another format version, lengths that contradict each other, data that do not fit
/// their digest.
RecordingInfo read_info(const std::filesystem::path& path);
sim::Sensors read_sensors(const std::filesystem::path& path);
/// The same with the points set aside in `scratch`, a store for each lidar, whose records then hold none.
sim::Sensors read_sensors(const std::filesystem::path& path, const std::filesystem::path& scratch,
                          std::vector<PointStore>& points);
sim::Truth read_truth(const std::filesystem::path& path);
/// The same with its rows set aside in `scratch`: a MiB at a time is in memory.
StoredTruth read_truth(const std::filesystem::path& path, const std::filesystem::path& scratch);

}  // namespace tumble::scenarios
