// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>

#include "scenarios/draw/data_sheet.hpp"
#include "sim/recording.hpp"

/// Detects the data sheet of a sensor from the sensor's name and data.
namespace tumble::scenarios {

/// ProbableDevice is a data sheet with the reason why it probably applies.
struct ProbableDevice {
  std::string device, evidence;
};

/// Detects the data sheet of a lidar. A spinning lidar is detected from the number and the elevations of its rings:
/// each ring must be within half a degree of a beam of the data sheet. For other lidars, the name of the sensor must
/// contain the name of the device ("livox_mid360"). The lidar points must be in memory.
std::optional<ProbableDevice> probable_lidar(const sim::LidarRecord& lidar, std::span<const DataSheet> sheets);

/// Detects the data sheet of an IMU. The name of the sensor must contain the name of the device, or the name of the
/// maker of a lidar with a built-in IMU (`ouster`, `livox`). A data sheet is rejected if readings exceed its range by
/// more than saturation limits do.
std::optional<ProbableDevice> probable_imu(const sim::ImuRecord& imu, std::span<const DataSheet> sheets);

/// Sets device, ranges and noise of an IMU from a data sheet.
void apply_sheet(const DataSheet& sheet, sim::ImuRecord& imu);

}  // namespace tumble::scenarios
