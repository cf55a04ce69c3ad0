// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/recording.hpp"
#include "tumble/angular_velocity/detail/frozen_axes.hpp"

namespace tumble::scenarios {

/// Returns the sensor and axis for a health key, for example "gyro_z".
std::string to_string(const FrozenAxis& frozen);

/// Returns the frozen axes of an IMU with their time intervals. `samples` must be the converted samples of `record`.
std::vector<FrozenAxis> find_frozen_axes(const sim::ImuRecord& record, std::span<const ImuSample> samples);

}  // namespace tumble::scenarios
