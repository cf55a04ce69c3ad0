// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

namespace tumble::calibration_fields {

inline constexpr Field kMountSigma_rad{
    "mount_sigma_rad",
    "rad",
    0.0,
    1.0,
    "prior standard deviation of the lidar's orientation relative to the IMU; 0: exact, no estimate",
    FieldRank::basic};
inline constexpr Field kMountSigma_m{
    "mount_sigma_m",
    "m",
    0.0,
    1.0,
    "prior standard deviation of the lidar's position relative to the IMU; 0: exact, no estimate",
    FieldRank::basic};
inline constexpr Field kTimeOffsetSigma_s{
    "time_offset_sigma_s",
    "s",
    0.0,
    0.02,
    "prior standard deviation of the time offset between lidar and IMU; 0: no offset, no estimate",
    FieldRank::basic};

}  // namespace tumble::calibration_fields
