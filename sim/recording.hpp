// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

/// What a simulation leaves: data types only. Frames and units as in DESIGN: W world (z up), B body at the centre of
/// mass, I an IMU, L the lidar, G the sphere's geometric centre; SI; int64 nanoseconds from the start.
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

/// Everything that an estimator may see.
struct Sensors {
  std::string robot;           ///< "rig", "sphere", "pendulum"; "" for a recording of an unknown robot
  double sphere_radius_m = 0;  ///< 0 when not a sphere
  double gravity_m_s2 = 9.80665;
  std::vector<ImuRecord> imus;  ///< the first is the primary one; `imu_reference`, if any, is for comparison only
  std::vector<LidarRecord> lidars;
};

/// State of contact, over a window that bridges chatter.
enum class ContactLabel : std::uint8_t { air, grip, slip, slide };

/// One contact at one instant of the truth.
struct ContactTruth {
  std::int64_t time_ns = 0;
  Eigen::Vector3d point_W_m;
  Eigen::Vector3d normal_W;             ///< unit, into the robot
  Eigen::Vector3d slip_velocity_W_m_s;  ///< of the robot's material point against the world, tangential
  double normal_force_n = 0;
  std::int32_t surface_id = -1;
};

/// What truly happened at one IMU: the same windows and time stamps as the readings.
struct ImuTruth {
  std::string name;
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();  ///< true mounting
  std::vector<Eigen::Vector3d> rate_rad_s;                 ///< exact: rotation over the window over its length
  std::vector<Eigen::Vector3d> specific_force_m_s2;        ///< exact: velocity gained less gravity, in half-way axes
  std::vector<Eigen::Vector3d> gyro_unclipped_rad_s;       ///< the reading with all errors but the rail
  std::vector<Eigen::Vector3d> accel_unclipped_m_s2;
  std::vector<Eigen::Vector3d> gyro_bias_rad_s;  ///< bias in force at each sample
  std::vector<Eigen::Vector3d> accel_bias_m_s2;
  /// The sensing elements (sim/imu/elements.hpp): three rows of the matrix M, which the rail acts behind; empty:
  /// upright.
  std::vector<Eigen::Vector3d> gyro_elements, accel_elements;
  Eigen::Vector3d gyro_element_offset_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_element_offset_m_s2 = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> magnetic_field_t;  ///< true mean over the window, disturbances included
};

/// Exact lidar: parallel to LidarRecord's points.
struct LidarTruth {
  std::string name;
  Eigen::Isometry3d T_BL = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector3f> hit_W_m;
  std::vector<std::int32_t> surface_id;  ///< into Truth::surfaces; -2 the robot's own cage
};

/// What truly happened; physics samples every `period_ns` from time 0.
struct Truth {
  std::int64_t period_ns = 500000;
  std::vector<Eigen::Vector3d> p_WB_m;
  std::vector<Eigen::Quaterniond> q_WB;
  std::vector<Eigen::Vector3d> v_WB_m_s;
  std::vector<Eigen::Vector3d> w_WB_B_rad_s;
  std::vector<Eigen::Vector3d> f_B_m_s2;  ///< specific force at the centre of mass, mean over the step that ends here
  std::vector<ContactLabel> label;
  std::vector<ContactTruth> contacts;                ///< in time order; several or none per physics sample
  Eigen::Vector3d p_BG_m = Eigen::Vector3d::Zero();  ///< geometric centre in B (sphere)
  std::vector<std::string> surfaces;                 ///< name of surface id i: "terrain", "rock_3", "trunk_7"
  std::vector<ImuTruth> imus;                        ///< in the order of Sensors::imus
  std::vector<LidarTruth> lidars;
};

/// A simulated recording.
struct Recording {
  Sensors sensors;
  Truth truth;
};

}  // namespace tumble::sim
