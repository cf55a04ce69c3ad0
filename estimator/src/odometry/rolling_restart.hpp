// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace tumble {

/// start of a run of RollingOdometry after a gap or a step of the clock
struct RollingRestart {
  Eigen::Vector3d sphere_centre_W_m = Eigen::Vector3d::Zero();  ///< position of the sphere's centre
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

}  // namespace tumble
