// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/mapping/detail/spatial_hash.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Usable lidar return in IMU axes at the time when the laser fired.
struct SweepPoint {
  Eigen::Vector3f x_I_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f point_L_m = Eigen::Vector3f::Zero();  ///< measured position, in lidar axes
  float t_s = 0.0f;           ///< firing time after the start of the trajectory, in the IMU's clock
  float sweep_time_s = 0.0f;  ///< firing time after the start of the sweep
  float range_m = 0.0f;       ///< distance from the lidar
  std::uint16_t ring = 0;
};

struct PointSelectionBounds {
  double range_min_m = 0.3;
  double range_max_m = 100.0;
  Eigen::AlignedBox3d own_body_L;  ///< bounding box of the robot's own body, whose returns are dropped; may be empty
};

struct PointCounts {
  std::size_t received = 0;
  std::size_t finite = 0;  ///< number of returns with finite coordinates; a laser pulse without a return may be NaN
  std::size_t usable_points = 0;
  bool has_ring_numbers = false;  ///< false if the device does not report ring numbers
};

/// Selects the usable lidar returns of a sweep and transforms them to IMU axes. `sweep_start_s` is the start of the
/// sweep relative to the start of the trajectory.
PointCounts select_points(std::span<const LidarPoint> points, const PointSelectionBounds& bounds,
                          const Eigen::Isometry3d& T_IL, double sweep_start_s, std::vector<SweepPoint>& selected);

/// Recomputes `points` for another calibration and writes the result to `moved`, which must be a different object.
/// `later_s` is added to the times of the points in the IMU's clock. Cost: O(n).
void apply_calibration(const LidarImuCalibration& calibration, double later_s, std::span<const SweepPoint> points,
                       std::vector<SweepPoint>& moved);
void apply_calibration(const LidarImuCalibration& calibration, double later_s, std::span<SweepPoint> points);

/// Computes the lever arm vector of each point: the position of the point in the world minus
/// SweepTrajectory::gravity_free_position_m() at the time of the point. Cost: O(n).
void compute_lever_arm_vectors(const SweepTrajectory& trajectory, std::span<const SweepPoint> points,
                               std::vector<Eigen::Vector3f>& levers_W_m);

/// Transforms the points of a sweep to IMU axes at the time `target_s` after the start of the trajectory. The deskewed
/// points equal the points that a stationary sensor would measure at `target_s`.
void deskew(const SweepTrajectory& trajectory, std::span<const SweepPoint> points, double target_s,
            std::vector<Eigen::Vector3f>& positions_I_m);

/// Reduces a sweep to points of even density: the first point in each cube of edge `voxel_m` in the world.
class SweepSampler {
 public:
  /// `chosen` receives the indices of the kept points, in increasing order.
  void choose_points_per_voxel(std::span<const Eigen::Vector3f> positions_W_m, double voxel_m,
                               std::vector<std::uint32_t>& chosen);

 private:
  SpatialHash occupied_voxels_{1 << 14};
};

}  // namespace tumble
