// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "saved_bytes.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"

namespace tumble::odometry {

void write_rails(const SaturationLevels& rails, SavedWriter& out);
void read_rails(SavedReader& in, SaturationLevels& rails);

void start_from_rails(const SaturationLevels& rails, RailDetector::Params& detector, RailPlaneFinder::Params& gyro,
                      RailPlaneFinder::Params& accel);

}  // namespace tumble::odometry
