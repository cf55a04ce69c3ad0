// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Function of the caller that runs body(0) to body(count - 1) once each, in any order and on any threads, and returns
/// when all calls are done. Without a ParallelFor, the calling thread does all work. Results are bit-identical for any
/// number of threads.
using ParallelFor = std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

/// Lidar return before deskewing: the position is in the axes that the lidar had when the laser fired.
struct LidarPoint {
  Eigen::Vector3f position_L_m = Eigen::Vector3f::Zero();
  float intensity = 0.0f;       ///< 0 to 1
  std::uint32_t offset_ns = 0;  ///< firing time after the start of the sweep
  std::uint16_t ring = 0;       ///< number of the laser, from bottom to top, or of the scan line
};

/// Point of the map in world axes.
struct MapPoint {
  Eigen::Vector3f position_W_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal_W = Eigen::Vector3f::Zero();  ///< unit normal; zero if no plane could be fitted
  float sigma_m = 0.0f;                                ///< standard deviation of the position
};

/// Pose of the lidar in IMU axes, time offset between IMU and lidar, and gravity. The registration of the sweeps
/// refines the calibration. The error vector of a calibration contains rotation of T_IL, translation of T_IL, time
/// offset and gravity, in this order. The rotation error phi is a left perturbation in IMU axes: R_true = Exp(phi) R.
struct LidarImuCalibration {
  static constexpr int kErrorCount = 10;
  using Covariance = Eigen::Matrix<double, kErrorCount, kErrorCount>;

  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  /// time of an event in the IMU's clock minus time of the same event in the lidar's clock
  double imu_minus_lidar_clock_s = 0.0;
  Eigen::Vector3d gravity_W_m_s2 = Eigen::Vector3d(0.0, 0.0, -9.80665);

  void add(const Eigen::Matrix<double, kErrorCount, 1>& error);
  /// Returns the error vector whose addition to `other` gives this calibration.
  Eigen::Matrix<double, kErrorCount, 1> minus(const LidarImuCalibration& other) const;
};

/// Returns `out_of_range` if `distance_in_sigmas` (of LidarImuCalibrationPrior::distance_in_sigmas()) exceeds
/// kDistanceMax_sigmas. `out_of_range` means that the stated calibration is probably wrong.
Status check_lidar_calibration_distance(double distance_in_sigmas);

/// Calibration that the caller states, with standard deviations of the lidar's orientation (per axis), position (per
/// axis) and time offset. A standard deviation of 0 means that the stated value is exact.
struct LidarImuCalibrationPrior {
  static constexpr double kDistanceMax_sigmas = 5.0;  ///< largest plausible result of distance_in_sigmas()

  LidarImuCalibration calibration;
  double mount_sigma_rad = 0.0, mount_sigma_m = 0.0, time_offset_sigma_s = 0.0;

  /// Returns how far an estimated calibration is from the stated calibration: mapping.md (R69). The differences of
  /// rotation, translation and time offset are each divided by the stated standard deviation, and the largest of the
  /// three quotients is returned. The result is infinite if an estimated value differs from a stated value with
  /// standard deviation 0.
  double distance_in_sigmas(const LidarImuCalibration& estimated) const;
};

/// Describes the parameters for the standard deviations of the lidar's pose in IMU axes and time offset.
namespace lidar_calibration_fields {

inline constexpr ParameterInfo kMountSigmaInfo_rad{
    "mount_sigma_rad",
    "rad",
    0.0,
    1.0,
    "prior standard deviation of the lidar's orientation relative to the IMU; 0: exact, no estimate",
    ParameterAudience::common_use};
inline constexpr ParameterInfo kMountSigmaInfo_m{
    "mount_sigma_m",
    "m",
    0.0,
    1.0,
    "prior standard deviation of the lidar's position relative to the IMU; 0: exact, no estimate",
    ParameterAudience::common_use};
inline constexpr ParameterInfo kTimeOffsetSigma_s{
    "time_offset_sigma_s",
    "s",
    0.0,
    0.02,
    "prior standard deviation of the time offset between lidar and IMU; 0: no offset, no estimate",
    ParameterAudience::common_use};

}  // namespace lidar_calibration_fields

/// An odometer reading is a motion or a velocity of the robot, measured by wheels, legs, a camera or a radar. Times are
/// in the IMU's clock. The error of each odometer reading is assumed independent of all other errors. Wheel slip beyond
/// the stated uncertainty corrupts the estimate.

struct VelocityReading {
  TimeNs time_ns = 0;
  Eigen::Vector3d v_WI_I_m_s = Eigen::Vector3d::Zero();  ///< velocity in IMU axes at the reading's time
  double sigma_m_s = 0.0;                                ///< standard deviation of each axis
};

/// Measured motion of the IMU I from `from_ns` to `to_ns`. For IMU poses T_OI in a drifting odometer frame O, the
/// motion is T_OI(from)^-1 T_OI(to).
struct RelativePoseReading {
  TimeNs from_ns = 0;
  TimeNs to_ns = 0;
  Eigen::Isometry3d imu_T_from_to = Eigen::Isometry3d::Identity();
  /// Covariance of position error [m] and attitude error phi [rad], in this order, both in IMU axes at `from_ns`. The
  /// attitude error is defined by R_true = Exp(phi) R. Set a large variance for components that the odometer does not
  /// measure.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

using OdometerReading = std::variant<VelocityReading, RelativePoseReading>;

/// Measured position of an antenna or tag A on the robot, for example from GPS or beacons. The position is given in a
/// position frame P with an upward z axis, for example east, north, up. The errors of successive readings are assumed
/// independent; state a larger covariance if the errors are correlated.
struct PositionReading {
  TimeNs time_ns = 0;  ///< in the IMU's clock
  Eigen::Vector3d antenna_position_P_m = Eigen::Vector3d::Zero();
  /// Covariance of the position error in axes of P. The estimator uses only the mean of the three variances.
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  Eigen::Vector3d antenna_lever_arm_I_m = Eigen::Vector3d::Zero();  ///< position of the antenna or tag A in IMU axes
};

/// Estimated transform from the odometry frame W of the poses to the frame P of the position readings. The transform
/// compensates the drift of the odometry, so poses in the frame P do not drift.
struct PositionFrame {
  Eigen::Isometry3d T_PW = Eigen::Isometry3d::Identity();  ///< the rotation is about the vertical
  Eigen::Vector3d covariance_reference_point_W_m = Eigen::Vector3d::Zero();
  /// Covariance of the transform's error in axes of the frame P. The error vector contains the translation of
  /// `covariance_reference_point_W_m` [m], followed by the rotation about the vertical through this point [rad].
  Eigen::Matrix4d xyz_yaw_covariance_P = Eigen::Matrix4d::Zero();

  /// Converts a pose from the odometry frame W to the frame P. In the converted pose, the covariance of position and
  /// heading comes from PositionFrame::xyz_yaw_covariance_P, and the covariance of the tilt comes from `in_W`.
  PoseState transform(const PoseState& in_W) const;
};

/// Map of an earlier run, in which a new run localises the robot. The z axis of the map frame M points upwards.
struct PriorMap {
  std::vector<MapPoint> points = {};  ///< points with normals, in the map frame M; to_map_points() computes normals
  /// Start pose of the IMU in the map frame M, if known; only position and heading are used. If the start pose is
  /// unknown, the run may start anywhere in the map.
  std::optional<Eigen::Isometry3d> start_T_MI = std::nullopt;
  double start_position_sigma_m = 0.0;   ///< standard deviation of the position of start_T_MI per axis; 0: exact
  double start_heading_sigma_rad = 0.0;  ///< standard deviation of the heading of start_T_MI; 0: exact
  /// If `extend` is true, sweeps add points to the map, and remove points through which beams pass. If `extend` is
  /// false, the map is constant.
  bool extend = true;
};

/// Returns `non_finite` if a number is NaN or infinite. Returns `out_of_range` for a negative standard deviation, a
/// normal that is neither zero nor a unit vector, or a coordinate beyond 50 km. Otherwise returns `ok`.
Status check_map_points(std::span<const MapPoint> points);
/// Returns `ok`, an error of check_map_points(), or `insufficient_data` if fewer than 100 points have a normal. Returns
/// `non_finite` or `out_of_range` if the start pose or a standard deviation is invalid.
Status check_prior_map(const PriorMap& map);

/// Converts positions, for example of a PCD or PLY file, to map points with normals. The result contains at most one
/// point per cube of 0.1 m, and no positions that are NaN or infinite. The sign of a computed normal is arbitrary.
/// `sigma_m` is the standard deviation of each position. Cost: O(points).
std::vector<MapPoint> to_map_points(std::span<const Eigen::Vector3f> positions_M_m, float sigma_m = 0.02f);

/// SweepVerdict states whether the pose of a sweep comes from the registration or from the inertial prediction. If a
/// `degenerate` sweep has an eigenvalue_ratio of 0, the whole pose comes from the inertial prediction.
enum class SweepVerdict : std::uint8_t {
  first,       ///< the sweep started the map
  registered,  ///< all six degrees of freedom were aligned with the map
  degenerate,  ///< directions that no surface constrains come from the inertial prediction
  rejected,    ///< too few matches or too large a correction; the pose is the inertial prediction
};
const char* to_string(SweepVerdict verdict);

/// Result of one sweep: poses of the IMU with covariance, and the quality of the registration.
struct SweepResult {
  SweepVerdict verdict = SweepVerdict::rejected;
  PoseState pose;  ///< pose and velocity of the IMU at the end of the sweep, with covariance
  /// covariance of the velocity in IMU axes at the end of the sweep [m^2/s^2]
  Eigen::Matrix3d velocity_covariance_I_m2_s2 = Eigen::Matrix3d::Zero();
  std::vector<PoseState> trajectory;  ///< IMU poses within the sweep, corrected by the registration
  /// Final poses of the oldest sweep in the window of the fixed-lag smoother. Later sweeps do not change the final
  /// poses. `final_poses_of_earlier_sweep` is empty until `window_sweeps` sweeps have arrived. If `window_sweeps` is 2
  /// (the default), `final_poses_of_earlier_sweep` contains the final poses of the sweep before this sweep.
  std::vector<PoseState> final_poses_of_earlier_sweep;
  double inlier_ratio = 0.0;  ///< fraction of the registered points that are inliers
  /// ratio of the smallest to the largest eigenvalue of the pose's scaled information matrix
  double eigenvalue_ratio = 0.0;
  /// Standard deviation of the pose in the least constrained direction, from the lidar points alone. A value of 0 means
  /// that the sweep was not aligned.
  double least_constrained_sigma_m = 0.0;
  /// Normalised innovation sqrt(d' P^-1 d / 9). The vector d contains the registration's nine corrections of predicted
  /// position, attitude and velocity, and P is their predicted covariance. With correct covariances, the mean of
  /// `normalised_innovation` is at most 1. A value of 0 means that the sweep was not aligned.
  double normalised_innovation = 0.0;
  /// Standard deviation of the position relative to the nearby map points. The covariance of `pose` also includes the
  /// map's drift and tilt, which grow with the travelled distance.
  double position_in_map_sigma_m = 0.0;
  int iterations = 0;
  int consecutive_rejected_sweeps = 0;  ///< consecutive rejected sweeps, including the current sweep
  /// True after a relocalisation that disagrees with the inertial prediction or fits the map poorly, until two further
  /// sweeps confirm the new pose. If a sweep contradicts the new pose, the odometry returns to the pose of the inertial
  /// prediction.
  bool relocalisation_unconfirmed = false;
  /// Direction in which the lidar constrains the pose least: unit vector of three position and three attitude
  /// components, in world axes. The attitude components are angles, multiplied by the root-mean-square distance of the
  /// points from the IMU, so all six components are lengths.
  Eigen::Matrix<double, 6, 1> least_constrained_pose_direction_W = Eigen::Matrix<double, 6, 1>::Zero();
  /// Mean saturation deficit during the sweep, in IMU axes: angular velocity that the registration estimates on clipped
  /// gyro axes, minus the angular velocity passed to add_imu().
  Eigen::Vector3d mean_saturation_deficit_I_rad_s = Eigen::Vector3d::Zero();
  std::size_t usable_points = 0;              ///< finite returns within the range limits that do not hit the robot
  std::size_t isolated_points_dropped = 0;    ///< unused returns that no neighbouring beam confirms
  std::size_t points_after_downsampling = 0;  ///< usable points after downsampling to one point per voxel
  std::size_t map_points_added = 0;
  /// `in_prior_map` is true if the poses are in the frame of the prior map.
  bool in_prior_map = false;
};

}  // namespace tumble
