// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "saved_bytes.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"

namespace tumble::odometry {

void write_saturation_levels(const SaturationLevels& rails, SavedStateWriter& out);
void read_saturation_levels(SavedStateReader& in, SaturationLevels& rails);

void start_from_saturation_levels(const SaturationLevels& rails, SaturationLimitDetector::Params& detector,
                                  SaturationPlaneFinder::Params& gyro, SaturationPlaneFinder::Params& accel);

}  // namespace tumble::odometry
