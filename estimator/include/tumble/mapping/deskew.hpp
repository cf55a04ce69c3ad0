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

/// A lidar return that is used: in the IMU's axes at its own instant.
struct SweepPoint {
  Eigen::Vector3f x_I_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f x_L_m = Eigen::Vector3f::Zero();  ///< as measured, so that the mounting can be refined
  float t_s = 0.0f;                                 ///< after the start of the trajectory, by the IMU's clock
  float sweep_t_s = 0.0f;                           ///< after the start of the sweep
  float range_m = 0.0f;                             ///< from the lidar
  std::uint16_t ring = 0;
};

/// Which returns are used.
struct PointBounds {
  double range_min_m = 0.3;
  double range_max_m = 100.0;
  Eigen::AlignedBox3d own_body_L;  ///< returns inside are the robot's own; an empty box keeps all
};

/// What was found on the way.
struct PointCounts {
  std::size_t given = 0;
  std::size_t finite = 0;  ///< returns with finite coordinates; misses may be stored as NaN
  std::size_t used = 0;
  bool rings_differ = false;  ///< false when the device does not tell its rings
};

/// Takes the usable returns of a sweep into the IMU's axes. `sweep_start_s` is the sweep's start after the
/// trajectory's.
PointCounts select_points(std::span<const LidarPoint> points, const PointBounds& bounds, const Eigen::Isometry3d& T_IL,
                          double sweep_start_s, std::vector<SweepPoint>& selected);

/// The same points under another calibration, `later_s` later by the IMU's clock. `moved` may not be `points`. O(n).
void apply_calibration(const SweepCalibration& calibration, double later_s, std::span<const SweepPoint> points,
                       std::vector<SweepPoint>& moved);
/// The same in place.
void apply_calibration(const SweepCalibration& calibration, double later_s, std::span<SweepPoint> points);

/// Levers u_i = S(t_i) + R(t_i) x_i of SweepTrajectory: the point in the world is trajectory.base_m(t_i) + u_i. O(n).
void compute_levers(const SweepTrajectory& trajectory, std::span<const SweepPoint> points,
                    std::vector<Eigen::Vector3f>& levers_W_m);

/// Positions of points in the IMU's axes at `target_s` after the trajectory's start (its end, usually): what a still
/// sensor would have seen from there. Each point is moved from its own instant.
void deskew(const SweepTrajectory& trajectory, std::span<const SweepPoint> points, double target_s,
            std::vector<Eigen::Vector3f>& positions_I_m);

/// Picks one point per cube of edge `voxel_m` in the world, the first in each: even density, and few points to
/// register.
class SweepSampler {
 public:
  /// `chosen` holds indices into `positions_W_m`, in order.
  void choose(std::span<const Eigen::Vector3f> positions_W_m, double voxel_m, std::vector<std::uint32_t>& chosen);

 private:
  SpatialHash seen_{1 << 14};
};

}  // namespace tumble
