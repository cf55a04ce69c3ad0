// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/vqf.hpp"

#include "tumble/attitude/detail/coarse_alignment.hpp"
#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

constexpr double kBiasSigmaStart_rad_s = 8.7266e-3;  // prior standard deviation of the bias: 0.5 deg/s
// standard deviation of the gyro bias in motion: 0.1 deg/s
constexpr double kBiasSigmaMotion_rad_s = 1.7453e-3;
// standard deviation of the gyro bias at rest: 0.03 deg/s
constexpr double kBiasSigmaRest_rad_s = 5.2360e-4;
// weight of the assumption that the unobservable vertical gyro bias is zero
constexpr double kVerticalForgetting = 1e-4;
// time constant of the low-pass filter for detecting rest
constexpr double kRestTau_s = 0.5;
// time in which the variance of the gyro bias grows to (0.1 deg/s)^2
constexpr double kBiasForgetting_s = 100.0;
constexpr double kBiasClip_rad_s = 3.4907e-2;  // largest accepted bias: 2 deg/s
constexpr double kRestTime_s = 1.5;
// maximum difference between angular rate and low-passed angular rate at rest: 2 deg/s
constexpr double kRestRate_rad_s = 3.4907e-2;
// maximum difference between specific force and low-passed specific force at rest
constexpr double kRestForce_m_s2 = 0.5;

constexpr double kNoDirection_m_s2 = 1e-6;
/// standard deviation of the gyro bias' change within kBiasForgetting_s (0.1 deg/s in the VQF publication)
constexpr double kForgottenSigma_rad_s = 1.7453292519943295e-3;

/// Returns the measurement variance with which a scalar Kalman filter of the gyro bias converges to the standard
/// deviation `sigma`. `growth` is the increase of the bias variance per step.
double steady_state_noise(double sigma, double growth) {
  const double variance = sigma * sigma;
  return variance * variance / growth + variance;
}

}  // namespace

Vqf::Vqf(const Params& p) : params_(p) {
  require_valid_fields(p);
}

Status Vqf::step(const ImuSample& sample, State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  double dt_s = 0.0;
  if (state.started) {
    if (const Status bad = elapsed_time_since_last(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s);
        !bad.ok())
      return bad;
  } else {
    if (const Status bad = inclination_from_force(sample.specific_force_m_s2, state.inclination_correction); !bad.ok())
      return bad;
    state.bias_covariance_rad2_s2.diagonal().setConstant(kBiasSigmaStart_rad_s * kBiasSigmaStart_rad_s);
  }
  if (dt_s > 0.0) {
    detect_rest(sample, dt_s, state);
    state.attitude_without_correction =
        (state.attitude_without_correction * so3::exp((sample.angular_velocity_rad_s - state.bias_rad_s) * dt_s))
            .normalized();
    if (sample.specific_force_m_s2.norm() >= kNoDirection_m_s2) {
      const Eigen::Vector3d up_W = level_inertial_frame(sample.specific_force_m_s2, dt_s, state);
      if (params_.rest_bias_estimation || params_.motion_bias_estimation) estimate_bias(up_W, dt_s, state);
    }
  }
  state.q_WI = (state.inclination_correction * state.attitude_without_correction).normalized();
  state.last_time_ns = sample.time_ns;
  state.started = true;
  return {};
}

void Vqf::detect_rest(const ImuSample& sample, double dt_s, State& state) const {
  const double warp = low_pass_prewarp(kRestTau_s, dt_s);
  state.rest_rate_rad_s.advance(sample.angular_velocity_rad_s, kRestTau_s, dt_s, warp);
  state.rest_force_m_s2.advance(sample.specific_force_m_s2, kRestTau_s, dt_s, warp);
  const bool quiet = (sample.angular_velocity_rad_s - state.rest_rate_rad_s.value).norm() < kRestRate_rad_s &&
                     (sample.specific_force_m_s2 - state.rest_force_m_s2.value).norm() < kRestForce_m_s2 &&
                     state.rest_rate_rad_s.value.cwiseAbs().maxCoeff() <= kBiasClip_rad_s;
  state.rest_s = quiet ? state.rest_s + dt_s : 0.0;
  state.at_rest = state.rest_s >= kRestTime_s && quiet;
}

/// Levels frame W. Returns the upward unit vector along the specific force, in frame W before levelling.
Eigen::Vector3d Vqf::level_inertial_frame(const Eigen::Vector3d& f_I_m_s2, double dt_s, State& state) const {
  // See attitude.md (A3).
  state.filtered_specific_force_m_s2.advance(state.attitude_without_correction * f_I_m_s2, params_.tau_s, dt_s,
                                             low_pass_prewarp(params_.tau_s, dt_s));
  const double length = state.filtered_specific_force_m_s2.value.norm();
  if (length < kNoDirection_m_s2) return Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_W = state.inclination_correction * (state.filtered_specific_force_m_s2.value / length);
  // See attitude.md (A2).
  state.inclination_correction = (levelling(up_W) * state.inclination_correction).normalized();
  return up_W;
}

void Vqf::estimate_bias(const Eigen::Vector3d& up_W, double dt_s, State& state) const {
  const double warp = low_pass_prewarp(params_.tau_s, dt_s);
  Eigen::Matrix3d R = (state.inclination_correction * state.attitude_without_correction).toRotationMatrix();
  const Eigen::Vector3d& b = state.bias_rad_s;
  state.bias_W_rad_s.advance((R * b).head<2>(), params_.tau_s, dt_s, warp);
  state.R_WI.advance(Eigen::Map<const Eigen::Matrix<double, 9, 1>>(R.data()), params_.tau_s, dt_s, warp);

  Eigen::Matrix3d& P = state.bias_covariance_rad2_s2;
  const double growth = kForgottenSigma_rad_s * kForgottenSigma_rad_s * dt_s / kBiasForgetting_s;
  const double start = kBiasSigmaStart_rad_s * kBiasSigmaStart_rad_s;
  for (int axis = 0; axis < 3; ++axis) {
    if (P(axis, axis) < start) P(axis, axis) += growth;
  }

  Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
  Eigen::Vector3d innovation, noise;
  if (state.at_rest && params_.rest_bias_estimation) {
    innovation = state.rest_rate_rad_s.value - b;
    noise.setConstant(steady_state_noise(kBiasSigmaRest_rad_s, growth));
  } else if (params_.motion_bias_estimation) {
    H = Eigen::Map<const Eigen::Matrix3d>(state.R_WI.value.data());
    // The measured gyro bias is the low-passed bias estimate plus the rate at which levelling rotates the vertical.
    const Eigen::Vector2d low_passed = state.bias_W_rad_s.value;
    innovation = Eigen::Vector3d(low_passed.x() - up_W.y() / dt_s, low_passed.y() + up_W.x() / dt_s, 0.0) - H * b;
    const double motion = steady_state_noise(kBiasSigmaMotion_rad_s, growth);
    noise = {motion, motion, motion / kVerticalForgetting};
  } else {
    return;
  }
  const double clip = kBiasClip_rad_s;
  innovation = innovation.cwiseMax(-clip).cwiseMin(clip);
  const Eigen::Vector3d correction = vector_update<3, 3>(H, innovation, noise.asDiagonal(), P);
  state.bias_rad_s = (b + correction).cwiseMax(-clip).cwiseMin(clip);
}

}  // namespace tumble
