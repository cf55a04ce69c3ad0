// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace tumble::baselines {

/// Returns the attitude after one step of Madgwick's filter: q' = q/2 (x) (0, w) - gain s/|s| by explicit Euler, then
/// normalisation of q. Without a usable gradient s of the tilt error (|f| < 1e-6 m/s^2 or |s| < 1e-12), the step only
/// integrates the gyro.
Eigen::Quaterniond madgwick_step(const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& w_I_rad_s,
                                 const Eigen::Vector3d& f_I_m_s2, double gain_rad_s, double dt_s);

}  // namespace tumble::baselines
