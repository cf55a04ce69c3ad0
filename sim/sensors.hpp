// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

/// The sensor data are the complete input of an estimator, with frames and units as in docs/design.md. Frame B is the
/// body at the centre of mass, I an IMU, L the lidar, and X any other sensor. Units are SI units, and times are int64
/// nanoseconds from the start.
namespace tumble::sim {

struct ImuRecord {
  std::string name;
  std::string device;  ///< for example "mti30"
  std::int64_t period_ns = 0;
  double stated_gyro_range_rad_s = 0.0;  ///< range in the data sheet; the saturation limit may differ
  double stated_accel_range_m_s2 = 0.0;
  double gyro_noise_rad_s_sqrt_hz = 0.0;
  double accel_noise_m_s2_sqrt_hz = 0.0;
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();  ///< for the estimator, with errors
  std::vector<std::int64_t> time_ns;                       ///< end of each sample's window
  std::vector<Eigen::Vector3d> gyro_rad_s;
  std::vector<Eigen::Vector3d> accel_m_s2;        ///< specific force
  std::vector<std::uint8_t> clip_flags;           ///< bits: gyro x, y, z, accelerometer x, y, z
  std::vector<Eigen::Vector3d> magnetic_field_t;  ///< in IMU axes, one per sample
  /// magnetic field of the Earth at the location of the recording, without disturbances; 0: unknown
  Eigen::Vector3d earth_field_W_t = Eigen::Vector3d::Zero();
};

enum class PointTimes : std::uint8_t {
  measured,  ///< each point has its own time in offset_ns
  /// all points belong to the start of the sweep (flash lidar or deskewed sweep); offset_ns is 0
  not_skewed,
  unknown  ///< unknown motion distortion; offset_ns is 0
};

/// LidarRecord contains the sweeps of a lidar. A laser pulse without a return gives no point.
struct LidarRecord {
  std::string name;
  std::string device;
  Eigen::Isometry3d T_BL = Eigen::Isometry3d::Identity();  ///< for the estimator, with errors
  std::int64_t sweep_period_ns = 0;
  PointTimes point_times = PointTimes::measured;
  std::vector<std::int64_t> sweep_start_ns;
  std::vector<std::uint64_t> sweep_first;  ///< index of the first point of each sweep, then the total number of points
  std::vector<Eigen::Vector3f> position_L_m;
  std::vector<float> range_m;
  std::vector<float> intensity;          ///< 0 to 1
  std::vector<std::uint32_t> offset_ns;  ///< firing time since the sweep's start
  std::vector<std::uint16_t> ring;
};

struct Quantity {
  std::string name;  ///< ends in its unit: "pressure_pa"
  std::string unit;
  double noise = 0.0;          ///< standard deviation in the data sheet; 0: not stated
  std::vector<double> values;  ///< one per time stamp of the sensor
};

struct Constant {
  std::string name;  ///< ends in its unit
  double value = 0.0;
};

struct SeriesRecord {
  std::string name;
  std::string kind;  ///< for example "barometer"
  std::string device;
  std::int64_t period_ns = 0;
  Eigen::Isometry3d T_BX = Eigen::Isometry3d::Identity();  ///< for the estimator, with errors
  std::vector<std::int64_t> time_ns;                       ///< end of each sample's window
  std::vector<Quantity> quantities;
  std::vector<Constant> constants;  ///< needed to interpret the readings
};

struct Sensors {
  std::string robot;           ///< "rig", "sphere", "pendulum" or empty
  double sphere_radius_m = 0;  ///< 0: no sphere
  double gravity_m_s2 = 9.80665;
  std::vector<ImuRecord> imus;  ///< primary IMU first; `imu_reference`: comparison
  std::vector<LidarRecord> lidars;
  std::vector<SeriesRecord> series;
};

}  // namespace tumble::sim
