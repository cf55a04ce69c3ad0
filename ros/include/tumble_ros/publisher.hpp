// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::ros {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Odometry has the contents of nav_msgs/Odometry: frame O is the odometry frame, B the base frame (REP 105).
struct Odometry {
  TimeNs stamp_ns = 0;
  Eigen::Isometry3d T_OB = Eigen::Isometry3d::Identity();
  /// Covariance of position and of the rotation about the fixed axes of O, in the order x, y, z, rx, ry, rz [m, rad].
  Matrix6 pose_covariance = Matrix6::Zero();
  Vector6 twist_B = Vector6::Zero();  ///< velocity of B's origin and angular velocity, in axes of B [m/s, rad/s]
  Matrix6 twist_covariance = Matrix6::Zero();  ///< covariance of twist_B
};

/// RecoveredImu has the contents of sensor_msgs/Imu: an IMU sample whose angular velocity is estimated through
/// saturation. The axes of RecoveredImu are the axes of the IMU.
struct RecoveredImu {
  AngularRateState rate;
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();
  double force_variance_m2_s4 = 0.0;  ///< per axis, from the data sheet's noise density
};

/// DeskewedPoint is a return in lidar axes at the end of its sweep.
struct DeskewedPoint {
  Eigen::Vector3f position_L_m;
  float intensity = 0.0f;
};

struct DeskewedSweep {
  TimeNs stamp_ns = 0;  ///< end of the sweep
  std::vector<DeskewedPoint> points;
};

/// Diagnostics has the contents of diagnostic_msgs/DiagnosticStatus.
struct Diagnostics {
  bool ok = true;  ///< false: level WARN
  std::string message;
  std::vector<std::pair<std::string, std::string>> values;
};

/// Output lists the messages that are costly to compute. The adapter skips messages that are not needed (wants()).
enum class Output { odometry_imu, points, map };

/// Publisher receives the results of an adapter. A node converts the results to messages.
class Publisher {
 public:
  virtual ~Publisher() = default;
  /// Returns true if the output is needed.
  virtual bool wants(Output) { return true; }
  virtual void odometry(const Odometry&) = 0;      ///< pose of a registered sweep, or smoothed pose of a sphere
  virtual void odometry_imu(const Odometry&) = 0;  ///< predicted pose at the newest IMU sample
  virtual void position_pose(const Odometry&) {}   ///< pose of a registered sweep in the frame of position readings
  virtual void imu(const RecoveredImu&) {}
  virtual void points(const DeskewedSweep&) {}
  virtual void map(TimeNs, const std::vector<MapPoint>&) {}
  virtual void diagnostics(TimeNs, const Diagnostics&) = 0;
};

/// Converts a pose of the IMU to the odometry of the base frame. `rate` contains the angular velocity and its
/// covariance. The velocity includes the rotation of the lever arm from the IMU to the base.
/// @param velocity_covariance_I_m2_s2  covariance of the velocity in IMU axes (SweepResult)
/// @param T_IB                         pose of the base in IMU axes
Odometry base_odometry(const PoseState& imu, const Eigen::Matrix3d& velocity_covariance_I_m2_s2,
                       const AngularRateState& rate, const Eigen::Isometry3d& T_IB);

/// Transforms the points of a sweep to lidar axes at the end of the sweep.
/// @param trajectory    poses of the IMU within the sweep, in order of time (SweepResult::trajectory)
/// @param T_IL          pose of the lidar in IMU axes
/// @param start_ns      start of the sweep, in the clock of the trajectory
/// Cost: O(points). Between poses, the rotation rate and the velocity are constant.
void deskew(const std::vector<PoseState>& trajectory, const Eigen::Isometry3d& T_IL, TimeNs start_ns,
            const std::vector<LidarPoint>& points, std::vector<DeskewedPoint>& deskewed);

}  // namespace tumble::ros
