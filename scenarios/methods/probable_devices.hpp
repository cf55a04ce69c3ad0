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

/// Each ring of a spinning lidar must be within half a degree of a beam of the data sheet. For other lidars, the name
/// of the sensor must contain the name of the device ("livox_mid360"). The lidar points must be in memory.
std::optional<ProbableDevice> probable_lidar(const sim::LidarRecord& lidar, std::span<const DataSheet> sheets);

/// The name of the sensor must contain the name of the device, or the maker of a lidar with a built-in IMU (`ouster`,
/// `livox`). A data sheet is rejected if readings exceed its range by more than saturation limits can.
std::optional<ProbableDevice> probable_imu(const sim::ImuRecord& imu, std::span<const DataSheet> sheets);

void apply_sheet(const DataSheet& sheet, sim::ImuRecord& imu);

}  // namespace tumble::scenarios
