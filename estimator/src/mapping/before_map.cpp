// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_impl.hpp"

#include <Eigen/LU>
#include <cmath>

#include "inertial_track.hpp"
#include "tumble/common/types.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace {

namespace u = unknowns;
using Motion = Eigen::Matrix<double, 9, 9>;
using Params = LidarInertialOdometry::Params;

// assumed standard deviation and correlation time of the robot's speed before a map exists
constexpr double kSpeed_m_s = 10.0, kSpeedTime_s = 1.0;
// If a recording starts in motion, the mean specific force over 0.5 s is assumed to differ from gravity by at least 1
// m/s^2. The initial speed is assumed to result from an acceleration of at least 1 m/s^2 during 2 s.
constexpr double kMovingForce_m_s2 = 1.0, kMovingTime_s = 2.0;
constexpr double kMovingTiltMax_rad = 1.0;  // any direction of gravity is possible

StateEstimate state_estimate_of_motion(const MotionState& state, const LidarImuCalibration& calibration,
                                       const Motion& weight, const Motion& error) {
  StateEstimate out;
  out.mean.state = state;
  out.mean.state.covariance = weight;
  out.mean.calibration = calibration;
  u::sub_block(out.prior_weight_covariance, u::motion) = weight;
  u::sub_block(out.state_error_covariance, u::motion) = error;
  return out;
}

double yaw_rad(const Eigen::Quaterniond& q) {
  return 2.0 * std::atan2(q.z(), q.w());
}

/// Returns the Jacobian of position, attitude and velocity errors for a change to a new world frame. The new frame has
/// its origin at the IMU, and is rotated by `turn`.
Motion world_frame_jacobian(const Eigen::Matrix3d& turn, const Eigen::Vector3d& v_WI_m_s) {
  Motion T = Motion::Zero();
  T.block<2, 3>(3, 3) = turn.topRows<2>();
  T.block<3, 3>(6, 6) = turn;
  T.block<3, 3>(6, 3) = so3::hat(v_WI_m_s).col(2) * turn.row(2);  // the yaw error rotates the velocity
  return T;
}

/// Applies a Kalman update with the measured velocity 0. The covariance C determines the Kalman gain. The covariance E
/// describes the actual errors of `state`.
void bound_speed(double sigma_m_s, MotionState& state, Motion& C, Motion& E) {
  const Eigen::Matrix3d R = sigma_m_s * sigma_m_s * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d S = u::sub_block(C, u::velocity) + R;
  const Eigen::Matrix<double, 9, 3> K = u::columns(C, u::velocity) * S.inverse();
  const Eigen::Matrix<double, 9, 1> moved = -K * state.v_WI_m_s;
  state.q_WI = (so3::exp(u::segment(moved, u::attitude)) * state.q_WI).normalized();
  state.v_WI_m_s += u::segment(moved, u::velocity);
  Motion kept = Motion::Identity();
  u::columns(kept, u::velocity) -= K;
  C = (kept * C * kept.transpose() + K * R * K.transpose()).eval();
  E = (kept * E * kept.transpose() + K * R * K.transpose()).eval();
}

}  // namespace

StateEstimate estimate_before_map(const Params& params, const MotionState& levelled) {
  LidarImuCalibration calibration;
  calibration.T_IL = params.T_IL;
  calibration.gravity_W_m_s2 = Eigen::Vector3d(0.0, 0.0, -params.expert.gravity_m_s2);
  Motion error = levelled.covariance;
  const double level = OdometryStart::kLevelSigma_rad, world = params.expert.world_covariance.tilt_sigma_rad;
  if (u::variances(error, u::tilt).maxCoeff() <= level * level) u::variances(error, u::tilt).setConstant(world * world);
  return state_estimate_of_motion(levelled, calibration, levelled.covariance, error);
}

MotionState start_in_motion(std::span<const MotionSample> samples, double gravity_m_s2) {
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  // from the IMU's axes to those of the first sample
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double square = 0.0, time_s = 0.0;
  for (const MotionSample& sample : samples) {
    if (seconds(sample.time_ns - samples.front().from_ns) > StationaryBounds::kLevellingMax_s && time_s > 0.0) break;
    const double step_s = seconds(sample.time_ns - sample.from_ns);
    const Eigen::Vector3d angle_rad = step_s * sample.w_WI_I_rad_s;
    force += step_s * (turned * so3::exp(0.5 * angle_rad) * sample.f_I_m_s2);
    square += step_s * sample.f_I_m_s2.squaredNorm();
    time_s += step_s;
    turned = (turned * so3::exp(angle_rad)).normalized();
  }
  const double weight = 1.0 / std::max(time_s, 1e-9), gravity = std::max(gravity_m_s2, 1e-3);
  force *= weight;
  const double variance = std::max(weight * square - force.squaredNorm(), 0.0);
  const double surplus = force.norm() - gravity;
  const double sigma_m_s2 = std::sqrt(kMovingForce_m_s2 * kMovingForce_m_s2 + surplus * surplus + 0.25 * variance);
  const double tilt_rad = std::min(sigma_m_s2 / gravity, kMovingTiltMax_rad);
  const double speed_m_s = std::min(kMovingTime_s * sigma_m_s2, kSpeed_m_s);
  MotionState state;
  if (!level_at_rest(force, state).ok()) state = MotionState{};  // in flight, any attitude is equally probable
  state.time_ns = samples.front().from_ns;
  u::variances(state.covariance, u::tilt).setConstant(tilt_rad * tilt_rad);
  u::variances(state.covariance, u::velocity).setConstant(speed_m_s * speed_m_s);
  return state;
}

MotionState transformed_to_pose(const Eigen::Isometry3d& T_WI, const MotionState& motion) {
  const Eigen::Quaterniond wanted(T_WI.linear());
  const Eigen::Quaterniond turn = so3::exp({0.0, 0.0, yaw_rad(wanted * motion.q_WI.conjugate())});
  const Eigen::Matrix3d R = turn.toRotationMatrix();
  Motion T = Motion::Zero();
  for (int k = 0; k < Motion::RowsAtCompileTime; k += 3) T.block<3, 3>(k, k) = R;
  MotionState out = motion;
  out.p_WI_m = T_WI.translation();
  out.q_WI = (turn * motion.q_WI).normalized();
  out.v_WI_m_s = R * motion.v_WI_m_s;
  out.covariance = T * motion.covariance * T.transpose();
  return out;
}

StateEstimate transformed_to_pose(const Eigen::Isometry3d& T_WI, const StateEstimate& estimate) {
  MotionState state = estimate.mean.state, error = estimate.mean.state;
  state.covariance = u::sub_block(estimate.prior_weight_covariance, u::motion);
  error.covariance = u::sub_block(estimate.state_error_covariance, u::motion);
  state = transformed_to_pose(T_WI, state);
  return state_estimate_of_motion(state, estimate.mean.calibration, state.covariance,
                                  transformed_to_pose(T_WI, error).covariance);
}

StateEstimate with_start_tilt(const LidarInertialOdometry::StartTiltCorrection& tilt, const StateEstimate& estimate) {
  const Eigen::Matrix3d R = tilt.rotation.toRotationMatrix();
  MotionState state = estimate.mean.state;
  state.q_WI = (tilt.rotation * state.q_WI).normalized();
  state.v_WI_m_s = R * state.v_WI_m_s;
  Motion T = Motion::Identity();
  T.block<2, 9>(3, 0).setZero();
  T.block<3, 3>(6, 6) = R;
  const auto corrected = [&](const Registration::Matrix& P) {
    Motion out = T * u::sub_block(P, u::motion) * T.transpose();
    u::variances(out, u::tilt).setConstant(tilt.sigma_rad * tilt.sigma_rad);
    return out;
  };
  return state_estimate_of_motion(state, estimate.mean.calibration, corrected(estimate.prior_weight_covariance),
                                  corrected(estimate.state_error_covariance));
}

StateEstimate reset_origin_and_yaw(const StateEstimate& reckoned, double step_s) {
  MotionState state = reckoned.mean.state;
  Motion C = u::sub_block(reckoned.prior_weight_covariance, u::motion),
         E = u::sub_block(reckoned.state_error_covariance, u::motion);
  bound_speed(kSpeed_m_s * std::sqrt(kSpeedTime_s / step_s), state, C, E);
  const Eigen::Quaterniond turn = so3::exp({0.0, 0.0, -yaw_rad(state.q_WI)});
  state.p_WI_m.setZero();
  state.q_WI = (turn * state.q_WI).normalized();
  state.v_WI_m_s = turn * state.v_WI_m_s;
  const Motion T = world_frame_jacobian(turn.toRotationMatrix(), state.v_WI_m_s);
  return state_estimate_of_motion(state, reckoned.mean.calibration, T * C * T.transpose(), T * E * T.transpose());
}

/// A tilt error φ of the map frame adds the error v × φ to the velocity v, and the error g × φ to gravity g.
StateEstimate estimate_at_first_sweep(const Params& params, const StateEstimate& reckoned) {
  MotionState start = reckoned.mean.state;
  start.covariance.setZero();
  u::variances(start.covariance, u::tilt).setConstant(OdometryStart::kLevelSigma_rad * OdometryStart::kLevelSigma_rad);
  StateEstimate out = estimate_at_start(params, start);
  // rows: errors of velocity and gravity in the map frame; columns: errors of position, attitude and velocity in the
  // dead-reckoned state `reckoned`
  Eigen::Matrix<double, 6, 9> T = Eigen::Matrix<double, 6, 9>::Zero();
  T.block<3, 3>(0, 3) = so3::hat(start.v_WI_m_s);
  T.block<3, 3>(0, 6).setIdentity();
  const bool free_gravity = params.expert.gravity_sigma_m_s2 > 0.0;
  if (free_gravity) T.block<3, 3>(3, 3) = so3::hat(out.mean.calibration.gravity_W_m_s2);
  const auto add = [&](const Registration::Matrix& from, Registration::Matrix& sub_block) {
    const Eigen::Matrix<double, 6, 6> P = T * u::sub_block(from, u::motion) * T.transpose();
    u::sub_block(sub_block, u::velocity) += P.topLeftCorner<3, 3>();
    u::sub_block(sub_block, u::velocity, u::gravity) += P.topRightCorner<3, 3>();
    u::sub_block(sub_block, u::gravity, u::velocity) += P.bottomLeftCorner<3, 3>();
    u::sub_block(sub_block, u::gravity) += P.bottomRightCorner<3, 3>();
    if (free_gravity)  // error of the second order in the tilt
      u::variances(sub_block, u::gravity)[2] +=
          std::pow(params.expert.gravity_m_s2 * u::variances(from, u::tilt).mean(), 2);
  };
  add(reckoned.prior_weight_covariance, out.prior_weight_covariance);
  add(reckoned.state_error_covariance, out.state_error_covariance);
  out.mean.state.covariance = u::sub_block(out.prior_weight_covariance, u::motion);
  return out;
}

WorldCovariance world_at_first_sweep(const Params& params, const StateEstimate& reckoned) {
  WorldCovarianceParams world = params.expert.world_covariance;
  world.tilt_sigma_rad = std::sqrt(u::variances(reckoned.state_error_covariance, u::tilt).mean());
  const MotionState& start = reckoned.mean.state;
  return {world, start.q_WI, params.T_IL.translation(), start.p_WI_m};
}

}  // namespace tumble::mapping
