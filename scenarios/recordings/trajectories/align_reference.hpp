// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// align_reference.hpp aligns an optical reference with the IMU in time and rotation.
namespace tumble::scenarios {

/// The alignment is w_I(t) = R_IV w_V(t + delay), where V is the body frame of the reference and I the IMU frame. R_WV
/// rotates the reference's world to a world with z up. The uncertainties are standard deviations of separate estimates
/// from eight parts of the recording. The uncertainties exclude errors that are equal in all parts.
struct ReferenceAlignment {
  bool known = false;  ///< false: too little rotation without saturation, or too few reference poses
  double delay_s = 0.0, delay_sigma_s = 0.0;
  Eigen::Quaterniond q_IV = Eigen::Quaterniond::Identity();
  Eigen::Vector3d q_IV_sigma_rad = Eigen::Vector3d::Zero();  ///< about the axes of I
  Eigen::Quaterniond q_WV = Eigen::Quaterniond::Identity();
  std::size_t samples = 0;  ///< number of unsaturated samples
  std::string text() const;
};

/// Estimates delay and rotation between reference and IMU. The first delay has the largest cross-correlation of |w|
/// within +-0.1 s. Robust least squares refine the delay, and reject outliers beyond three times the median error. The
/// rotation solves Wahba's problem for two kinds of vector pairs. The first pairs the rates of gyro and reference at an
/// unsaturated sample. The second pairs the specific force and the reference's gravity; its weight decreases with the
/// difference of both norms. Rates alone do not determine the rotation if the body turns about a single axis.
///
/// A sample is unsaturated if every gyro axis is below 0.9 of its extreme reading. The direction of gravity in the
/// reference's world is the mean specific force, which assumes that the body ends with about its initial position and
/// speed. Wahba's problem (SIAM Review 7(3), 1965) is solved by singular values (Markley, Journal of the Astronautical
/// Sciences 36(3), 1988). The cost is about fifty passes over the samples.
ReferenceAlignment align_reference(const std::vector<ReferencePose>& poses, const sim::ImuRecord& imu);

/// Converts the poses to poses of the IMU, in the IMU's clock and a world with z up.
void apply(const ReferenceAlignment& alignment, std::vector<ReferencePose>& poses);

}  // namespace tumble::scenarios
