// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/estimates/findings.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::scenarios {

enum class Kind { rate, attitude, position, slam };
inline constexpr std::array kKinds = {Kind::rate, Kind::attitude, Kind::position, Kind::slam};
const char* to_string(Kind kind);
std::optional<Kind> kind_named(std::string_view name);
std::string full_name(Kind kind, const std::string& method);

enum class Frame { imu, lidar, body, centre };
const char* to_string(Frame frame);

/// RecordingSetting is a property of a recording, for example a range, that `tumble odometry` reports with its source.
struct RecordingSetting {
  std::string name;
  std::string value;   ///< value with the evidence for it
  std::string source;  ///< stated, measured, by name or assumed
  std::string option;  ///< changes the setting
};

struct Estimate {
  Status status;                         ///< error of the whole run, or `ok`
  Frame frame = Frame::imu;              ///< frame of `attitudes` and `poses`
  std::vector<AngularRateState> rates;   ///< kind slam: rates used for deskewing
  std::vector<AttitudeState> attitudes;  ///< for kind attitude
  std::vector<PoseState> poses;          ///< kinds position and slam, IMU times
  /// Contact mode of the sphere at each pose, or an empty vector if the method does not estimate contact modes. The
  /// contact mode `air` means no contact, or a bump (the contact point rises or falls) without slip.
  std::vector<sim::ContactLabel> contacts;
  /// For each pose, true if the pose is in a slip event whose displacement is uncertain; empty if the method does not
  /// estimate slip.
  std::vector<bool> uncertain;
  /// Position of the sphere's centre relative to the centre of mass, in body axes [m].
  Eigen::Vector3d centre_B_m = Eigen::Vector3d::Zero();
  std::vector<LidarInertialOdometry::SweepResult> sweeps;  ///< for kind slam, one per sweep
  std::vector<std::int64_t> sweep_end_ns;                  ///< parallel to `sweeps`
  std::vector<MapPoint> map;                               ///< for kind slam
  /// Pose of the lidar in body axes that the slam method estimated, if the stated pose contradicts the recording.
  std::optional<Eigen::Isometry3d> replaced_T_BL;
  SensorHealth faults;  ///< suspected faults of sensors and estimate
  /// Covariance that is added to the covariance of each angular rate because of health findings (suspected faults);
  /// empty without health findings.
  std::vector<Eigen::Matrix3d> suspect_rad2_s2;
  std::map<std::string, double> health;      ///< named counters: "rejected_samples", "sweeps_rejected"
  std::map<std::string, double> parameters;  ///< parameters that the user set by name
  std::vector<RecordingSetting> settings;    ///< settings that `tumble odometry` reports
  /// Pose of the IMU in the base frame. If set, the file trajectory.tum contains poses of the base frame; `frame` must
  /// be `imu`, and `poses` are poses of the IMU.
  std::optional<Eigen::Isometry3d> T_base_imu;
  std::string transcript;  ///< output of an external program; not scored
};

}  // namespace tumble::scenarios
