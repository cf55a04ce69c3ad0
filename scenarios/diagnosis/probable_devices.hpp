// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>

#include "scenarios/draw/data_sheet.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

struct ProbableDevice {
  std::string device, evidence;
};

/// Finds the data sheet of a lidar. A spinning lidar matches a data sheet if each ring is within half a degree of a
/// beam of the data sheet. If no data sheet matches the rings, the name of the lidar must contain the name of a device
/// ("livox_mid360").
std::optional<ProbableDevice> probable_lidar(const sim::LidarRecord& lidar, std::span<const DataSheet> sheets);

/// Finds the data sheet of an IMU. An IMU matches a data sheet if the IMU's name contains the name of the device, or
/// the maker of a lidar with a built-in IMU (`ouster`, `livox`). A data sheet is rejected if a reading exceeds
/// bridge::kStatedRangesMax times the range in the data sheet, because real devices saturate below this limit.
std::optional<ProbableDevice> probable_imu(const sim::ImuRecord& imu, std::span<const DataSheet> sheets);

void apply_sheet(const DataSheet& sheet, sim::ImuRecord& imu);

}  // namespace tumble::scenarios
