// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

/// What sensors say, all that an estimator may see: data types only. Frames and units as in docs/design.md: B body at
/// the centre of mass, I an IMU, L the lidar, X any other sensor; SI; int64 nanoseconds from the start.
namespace tumble::sim {

/// Readings of one IMU, as the device delivers them.
struct ImuRecord {
  std::string name;    ///< of the sensor in the situation: "imu"
  std::string device;  ///< "mti30"
  std::int64_t period_ns = 0;
  double stated_gyro_range_rad_s = 0.0;  ///< what the data sheet claims; the rail may be elsewhere
  double stated_accel_range_m_s2 = 0.0;
  double gyro_noise_rad_s_sqrt_hz = 0.0;  ///< densities of the data sheet
  double accel_noise_m_s2_sqrt_hz = 0.0;
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();  ///< the calibration an estimator is given, errors included
  std::vector<std::int64_t> time_ns;                       ///< end of each sample's window
  std::vector<Eigen::Vector3d> gyro_rad_s;
  std::vector<Eigen::Vector3d> accel_m_s2;        ///< specific force
  std::vector<std::uint8_t> clip_flags;           ///< bits gyro x y z, accel x y z; zero for devices without flags
  std::vector<Eigen::Vector3d> magnetic_field_t;  ///< flux density in I, one per sample; empty without magnetometer
  Eigen::Vector3d earth_field_W_t = Eigen::Vector3d::Zero();  ///< the Earth's, undisturbed, from a map; 0: unknown
};

/// What a recording knows of the instants within a sweep.
enum class PointTimes : std::uint8_t {
  measured,    ///< each point has its own, in offset_ns
  not_skewed,  ///< the points belong to one instant, the sweep's start: a flash, or deskewed before; offset_ns is 0
  unknown      ///< the sweep is skewed, nobody says how: offset_ns is 0
};

/// Returns of one lidar, sweep after sweep; misses leave no point.
struct LidarRecord {
  std::string name;
  std::string device;
  Eigen::Isometry3d T_BL = Eigen::Isometry3d::Identity();  ///< calibration given, errors included
  std::int64_t sweep_period_ns = 0;
  PointTimes point_times = PointTimes::measured;
  std::vector<std::int64_t> sweep_start_ns;
  std::vector<std::uint64_t>
      sweep_first;  ///< index of each sweep's first point, and one past the last point at the end
  std::vector<Eigen::Vector3f> position_L_m;
  std::vector<float> range_m;
  std::vector<float> intensity;          ///< 0..1
  std::vector<std::uint32_t> offset_ns;  ///< firing after the sweep's start
  std::vector<std::uint16_t> ring;
};

/// One number that a sensor reads, with all its readings.
struct Quantity {
  std::string name;            ///< ends in its unit: "pressure_pa"
  std::string unit;            ///< "Pa"
  double noise = 0.0;          ///< standard deviation of a reading, of the data sheet; 0: not stated
  std::vector<double> values;  ///< one for each of the sensor's times
};

/// A number that is known of a sensor and does not change, as where a beacon stands.
struct Constant {
  std::string name;  ///< ends in its unit
  double value = 0.0;
};

/// Readings of any other sensor, a barometer for one: at each of its times one number for each of its quantities.
struct SeriesRecord {
  std::string name;
  std::string kind;  ///< of the sensor: "barometer"
  std::string device;
  std::int64_t period_ns = 0;
  Eigen::Isometry3d T_BX = Eigen::Isometry3d::Identity();  ///< calibration given, errors included
  std::vector<std::int64_t> time_ns;                       ///< end of each sample's window
  std::vector<Quantity> quantities;
  std::vector<Constant> constants;  ///< what readings are understood by
};

/// Everything that an estimator may see.
struct Sensors {
  std::string robot;           ///< "rig", "sphere", "pendulum"; "" for a recording of an unknown robot
  double sphere_radius_m = 0;  ///< 0 when not a sphere
  double gravity_m_s2 = 9.80665;
  std::vector<ImuRecord> imus;  ///< the first is the primary one; `imu_reference`, if any, is for comparison only
  std::vector<LidarRecord> lidars;
  std::vector<SeriesRecord> series;  ///< of all sensors that are neither
};

}  // namespace tumble::sim
