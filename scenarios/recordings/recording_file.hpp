// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// What a recording file says of itself.
struct RecordingInfo {
  int format_version = 1;
  std::string scenario;         ///< "" for a real recording
  std::uint64_t seed = 0;
  std::string situation_yaml;   ///< resolved situation; "" for a real recording
  std::string tumble_version;
  std::string engine_version;   ///< MuJoCo's
  std::string digest;           ///< of all sensor and truth data, 32 hexadecimal digits
  bool has_truth = false;
};

/// XXH3 (128 bit) over every field of sensors and truth in a fixed order: equal data, equal digest.
std::string digest(const sim::Sensors& sensors, const sim::Truth* truth);

/// Writes recording as HDF5 (scenarios/recordings/FORMAT.md) under a temporary name in the same folder, then renames.
/// `truth` may be null. Throws BadInput when the folder cannot be written or the disk is full; no partial file stays.
void write_recording(const std::filesystem::path& path, const RecordingInfo& info, const sim::Sensors& sensors,
                     const sim::Truth* truth);

/// Each reader opens only its own group. All throw BadInput with path and reason: absent, not HDF5, truncated, a missing
/// or mis-shaped dataset, another format version.
RecordingInfo read_info(const std::filesystem::path& path);
sim::Sensors read_sensors(const std::filesystem::path& path);
sim::Truth read_truth(const std::filesystem::path& path);

}  // namespace tumble::scenarios
