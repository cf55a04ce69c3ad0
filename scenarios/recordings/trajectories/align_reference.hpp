// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// Alignment of an optical reference with the IMU in time and rotation. Private to scenarios/recordings.
namespace tumble::scenarios {

/// w_I(t) = R_IV w_V(t + delay), where V is the reference's body frame. `R_WV` levels the reference's world. The
/// uncertainties are standard deviations from eight parts of the recording, estimated separately; errors common to all
/// parts are not included.
struct ReferenceAlignment {
  bool known = false;  ///< false: too little rotation while the gyro is unsaturated, or too few reference poses
  double delay_s = 0.0, delay_sigma_s = 0.0;
  Eigen::Quaterniond q_IV = Eigen::Quaterniond::Identity();
  Eigen::Vector3d q_IV_sigma_rad = Eigen::Vector3d::Zero();  ///< about the axes of I
  Eigen::Quaterniond q_WV = Eigen::Quaterniond::Identity();
  std::size_t samples = 0;  ///< number of unsaturated samples used
  std::string text() const;
};

/// Estimates the delay by cross-correlation of |w| within +-0.1 s, then by robust least squares (outliers beyond three
/// times the median). The rotation solves Wahba's problem over two kinds of pairs: rates at unsaturated samples, and
/// specific force against the reference's gravity, weighted by how close its size is to gravity. Rates alone do not
/// determine the rotation about a single rotation axis.
///
/// A sample is unsaturated if every gyro axis is below 0.9 of its extreme. Gravity in the reference's world is the mean
/// specific force, assuming that the body ends with about its initial position and speed. Wahba, SIAM Review 7(3),
/// 1965; solved by singular values (Markley, J. Astronautical Sciences 36(3), 1988). O(N) with about fifty passes.
ReferenceAlignment align_reference(const std::vector<ReferencePose>& poses, const sim::ImuRecord& imu);

/// Removes delay, rotation and tilt: converts the poses to the IMU, in its clock and a level world.
void apply(const ReferenceAlignment& alignment, std::vector<ReferencePose>& poses);

}  // namespace tumble::scenarios
