// SPDX-License-Identifier: BSD-3-Clause
#include "frame_change.hpp"

#include "../common/symmetric.hpp"
#include "tumble/common/so3.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace u = unknowns;
using Matrix = Registration::Matrix;

Matrix FrameChange::rotation() const {
  Matrix T = Matrix::Identity();
  const Eigen::Matrix3d R = T_MW.linear();
  u::block(T, u::position) = R;
  u::block(T, u::attitude) = R;
  u::block(T, u::velocity) = R;
  u::block(T, u::gravity) = R;
  return T;
}

void FrameChange::apply(Registration::Estimate& mean) const {
  const Eigen::Quaterniond q_MW(T_MW.linear());
  MotionState& state = mean.state;
  state.p_WI_m = T_MW * state.p_WI_m;
  state.q_WI = (q_MW * state.q_WI).normalized();
  state.v_WI_m_s = q_MW * state.v_WI_m_s;
  mean.calibration.gravity_W_m_s2 = q_MW * mean.calibration.gravity_W_m_s2;
  Matrix of_motion = Matrix::Zero();
  u::block(of_motion, u::motion) = state.covariance;
  apply(mean, of_motion);
  state.covariance = u::block(of_motion, u::motion);
}

void FrameChange::apply(const Registration::Estimate& mean, Matrix& of_all) const {
  const Matrix T = rotation();
  Matrix turned;
  propagate_covariance(T, of_all, turned);
  Eigen::Matrix<double, Registration::kUnknowns, 6> J = Eigen::Matrix<double, Registration::kUnknowns, 6>::Zero();
  u::rows(J, u::position).leftCols<3>().setIdentity();
  u::rows(J, u::position).rightCols<3>() = -so3::hat(mean.state.p_WI_m - sensor_M_m);
  u::rows(J, u::attitude).rightCols<3>().setIdentity();
  u::rows(J, u::velocity).rightCols<3>() = -so3::hat(mean.state.v_WI_m_s);
  const bool free_gravity = u::variances(of_all, u::gravity).maxCoeff() > 0.0;
  if (free_gravity) u::rows(J, u::gravity).rightCols<3>() = -so3::hat(mean.calibration.gravity_W_m_s2);
  of_all = turned + J * covariance * J.transpose();
  make_symmetric(of_all);
}

void FrameChange::apply(SweepBoundary& boundary) const {
  StateEstimate& estimate = boundary.state_estimate;
  apply(estimate.mean);
  apply(estimate.mean, estimate.weight);
  apply(estimate.mean, estimate.error);
  estimate.mean.state.covariance = u::block(estimate.weight, u::motion);
  const Matrix T = rotation();
  Matrix turned;
  propagate_covariance(T, boundary.end_start_jacobian, turned);
  boundary.end_start_jacobian = turned;
  boundary.clipped_velocity_m2_s2 =
      (T_MW.linear() * boundary.clipped_velocity_m2_s2 * T_MW.linear().transpose()).eval();
}

void FrameChange::apply(LagWindow& window) const {
  const Matrix T = rotation();
  window.for_each([&](WindowSweep& sweep) {
    for (Estimated* estimated : {&sweep.predicted, &sweep.filtered, &sweep.smoothed}) {
      apply(estimated->mean);
      apply(estimated->mean, estimated->errors);
    }
    Matrix turned;
    propagate_covariance(T, sweep.jacobian_previous, turned);
    sweep.jacobian_previous = turned;
  });
}

}  // namespace tumble::mapping
