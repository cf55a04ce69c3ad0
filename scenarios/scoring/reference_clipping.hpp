// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Which readings of a real gyro are clipped, told by the readings and by a reference of the rate. Independent of any
/// estimator's own detection.
namespace tumble::scenarios {

/// A rail of one axis j and sign s, a tilted plane in the readings: s y_j = rail + slopes . (the other two axes, in
/// order). Elements clip along axes of their own, not quite orthogonal, before a device's calibration: hence the tilt.
struct ReferenceRail {
  bool found = false;
  double rail_rad_s = 0.0;
  Eigen::Vector2d slopes = Eigen::Vector2d::Zero();
};

/// Definition. Of the samples whose reading lies within 5 % of the axis' extreme of that sign and whose reference is
/// known, those count for a rail whose reference lies beyond the reading by more than 2 % of it and more than four
/// times the median size of reading minus reference on that axis; there is a rail where these are five at least and
/// half of all. Its plane is fitted to them by least squares, slopes with a prior of 0 +- 0.03 against a spread of 0.02
/// rad/s, twice, the second time to those within 2 % of the first plane. Axis j of a sample is clipped where reading
/// and reference both lie at or beyond 0.98 of the plane. A reference that is NaN makes a sample unknown: no axis.
/// `reading` and `reference` are parallel, in the IMU's axes [rad/s]. O(N).
std::array<ReferenceRail, 6> reference_rails(std::span<const Eigen::Vector3d> reading,
                                             std::span<const Eigen::Vector3d> reference);

/// Bit j: axis j is clipped, of each sample.
std::vector<std::uint8_t> clipped_by_reference(std::span<const Eigen::Vector3d> reading,
                                               std::span<const Eigen::Vector3d> reference);

}  // namespace tumble::scenarios
