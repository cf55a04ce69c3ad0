// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// The functions in align_reference.hpp align an optical reference with the IMU in time and rotation.
namespace tumble::scenarios {

/// The alignment is w_I(t) = R_IV w_V(t + delay), where V is the reference's body frame and I the IMU frame. The
/// rotation `R_WV` transforms the reference's world to a level world. The uncertainties are standard deviations of
/// separate estimates from eight parts of the recording. The uncertainties exclude errors that all parts share.
struct ReferenceAlignment {
  bool known = false;  ///< false: too little rotation while the gyro is unsaturated, or too few reference poses
  double delay_s = 0.0, delay_sigma_s = 0.0;
  Eigen::Quaterniond q_IV = Eigen::Quaterniond::Identity();
  Eigen::Vector3d q_IV_sigma_rad = Eigen::Vector3d::Zero();  ///< about the axes of I
  Eigen::Quaterniond q_WV = Eigen::Quaterniond::Identity();
  std::size_t samples = 0;  ///< number of unsaturated samples used
  std::string text() const;
};

/// Estimates the delay and rotation between reference and IMU; the first delay is that of the largest cross-correlation
/// of |w| within +-0.1 s. Robust least squares then refine the delay, and reject outliers beyond three times the median
/// error. The rotation solves Wahba's problem for two kinds of vector pairs. The first kind of pair is the rates of
/// gyro and reference at an unsaturated sample. The second kind of pair is the specific force and the gravity of the
/// reference; its weight decreases with the difference between both norms. The rates alone do not determine the
/// rotation if the body turns about a single axis.
///
/// A sample counts as unsaturated if the reading of every gyro axis is below 0.9 of the extreme reading of the axis.
/// The direction of gravity in the reference's world is the mean specific force, which assumes that the body ends with
/// about its initial position and speed. Wahba's problem (SIAM Review 7(3), 1965) is solved by singular values
/// (Markley, Journal of the Astronautical Sciences 36(3), 1988). The cost is about fifty passes over the samples.
ReferenceAlignment align_reference(const std::vector<ReferencePose>& poses, const sim::ImuRecord& imu);

/// Converts the poses by the alignment to poses of the IMU, in the IMU's clock and a level world.
void apply(const ReferenceAlignment& alignment, std::vector<ReferencePose>& poses);

}  // namespace tumble::scenarios
