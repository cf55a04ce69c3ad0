// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>

#include "scenarios/draw/data_sheet.hpp"
#include "sim/recording.hpp"

/// The functions in probable_devices.hpp find the data sheet of a sensor from the sensor's name and data.
namespace tumble::scenarios {

/// ProbableDevice is the data sheet that probably belongs to a sensor, with the reason.
struct ProbableDevice {
  std::string device, evidence;
};

/// Finds the data sheet of a lidar from its name and points. For a spinning lidar, the number and elevations of the
/// rings decide: each ring must be within half a degree of a beam of the data sheet. For other lidars, the name of the
/// sensor must contain the name of the device ("livox_mid360"). The lidar points must be in memory.
std::optional<ProbableDevice> probable_lidar(const sim::LidarRecord& lidar, std::span<const DataSheet> sheets);

/// Finds the data sheet of an IMU from its name and readings. The name of the sensor must contain the name of the
/// device, or the maker of a lidar with a built-in IMU (`ouster`, `livox`). A data sheet is rejected if readings exceed
/// its range by more than saturation limits can.
std::optional<ProbableDevice> probable_imu(const sim::ImuRecord& imu, std::span<const DataSheet> sheets);

/// Sets the device name, ranges and noise densities of an IMU from a data sheet.
void apply_sheet(const DataSheet& sheet, sim::ImuRecord& imu);

}  // namespace tumble::scenarios
