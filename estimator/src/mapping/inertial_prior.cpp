// SPDX-License-Identifier: BSD-3-Clause
#include "inertial_prior.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/attitude/detail/strapdown.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace {

// standard deviation of the specific force along a saturated accelerometer axis
constexpr double kSaturatedForceSigma_m_s2 = 50.0;
// ratio of the standard deviations of the process noise at rest and in motion
constexpr double kRestNoiseRatio = 0.02;
// standard deviation of the initial speed of a robot that seems to be at rest
constexpr double kStartSpeedSigma_m_s = 0.05;

}  // namespace

namespace u = unknowns;

/// See mapping.md (R39), (R40), (R41), (R43).
Eigen::Matrix<double, 9, 9> inertial_noise(const LidarInertialOdometry::Params& params,
                                           const SweepTrajectory& trajectory, std::span<const MotionSample> samples,
                                           unsigned deficit_axes) {
  const double span = trajectory.duration_s() / InertialNoiseParams::kSweepInterval_s;
  Eigen::Matrix<double, 9, 9> noise = Eigen::Matrix<double, 9, 9>::Zero();
  u::variances(noise, u::position).setConstant(std::pow(params.expert.prior.sigma_m * span, 2));
  u::variances(noise, u::attitude).setConstant(std::pow(params.expert.prior.sigma_rad * span, 2));

  const TimeNs start_ns = trajectory.start_ns();
  std::size_t hint = 0;
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  double rotated_rad = 0.0, velocity_change_m_s = 0.0, gap_m2_s2 = 0.0, gap_m2 = 0.0, gap_m2_s = 0.0;
  const double gap_m2_s3 = std::pow(params.expert.prior.kGapVelocityWalk_m_s_sqrt_s, 2);
  for (const MotionSample& sample : samples) {
    const double from = std::max(seconds(sample.from_ns - start_ns), 0.0);
    const double to = std::min(seconds(sample.time_ns - start_ns), trajectory.duration_s());
    if (to <= from) continue;
    const Eigen::Matrix3d R = trajectory.at(0.5 * (from + to), hint).q_WI.toRotationMatrix();
    Eigen::Vector3d variance = sample.rate_sigma_rad_s.cwiseAbs2();
    for (int axis = 0; axis < 3; ++axis) {
      if (deficit_axes >> axis & sample.clipped_axes >> axis & 1) variance[axis] = 0.0;
    }
    const double dt = to - from, walk_m2_s3 = sample.bridges_gap ? gap_m2_s3 : 0.0;
    gap_m2 += dt * (2.0 * gap_m2_s + dt * (gap_m2_s2 + walk_m2_s3 * dt / 3.0));
    gap_m2_s += dt * (gap_m2_s2 + 0.5 * walk_m2_s3 * dt);
    gap_m2_s2 += walk_m2_s3 * dt;
    if (!sample.bridges_gap) velocity_change_m_s += dt * sample.f_I_m_s2.norm();
    rotated_rad += dt * sample.w_WI_I_rad_s.norm();
    turned += dt * R * variance.asDiagonal() * R.transpose();
  }
  u::variances(noise, u::velocity)
      .setConstant(std::pow(params.expert.prior.kSigma_m_s * span, 2) +
                   std::pow(params.expert.prior.kForceShare * velocity_change_m_s, 2) + gap_m2_s2);
  u::variances(noise, u::position).array() += gap_m2;
  // A robot at rest has zero velocity, so errors of gyro and accelerometer hardly change its predicted pose.
  const auto rests = [&](const MotionSample& sample) {
    return sample.at_rest || seconds(sample.from_ns - start_ns) >= trajectory.duration_s();
  };
  if (std::all_of(samples.begin(), samples.end(), rests)) return kRestNoiseRatio * kRestNoiseRatio * noise;
  u::sub_block(noise, u::attitude) += trajectory.duration_s() * turned;  // mapping.md (R42)
  u::variances(noise, u::attitude).array() += std::pow(params.expert.prior.kRotationNoiseRatio * rotated_rad, 2);
  return noise;
}

/// See mapping.md (R45).
Eigen::Matrix3d velocity_variance_from_clipping(const SweepTrajectory& trajectory,
                                                std::span<const MotionSample> samples) {
  std::size_t hint = 0;
  Eigen::Matrix3d lasted = Eigen::Matrix3d::Zero();  // column j: accelerometer axis j, times its saturated time
  for (const MotionSample& sample : samples) {
    const double from = std::max(seconds(sample.from_ns - trajectory.start_ns()), 0.0);
    const double to = std::min(seconds(sample.time_ns - trajectory.start_ns()), trajectory.duration_s());
    if (to <= from || sample.accel_saturated_axes == 0) continue;
    const Eigen::Matrix3d R = trajectory.at(0.5 * (from + to), hint).q_WI.toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) {
      if (sample.accel_saturated_axes >> axis & 1) lasted.col(axis) += (to - from) * R.col(axis);
    }
  }
  return kSaturatedForceSigma_m_s2 * kSaturatedForceSigma_m_s2 * lasted * lasted.transpose();
}

Status start_at_rest(std::span<const MotionSample> samples, MotionState& state) {
  if (samples.empty()) return {ErrorCode::insufficient_data, "imu samples", 0.0, 1.0};
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const MotionSample& sample : samples) {
    if (seconds(sample.time_ns - samples.front().from_ns) > StationaryBounds::kLevellingMax_s && count > 0.0) break;
    force += sample.f_I_m_s2;
    count += 1.0;
  }
  if (Status status = level_at_rest(force / count, state); !status.ok()) return status;
  state.time_ns = samples.front().from_ns;
  return {};
}

Status level_at_rest(const Eigen::Vector3d& force_I_m_s2, MotionState& state) {
  const double force_m_s2 = force_I_m_s2.norm();
  if (!(force_m_s2 >= 1.0)) return {ErrorCode::degenerate, "specific_force_m_s2", force_m_s2, 1.0};
  state = MotionState{};
  if (Status status = inclination_from_force(force_I_m_s2, state.q_WI); !status.ok()) return status;
  u::variances(state.covariance, u::tilt).setConstant(OdometryStart::kLevelSigma_rad * OdometryStart::kLevelSigma_rad);
  u::variances(state.covariance, u::velocity).setConstant(kStartSpeedSigma_m_s * kStartSpeedSigma_m_s);
  return {};
}

Eigen::Vector3d assumed_rate_sigma(const LidarInertialOdometry::Params& params, const AngularRateState& rate) {
  Eigen::Vector3d sigma = rate.covariance_rad2_s2.diagonal().cwiseMax(0.0).cwiseSqrt();
  const bool recovered =
      rate.source == AngularRateSource::recovered_in_flight || rate.source == AngularRateSource::recovered_in_contact;
  for (int axis = 0; axis < 3; ++axis) {
    if (rate.clipped_axes >> axis & 1 && !recovered)
      sigma[axis] = std::max(sigma[axis], params.expert.saturated_imu.kRateSigma_rad_s);
  }
  return sigma.cwiseMin(params.expert.prior.kRateSigmaMax_rad_s);
}

}  // namespace tumble::mapping
