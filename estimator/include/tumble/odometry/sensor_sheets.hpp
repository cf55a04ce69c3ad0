// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "tumble/common/parameters.hpp"

namespace tumble {

/// Values of an IMU's data sheet. A gyro or accelerometer range of 0 means that the range is unknown. The estimators
/// detect saturation limits from the readings, with or without a stated range. Manufacturers usually state gyro ranges
/// of 250 to 4000 deg/s. A value of `gyro_range_rad_s` above 100 rad/s (5730 deg/s) is rejected, because the value is
/// probably in degrees per second.
struct ImuDataSheet {
  double rate_hz = 100.0;
  double gyro_range_rad_s = 0.0;
  double accel_range_m_s2 = 0.0;
  double gyro_noise_rad_s_sqrt_hz = 5.236e-4;
  double accel_noise_m_s2_sqrt_hz = 5.9e-4;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.rate_hz, {"rate_hz", "Hz", 1.0, 1e5, "samples per second", ParameterAudience::common_use});
    visit(p.gyro_range_rad_s, {"gyro_range_rad_s", "rad/s", 0.0, 100.0, "stated range of the gyro; 0: not stated",
                               ParameterAudience::common_use});
    visit(p.accel_range_m_s2, {"accel_range_m_s2", "m/s^2", 0.0, 1e5,
                               "stated range of the accelerometer; 0: not stated", ParameterAudience::common_use});
    visit(p.gyro_noise_rad_s_sqrt_hz, {"gyro_noise_rad_s_sqrt_hz", "rad/s/sqrt(Hz)", 1e-9, 1.0,
                                       "noise density of the gyro", ParameterAudience::common_use});
    visit(p.accel_noise_m_s2_sqrt_hz, {"accel_noise_m_s2_sqrt_hz", "m/s^2/sqrt(Hz)", 1e-9, 100.0,
                                       "noise density of the accelerometer", ParameterAudience::common_use});
  }
};

/// Returns the largest reading that is certainly unsaturated: 98 % of a range from a data sheet. Returns infinity if
/// the range is unknown (0). The 2 % are a margin for scale errors: a device that multiplies its readings by
/// calibration factors can saturate slightly below the stated range.
double max_unsaturated_reading(double stated_range);

/// Range limits in the data sheet of a lidar. The estimators drop lidar returns outside of the limits.
struct LidarDataSheet {
  double range_min_m = 0.3;
  double range_max_m = 100.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.range_min_m,
          {"range_min_m", "m", 0.0, 10.0, "minimum range; nearer returns are dropped", ParameterAudience::common_use});
    visit(p.range_max_m,
          {"range_max_m", "m", 0.0, 1e4, "maximum range; farther returns are dropped", ParameterAudience::common_use});
  }
};

/// Describes a lidar in addition to the first lidar of TumblingParams. Pose and clock offset relative to the first
/// lidar must be exact, because TumblingOdometry estimates both only for the first lidar.
struct FurtherLidar {
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  LidarDataSheet data_sheet;
  /// Box in axes of this lidar that contains the robot; see TumblingParams::own_body_L.
  Eigen::AlignedBox3d own_body_L;
  /// time of an event in the first lidar's clock minus time of the same event in this lidar's clock
  double first_minus_this_clock_s = 0.0;
};

/// Data sheets of common sensors: for example, `sheets::mti30()` returns the data sheet of the Xsens MTi-30. The file
/// models/sensors/NAME.yaml states the source of each number of the sensor NAME. The numbers are in the order of the
/// members of ImuDataSheet and LidarDataSheet.
namespace sheets {

/// A data sheet and the name of its sensor. The call operator returns the data sheet.
template <class DataSheet>
struct Named {
  const char* name;
  DataSheet data_sheet;

  constexpr DataSheet operator()() const { return data_sheet; }
};
using NamedImu = Named<ImuDataSheet>;
using NamedLidar = Named<LidarDataSheet>;

/// Xsens MTi-30 of the fifth generation, with ranges of 450 deg/s and 20 g.
inline constexpr NamedImu mti30{"mti30", {100.0, 7.853981634, 196.133, 5.23598776e-4, 5.88399e-4}};
/// VectorNav VN-100.
inline constexpr NamedImu vn100{"vn100", {100.0, 34.906585, 156.9064, 6.108652e-5, 1.372931e-3}};
/// PhidgetSpatial Precision 3/3/3 1044_0.
inline constexpr NamedImu phidget1044{"phidget1044", {250.0, 34.906585, 78.4532, 6.512629e-4, 1.736638e-3}};
/// InvenSense MPU-6050 with ranges of 500 deg/s and 16 g.
inline constexpr NamedImu mpu6050{"mpu6050", {100.0, 8.726646, 156.9064, 8.726646e-05, 0.00392266}};
/// Bosch BMI088 with ranges of 2000 deg/s and 24 g.
inline constexpr NamedImu bmi088{"bmi088", {200.0, 34.90658504, 235.3596, 0.0002443461, 0.001716164}};
/// InvenSense ICM-20948 with ranges of 2000 deg/s and 16 g.
inline constexpr NamedImu icm20948{"icm20948", {200.0, 34.90658504, 156.9064, 0.0002617994, 0.002255529}};
/// InvenSense ICM-42688-P with ranges of 2000 deg/s and 16 g.
inline constexpr NamedImu icm42688{"icm42688", {200.0, 34.90658504, 156.9064, 4.886922e-05, 0.0006864655}};
/// Xsens MTi-3.
inline constexpr NamedImu mti3{"mti3", {100.0, 34.90658504, 156.9064, 0.000122173, 0.001176798}};
/// STMicroelectronics LSM6DSO with ranges of 2000 deg/s and 16 g.
inline constexpr NamedImu lsm6dso{"lsm6dso", {200.0, 34.90658504, 156.9064, 6.632251e-05, 0.001078731}};
/// IMU inside an Ouster OS0 or OS1, with the default ranges of 250 deg/s and 2 g.
inline constexpr NamedImu ouster_imu{"ouster_imu", {100.0, 4.36332313, 19.6133, 0.0002617994, 0.002255529}};
/// IMU inside a Livox Mid-360 with ranges of 2000 deg/s and 4 g.
inline constexpr NamedImu mid360_imu{"mid360_imu", {200.0, 34.90658504, 39.2266, 7.853982e-05, 0.000980665}};
/// InvenSense ICM-20601 with ranges of 2000 deg/s and 32 g.
inline constexpr NamedImu icm20601{"icm20601", {100.0, 34.90658504, 313.8128, 0.0001745329, 0.002941995}};
/// InvenSense ICM-20602 with ranges of 2000 deg/s and 16 g.
inline constexpr NamedImu icm20602{"icm20602", {200.0, 34.90658504, 156.9064, 6.981317e-05, 0.000980665}};
/// STMicroelectronics LSM6DSV320X with ranges of 4000 deg/s and 16 g.
inline constexpr NamedImu lsm6dsv320x{"lsm6dsv320x", {250.0, 69.81317008, 156.9064, 6.632251e-05, 0.000588399}};
/// Analog Devices ADIS16405 with ranges of 300 deg/s and 18 g.
inline constexpr NamedImu adis16405{"adis16405", {500.0, 5.235987756, 176.5197, 0.0008726646, 0.003333333}};
/// InvenSense IIM-42653 with ranges of 4000 deg/s and 32 g.
inline constexpr NamedImu iim42653{"iim42653", {200.0, 69.81317008, 313.8128, 8.726646e-05, 0.0006374322}};

/// Returns the data sheets of all IMUs, for programs that select a data sheet by name.
std::span<const NamedImu> imus();

/// RoboSense RS-16.
inline constexpr NamedLidar rs16{"rs16", {0.2, 150.0}};
/// Livox Mid-40.
inline constexpr NamedLidar mid40{"mid40", {1.0, 260.0}};
/// Livox Mid-100.
inline constexpr NamedLidar mid100{"mid100", {1.0, 260.0}};
/// Velodyne VLP-16.
inline constexpr NamedLidar vlp16{"vlp16", {0.4, 100.0}};
/// Hesai XT16.
inline constexpr NamedLidar xt16{"xt16", {0.05, 120.0}};
/// Hesai XT32.
inline constexpr NamedLidar xt32{"xt32", {0.05, 120.0}};
/// RoboSense Helios with 32 beams.
inline constexpr NamedLidar helios32{"helios32", {0.2, 150.0}};
/// Ouster OS0 with 64 rings.
inline constexpr NamedLidar os0_64{"os0_64", {0.3, 50.0}};
/// Ouster OS0 with 128 rings.
inline constexpr NamedLidar os0_128{"os0_128", {0.3, 50.0}};
/// Ouster OS1 with 64 rings.
inline constexpr NamedLidar os1_64{"os1_64", {0.3, 120.0}};
/// Ouster OS1 with 128 rings.
inline constexpr NamedLidar os1_128{"os1_128", {0.3, 120.0}};
/// Livox Mid-360.
inline constexpr NamedLidar mid360{"mid360", {0.1, 70.0}};

/// Returns the data sheets of all lidars.
std::span<const NamedLidar> lidars();

}  // namespace sheets

}  // namespace tumble
