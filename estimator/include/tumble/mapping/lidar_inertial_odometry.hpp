// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/lidar.hpp"

namespace tumble {

/// What became of a sweep. Anything but `registered` means that the pose rests on the inertial prior.
enum class SweepVerdict : std::uint8_t {
  first,        ///< started the map
  registered,   ///< aligned with the map in all six directions
  degenerate,   ///< aligned where the surfaces allow it, prior elsewhere
  rejected,     ///< too few matches, or a correction beyond the bound: prior kept, map not extended
};
const char* to_string(SweepVerdict verdict);

/// Lidar-inertial odometry and mapping of a body that tumbles: integrates the IMU between sweeps, deskews each point at
/// its own time, registers the sweep to a voxel map by k-nearest-neighbour point-to-plane, and extends the map.
///
/// World: z up, origin and yaw at the IMU at the first sample, levelled by the specific force at rest.
/// Feed IMU samples in time order, then each sweep once IMU samples reach its end. No threads, no files, no printing.
class LidarInertialOdometry {
 public:
  struct Params {
    Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< lidar in IMU axes
    double gravity_m_s2 = 9.80665;
    double rest_s = 0.5;              ///< length of rest at the start used to level the attitude; bound (0, 60]
    double range_min_m = 0.3;         ///< nearer returns are dropped; bound [0, 10]
    double range_max_m = 100.0;       ///< farther returns are dropped
    Eigen::AlignedBox3d own_body_L{Eigen::Vector3d(-0.5, -0.4, -0.27), Eigen::Vector3d(0.5, 0.4, 0.23)};  ///< returns inside are the robot's own; an empty box keeps all
    double sweep_voxel_m = 0.25;      ///< one point per voxel of a sweep is registered; bound (0, 10]
    double map_voxel_m = 0.5;         ///< cell of the map's hash; bound (0, 10]
    double map_spacing_m = 0.05;      ///< least distance of two map points; bound [0, 1]
    int neighbours = 8;               ///< k of the plane fit; bound [3, 32]
    double match_distance_m = 1.0;    ///< farther map points are no match; bound (0, 10]
    int iterations_max = 30;          ///< bound [1, 200]
    double correction_max_m = 15.0;   ///< a larger correction of the prior is rejected
    double correction_max_rad = 1.1;  ///< a larger correction of the prior is rejected
    double prior_sigma_m = 0.3;       ///< prior between sweeps, per sweep
    double prior_sigma_rad = 0.1;
  };

  struct SweepReport {
    SweepVerdict verdict = SweepVerdict::rejected;
    PoseState pose;                      ///< pose and velocity of the IMU at the end of the sweep, with covariance
    std::vector<PoseState> trajectory;   ///< IMU poses inside the sweep at IMU times, corrected by the registration
    double inlier_share = 0.0;           ///< of the points registered
    double conditioning = 0.0;           ///< smallest over largest eigenvalue of the scaled normal matrix
    int iterations = 0;
  };

  explicit LidarInertialOdometry(const Params& params);
  ~LidarInertialOdometry();
  LidarInertialOdometry(LidarInertialOdometry&&) noexcept;
  LidarInertialOdometry& operator=(LidarInertialOdometry&&) noexcept;
  /// Copies carry all state: continuing from a copy gives bit-identical results.
  LidarInertialOdometry(const LidarInertialOdometry&);
  LidarInertialOdometry& operator=(const LidarInertialOdometry&);

  /// Adds a sample with the angular velocity that a rate method gave for it. On trouble the state is unchanged.
  Status add_imu(const ImuSample& sample, const RateState& rate);

  /// Registers a sweep of points fired in [start_ns, end_ns]. Trouble: `empty` (no points), `time_order`, `too_few`
  /// (IMU samples do not reach the end), `out_of_range` (an offset beyond the sweep), `non_finite`.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, SweepReport& report);

  /// The whole map so far. O(number of points).
  std::vector<MapPoint> map() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble
