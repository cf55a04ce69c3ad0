// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/detail/map_drawing.hpp"
#include "tumble/mapping/detail/registration.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::baselines {

/// RigidOdometry deskews each sweep once with the predicted motion and corrects only the pose at the end of the sweep.
/// RigidOdometry neglects mounting errors and clock offsets, and does not recover after a tracking failure.
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
    /// If true, sweeps whose registration failed are inserted into the map at their predicted pose, as in most
    /// published methods.
    bool extend_always = true;
    double degenerate_sigma_m = 0.15;  ///< as in LidarInertialOdometry
    Registration::Params registration;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.range_min_m, {"range_min_m", "m", 0.0, 10.0, "minimum range; nearer returns are dropped"});
      visit(p.range_max_m, {"range_max_m", "m", 0.0, 1e4, "maximum range; farther returns are dropped"});
      visit(p.own_body_L.min(),
            {"own_body_min_m", "m", -kUnbounded, kUnbounded,
             "minimum corner of a box around the robot, lidar axes; returns inside the box are dropped"});
      visit(p.own_body_L.max(),
            {"own_body_max_m", "m", -kUnbounded, kUnbounded,
             "maximum corner of a box around the robot, lidar axes; returns inside the box are dropped"});
      visit(p.sweep_voxel_m, {"sweep_voxel_m", "m", 0.01, 10.0,
                              "edge length of the voxels; one point per voxel and sweep is registered, so a larger "
                              "value is faster and coarser",
                              ParameterRank::common_use});
      visit(p.map_voxel_m, {"map_voxel_m", "m", 0.01, 100.0, "edge length of a voxel of the map's hash table",
                            ParameterRank::common_use});
      visit(p.map_spacing_m, {"map_spacing_m", "m", 0.0, 100.0,
                              "edge length of the cube that stores at most one map point; a larger value makes the map "
                              "smaller and coarser",
                              ParameterRank::common_use});
      visit(p.extend_always,
            boolean_field("extend_always", "1: extend the map with sweeps that could not be registered"));
      visit(p.degenerate_sigma_m,
            {"degenerate_sigma_m", "m", 1e-6, 1e3,
             "a sweep counts as degenerate if the surfaces alone determine its pose with a standard deviation above "
             "this value"});
      visit.group("", p.registration);
    }
  };

  struct Motion {
    MotionState start;                  ///< state at or before the sweep's start
    std::vector<MotionSample> samples;  ///< from the start to the sweep's end
    double gravity_m_s2 = 0.0;          ///< gravity in the specific force of `samples`
    Eigen::Matrix<double, 9, 9> end_covariance = Eigen::Matrix<double, 9, 9>::Zero();
  };

  explicit RigidOdometry(const Params& params);

  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points, const Motion& motion,
                   LidarInertialOdometry::SweepReport& report);

  const MotionState& predicted() const { return predicted_; }
  const MotionState& state() const { return state_; }

  std::vector<MapPoint> map() const;

 private:
  void place(const Eigen::Isometry3d& T_WI);
  void register_points(LidarInertialOdometry::SweepReport& report);
  void extend_map(bool has_ring_numbers, LidarInertialOdometry::SweepReport& report);
  void describe(const SweepTrajectory& trajectory, LidarInertialOdometry::SweepReport& report) const;

  Params params_;
  MotionState predicted_, state_;
  VoxelMap map_;
  std::vector<Eigen::Vector3f> seen_from_W_m_;
  mapping::ScanLines scan_lines_;
  Registration registration_;
  SweepSampler sampler_;
  std::vector<SweepPoint> points_, chosen_;
  std::vector<Eigen::Vector3f> positions_m_;
  std::vector<std::uint32_t> chosen_index_;
};

}  // namespace tumble::baselines
