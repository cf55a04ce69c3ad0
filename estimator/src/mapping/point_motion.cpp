// SPDX-License-Identifier: BSD-3-Clause
#include "point_motion.hpp"

#include "unknowns.hpp"

namespace tumble::mapping {

namespace u = unknowns;

PointMotion::PointMotion(const SweepTrajectory& trajectory, const LidarImuCalibration& calibration,
                         const SweepPoint& point, std::size_t& hint)
    : t_s_(point.t_s), clipped_(trajectory.clipped_axes() != 0) {
  const Eigen::Vector3d x_I = point.x_I_m.cast<double>();
  now_ = trajectory.at(t_s_, x_I, hint, velocity_m_s_);
  rotated_point_ = now_.q_WI * x_I;
  lever_arm_ = now_.preintegrated_position_m + rotated_point_;
  point_from_lidar_I_ = x_I - calibration.T_IL.translation();
  if (clipped_) saturation_deficit_jacobian_ = trajectory.saturation_deficit_jacobian(t_s_, hint);
}

void PointMotion::derivative_along_normal(const Eigen::Vector3d& n, RegistrationUnknowns::Vector& derivative) const {
  const Eigen::Vector3d n_I = now_.q_WI.conjugate() * n;
  u::segment(derivative, u::position) = n;
  u::segment(derivative, u::attitude) = lever_arm_.cross(n);
  u::segment(derivative, u::velocity) = t_s_ * n;
  auto of_deficit = u::segment(derivative, u::deficit);
  if (clipped_) {
    of_deficit = saturation_deficit_jacobian_.position_jacobian_m_s.transpose() * n +
                 saturation_deficit_jacobian_.attitude_by_deficit_s.transpose() * rotated_point_.cross(n);
  } else {
    of_deficit.setZero();
  }
  u::segment(derivative, u::calibration) << point_from_lidar_I_.cross(n_I), n_I, n.dot(velocity_m_s_),
      (0.5 * t_s_ * t_s_) * n;
}

}  // namespace tumble::mapping
