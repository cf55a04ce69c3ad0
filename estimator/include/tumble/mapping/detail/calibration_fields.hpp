// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

/// Fields shared by all `Params` that state the accuracy of the lidar's mounting and time offset.
namespace tumble::calibration_fields {

inline constexpr Field kMountSigma_rad{
    "mount_sigma_rad", "rad", 0.0, 1.0, "the lidar's attitude on the IMU as given; 0: exact", Rank::first};
inline constexpr Field kMountSigma_m{
    "mount_sigma_m", "m", 0.0, 1.0, "the lidar's position on the IMU as given; 0: exact", Rank::first};
inline constexpr Field kTimeOffsetSigma_s{
    "time_offset_sigma_s", "s", 0.0, 0.02, "offset between the clocks of lidar and IMU; 0: none", Rank::first};

}  // namespace tumble::calibration_fields
