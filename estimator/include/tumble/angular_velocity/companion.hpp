// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tumble {

/// Another accelerometer on the same rigid body, expressed in the axes and at the time stamps of the primary IMU. What
/// the two read differs by the rotation of the body alone, in flight and in contact.
struct Companion {
  Eigen::Vector3d p_I_m = Eigen::Vector3d::Zero();   ///< from the primary IMU to it, primary IMU's axes
  std::vector<Eigen::Vector3d> specific_force_m_s2;  ///< one per sample of the primary; NaN where it says nothing
};

}  // namespace tumble
