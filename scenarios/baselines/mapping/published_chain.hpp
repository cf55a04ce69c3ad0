// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "scenarios/baselines/mapping/published_imu_odometry.hpp"
#include "scenarios/baselines/mapping/trimmed_icp.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::baselines {

/// PublishedChain estimates trajectory and map from lidar sweeps, specific forces, and angular rates of another
/// estimator. PublishedChain repeats the mapping chain of the ICRA 2024 paper by Deschenes et al., with the constants
/// of the published launch files.
class PublishedChain {
 public:
  struct Params {
    Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
    Eigen::AlignedBox3d own_body_L;                          ///< points inside belong to the robot
    double skew_sigma_m_s = 0.25;
    TrimmedIcp::Params icp;
    bool late_velocity = true, voxel_averages_time = true, abort_ends_mapping = false;
    double madgwick_gain_rad_s = 0.01;
    int stamp_step_ns = 50000;
    double range_min_m = 0.2, range_max_m = 100.0;
    double sweep_voxel_m = 0.15;
    double map_spacing_m = 0.05;
    double range_sigma_m = 0.02, range_sigma_ratio = 0.0015;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.skew_sigma_m_s,
            {"skew_sigma_m_s", "m/s", 0.0, 100.0,
             "growth of a point's standard deviation with the time since the start of the sweep; 0: no growth",
             ParameterAudience::common_use});
      visit(p.late_velocity,
            boolean_parameter(
                "late_velocity",
                "1: take the mean velocity since the last sweep as the velocity at the end of the sweep, as "
                "in the launch files; 0: take it as the velocity in the middle between both sweeps",
                ParameterAudience::common_use));
      visit(p.voxel_averages_time,
            boolean_parameter("voxel_averages_time",
                              "1: average the times of the points in a voxel, as in the launch files; 0: average the "
                              "variances that follow from these times",
                              ParameterAudience::common_use));
      visit(p.abort_ends_mapping,
            boolean_parameter("abort_ends_mapping",
                              "1: a failed registration ends mapping, as in the launch files; 0: the pose of the sweep "
                              "comes from odometry only",
                              ParameterAudience::common_use));
      visit.group("", p.icp);
      visit(p.own_body_L.min(),
            {"own_body_min_m", "m", -kUnbounded, kUnbounded,
             "minimum corner of a box around the robot, lidar axes; returns inside the box are dropped"});
      visit(p.own_body_L.max(),
            {"own_body_max_m", "m", -kUnbounded, kUnbounded,
             "maximum corner of a box around the robot, lidar axes; returns inside the box are dropped"});
      visit(p.madgwick_gain_rad_s, {"madgwick_gain_rad_s", "rad/s", 0.0, 10.0, "gain of the Madgwick attitude filter"});
      visit(p.stamp_step_ns, {"stamp_step_ns", "ns", 1, 1000000,
                              "time step to which point times are rounded down before the pose lookup"});
      visit(p.range_min_m, {"range_min_m", "m", 0.0, 10.0, "minimum range; nearer returns are dropped"});
      visit(p.range_max_m, {"range_max_m", "m", 0.0, 1e4, "maximum range; farther returns are dropped"});
      visit(p.sweep_voxel_m, {"sweep_voxel_m", "m", 0.01, 10.0,
                              "edge length of the voxels; the points in a voxel are averaged before registration"});
      visit(p.map_spacing_m,
            {"map_spacing_m", "m", 0.0, 10.0, "minimum distance between a new map point and the existing map"});
      visit(p.range_sigma_m, {"range_sigma_m", "m", 1e-6, 10.0, "minimum standard deviation of a range"});
      visit(p.range_sigma_ratio,
            {"range_sigma_ratio", "1", 0.0, 1.0, "standard deviation of a range, as a share of the range"});
    }
  };
  using SweepResult = LidarInertialOdometry::SweepResult;

  struct Sweep {
    TimeNs start_ns = 0, end_ns = 0;
    std::span<const LidarPoint> points;
  };

  /// `rates` contains one angular rate per IMU sample, which replaces the gyro reading of this IMU sample. The data of
  /// `samples` must outlive the PublishedChain.
  PublishedChain(const Params& params, std::span<const ImuSample> samples, std::span<const AngularRateState> rates);

  bool covers(const Sweep& sweep) const;
  /// Sweeps must be added in order of time, and `covers(sweep)` must be true. Returns `empty`, `degenerate` (all points
  /// have one time stamp) or `insufficient_data` (too few points in range) if the sweep cannot be registered.
  Status add(const Sweep& sweep, SweepResult& report);
  std::vector<MapPoint> map() const;

 private:
  bool registers(const Sweep& sweep, TimeNs at_ns, std::span<const TrimmedIcp::Point> points, SweepResult& report);
  void extend(std::span<const TrimmedIcp::Point> points, const Eigen::Isometry3d& T_WL, SweepResult& report);
  void report_poses(const Sweep& sweep, SweepResult& report);
  void feed_back(TimeNs at_ns);

  Params params_;
  std::span<const ImuSample> samples_;
  PublishedImuOdometry odometry_;
  TrimmedIcp icp_;
  VoxelMap map_{{0.5, 0.0}};
  std::vector<Eigen::Vector3f> seen_from_;
  Eigen::Isometry3d T_map_odom_ = Eigen::Isometry3d::Identity();
  bool dead_ = false;
  std::optional<TimeNs> registered_ns_;
  Eigen::Vector3d registered_m_ = Eigen::Vector3d::Zero();
};

}  // namespace tumble::baselines
