// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/mapping/calibration.hpp"
#include "tumble/mapping/detail/spatial_hash.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/lidar.hpp"

namespace tumble {

/// SweepPoint is a usable lidar return in IMU axes at the time when the laser fired.
struct SweepPoint {
  Eigen::Vector3f x_I_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f point_L_m = Eigen::Vector3f::Zero();  ///< measured position, in lidar axes
  float t_s = 0.0f;           ///< firing time after the start of the trajectory, in the IMU's clock
  float sweep_time_s = 0.0f;  ///< firing time after the start of the sweep
  float range_m = 0.0f;       ///< distance from the lidar
  std::uint16_t ring = 0;
};

/// PointBounds limits the range and position of usable lidar returns.
struct PointBounds {
  double range_min_m = 0.3;
  double range_max_m = 100.0;
  Eigen::AlignedBox3d own_body_L;  ///< returns inside this box hit the robot; an empty box keeps all returns
};

/// PointCounts contains the numbers of received and usable lidar returns of a sweep.
struct PointCounts {
  std::size_t received = 0;
  std::size_t finite = 0;  ///< number of returns with finite coordinates; a laser pulse without a return may be NaN
  std::size_t used = 0;
  bool has_ring_numbers = false;  ///< false if the device does not report ring numbers
};

/// Selects the usable lidar returns of a sweep and transforms them to IMU axes. The argument `sweep_start_s` is the
/// start of the sweep relative to the start of the trajectory.
PointCounts select_points(std::span<const LidarPoint> points, const PointBounds& bounds, const Eigen::Isometry3d& T_IL,
                          double sweep_start_s, std::vector<SweepPoint>& selected);

/// Recomputes `points` for another calibration and writes the result to `moved`. Cost: O(n). The function adds
/// `later_s` to the times of the points in the IMU's clock. The arguments `points` and `moved` must be different
/// objects.
void apply_calibration(const SweepCalibration& calibration, double later_s, std::span<const SweepPoint> points,
                       std::vector<SweepPoint>& moved);
/// Recomputes `points` for another calibration in place, like the function above.
void apply_calibration(const SweepCalibration& calibration, double later_s, std::span<SweepPoint> points);

/// Computes the lever arm vector u_i = S(t_i) + R(t_i) x_i of SweepTrajectory for each point i. Cost: O(n). The
/// position of point i in the world is trajectory.common_position_m(t_i) + u_i.
void compute_lever_arm_vectors(const SweepTrajectory& trajectory, std::span<const SweepPoint> points,
                               std::vector<Eigen::Vector3f>& levers_W_m);

/// Transforms the points of a sweep to IMU axes at the time `target_s`, usually the end of the trajectory. The time
/// `target_s` is relative to the start of the trajectory. The deskewed points equal the points that a stationary sensor
/// would measure at the time `target_s`.
void deskew(const SweepTrajectory& trajectory, std::span<const SweepPoint> points, double target_s,
            std::vector<Eigen::Vector3f>& positions_I_m);

/// SweepSampler keeps the first point in each cube of edge `voxel_m` in the world. The registration needs fewer points
/// if their density is even.
class SweepSampler {
 public:
  /// Writes the indices of the kept points to `chosen`, in increasing order.
  void choose(std::span<const Eigen::Vector3f> positions_W_m, double voxel_m, std::vector<std::uint32_t>& chosen);

 private:
  SpatialHash occupied_voxels_{1 << 14};
};

}  // namespace tumble
