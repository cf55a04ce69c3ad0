// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/mapping/calibration.hpp"
#include "tumble/mapping/detail/spatial_hash.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"

namespace tumble {

/// A usable lidar return in the IMU's axes at the time of its firing.
struct SweepPoint {
  Eigen::Vector3f x_I_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f x_L_m = Eigen::Vector3f::Zero();  ///< position as measured, so that the mounting can be refined
  float t_s = 0.0f;                                 ///< time after the start of the trajectory, in the IMU's clock
  float sweep_t_s = 0.0f;                           ///< time after the start of the sweep
  float range_m = 0.0f;                             ///< distance from the lidar
  std::uint16_t ring = 0;
};

/// Limits of range and position for usable returns.
struct PointBounds {
  double range_min_m = 0.3;
  double range_max_m = 100.0;
  Eigen::AlignedBox3d own_body_L;  ///< returns inside hit the robot itself; an empty box keeps all
};

/// Counts of the returns of a sweep.
struct PointCounts {
  std::size_t received = 0;
  std::size_t finite = 0;  ///< returns with finite coordinates; misses may be stored as NaN
  std::size_t used = 0;
  bool rings_differ = false;  ///< false if the device does not report ring numbers
};

/// Selects the usable returns of a sweep and transforms them to the IMU's axes. `sweep_start_s` is the start of the
/// sweep relative to the trajectory's start.
PointCounts select_points(std::span<const LidarPoint> points, const PointBounds& bounds, const Eigen::Isometry3d& T_IL,
                          double sweep_start_s, std::vector<SweepPoint>& selected);

/// Recomputes the points for another calibration, with times that are `later_s` later in the IMU's clock. `moved` must
/// not be `points`. Cost: O(n).
void apply_calibration(const SweepCalibration& calibration, double later_s, std::span<const SweepPoint> points,
                       std::vector<SweepPoint>& moved);
/// Recomputes the points in place for another calibration, with times that are `later_s` later in the IMU's clock.
void apply_calibration(const SweepCalibration& calibration, double later_s, std::span<SweepPoint> points);

/// Computes the lever arm vectors u_i = S(t_i) + R(t_i) x_i of SweepTrajectory. Point i in the world is
/// trajectory.base_m(t_i) + u_i. Cost: O(n).
void compute_levers(const SweepTrajectory& trajectory, std::span<const SweepPoint> points,
                    std::vector<Eigen::Vector3f>& levers_W_m);

/// Transforms points to the IMU's axes at `target_s` after the trajectory's start, usually its end. Each point is moved
/// from the time of its firing, so the result is what a stationary sensor would measure at `target_s`.
void deskew(const SweepTrajectory& trajectory, std::span<const SweepPoint> points, double target_s,
            std::vector<Eigen::Vector3f>& positions_I_m);

/// Keeps the first point in each cube of edge `voxel_m` in the world. The kept points have an even density, and few
/// points need to be registered.
class SweepSampler {
 public:
  /// Writes the indices of the kept points of `positions_W_m` to `chosen`, in order.
  void choose(std::span<const Eigen::Vector3f> positions_W_m, double voxel_m, std::vector<std::uint32_t>& chosen);

 private:
  SpatialHash seen_{1 << 14};
};

}  // namespace tumble
