// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/spatial_hash.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Usable lidar return, in the axes that the IMU had when the laser fired.
struct SweepPoint {
  Eigen::Vector3f x_I_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f point_L_m = Eigen::Vector3f::Zero();  ///< in lidar axes
  float t_s = 0.0f;           ///< firing time after the start of the SweepTrajectory, in the IMU's clock
  float sweep_time_s = 0.0f;  ///< firing time after the start of the sweep
  float range_m = 0.0f;
  std::uint16_t ring = 0;
};

struct PointSelectionBounds {
  double range_min_m = 0.3;
  double range_max_m = 100.0;
  Eigen::AlignedBox3d
      own_body_L;  ///< bounding box of the robot in lidar axes; returns inside are dropped; may be empty
};

struct PointCounts {
  std::size_t received = 0;
  std::size_t finite = 0;  ///< number of returns with finite coordinates; a laser pulse without return may be NaN
  std::size_t usable_points = 0;
  bool has_ring_numbers = false;
};

/// Selects the usable lidar returns of a sweep and transforms each return to IMU axes. `sweep_start_s` is the start of
/// the sweep relative to the start of the SweepTrajectory.
PointCounts select_points(std::span<const LidarPoint> points, const PointSelectionBounds& bounds,
                          const Eigen::Isometry3d& T_IL, double sweep_start_s, std::vector<SweepPoint>& selected);

/// Recomputes `points` for another pose of the lidar in IMU axes, and writes the result to `moved`, which must be a
/// different object. `later_s` is added to the firing times in the IMU's clock. Cost: O(n).
void apply_calibration(const LidarImuCalibration& calibration, double later_s, std::span<const SweepPoint> points,
                       std::vector<SweepPoint>& moved);
void apply_calibration(const LidarImuCalibration& calibration, double later_s, std::span<SweepPoint> points);

/// Computes the position of each point in the world minus SweepTrajectory::gravity_free_position_m() at the firing time
/// (lever arm vector). Cost: O(n).
void compute_lever_arm_vectors(const SweepTrajectory& trajectory, std::span<const SweepPoint> points,
                               std::vector<Eigen::Vector3f>& levers_W_m);

/// Transforms the points of a sweep to the axes that the IMU has at the time `target_s` after the start of the
/// trajectory. The deskewed points equal those of a sensor that is stationary in its pose at `target_s`.
void deskew(const SweepTrajectory& trajectory, std::span<const SweepPoint> points, double target_s,
            std::vector<Eigen::Vector3f>& positions_I_m);

/// Downsamples a sweep to the first point in each cube of edge `voxel_m` in world axes.
class SweepSampler {
 public:
  /// `chosen` receives the indices of the kept points, in increasing order.
  void choose_points_per_voxel(std::span<const Eigen::Vector3f> positions_W_m, double voxel_m,
                               std::vector<std::uint32_t>& chosen);

 private:
  SpatialHash occupied_voxels_{1 << 14};
};

}  // namespace tumble

namespace tumble::mapping {

/// Returns `out_of_range` if a point was fired after the end of the sweep, which takes `span_ns`.
Status check_time_offsets(TimeNs span_ns, std::span<const LidarPoint> points);

/// Returns `empty` (no points), `non_finite` (no finite point), `insufficient_data` (no point in range) or `degenerate`
/// (all points have one time stamp, although the sweep has a duration).
Status check_point_selection(TimeNs span_ns, std::span<const LidarPoint> points, const PointCounts& counts);

}  // namespace tumble::mapping

namespace tumble {

/// Returns `non_finite` if a number is not finite. Returns `out_of_range` if a standard deviation is not above 0, a
/// covariance is not positive definite, or a rotation matrix is not orthonormal. Returns `time_order` if a motion ends
/// before or at its start.
Status check_odometer_reading(const OdometerReading& reading);
TimeNs reading_start_ns(const OdometerReading& reading);
TimeNs reading_end_ns(const OdometerReading& reading);

}  // namespace tumble
