// SPDX-License-Identifier: BSD-3-Clause
#include "frame_change.hpp"

#include "../common/symmetric.hpp"
#include "tumble/common/types.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace u = unknowns;
using Matrix = Registration::Matrix;

Matrix FrameChange::rotation() const {
  Matrix T = Matrix::Identity();
  const Eigen::Matrix3d R = T_prior_map_world.linear();
  u::sub_block(T, u::position) = R;
  u::sub_block(T, u::attitude) = R;
  u::sub_block(T, u::velocity) = R;
  u::sub_block(T, u::gravity) = R;
  return T;
}

void FrameChange::apply(Registration::Estimate& mean) const {
  const Eigen::Quaterniond q_MW(T_prior_map_world.linear());
  MotionState& state = mean.state;
  state.p_WI_m = T_prior_map_world * state.p_WI_m;
  state.q_WI = (q_MW * state.q_WI).normalized();
  state.v_WI_m_s = q_MW * state.v_WI_m_s;
  mean.calibration.gravity_W_m_s2 = q_MW * mean.calibration.gravity_W_m_s2;
  Matrix of_motion = Matrix::Zero();
  u::sub_block(of_motion, u::motion) = state.covariance;
  apply(mean, of_motion);
  state.covariance = u::sub_block(of_motion, u::motion);
}

void FrameChange::apply(const Registration::Estimate& mean, Matrix& of_all) const {
  const Matrix T = rotation();
  Matrix turned;
  propagate_covariance(T, of_all, turned);
  Eigen::Matrix<double, Registration::kUnknowns, 6> J = Eigen::Matrix<double, Registration::kUnknowns, 6>::Zero();
  u::row_range(J, u::position).leftCols<3>().setIdentity();
  u::row_range(J, u::position).rightCols<3>() = -so3::hat(mean.state.p_WI_m - sensor_in_prior_map_m);
  u::row_range(J, u::attitude).rightCols<3>().setIdentity();
  u::row_range(J, u::velocity).rightCols<3>() = -so3::hat(mean.state.v_WI_m_s);
  const bool free_gravity = u::variances(of_all, u::gravity).maxCoeff() > 0.0;
  if (free_gravity) u::row_range(J, u::gravity).rightCols<3>() = -so3::hat(mean.calibration.gravity_W_m_s2);
  of_all = turned + J * covariance * J.transpose();
  make_symmetric(of_all);
}

void FrameChange::apply(SweepBoundary& boundary) const {
  StateEstimate& estimate = boundary.state_estimate;
  apply(estimate.mean);
  apply(estimate.mean, estimate.prior_weight_covariance);
  apply(estimate.mean, estimate.state_error_covariance);
  estimate.mean.state.covariance = u::sub_block(estimate.prior_weight_covariance, u::motion);
  const Matrix T = rotation();
  Matrix turned;
  propagate_covariance(T, boundary.end_by_start_jacobian, turned);
  boundary.end_by_start_jacobian = turned;
  boundary.clipped_velocity_variance_m2_s2 =
      (T_prior_map_world.linear() * boundary.clipped_velocity_variance_m2_s2 * T_prior_map_world.linear().transpose())
          .eval();
}

void FrameChange::apply(LagWindow& window) const {
  const Matrix T = rotation();
  window.for_each([&](WindowSweep& sweep) {
    for (EstimatedSweep* estimated : {&sweep.predicted, &sweep.filtered, &sweep.smoothed}) {
      apply(estimated->mean);
      apply(estimated->mean, estimated->error_covariance);
    }
    Matrix turned;
    propagate_covariance(T, sweep.jacobian_previous, turned);
    sweep.jacobian_previous = turned;
  });
}

PosesBeforeChange::PosesBeforeChange(const FrameChange& change, const PoseState& last)
    : T_prior_map_world_(change.T_prior_map_world), last_M_m_(change.T_prior_map_world * last.position_W_m) {
  Eigen::Matrix<double, 6, 6> R = Eigen::Matrix<double, 6, 6>::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = T_prior_map_world_.linear();
  last_covariance_M_ = R * last.covariance * R.transpose() + change.covariance;
}

void PosesBeforeChange::apply(PoseState& pose) const {
  const Eigen::Quaterniond q_MW(T_prior_map_world_.linear());
  pose.position_W_m = T_prior_map_world_ * pose.position_W_m;
  pose.orientation_W = (q_MW * pose.orientation_W).normalized();
  pose.velocity_W_m_s = q_MW * pose.velocity_W_m_s;
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Identity();
  A.topRightCorner<3, 3>() = -so3::hat(pose.position_W_m - last_M_m_);
  pose.covariance = A * last_covariance_M_ * A.transpose();
  make_symmetric(pose.covariance);
}

}  // namespace tumble::mapping
