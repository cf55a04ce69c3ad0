// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/recordings/trajectories/reference.hpp"

/// How an optical reference lies to the IMU in time and in space. Private to scenarios/recordings.
namespace tumble::scenarios {

/// w_I(t) = R_IV w_V(t + delay): V is what the reference calls the body. `R_WV` levels the reference's world. The
/// uncertainties are standard deviations, from eight parts of the recording estimated apart; they count what changes
/// from part to part, and no error that all of them share.
struct ReferenceAlignment {
  bool known = false;  ///< false: the gyro moves too little while it is free, or the reference knows too little
  double delay_s = 0.0, delay_sigma_s = 0.0;
  Eigen::Quaterniond q_IV = Eigen::Quaterniond::Identity();
  Eigen::Vector3d q_IV_sigma_rad = Eigen::Vector3d::Zero();  ///< about the axes of I
  Eigen::Quaterniond q_WV = Eigen::Quaterniond::Identity();
  std::size_t samples = 0;  ///< free ones that it rests on
  std::string text() const;
};

/// The delay by cross-correlation of |w| within +-0.1 s, then by least squares of the difference (outliers beyond three
/// times the median taken as such); the rotation by Wahba's problem over two sorts of pairs, rates at free samples and
/// specific force against gravity as the reference sees it, the latter trusted by how near its size is to gravity: a
/// body that turns about one axis alone would not tell the rotation about it from rates. Free: every axis of the gyro
/// within 0.9 of its extreme reading. Gravity in the reference's world is the mean specific force, as of a body that
/// ends about where and as fast as it began. Wahba, SIAM Review 7(3), 1965; solved by singular values (Markley, J.
/// Astronautical Sciences 36(3), 1988). O(N) with some fifty passes.
ReferenceAlignment align_reference(const std::vector<ReferencePose>& poses, const sim::ImuRecord& imu);

/// Takes delay, rotation and tilt out of poses: they become those of the IMU, in its clock, in a level world.
void apply(const ReferenceAlignment& alignment, std::vector<ReferencePose>& poses);

}  // namespace tumble::scenarios
