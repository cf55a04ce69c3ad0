// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/mapping/detail/registration.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::baselines {

/// RigidOdometry deskews each sweep once with the predicted motion and corrects only the pose at the end of the sweep.
/// RigidOdometry neglects errors of the lidar's mounting and clock, and does not recover after a tracking failure. If
/// the registration of a sweep fails, RigidOdometry inserts the sweep into the map at the predicted pose, as in most
/// published methods.
class RigidOdometry {
 public:
  struct Params {
    Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in the axes of `Motion`
    double range_min_m = 0.3;
    double range_max_m = 100.0;
    Eigen::AlignedBox3d own_body_L;  ///< points inside belong to the robot
    double sweep_voxel_m = 0.25;     ///< one point per voxel is registered
    double map_voxel_m = 0.5;
    double map_spacing_m = 0.1;
    double degenerate_sigma_m = 0.15;  ///< same value as in LidarInertialOdometry
    Registration::Params registration;
  };

  struct Motion {
    MotionState start;                  ///< state at or before the sweep's start
    std::vector<MotionSample> samples;  ///< from the start to the sweep's end
    double gravity_m_s2 = 0.0;          ///< gravity in the specific force of `samples`
    Eigen::Matrix<double, 9, 9> end_covariance = Eigen::Matrix<double, 9, 9>::Zero();
  };

  explicit RigidOdometry(const Params& params);

  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, const Motion& motion,
                   LidarInertialOdometry::SweepResult& report);

  const MotionState& state() const { return state_; }

 private:
  void place(const Eigen::Isometry3d& T_WI);
  void register_points(LidarInertialOdometry::SweepResult& report);
  void extend_map(bool has_ring_numbers, LidarInertialOdometry::SweepResult& report);
  void describe(const SweepTrajectory& trajectory, LidarInertialOdometry::SweepResult& report) const;

  Params params_;
  MotionState predicted_, state_;
  VoxelMap map_;
  std::uint32_t sweeps_ = 0;  ///< number of sweeps in the map
  mapping::ScanLines scan_lines_;
  Registration registration_;
  SweepSampler sampler_;
  std::vector<SweepPoint> points_, chosen_;
  std::vector<Eigen::Vector3f> positions_m_;
  std::vector<std::uint32_t> chosen_index_;
};

}  // namespace tumble::baselines
