// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// Aligns an optical reference with the IMU in time and rotation. Used only within scenarios/recordings.
namespace tumble::scenarios {

/// The alignment is w_I(t) = R_IV w_V(t + delay), where V is the reference's body frame and I the IMU frame. `R_WV`
/// rotates the reference's world to a level world. The uncertainties are standard deviations from eight parts of the
/// recording, estimated separately; errors common to all parts are not included.
struct ReferenceAlignment {
  bool known = false;  ///< false: too little rotation while the gyro is unsaturated, or too few reference poses
  double delay_s = 0.0, delay_sigma_s = 0.0;
  Eigen::Quaterniond q_IV = Eigen::Quaterniond::Identity();
  Eigen::Vector3d q_IV_sigma_rad = Eigen::Vector3d::Zero();  ///< about the axes of I
  Eigen::Quaterniond q_WV = Eigen::Quaterniond::Identity();
  std::size_t samples = 0;  ///< number of unsaturated samples used
  std::string text() const;
};

/// Estimates the delay by cross-correlation of |w| within +-0.1 s, then by robust least squares, which rejects outliers
/// beyond three times the median. Estimates the rotation by Wahba's problem over two kinds of vector pairs: rates at
/// unsaturated samples, and specific force with the reference's gravity. The weight of a force pair decreases with the
/// difference between force and gravity. Rates alone do not determine the rotation if the body only turns about one
/// axis.
///
/// A sample counts as unsaturated if every gyro axis is below 0.9 of the axis's extreme reading. The direction of
/// gravity in the reference's world is the mean specific force, which assumes that the body ends with about its initial
/// position and speed. The method is Wahba's problem (SIAM Review 7(3), 1965), solved by singular values (Markley,
/// Journal of the Astronautical Sciences 36(3), 1988). The cost is about fifty passes over the samples.
ReferenceAlignment align_reference(const std::vector<ReferencePose>& poses, const sim::ImuRecord& imu);

/// Removes delay, rotation and tilt: converts the poses to poses of the IMU, in the IMU's clock and a level world.
void apply(const ReferenceAlignment& alignment, std::vector<ReferencePose>& poses);

}  // namespace tumble::scenarios
