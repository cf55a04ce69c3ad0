// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/sensor_sheets.hpp"

#include <limits>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"

namespace tumble {

double max_unsaturated_reading(double stated_range) {
  return stated_range > 0.0 ? (1.0 - kNearRailRatio) * stated_range : std::numeric_limits<double>::infinity();
}

namespace sheets {

std::span<const NamedImu> imus() {
  static constexpr NamedImu kAll[] = {mti30,    vn100,       phidget1044, mpu6050,    bmi088,     icm20948,
                                      icm42688, mti3,        lsm6dso,     ouster_imu, mid360_imu, icm20601,
                                      icm20602, lsm6dsv320x, adis16405,   iim42653};
  return kAll;
}

std::span<const NamedLidar> lidars() {
  static constexpr NamedLidar kAll[] = {rs16,     mid40,  mid100,  vlp16,  xt16,    xt32,
                                        helios32, os0_64, os0_128, os1_64, os1_128, mid360};
  return kAll;
}

}  // namespace sheets

}  // namespace tumble
