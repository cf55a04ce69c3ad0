// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "odometry_impl.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

// variance added to what the prior holds exactly, so that it can be inverted
constexpr double kLeastVariance = 1e-12;
constexpr double kStartTilt_rad =
    0.002;  // a levelled start is off by: an accelerometer's turn-on bias of 2 mg (MTi-30)
// Of the weakest direction's standard deviation, per sweep, where the surfaces do not hold it: measured on `bare`.
constexpr double kDriftShare = 0.1;
constexpr double kDriftMax_m = 3.0;

/// Pose errors of the IMU by errors of the mounting, at this attitude of it, while the lidar's pose is certain: K of
/// mapping.md (R43).
Eigen::Matrix<double, 6, 6> pose_by_mounting(const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m) {
  const Eigen::Matrix3d R = q_WI.toRotationMatrix();
  Eigen::Matrix<double, 6, 6> B = Eigen::Matrix<double, 6, 6>::Zero();
  B.topLeftCorner<3, 3>() = -R * so3::hat(p_IL_m);
  B.topRightCorner<3, 3>() = -R;
  B.bottomLeftCorner<3, 3>() = -R;
  return B;
}

/// Covariance of (error of the pose) - by_mounting (error of the mounting): mapping.md (R46).
Eigen::Matrix<double, 6, 6> less_mounting(const Registration::Matrix& joint,
                                          const Eigen::Matrix<double, 6, 6>& by_mounting) {
  Eigen::Matrix<double, 6, Registration::kUnknowns> G = Eigen::Matrix<double, 6, Registration::kUnknowns>::Zero();
  G.leftCols<6>().setIdentity();
  G.middleCols<6>(Registration::kCalibration) = -by_mounting;
  const Eigen::Matrix<double, 6, 6> P = G * joint * G.transpose();
  return 0.5 * (P + P.transpose());
}

}  // namespace

/// mapping.md (R12), of all unknowns.
Registration::Matrix mapping::unknowns_at(const SweepTrajectory& trajectory, double t_s) {
  const SweepTrajectory::Transition step = trajectory.transition(t_s);
  Registration::Matrix F = Registration::Matrix::Identity();
  F.topLeftCorner<9, 9>() = step.by_start;
  F.block<9, SweepTrajectory::kExcess>(0, Registration::kExcess) = step.by_excess_s;
  F.topRightCorner<9, 3>() = step.by_gravity;
  return F;
}

/// The map hangs on the lidar: at the start the lidar's pose is certain by definition, and an error of its mounting is
/// one of the IMU's pose, of gravity as seen from the map too: mapping.md (R43), (R44).
void LidarInertialOdometry::Impl::start_calibration() {
  calibration.T_IL = params.T_IL;
  calibration.time_offset_s = 0.0;  // the given offset is applied to the stamps
  calibration.gravity_W_m_s2 = Eigen::Vector3d(0.0, 0.0, -params.gravity_m_s2);
  constexpr int kCal = Registration::kCalibration;
  covariance.setZero();
  auto of_calibration = covariance.bottomRightCorner<SweepCalibration::kErrors, SweepCalibration::kErrors>();
  auto diagonal = covariance.diagonal().tail<SweepCalibration::kErrors>();
  diagonal.segment<3>(0).setConstant(params.mount_sigma_rad * params.mount_sigma_rad);
  diagonal.segment<3>(3).setConstant(params.mount_sigma_m * params.mount_sigma_m);
  diagonal[6] = params.time_offset_sigma_s * params.time_offset_sigma_s;

  const Eigen::Matrix3d R = state.q_WI.toRotationMatrix();
  start_by_mounting = pose_by_mounting(state.q_WI, params.T_IL.translation());
  Eigen::Matrix<double, 9, 6> by_mounting = Eigen::Matrix<double, 9, 6>::Zero();
  by_mounting.topRows<6>() = start_by_mounting;
  const Eigen::Matrix<double, 6, 6> mounting = of_calibration.topLeftCorner<6, 6>();
  covariance.topLeftCorner<9, 9>() = state.covariance + by_mounting * mounting * by_mounting.transpose();
  covariance.block<9, 6>(0, kCal) = by_mounting * mounting;
  if (params.gravity_sigma_m_s2 > 0.0) {
    Eigen::Matrix<double, 3, 6> gravity_by_mounting = Eigen::Matrix<double, 3, 6>::Zero();
    gravity_by_mounting.leftCols<3>() = so3::hat(calibration.gravity_W_m_s2) * R;
    of_calibration.block<3, 6>(7, 0) = gravity_by_mounting * mounting;
    of_calibration.block<6, 3>(0, 7) = of_calibration.block<3, 6>(7, 0).transpose();
    of_calibration.bottomRightCorner<3, 3>() = gravity_by_mounting * mounting * gravity_by_mounting.transpose();
    const double sigma2 = params.gravity_sigma_m_s2 * params.gravity_sigma_m_s2;
    // the magnitude is known much better than the direction
    diagonal.segment<3>(7) += Eigen::Vector3d(sigma2, sigma2, 0.01 * sigma2);
    covariance.block<9, 3>(0, kCal + 7) = by_mounting * mounting * gravity_by_mounting.transpose();
  }
  covariance.bottomLeftCorner<SweepCalibration::kErrors, 9>() =
      covariance.topRightCorner<9, SweepCalibration::kErrors>().transpose();
  state.covariance = covariance.topLeftCorner<9, 9>();
  error_covariance = covariance;
}

/// What the unknowns are off by after the registration, which weighed prior and surfaces by what it made of them: the
/// errors of the prior and the pull of the surfaces, whose score_covariance is measured, through the same normal
/// equations: mapping.md (R41).
void LidarInertialOdometry::Impl::count_errors() {
  errors = prediction.errors;
  if (result.verdict != RegistrationVerdict::converged) return;
  Registration::Matrix weighed = prediction.prior.covariance;
  weighed.diagonal().array() += kLeastVariance;
  // what is no information corrects nothing
  Registration::Matrix kept = weighed.ldlt().solve(Registration::Matrix::Identity());
  kept.topLeftCorner<9, 9>() += result.errors_in_variables_information;
  const Registration::Matrix from_prior = result.covariance * kept;
  const Registration::Matrix sum = from_prior * prediction.errors * from_prior.transpose() +
                                   result.covariance * result.score_covariance * result.covariance;
  errors = 0.5 * (sum + sum.transpose());
}

/// See SweepReport::innovation; mapping.md (R51).
double LidarInertialOdometry::Impl::innovation() const {
  constexpr int kMotion = Registration::kMotion;
  const auto moved = result.mean.minus(prediction.prior.mean).head<kMotion>().eval();
  Eigen::Matrix<double, kMotion, kMotion> P = prediction.errors.topLeftCorner<kMotion, kMotion>();
  P.diagonal().array() += kLeastVariance;
  return std::sqrt(std::max(0.0, moved.dot(P.ldlt().solve(moved))) / kMotion);
}

/// mapping.md (R42).
void LidarInertialOdometry::Impl::carry_covariance(TimeNs end_ns) {
  end_by_start = mapping::unknowns_at(trajectory, trajectory.duration_s());
  const Registration::Matrix P = end_by_start * result.covariance * end_by_start.transpose();
  covariance = 0.5 * (P + P.transpose());
  const Registration::Matrix E = end_by_start * errors * end_by_start.transpose();
  error_covariance = 0.5 * (E + E.transpose());
  state = trajectory.state(trajectory.duration_s());
  state.time_ns = end_ns;
  state.covariance = covariance.topLeftCorner<9, 9>();
  calibration = result.mean.calibration;
  excess_rad_s = result.mean.excess_rad_s;
}

/// Poses at the ends of the IMU's windows.
std::vector<PoseState> LidarInertialOdometry::Impl::describe(const SweepTrajectory& motion,
                                                             const Registration::Matrix& at_start) const {
  std::vector<PoseState> poses;
  for (std::size_t i = 0; i < motion.intervals(); ++i) {
    const double t_s = std::min(motion.interval_end_s(i), motion.duration_s());
    const Registration::Matrix F = mapping::unknowns_at(motion, t_s);
    PoseState pose = motion.state(t_s).pose();
    pose.covariance = reported_covariance(F * at_start * F.transpose(), pose.p_WA_m);
    poses.push_back(pose);
  }
  return poses;
}

/// Pose against the world rather than against the map: the world is held by the IMU's first pose, which the mounting
/// parts from the map; added what the map is off by here, and the tilt of the start: mapping.md (R47).
Eigen::Matrix<double, 6, 6> LidarInertialOdometry::Impl::reported_covariance(const Registration::Matrix& joint,
                                                                             const Eigen::Vector3d& p_WI_m) const {
  // a map that is turned about the start moves what is far from it: mapping.md (R45)
  Eigen::Matrix<double, 6, 6> start = start_by_mounting;
  start.topRows<3>() -= so3::hat(p_WI_m) * start_by_mounting.bottomRows<3>();
  Eigen::Matrix<double, 6, 2> by_tilt = Eigen::Matrix<double, 6, 2>::Zero();
  by_tilt.topRows<3>() = -so3::hat(p_WI_m).leftCols<2>();
  by_tilt.block<2, 2>(3, 0).setIdentity();
  Eigen::Matrix<double, 6, 6> P = less_mounting(joint, start);
  P += map_covariance + (kStartTilt_rad * kStartTilt_rad) * by_tilt * by_tilt.transpose();
  P.topLeftCorner<3, 3>() += drift_covariance_m2;
  return P;
}

/// mapping.md (R50).
void LidarInertialOdometry::Impl::count_drift(const SweepReport& report) {
  if (report.verdict != SweepVerdict::degenerate || resting_sweeps > 0) return;
  const double sigma_m = kDriftShare * std::min(report.weakest_sigma_m, kDriftMax_m);
  const Eigen::Vector3d direction = report.weakest_direction.head<3>();
  drift_covariance_m2 += (sigma_m * sigma_m) * direction * direction.transpose();
}

/// Of the lidar's pose in the map in the middle of the sweep, which is what draws it: an error of the mounting is none
/// of the map, and at its ends a sweep is known less well than as a whole. mapping.md (R48).
Eigen::Matrix<double, 6, 6> LidarInertialOdometry::Impl::drawing_covariance() const {
  const double middle_s = 0.5 * trajectory.duration_s();
  const Registration::Matrix F = mapping::unknowns_at(trajectory, middle_s);
  return less_mounting(F * errors * F.transpose(),
                       pose_by_mounting(trajectory.state(middle_s).q_WI, calibration.T_IL.translation()));
}

}  // namespace tumble
