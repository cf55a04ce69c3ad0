// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace tumble::baselines {

/// The step only integrates the gyro if the specific force is below 1e-6 m/s^2, or if the gradient of the tilt error is
/// below 1e-12.
Eigen::Quaterniond madgwick_step(const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& w_I_rad_s,
                                 const Eigen::Vector3d& f_I_m_s2, double gain_rad_s, double dt_s);

}  // namespace tumble::baselines
