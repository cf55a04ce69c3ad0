// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <utility>

#include "tumble/common/parameters.hpp"

namespace tumble {

/// A gyro or accelerometer range of 0 means that the range is unknown. The estimators detect saturation limits from the
/// readings, with or without a stated range. Manufacturers usually state gyro ranges of 250 to 4000 deg/s. A value of
/// `gyro_range_rad_s` above 100 rad/s (5730 deg/s) is rejected, because the value is probably in degrees per second.
struct ImuDataSheet {
  double rate_hz = 100.0;
  double gyro_range_rad_s = 0.0;
  double accel_range_m_s2 = 0.0;
  double gyro_noise_rad_s_sqrt_hz = 5.236e-4;
  double accel_noise_m_s2_sqrt_hz = 5.9e-4;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.rate_hz, {"rate_hz", "Hz", 1.0, 1e5, "samples per second", ParameterRank::common_use});
    visit(p.gyro_range_rad_s, {"gyro_range_rad_s", "rad/s", 0.0, 100.0, "stated range of the gyro; 0: not stated",
                               ParameterRank::common_use});
    visit(p.accel_range_m_s2, {"accel_range_m_s2", "m/s^2", 0.0, 1e5,
                               "stated range of the accelerometer; 0: not stated", ParameterRank::common_use});
    visit(p.gyro_noise_rad_s_sqrt_hz, {"gyro_noise_rad_s_sqrt_hz", "rad/s/sqrt(Hz)", 1e-9, 1.0,
                                       "noise density of the gyro", ParameterRank::common_use});
    visit(p.accel_noise_m_s2_sqrt_hz, {"accel_noise_m_s2_sqrt_hz", "m/s^2/sqrt(Hz)", 1e-9, 100.0,
                                       "noise density of the accelerometer", ParameterRank::common_use});
  }
};

/// Returns the largest reading that is certainly unsaturated: 98 % of a range from a data sheet. Returns infinity if
/// the range is unknown (0). The margin of 2 % is necessary, because the calibration in a device also scales saturated
/// readings.
double range_below_saturation(double stated_range);

/// LidarDataSheet contains the range limits in the data sheet of a lidar. The estimators drop lidar returns outside of
/// the stated limits.
struct LidarDataSheet {
  double range_min_m = 0.3;
  double range_max_m = 100.0;

  /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.range_min_m,
          {"range_min_m", "m", 0.0, 10.0, "minimum range; nearer returns are dropped", ParameterRank::common_use});
    visit(p.range_max_m,
          {"range_max_m", "m", 0.0, 1e4, "maximum range; farther returns are dropped", ParameterRank::common_use});
  }
};

/// FurtherLidar is a lidar in addition to the lidar of TumblingParams. Relative to the first lidar, the stated mounting
/// and clock offset of a further lidar must be exact. TumblingOdometry estimates only the mounting and clock offset of
/// the first lidar.
struct FurtherLidar {
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  LidarDataSheet data_sheet;
  Eigen::AlignedBox3d own_body_L;  ///< see TumblingParams::own_body_L, in axes of this lidar
  double time_offset_s = 0.0;      ///< clock of the first lidar minus clock of this lidar
};

/// The functions of this namespace return the data sheets of the simulated sensors. The file models/sensors/NAME.yaml
/// states the source of each number of the sensor NAME.
namespace sheets {

/// Xsens MTi-30 of the fifth generation, with ranges of 450 deg/s and 20 g.
ImuDataSheet mti30();
/// VectorNav VN-100.
ImuDataSheet vn100();
/// PhidgetSpatial Precision 3/3/3 1044_0.
ImuDataSheet phidget1044();
/// InvenSense MPU-6050 with ranges of 500 deg/s and 16 g.
ImuDataSheet mpu6050();
/// Bosch BMI088 with ranges of 2000 deg/s and 24 g.
ImuDataSheet bmi088();
/// InvenSense ICM-20948 with ranges of 2000 deg/s and 16 g.
ImuDataSheet icm20948();
/// InvenSense ICM-42688-P with ranges of 2000 deg/s and 16 g.
ImuDataSheet icm42688();
/// Xsens MTi-3.
ImuDataSheet mti3();
/// STMicroelectronics LSM6DSO with ranges of 2000 deg/s and 16 g.
ImuDataSheet lsm6dso();
/// IMU inside an Ouster OS0 or OS1, with the default ranges of 250 deg/s and 2 g.
ImuDataSheet ouster_imu();
/// IMU inside a Livox Mid-360 with ranges of 2000 deg/s and 4 g.
ImuDataSheet mid360_imu();
/// InvenSense ICM-20601 with ranges of 2000 deg/s and 32 g.
ImuDataSheet icm20601();
/// InvenSense ICM-20602 with ranges of 2000 deg/s and 16 g.
ImuDataSheet icm20602();
/// STMicroelectronics LSM6DSV320X with ranges of 4000 deg/s and 16 g.
ImuDataSheet lsm6dsv320x();
/// Analog Devices ADIS16405 with ranges of 300 deg/s and 18 g.
ImuDataSheet adis16405();
/// InvenSense IIM-42653 with ranges of 4000 deg/s and 32 g.
ImuDataSheet iim42653();

/// Returns the data sheets of all IMUs with their names, for programs that select a data sheet by name.
std::span<const std::pair<const char*, ImuDataSheet (*)()>> imus();

/// RoboSense RS-16.
LidarDataSheet rs16();
/// Livox Mid-40.
LidarDataSheet mid40();
/// Livox Mid-100.
LidarDataSheet mid100();
/// Velodyne VLP-16.
LidarDataSheet vlp16();
/// Hesai XT16.
LidarDataSheet xt16();
/// Hesai XT32.
LidarDataSheet xt32();
/// RoboSense Helios with 32 beams.
LidarDataSheet helios32();
/// Ouster OS0 with 64 rings.
LidarDataSheet os0_64();
/// Ouster OS0 with 128 rings.
LidarDataSheet os0_128();
/// Ouster OS1 with 64 rings.
LidarDataSheet os1_64();
/// Ouster OS1 with 128 rings.
LidarDataSheet os1_128();
/// Livox Mid-360.
LidarDataSheet mid360();

/// Returns the data sheets of all lidars with their names.
std::span<const std::pair<const char*, LidarDataSheet (*)()>> lidars();

}  // namespace sheets

}  // namespace tumble
