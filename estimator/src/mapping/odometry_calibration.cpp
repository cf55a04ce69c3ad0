// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_impl.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

constexpr double kStartTilt_rad = 0.003;  // of a levelled start: an accelerometer's bias of 0.03 m/s^2

}  // namespace

/// The map hangs on the lidar: at the start the lidar's pose is certain by definition, and an error of its mounting is one
/// of the IMU's pose, of gravity as seen from the map too.
void LidarInertialOdometry::Impl::start_calibration() {
  calibration.T_IL = params.T_IL;
  calibration.time_offset_s = 0.0;  // the given offset is applied to the stamps
  calibration.gravity_W_m_s2 = Eigen::Vector3d(0.0, 0.0, -params.gravity_m_s2);
  calibration_covariance.setZero();
  motion_calibration.setZero();
  auto diagonal = calibration_covariance.diagonal();
  diagonal.segment<3>(0).setConstant(params.mount_sigma_rad * params.mount_sigma_rad);
  diagonal.segment<3>(3).setConstant(params.mount_sigma_m * params.mount_sigma_m);
  diagonal[6] = params.time_offset_sigma_s * params.time_offset_sigma_s;

  const Eigen::Matrix3d R = state.q_WI.toRotationMatrix();
  Eigen::Matrix<double, 9, 6> by_mounting = Eigen::Matrix<double, 9, 6>::Zero();
  by_mounting.block<3, 3>(0, 0) = -R * so3::hat(params.T_IL.translation());
  by_mounting.block<3, 3>(0, 3) = -R;
  by_mounting.block<3, 3>(3, 0) = -R;
  const Eigen::Matrix<double, 6, 6> mounting = calibration_covariance.topLeftCorner<6, 6>();
  state.covariance += by_mounting * mounting * by_mounting.transpose();
  motion_calibration.leftCols<6>() = by_mounting * mounting;
  if (params.gravity_sigma_m_s2 <= 0.0) return;

  Eigen::Matrix<double, 3, 6> gravity_by_mounting = Eigen::Matrix<double, 3, 6>::Zero();
  gravity_by_mounting.leftCols<3>() = so3::hat(calibration.gravity_W_m_s2) * R;
  calibration_covariance.block<3, 6>(7, 0) = gravity_by_mounting * mounting;
  calibration_covariance.block<6, 3>(0, 7) = calibration_covariance.block<3, 6>(7, 0).transpose();
  calibration_covariance.bottomRightCorner<3, 3>() = gravity_by_mounting * mounting * gravity_by_mounting.transpose();
  const double sigma2 = params.gravity_sigma_m_s2 * params.gravity_sigma_m_s2;
  // the magnitude is known much better than the direction
  diagonal.segment<3>(7) += Eigen::Vector3d(sigma2, sigma2, 0.01 * sigma2);
  motion_calibration.rightCols<3>() = by_mounting * mounting * gravity_by_mounting.transpose();
}

/// Takes the joint covariance of the present sweep's start to its end.
void LidarInertialOdometry::Impl::carry_covariance(TimeNs end_ns) {
  const SweepTrajectory::Transition step = trajectory.transition(trajectory.duration_s());
  Eigen::Matrix<double, 9, Registration::kUnknowns> F = Eigen::Matrix<double, 9, Registration::kUnknowns>::Zero();
  F.leftCols<9>() = step.by_start;
  F.middleCols<3>(Registration::kExcess) = step.by_excess_s;
  F.rightCols<3>() = step.by_gravity;
  const Eigen::Matrix<double, 9, Registration::kUnknowns> FP = F * result.covariance;
  const Eigen::Matrix<double, 9, 9> P = FP * F.transpose();
  state = trajectory.state(trajectory.duration_s());
  state.time_ns = end_ns;
  state.covariance = 0.5 * (P + P.transpose());
  motion_calibration = FP.rightCols<SweepCalibration::kErrors>();
  calibration_covariance =
      result.covariance.bottomRightCorner<SweepCalibration::kErrors, SweepCalibration::kErrors>();
  calibration = result.calibration;
}

/// Pose against the world rather than against the map: what the map is off by here, and its tilt.
Eigen::Matrix<double, 6, 6> LidarInertialOdometry::Impl::reported_covariance(const Eigen::Matrix<double, 6, 6>& in_map,
                                                                             const Eigen::Vector3d& p_WI_m) const {
  Eigen::Matrix<double, 6, 2> by_tilt = Eigen::Matrix<double, 6, 2>::Zero();
  by_tilt.topRows<3>() = -so3::hat(p_WI_m).leftCols<2>();
  by_tilt.block<2, 2>(3, 0).setIdentity();
  return in_map + map_covariance + (kStartTilt_rad * kStartTilt_rad) * by_tilt * by_tilt.transpose();
}

}  // namespace tumble
