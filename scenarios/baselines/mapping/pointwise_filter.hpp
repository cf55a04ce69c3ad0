// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <span>
#include <vector>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/deskew.hpp"
#include "tumble/mapping/detail/map_drawing.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/voxel_map.hpp"

namespace tumble::baselines {

/// Estimates motion and map from lidar and IMU with a filter that processes each lidar point at the point's own time
/// (the method of Point-LIO, He et al., 2023). Angular velocity and specific force are random walks that the IMU
/// measures. Each point measures its distance to a plane of the map. Readings of clipped axes are ignored.
///
/// The error state contains position, attitude and velocity in W, and angular velocity and specific force in IMU axes.
/// The filter applies each IMU reading at the middle of its averaging window. The caller subtracts known biases.
/// Biases, gravity, mounting and clock offset are not part of the state, and updates are not iterated.
class PointwiseFilter {
 public:
  struct Params {
    Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();
    double gravity_m_s2 = 9.80665;
    double range_min_m = 0.3;
    double range_max_m = 100.0;
    Eigen::AlignedBox3d own_body_L;  ///< returns inside belong to the robot; an empty box keeps all
    double sweep_voxel_m = 0.25;     ///< one point per voxel of a sweep updates the state
    double map_voxel_m = 0.5;
    double map_spacing_m = 0.1;
    int neighbours = 8;  ///< for the plane fit
    double match_distance_m = 1.0;
    /// Densities of the random walks, equal to the square roots of the authors' values 1000 and 500.
    double rate_walk_rad_s_sqrt_s = 31.6;
    double force_walk_m_s2_sqrt_s = 22.4;
    double gyro_sigma_rad_s = 0.02;  ///< per reading
    double accel_sigma_m_s2 = 0.1;   ///< per reading
    double plane_sigma_m = 0.03;     ///< of a point's distance
    std::size_t updates_min = 50;    ///< accepted points; a sweep with fewer is rejected

    /// Visits every parameter with its name, unit and limits.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.0, 100.0, "strength of gravity"});
      visit(p.range_min_m, {"range_min_m", "m", 0.0, 10.0, "returns nearer than this are dropped"});
      visit(p.range_max_m, {"range_max_m", "m", 0.0, 1e4, "returns farther than this are dropped"});
      visit(p.own_body_L.min(), {"own_body_min_m", "m", -kUnbounded, kUnbounded,
                                 "smallest corner of the box around the robot's own returns, lidar axes"});
      visit(p.own_body_L.max(), {"own_body_max_m", "m", -kUnbounded, kUnbounded,
                                 "largest corner of the box around the robot's own returns, lidar axes"});
      visit(p.sweep_voxel_m, {"sweep_voxel_m", "m", 0.01, 10.0,
                              "edge of the voxel from which one point per sweep updates the state", Rank::first});
      visit(p.map_voxel_m, {"map_voxel_m", "m", 0.01, 100.0, "edge of a voxel of the map's hash table"});
      visit(p.map_spacing_m,
            {"map_spacing_m", "m", 0.0, 100.0, "edge of the cube that stores at most one map point; 0: store all"});
      visit(p.neighbours, {"neighbours", "1", 3, 32, "number of map points per plane fit"});
      visit(p.match_distance_m,
            {"match_distance_m", "m", 1e-3, 4.0, "largest distance between a point and its matches in the map"});
      visit(p.rate_walk_rad_s_sqrt_s,
            {"rate_walk_rad_s_sqrt_s", "rad/s/sqrt(s)", 1e-9, 1e6, "random walk of the rate", Rank::first});
      visit(p.force_walk_m_s2_sqrt_s,
            {"force_walk_m_s2_sqrt_s", "m/s^2/sqrt(s)", 1e-9, 1e6, "random walk of the specific force", Rank::first});
      visit(p.gyro_sigma_rad_s,
            {"gyro_sigma_rad_s", "rad/s", 1e-9, 1e3, "standard deviation of a gyro reading", Rank::first});
      visit(p.accel_sigma_m_s2,
            {"accel_sigma_m_s2", "m/s^2", 1e-9, 1e3, "standard deviation of an accelerometer reading", Rank::first});
      visit(p.plane_sigma_m,
            {"plane_sigma_m", "m", 1e-9, 10.0, "standard deviation of a point's distance to its plane", Rank::first});
      visit(p.updates_min,
            {"updates_min", "1", 0, 1e9, "least number of accepted points per sweep; a sweep with fewer is rejected"});
    }
  };
  static constexpr int kErrors = 15;

  /// `q_WI` is the attitude at the initial rest. The initial position is the origin of W.
  PointwiseFilter(const Params& params, const Eigen::Quaterniond& q_WI);

  /// Adds an IMU sample; samples must be added in time order. Bit j of `clipped` marks gyro axis j; bit 3 + j marks
  /// accelerometer axis j. Errors: `time_order`, `non_finite`.
  Status add_imu(const ImuSample& sample, unsigned clipped);

  /// Processes a sweep. The IMU samples up to the end of the sweep must be added before. The errors are those of
  /// LidarInertialOdometry::add_sweep.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points,
                   LidarInertialOdometry::SweepReport& report);

  std::vector<MapPoint> map() const;

 private:
  using Matrix = Eigen::Matrix<double, kErrors, kErrors>;
  using Vector = Eigen::Matrix<double, kErrors, 1>;
  struct Reading {
    TimeNs middle_ns, end_ns;
    Eigen::Vector3d rate_rad_s, force_m_s2;
    unsigned clipped;
  };

  void advance(TimeNs to_ns);
  void update(const Vector& row, double residual, double variance);
  void take(const Reading& reading);
  bool take(const SweepPoint& point);
  void take_points(TimeNs start_ns, TimeNs end_ns, LidarInertialOdometry::SweepReport& report);
  PoseState pose() const;

  Params params_;
  TimeNs time_ns_ = 0;
  bool started_ = false;
  Eigen::Vector3d p_m_ = Eigen::Vector3d::Zero(), v_m_s_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WI_;
  Eigen::Vector3d w_rad_s_ = Eigen::Vector3d::Zero(), f_m_s2_;
  Matrix P_ = Matrix::Zero();
  std::deque<Reading> readings_;
  TimeNs last_imu_ns_ = 0;
  TimeNs window_end_ns_ = 0;  // of the last processed reading
  bool has_imu_ = false;
  VoxelMap map_;
  std::vector<Eigen::Vector3f> seen_from_W_m_;
  mapping::ScanLines scan_lines_;
  SweepSampler sampler_;
  std::vector<SweepPoint> points_;
  std::vector<Eigen::Vector3f> positions_m_;
  std::vector<std::uint32_t> chosen_;
};

}  // namespace tumble::baselines
