// SPDX-License-Identifier: BSD-3-Clause
#include "state_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "../common/dense.hpp"
#include "tumble/common/types.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

using Matrix = Registration::Matrix;

namespace {

using Pose = WorldCovariance::Pose;

// The errors of successive sweeps are correlated, so the position error grows in proportion to the distance from the
// start (0.24 % in a hall with pillars).
constexpr double kScale = 0.003;
// The map drifts in the direction that surfaces constrain least. The standard deviation of the drift per sweep is
// kDriftRatio times the standard deviation of the pose in the least constrained direction.
constexpr double kDriftRatio = 0.1, kDriftSigmaMax_m = 3.0;

/// See mapping.md (R57).
Pose subtract_mounting(const Registration::Matrix& joint, const Pose& by_mounting) {
  Eigen::Matrix<double, 6, Registration::kUnknowns> G = Eigen::Matrix<double, 6, Registration::kUnknowns>::Zero();
  unknowns::columns(G, unknowns::pose).setIdentity();
  unknowns::columns(G, unknowns::mounting) = -by_mounting;
  const Pose P = G * joint * G.transpose();
  return 0.5 * (P + P.transpose());
}

}  // namespace

/// See mapping.md (R54), (R55). The lidar pose of the first sweep defines the map frame. An error of the lidar's
/// mounting therefore causes an error of the initial IMU pose, and of gravity's direction in the map frame.
StateEstimate estimate_at_start(const LidarInertialOdometry::Params& params, const MotionState& levelled) {
  namespace u = unknowns;
  StateEstimate state_estimate;
  LidarImuCalibration& calibration = state_estimate.mean.calibration;
  calibration.T_IL = params.T_IL;
  calibration.imu_minus_lidar_clock_s = 0.0;  // the time stamps already include the stated offset
  calibration.gravity_W_m_s2 = Eigen::Vector3d(0.0, 0.0, -params.expert.gravity_m_s2);
  Matrix& P = state_estimate.prior_weight_covariance;
  u::variances(P, u::mounting_rotation).setConstant(params.mount_sigma_rad * params.mount_sigma_rad);
  u::variances(P, u::mounting_translation).setConstant(params.mount_sigma_m * params.mount_sigma_m);
  u::variances(P, u::clock).setConstant(params.time_offset_sigma_s * params.time_offset_sigma_s);

  Eigen::Matrix<double, 9, 6> by_mounting = Eigen::Matrix<double, 9, 6>::Zero();
  by_mounting.topRows<6>() = pose_mounting_jacobian(levelled.q_WI, params.T_IL.translation());
  const Eigen::Matrix<double, 6, 6> mounting = u::sub_block(P, u::mounting);
  u::sub_block(P, u::motion) = levelled.covariance + by_mounting * mounting * by_mounting.transpose();
  u::sub_block(P, u::motion, u::mounting) = by_mounting * mounting;
  if (params.expert.gravity_sigma_m_s2 > 0.0) {
    Eigen::Matrix<double, 3, 6> gravity_mounting_jacobian = Eigen::Matrix<double, 3, 6>::Zero();
    gravity_mounting_jacobian.leftCols<3>() = so3::hat(calibration.gravity_W_m_s2) * levelled.q_WI.toRotationMatrix();
    u::sub_block(P, u::gravity, u::mounting) = gravity_mounting_jacobian * mounting;
    u::sub_block(P, u::mounting, u::gravity) = u::sub_block(P, u::gravity, u::mounting).transpose();
    u::sub_block(P, u::gravity) = gravity_mounting_jacobian * mounting * gravity_mounting_jacobian.transpose();
    const double sigma2 = params.expert.gravity_sigma_m_s2 * params.expert.gravity_sigma_m_s2;
    // The magnitude of gravity is known much better than its direction.
    u::variances(P, u::gravity) += Eigen::Vector3d(sigma2, sigma2, 0.01 * sigma2);
    u::sub_block(P, u::motion, u::gravity) = by_mounting * mounting * gravity_mounting_jacobian.transpose();
  }
  u::sub_block(P, u::calibration, u::motion) = u::sub_block(P, u::motion, u::calibration).transpose();
  state_estimate.mean.state = levelled;
  state_estimate.mean.state.covariance = u::sub_block(P, u::motion);
  state_estimate.state_error_covariance = P;
  return state_estimate;
}

/// See mapping.md (R11).
Matrix unknowns_at(const SweepTrajectory& trajectory, double t_s) {
  namespace u = unknowns;
  const SweepTrajectory::Transition step = trajectory.transition(t_s);
  Matrix F = Matrix::Identity();
  u::sub_block(F, u::motion) = step.jacobian_start;
  u::sub_block(F, u::motion, u::deficit) = step.jacobian_saturation_deficit_s;
  u::sub_block(F, u::motion, u::gravity) = step.jacobian_gravity;
  return F;
}

MotionErrors marginal_motion_errors(const Matrix& F, const Matrix& errors) {
  const auto rows = F.topRows<Registration::kMotionSize>();
  const Eigen::Matrix<double, Registration::kMotionSize, Registration::kUnknowns> moved = rows * errors;
  return moved * rows.transpose();
}

/// The velocity error in IMU axes is R_IW (δv + v × φ), for the error δv of the velocity v and the error φ of the
/// attitude.
Eigen::Matrix3d velocity_covariance_I(const MotionState& state, const MotionErrors& errors) {
  namespace u = unknowns;
  const Eigen::Matrix3d R_IW = state.q_WI.toRotationMatrix().transpose();
  Eigen::Matrix<double, 3, Registration::kMotionSize> J = Eigen::Matrix<double, 3, Registration::kMotionSize>::Zero();
  u::columns(J, u::attitude) = R_IW * so3::hat(state.v_WI_m_s);
  u::columns(J, u::velocity) = R_IW;
  return J * errors * J.transpose();
}

/// The number of rows of each matrix block is a multiple of the SIMD packet size. The block products therefore add
/// their terms in the same order as propagate_covariance(). The rows of mounting and other constants in the transition
/// matrix F are rows of the identity matrix: mapping.md (R11).
Matrix propagate_pose_and_mounting(const Matrix& F, const Matrix& errors) {
  constexpr int kSize = 8, kMounting = 16;
  static_assert(kMounting >= Registration::kMotionSize && kMounting <= Registration::kFirstCalibrationUnknown &&
                Registration::kFirstCalibrationUnknown + 6 <= kMounting + kSize);
  Matrix out = Matrix::Zero();
  const Eigen::Matrix<double, kSize, Registration::kUnknowns> moved = F.topRows<kSize>() * errors;
  out.topRows<kSize>() = moved * F.transpose();
  out.block<kSize, kSize>(kMounting, 0) = errors.middleRows<kSize>(kMounting) * F.topRows<kSize>().transpose();
  out.block<kSize, kSize>(kMounting, kMounting) = errors.block<kSize, kSize>(kMounting, kMounting);
  return out;
}

/// See mapping.md (R53).
void at_end(const StateEstimate& at_start, const SweepTrajectory& trajectory, const Matrix& end_start_jacobian,
            TimeNs end_ns, StateEstimate& end) {
  end.mean = at_start.mean;
  propagate_covariance(end_start_jacobian, at_start.prior_weight_covariance, end.prior_weight_covariance);
  propagate_covariance(end_start_jacobian, at_start.state_error_covariance, end.state_error_covariance);
  make_symmetric(end.prior_weight_covariance);
  make_symmetric(end.state_error_covariance);
  end.mean.state = trajectory.state(trajectory.duration_s());
  end.mean.state.time_ns = end_ns;
  end.mean.state.covariance = unknowns::sub_block(end.prior_weight_covariance, unknowns::motion);
}

[[gnu::noinline]] void propagate_covariance(const Matrix& F, const Matrix& P, Matrix& out) {
  out.noalias() = F * P * F.transpose();
}

Eigen::Matrix<double, 6, 6> pose_mounting_jacobian(const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& p_IL_m) {
  const Eigen::Matrix3d R = q_WI.toRotationMatrix();
  Eigen::Matrix<double, 6, 6> B = Eigen::Matrix<double, 6, 6>::Zero();
  B.topLeftCorner<3, 3>() = -R * so3::hat(p_IL_m);
  B.topRightCorner<3, 3>() = -R;
  B.bottomLeftCorner<3, 3>() = -R;
  return B;
}

Matrix make_invertible(const Matrix& covariance) {
  Matrix out = covariance;
  out.diagonal().array() += unknowns::kMinVariance;
  return out;
}

/// See mapping.md (R56).
Pose WorldCovariance::mounting_jacobian_at_start(const Eigen::Vector3d& p_WI_m) const {
  Pose start = mounting_jacobian_at_start_;
  start.topRows<3>() -= so3::hat(p_WI_m - first_position_W_m_) * mounting_jacobian_at_start_.bottomRows<3>();
  return start;
}

WorldCovariance WorldCovariance::covariance_in_prior_map(const WorldCovarianceParams& params,
                                                         const Eigen::Vector3d& p_WI_m) {
  WorldCovariance out;
  out.params_ = params;
  out.params_.tilt_sigma_rad = 0.0;
  out.first_position_W_m_ = out.last_map_extension_W_m_ = p_WI_m;
  return out;
}

double WorldCovariance::sigma_in_map_m(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const {
  const Pose P = subtract_mounting(joint, mounting_jacobian_at_start(p_WI_m));
  return std::sqrt(std::max(P.topLeftCorner<3, 3>().trace(), 0.0));
}

/// See mapping.md (R58).
Pose WorldCovariance::in_world_frame(const Registration::Matrix& joint, const Eigen::Vector3d& p_WI_m) const {
  const Eigen::Vector3d from_start_m = p_WI_m - first_position_W_m_;
  Eigen::Matrix<double, 6, 2> by_tilt = Eigen::Matrix<double, 6, 2>::Zero();
  by_tilt.topRows<3>() = -so3::hat(from_start_m).leftCols<2>();
  by_tilt.block<2, 2>(3, 0).setIdentity();
  Pose P = subtract_mounting(joint, mounting_jacobian_at_start(p_WI_m));
  P += map_ + (params_.tilt_sigma_rad * params_.tilt_sigma_rad) * by_tilt * by_tilt.transpose();
  P.topLeftCorner<3, 3>() += drift_covariance_m2_ + kScale * kScale * from_start_m * from_start_m.transpose();
  return P;
}

/// See mapping.md (R61).
void WorldCovariance::add_drift(double least_constrained_sigma_m,
                                const Eigen::Matrix<double, 6, 1>& least_constrained_direction) {
  const double sigma_m = kDriftRatio * std::min(least_constrained_sigma_m, kDriftSigmaMax_m);
  const Eigen::Vector3d direction = least_constrained_direction.head<3>();
  drift_covariance_m2_ += (sigma_m * sigma_m) * direction * direction.transpose();
}

/// See mapping.md (R59), (R60). Mounting errors of the lidar do not change the map.
void WorldCovariance::add_inserted_sweep(double inserted_fraction, const SweepTrajectory& trajectory,
                                         const Registration::Matrix& errors, const Eigen::Vector3d& p_IL_m) {
  const double middle_s = 0.5 * trajectory.duration_s();
  // A rotation error of the map causes a position error in proportion to the distance from the last sweep with points
  // inserted into the map.
  const Eigen::Vector3d p_WI_m = trajectory.state(middle_s).p_WI_m;
  Pose moved = Pose::Identity();
  moved.topRightCorner<3, 3>() = -so3::hat(p_WI_m - last_map_extension_W_m_);
  map_ = (moved * map_ * moved.transpose()).eval();
  last_map_extension_W_m_ = p_WI_m;
  const Registration::Matrix F = unknowns_at(trajectory, middle_s);
  map_ += inserted_fraction * inserted_fraction *
          subtract_mounting(propagate_pose_and_mounting(F, errors),
                            pose_mounting_jacobian(trajectory.state(middle_s).q_WI, p_IL_m));
}

}  // namespace tumble::mapping
