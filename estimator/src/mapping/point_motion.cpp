// SPDX-License-Identifier: BSD-3-Clause
#include "point_motion.hpp"

#include "unknowns.hpp"

namespace tumble::mapping {

namespace u = unknowns;

PointMotion::PointMotion(const SweepTrajectory& trajectory, const SweepCalibration& calibration,
                         const SweepPoint& point, std::size_t& hint)
    : t_s_(point.t_s), clipped_(trajectory.clipped_axes() != 0) {
  const Eigen::Vector3d x_I = point.x_I_m.cast<double>();
  now_ = trajectory.at(t_s_, x_I, hint, velocity_m_s_);
  turned_ = now_.q_WI * x_I;
  lever_ = now_.preintegrated_position_m + turned_;
  from_lidar_I_ = x_I - calibration.T_IL.translation();
  if (clipped_) deficit_derivative_ = trajectory.deficit_derivative(t_s_, hint);
}

void PointMotion::along(const Eigen::Vector3d& n, SweepUnknowns::Vector& derivative) const {
  const Eigen::Vector3d n_I = now_.q_WI.conjugate() * n;
  u::segment(derivative, u::position) = n;
  u::segment(derivative, u::attitude) = lever_.cross(n);
  u::segment(derivative, u::velocity) = t_s_ * n;
  auto of_deficit = u::segment(derivative, u::deficit);
  if (clipped_) {
    of_deficit = deficit_derivative_.position_jacobian_m_s.transpose() * n +
                 deficit_derivative_.attitude_jacobian_s.transpose() * turned_.cross(n);
  } else {
    of_deficit.setZero();
  }
  u::segment(derivative, u::calibration) << from_lidar_I_.cross(n_I), n_I, n.dot(velocity_m_s_),
      (0.5 * t_s_ * t_s_) * n;
}

}  // namespace tumble::mapping
