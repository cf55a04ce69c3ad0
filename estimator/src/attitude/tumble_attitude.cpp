// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/tumble_attitude.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

constexpr double kRollingVelocitySigma_m_s = 0.03;  // velocity error of rolling without slip, per filter step
constexpr double kGyroNoise_rad_sqrts = 1e-3;       // angle random walk, including unmodelled errors
constexpr double kRateError_sqrts = 4e-3;           // angle random walk per rad/s of rate, from scale and timing errors
constexpr double kBiasWalk_rad_s_sqrts = 2e-6;      // random walk of the gyro bias
constexpr double kAccelerationNoise_m_s_sqrts = 0.01;  // velocity random walk
constexpr double kVelocity_m_sqrts = 1.0;              // standard deviation of the mean velocity over 1 s of motion
constexpr double kDisplacement_m_sqrts = 0.3;          // standard deviation of the mean displacement over 1 s
constexpr double kDisplacementTau_s = 10.0;            // time constant with which the displacement decays to zero
constexpr double kMotionTau_s = 3.0;  // correlation time of velocity and displacement, averaging time of variances
// A slip starts at a velocity residual above kSlipVelocity_m_s, and can end at a residual below kSlipVelocity_m_s / 2.
constexpr double kSlipVelocity_m_s = 0.12;
constexpr double kSlipQuiet_s = 0.2;  // duration of small velocity residuals after which slip ends
constexpr double kSlipTimeout_s = 3.0;
constexpr double kGapMin_s = 0.05;  // minimum time between two samples that counts as a gap
constexpr double kNode_s = 0.04;    // time between two corrections
constexpr double kReading_s = 4e-3;
constexpr double kSampleGapMax_s = 1.0;  // a longer time between two samples causes an error
// Tilt standard deviations per axis: coarse alignment starts above kLostTilt_rad, where the linearised filter is
// invalid, and ends below kAlignedTilt_rad.
constexpr double kLostTilt_rad = 0.3, kAlignedTilt_rad = 0.4;
constexpr RestDetector::Params kRestDetector = {
    .rate_max_rad_s = 3.4907e-2,
    .rate_spread_rad_s = 3.4907e-2,
    .force_spread_m_s2 = 0.5,
    .rest_s = 1.0,
    .caller_settings = {.reading_s = 0.0,  // the readings are already averaged
                        .memory_s = 1.0}};
constexpr double kRestVelocitySigma_m_s = 0.005;   // standard deviation of the velocity at rest, per filter step
constexpr double kRestRateSigma_rad_sqrts = 2e-3;  // standard deviation of the rate measured at rest, mean over 1 s
constexpr double kRestRateSigmas = 3.0;  // maximum difference of mean gyro rate and bias, in standard deviations
constexpr double kGyroBiasSigmaStart_rad_s = 8.7266e-3;  // prior standard deviation of the gyro bias: 0.5 deg/s
constexpr double kTiltSigmaStart_rad = 0.01;
constexpr double kVelocitySigmaStart_m_s = 0.1;
constexpr double kDisplacementSigmaStart_m = 0.1;
constexpr double kContradicts_sigma2 = 4.0;
constexpr int kTilt = 0, kBias = 2, kVelocity = 5, kDisplacement = 7, kHeading = 9;

/// Applies a scalar Kalman update that does not change the variance of the heading: attitude.md (A4), (A9).
void update(int index, double innovation, double variance, TumbleAttitude::State& state) {
  const double heading = state.covariance(kHeading, kHeading);
  const Eigen::Matrix<double, TumbleAttitude::State::kStates, 1> correction =
      kalman_update_of_component(index, innovation, variance, state.covariance);
  state.q_WI = (so3::exp({correction[kTilt], correction[kTilt + 1], 0.0}) * state.q_WI).normalized();
  state.bias_rad_s += correction.segment<3>(kBias);
  state.v_W_m_s += correction.segment<2>(kVelocity);
  state.displacement_W_m += correction.segment<2>(kDisplacement);
  state.covariance(kHeading, kHeading) = heading;
}

double tilt_variance_rad2(const TumbleAttitude::State& state) {
  return state.covariance.diagonal().segment<2>(kTilt).maxCoeff();
}

/// During a coarse alignment, the reported tilt variance is at least the variance at the start of the alignment.
double reported_tilt_variance_rad2(const TumbleAttitude::State& state) {
  const double filtered = tilt_variance_rad2(state);
  return state.alignment.running ? std::max(filtered, state.alignment.tilt_rad2()) : filtered;
}

void clear_node(TumbleAttitude::State& state) {
  state.integrated_rotation_matrix_s.setZero();
  state.force_integral_W_m_s.setZero();
  state.squared_rate_integral_rad2_s = 0.0;
  state.recovered_angle_variance_rad2.setZero();
  state.time_since_node_s = 0.0;
}

Status check_covariance(const Eigen::Matrix3d& covariance_rad2_s2) {
  if (covariance_rad2_s2.allFinite() && covariance_rad2_s2.diagonal().minCoeff() >= 0.0) return {};
  return {ErrorCode::out_of_range, "rate_covariance_rad2_s2", covariance_rad2_s2.diagonal().minCoeff(), 0.0};
}

}  // namespace

TumbleAttitude::TumbleAttitude(const Params& p) : params_(p), rest_detector_(kRestDetector) {
  require_valid_fields(p);
  require_in_interval("lever_arm_m", p.lever_arm_m.norm(), 0.0, 10.0);
}

Status TumbleAttitude::step(const ImuSample& sample, const Eigen::Matrix3d& rate_covariance_rad2_s2,
                            State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  if (const Status bad = check_covariance(rate_covariance_rad2_s2); !bad.ok()) return bad;
  if (!state.started) {
    if (const Status bad = inclination_from_force(sample.specific_force_m_s2, state.q_WI); !bad.ok()) return bad;
    start(state);
  } else {
    double dt_s = 0.0;
    if (const Status bad = elapsed_time_since_last(sample.time_ns, state.last_time_ns, kSampleGapMax_s, dt_s);
        !bad.ok())
      return bad;
    if (dt_s > kGapMin_s) {
      bridge_gap(sample, rate_covariance_rad2_s2, dt_s, state);
      state.last_time_ns = sample.time_ns;
      return {};
    }
    // While readings are averaged, the attitude is extrapolated from the start of the averaging interval.
    if (state.average.readings == 0) {
      state.last_processed_q_WI = state.q_WI;
    } else {
      state.q_WI = state.last_processed_q_WI;
    }
    state.average.add(sample, dt_s);
    state.recovered_covariance_rad2_s2 +=
        dt_s / state.average.length_s * (rate_covariance_rad2_s2 - state.recovered_covariance_rad2_s2);
    if (state.average.full(kReading_s, dt_s)) {
      process_averaged_reading(state);
    } else {
      const Eigen::Vector3d rate = state.average.mean.angular_velocity_rad_s - state.bias_rad_s;
      if (!state.at_rest) state.q_WI = (state.q_WI * so3::exp(state.average.length_s * rate)).normalized();
    }
  }
  state.last_time_ns = sample.time_ns;
  return {};
}

Eigen::Matrix3d TumbleAttitude::attitude_covariance_rad2(const State& state) {
  constexpr std::array kAttitude = {kTilt, kTilt + 1, kHeading};
  Eigen::Matrix3d covariance = state.covariance(kAttitude, kAttitude);
  if (state.alignment.running) {  // the reported tilt of a coarse alignment must not depend on the filter's corrections
    covariance.topLeftCorner<2, 2>() = reported_tilt_variance_rad2(state) * Eigen::Matrix2d::Identity();
    covariance.topRightCorner<2, 1>().setZero();
    covariance.bottomLeftCorner<1, 2>().setZero();
  }
  return covariance;
}

void TumbleAttitude::process_averaged_reading(State& state) const {
  const ImuSample reading = state.average.mean;
  const double length_s = state.average.length_s;
  state.average = {};
  state.last_processed_q_WI.setIdentity();
  state.at_rest = rest_detector_.detect_stationary(reading, state.stationary_state, state.bias_rad_s) &&
                  rotates_within_gyro_bias(state);
  integrate(reading, length_s, state);
  add_recovered_rate_variance(length_s, state);
  if (state.time_since_node_s >= kNode_s - 0.5 * length_s) end_node(state);
}

/// See attitude.md (A16).
bool TumbleAttitude::rotates_within_gyro_bias(const State& state) const {
  const Eigen::Array3d off_rad_s = (state.stationary_state.mean_rate_rad_s() - state.bias_rad_s).array();
  const Eigen::Array3d variance = state.covariance.diagonal().segment<3>(kBias).array() +
                                  squared(kRestRateSigma_rad_sqrts);  // variance of a mean over 1 s
  return (off_rad_s.square() <= squared(kRestRateSigmas) * variance).all();
}

void TumbleAttitude::start(State& state) const {
  state.covariance.diagonal().segment<2>(kTilt).setConstant(squared(kTiltSigmaStart_rad));
  state.covariance.diagonal().segment<3>(kBias).setConstant(squared(kGyroBiasSigmaStart_rad_s));
  state.covariance.diagonal().segment<2>(kVelocity).setConstant(squared(kVelocitySigmaStart_m_s));
  state.covariance.diagonal().segment<2>(kDisplacement).setConstant(squared(kDisplacementSigmaStart_m));
  state.started = true;
}

/// See attitude.md (A5).
void TumbleAttitude::integrate(const ImuSample& sample, double dt_s, State& state) const {
  Eigen::Vector3d rate = sample.angular_velocity_rad_s - state.bias_rad_s;
  if (state.at_rest) rate.setZero();
  const Eigen::Quaterniond half = so3::exp(0.5 * dt_s * rate);
  const Eigen::Quaterniond q_mid = state.q_WI * half;
  const Eigen::Matrix3d R_mid = q_mid.toRotationMatrix();
  state.q_WI = (q_mid * half).normalized();
  state.integrated_rotation_matrix_s += dt_s * R_mid;
  state.force_integral_W_m_s += dt_s * (R_mid * sample.specific_force_m_s2);
  state.squared_rate_integral_rad2_s += dt_s * rate.squaredNorm();
  state.rate_rad_s = rate;
  state.time_since_node_s += dt_s;
}

/// See attitude.md (A17), (A18).
void TumbleAttitude::bridge_gap(const ImuSample& after, const Eigen::Matrix3d& rate_covariance_rad2_s2, double gap_s,
                                State& state) const {
  if (state.average.readings > 0) process_averaged_reading(state);
  state.at_rest = rest_detector_.detect_stationary(after, state.stationary_state, state.bias_rad_s) &&
                  rotates_within_gyro_bias(state);
  const Eigen::Vector3d from = state.rate_rad_s;
  Eigen::Vector3d to = after.angular_velocity_rad_s - state.bias_rad_s;
  if (state.at_rest) to.setZero();
  ImuSample straight = after;  // assumes that the specific force only balances gravity, so the velocity is constant
  straight.angular_velocity_rad_s = 0.5 * (from + to) + state.bias_rad_s;
  const Eigen::Quaterniond q_mid = state.q_WI * so3::exp(0.25 * gap_s * (from + to));
  straight.specific_force_m_s2 = q_mid.conjugate() * Eigen::Vector3d(0.0, 0.0, params_.gravity_m_s2);
  integrate(straight, gap_s, state);
  state.rate_rad_s = to;
  state.recovered_covariance_rad2_s2 = rate_covariance_rad2_s2;
  add_recovered_rate_variance(gap_s, state);
  if (!state.at_rest) {
    const double turn =
        squared(gap_s) / 12.0 * ((to - from).squaredNorm() / 3.0 + squared(Params::kGapRateWalk_rad_s_sqrts) * gap_s);
    state.recovered_angle_variance_rad2.array() += turn;
    state.covariance.diagonal().segment<2>(kVelocity).array() += squared(Params::kGapVelocityWalk_m_s_sqrts) * gap_s;
  }
  predict_node(state);
  // If a sphere gripped before a data gap, the sphere is assumed to roll without slip after the gap.
  if (params_.radius_m > 0.0 && !state.slipping) state.v_W_m_s = velocity_from_rotation(state);
  // correct_with_mean_force() changes the tilt variance, so reported_tilt_variance_rad2() is called first.
  const double tilt = reported_tilt_variance_rad2(state);
  state.alignment = {};
  correct_with_mean_force(state);
  clear_node(state);
  if (tilt > squared(kLostTilt_rad))
    state.alignment.start_alignment(body_velocity_variance_m2_s2(state.velocity_variance_m2_s2, state), tilt);
}

void TumbleAttitude::end_node(State& state) const {
  predict_node(state);
  if (state.alignment.running) state.alignment.add(state.force_integral_W_m_s, state.time_since_node_s);
  const Eigen::Quaterniond before = state.q_WI;
  correct_with_mean_force(state);
  if (state.alignment.running) align(state.q_WI * before.conjugate(), state);
  clear_node(state);
}

double TumbleAttitude::body_velocity_variance_m2_s2(double power_m2_s2, const State& state) const {
  if (state.at_rest) return squared(kRestVelocitySigma_m_s);
  const double assumed = squared(kVelocity_m_sqrts) / kMotionTau_s;
  const double turning = 0.5 * squared(params_.radius_m) * state.rate_rad_s.squaredNorm();
  return std::max({assumed, power_m2_s2, turning});
}

/// See attitude.md (A19), (A20).
void TumbleAttitude::align(const Eigen::Quaterniond& corrected, State& state) const {
  CoarseAlignment& alignment = state.alignment;
  alignment.integrated_force_W_m_s = corrected * alignment.integrated_force_W_m_s;
  // After a data gap, a wrong tilt falsifies the filtered velocity. The variance of the velocity is therefore not
  // computed from the filtered velocity.
  const double velocity = body_velocity_variance_m2_s2(alignment.start_velocity_variance_m2_s2, state);
  const double variance = alignment.variance_rad2(velocity, params_.gravity_m_s2);
  if (variance > squared(kAlignedTilt_rad)) {
    // When the body comes to rest, the coarse alignment restarts and ignores all earlier data.
    if (state.at_rest && alignment.start_velocity_variance_m2_s2 > velocity)
      alignment.start_alignment(velocity, alignment.tilt_rad2());
    return;
  }
  const double filtered = tilt_variance_rad2(state);
  const bool contradicts = squared(alignment.mean_force_tilt_rad()) > kContradicts_sigma2 * (variance + filtered);
  if (contradicts || variance < filtered) restart(alignment.levelling(), variance, velocity, state);
  alignment = {};
}

/// `levelling` is the rotation that levels the world frame W.
void TumbleAttitude::restart(const Eigen::Quaterniond& levelling, double tilt_rad2, double velocity_m2_s2,
                             State& state) const {
  state.q_WI = (levelling * state.q_WI).normalized();
  const Eigen::Matrix3d bias = state.covariance.block<3, 3>(kBias, kBias);
  const double heading = state.covariance(kHeading, kHeading);
  state.covariance.setZero();
  state.covariance.diagonal().segment<2>(kTilt).setConstant(tilt_rad2);
  state.covariance.block<3, 3>(kBias, kBias) = bias;
  state.covariance.diagonal().segment<2>(kVelocity).setConstant(velocity_m2_s2);
  const double displacement = squared(kDisplacement_m_sqrts) / kMotionTau_s;
  state.covariance.diagonal().segment<2>(kDisplacement).setConstant(displacement);
  state.covariance(kHeading, kHeading) = heading;
  state.v_W_m_s = state.at_rest ? Eigen::Vector2d::Zero().eval() : velocity_from_rotation(state);
  state.displacement_W_m.setZero();
  state.velocity_variance_m2_s2 = velocity_m2_s2;
  state.displacement_variance_m2 = 0.0;
}

/// Adds the variance of the rates recovered from clipped readings to the variance of the attitude: attitude.md (A10).
void TumbleAttitude::add_recovered_rate_variance(double dt_s, State& state) const {
  if (state.at_rest || state.recovered_covariance_rad2_s2.isZero(0.0)) {
    state.recovered_angle_sigma_sum_rad.setZero();
  } else {
    const Eigen::Matrix3d R = state.q_WI.toRotationMatrix();
    const Eigen::Vector3d variance = (R * state.recovered_covariance_rad2_s2 * R.transpose()).diagonal().cwiseMax(0.0);
    const Eigen::Vector2d step_rad =
        dt_s * Eigen::Vector2d(std::sqrt(variance.head<2>().mean()), std::sqrt(variance.z()));
    state.recovered_angle_variance_rad2 += step_rad.cwiseProduct(2.0 * state.recovered_angle_sigma_sum_rad + step_rad);
    state.recovered_angle_sigma_sum_rad =
        std::exp(-dt_s / Params::kRecoveredTau_s) * state.recovered_angle_sigma_sum_rad + step_rad;
  }
  state.recovered_covariance_rad2_s2.setZero();
}

/// Predicts one filter step: attitude.md (A6), (A7), (A8), (A9).
void TumbleAttitude::predict_node(State& state) const {
  const double h = state.time_since_node_s;
  const double keep = std::exp(-h / kDisplacementTau_s);
  const Eigen::Vector2d gained = state.force_integral_W_m_s.head<2>();  // gravity has no horizontal component
  state.displacement_W_m = keep * state.displacement_W_m + h * (state.v_W_m_s + 0.5 * gained);
  state.v_W_m_s += gained;

  State::Covariance F = State::Covariance::Identity();
  if (!state.at_rest) {
    F.block<2, 3>(kTilt, kBias) = -state.integrated_rotation_matrix_s.topRows<2>();
    F.block<1, 3>(kHeading, kBias) = -state.integrated_rotation_matrix_s.row(2);
  }
  // A tilt error phi changes the velocity by the horizontal part of the cross product of phi and the integrated force.
  F(kVelocity, kTilt + 1) = state.force_integral_W_m_s.z();
  F(kVelocity + 1, kTilt) = -state.force_integral_W_m_s.z();
  F.block<2, 2>(kDisplacement, kVelocity) = h * Eigen::Matrix2d::Identity();
  F.block<2, 2>(kDisplacement, kDisplacement) = keep * Eigen::Matrix2d::Identity();
  state.covariance = (F * state.covariance * F.transpose()).eval();

  const double turn =
      squared(kGyroNoise_rad_sqrts) * h + squared(kRateError_sqrts) * state.squared_rate_integral_rad2_s;
  state.covariance.diagonal().segment<2>(kTilt).array() += turn + state.recovered_angle_variance_rad2[0];
  if (state.alignment.running)
    state.alignment.tilt_variance_growth_rad2 += turn + state.recovered_angle_variance_rad2[0];
  state.covariance(kHeading, kHeading) += state.at_rest ? 0.0 : turn + state.recovered_angle_variance_rad2[1];
  state.covariance.diagonal().segment<3>(kBias).array() += squared(kBiasWalk_rad_s_sqrts) * h;
  state.covariance.diagonal().segment<2>(kVelocity).array() += squared(kAccelerationNoise_m_s_sqrts) * h;
}

bool TumbleAttitude::detect_slip(const Eigen::Vector2d& misfit_m_s, State& state) const {
  const double misfit = misfit_m_s.norm();
  state.slip_duration_s = state.slipping ? state.slip_duration_s + state.time_since_node_s : 0.0;
  state.grip_duration_s = misfit < 0.5 * kSlipVelocity_m_s ? state.grip_duration_s + state.time_since_node_s : 0.0;
  if (state.slipping) {
    state.slipping = !state.at_rest && state.grip_duration_s <= kSlipQuiet_s;
    if (state.slip_duration_s > kSlipTimeout_s) {
      // After a slip, the velocity from rolling is more accurate than the integrated velocity.
      state.covariance.diagonal().segment<2>(kVelocity).array() += squared(misfit);
      state.slipping = false;
    }
  } else {
    state.slipping = !state.at_rest && misfit > kSlipVelocity_m_s;
  }
  return state.slipping;
}

/// See attitude.md (A13).
double TumbleAttitude::body_motion_variance(const Eigen::Vector2d& misfit, int index, double sigma_sqrts, double power,
                                            const State& state) const {
  const double seen = 0.5 * (misfit.squaredNorm() - state.covariance.block<2, 2>(index, index).trace());
  const double decayed_power = std::exp(-state.time_since_node_s / kMotionTau_s) * power;
  return std::max({squared(sigma_sqrts) / kMotionTau_s, seen, decayed_power});
}

/// See attitude.md (A12), (A14).
void TumbleAttitude::correct_body_motion(const Eigen::Vector2d& turned_m_s, State& state) const {
  const double memories = kMotionTau_s / state.time_since_node_s;
  if (!state.at_rest) {
    const Eigen::Vector2d misfit = turned_m_s - state.v_W_m_s;
    double& power = state.velocity_variance_m2_s2;
    power = body_motion_variance(misfit, kVelocity, kVelocity_m_sqrts, power, state);
    for (int axis = 0; axis < 2; ++axis) {
      update(kVelocity + axis, turned_m_s[axis] - state.v_W_m_s[axis], power * memories, state);
    }
  }
  double& power = state.displacement_variance_m2;
  power = body_motion_variance(-state.displacement_W_m, kDisplacement, kDisplacement_m_sqrts, power, state);
  for (int axis = 0; axis < 2; ++axis) {
    update(kDisplacement + axis, -state.displacement_W_m[axis], power * memories, state);
  }
}

/// Returns the horizontal velocity of the IMU due to the body's rotation: attitude.md (A11).
Eigen::Vector2d TumbleAttitude::velocity_from_rotation(const State& state) const {
  const Eigen::Vector3d w_W = state.q_WI * state.rate_rad_s;
  const Eigen::Vector3d arm_W = state.q_WI * params_.lever_arm_m + params_.radius_m * Eigen::Vector3d::UnitZ();
  return w_W.cross(arm_W).head<2>();
}

/// See attitude.md (A11), (A12).
void TumbleAttitude::correct_with_mean_force(State& state) const {
  const double h = state.time_since_node_s;
  const Eigen::Vector2d turned = velocity_from_rotation(state);
  const bool rolls = params_.radius_m > 0.0;
  if (state.at_rest) {
    if (rolls) detect_slip(turned - state.v_W_m_s, state);
    for (int axis = 0; axis < 2; ++axis) {
      update(kVelocity + axis, -state.v_W_m_s[axis], squared(kRestVelocitySigma_m_s), state);
    }
  } else if (rolls && !detect_slip(turned - state.v_W_m_s, state)) {
    for (int axis = 0; axis < 2; ++axis) {
      update(kVelocity + axis, turned[axis] - state.v_W_m_s[axis], squared(kRollingVelocitySigma_m_s), state);
    }
  }
  if (!rolls) correct_body_motion(turned, state);
  if (state.at_rest) {
    const Eigen::Vector3d mean_rate_rad_s = state.stationary_state.mean_rate_rad_s();
    for (int axis = 0; axis < 3; ++axis) {
      update(kBias + axis, mean_rate_rad_s[axis] - state.bias_rad_s[axis], squared(kRestRateSigma_rad_sqrts) / h,
             state);
    }
  }
  state.covariance = (0.5 * (state.covariance + state.covariance.transpose())).eval();
}

}  // namespace tumble
