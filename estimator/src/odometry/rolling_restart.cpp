// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "rolling_odometry_impl.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

// standard deviations for a gap of the IMU data: speed, rate about the vertical, and heading after a long gap
constexpr double kGapSpeed_m_s = 0.5, kGapTurn_rad_s = 1.0, kUnknownHeading_rad = 1.8;

/// Removes the tilt from the covariance of the last pose, because a restart levels the attitude.
Eigen::Matrix<double, 6, 6> position_and_heading(Eigen::Matrix<double, 6, 6> covariance) {
  covariance.middleRows<2>(3).setZero();
  covariance.middleCols<2>(3).setZero();
  return covariance;
}

}  // namespace

void RollingOdometry::Impl::restart_at_newest(double gap_s) {
  const std::size_t before = finished_results_.size();
  end_continuous_run();
  std::optional<PoseState> pose;
  if (const std::optional<Pose> live = newest()) pose = live->pose;
  if (finished_results_.size() > before) {
    const RollingEstimate& last = finished_results_.back();
    pose = {last.time_ns, last.sphere_centre_W_m, last.q_WI, last.sphere_velocity_W_m_s, last.covariance};
  }
  Eigen::Isometry3d T_WG = start_.value_or(Eigen::Isometry3d::Identity());
  RollingRestart restart;
  if (pose) {
    T_WG.linear() = pose->orientation_W.toRotationMatrix();
    T_WG.translation() = pose->position_W_m;
    restart = RollingRestart{T_WG.translation(), position_and_heading(pose->covariance)};
    const double moved_m = gap_s * std::hypot(pose->velocity_W_m_s.norm(), kGapSpeed_m_s);
    const double turned_rad = std::min(gap_s * kGapTurn_rad_s, kUnknownHeading_rad);
    restart.covariance.diagonal().head<2>().array() += moved_m * moved_m;
    restart.covariance(5, 5) += turned_rad * turned_rad;
  }
  start_continuous_run();
  start_ = T_WG;
  ++restart_count_;
  restart_ = restart;
}

void RollingOdometry::Impl::initialise_pose() {
  if (!start_ || !state_->live_filter.started) return;
  const RollingEstimate first = RollingFilter::estimate(state_->live_filter);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(start_->linear()) * first.q_WI.conjugate();
  Eigen::Isometry3d T_WR = Eigen::Isometry3d::Identity();
  T_WR.linear() = so3::exp({0.0, 0.0, 2.0 * std::atan2(turn.z(), turn.w())}).toRotationMatrix();
  T_WR.translation() = start_->translation() - T_WR.linear() * first.sphere_centre_W_m;
  T_world_run_origin_ = T_WR;
  start_.reset();
}

RollingEstimate RollingOdometry::Impl::transform_to_world(RollingEstimate estimate) const {
  estimate.position_uncertain = estimate.position_uncertain || restart_.has_value();
  if (!T_world_run_origin_) return estimate;
  const Eigen::Matrix3d R = T_world_run_origin_->linear();
  Eigen::Matrix<double, 6, 6> both = Eigen::Matrix<double, 6, 6>::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = R;
  estimate.sphere_centre_W_m = *T_world_run_origin_ * estimate.sphere_centre_W_m;
  estimate.q_WI = (Eigen::Quaterniond(R) * estimate.q_WI).normalized();
  estimate.sphere_velocity_W_m_s = R * estimate.sphere_velocity_W_m_s;
  estimate.covariance = both * estimate.covariance * both.transpose();
  if (!restart_) return estimate;
  Eigen::Matrix<double, 6, 6> moved = Eigen::Matrix<double, 6, 6>::Identity();
  moved.topRightCorner<3, 3>() = -so3::hat(estimate.sphere_centre_W_m - restart_->sphere_centre_W_m);
  estimate.covariance += moved * restart_->covariance * moved.transpose();
  return estimate;
}

}  // namespace tumble
