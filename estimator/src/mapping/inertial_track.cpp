// SPDX-License-Identifier: BSD-3-Clause
#include "inertial_track.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/odometry_params.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace {

// standard deviation of the specific force along a saturated accelerometer axis
constexpr double kSaturatedForceSigma_m_s2 = 50.0;
// ratio of the standard deviations of the process noise at rest and in motion
constexpr double kRestNoiseRatio = 0.02;
// standard deviation of the initial speed of a robot that seems to be at rest
constexpr double kStartSpeedSigma_m_s = 0.05;

constexpr TimeNs kStep_ns = 10'000'000;
constexpr TimeNs kStepsMax = 64;

using Params = LidarInertialOdometry::Params;

WindowRate rate_of(const MotionSample& sample) {
  return {sample.w_WI_I_rad_s, sample.rate_sigma_rad_s, sample.from_ns, sample.time_ns};
}

std::uint8_t accel_saturated_axes(const Params& params, const ImuSample& sample) {
  std::uint8_t axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const bool railed = std::abs(sample.specific_force_m_s2[axis]) >= params.expert.saturated_imu.accel_m_s2 ||
                        (sample.device_clip_flags & (kClipAccelX << axis)) != 0;
    if (railed) axes |= static_cast<std::uint8_t>(1 << axis);
  }
  return axes;
}

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

/// See mapping.md (R44).
void bridge_gap(const WindowRate& before, const WindowRate& after, std::vector<MotionSample>& samples) {
  const TimeNs from_ns = before.time_ns, to_ns = after.from_ns;
  const TimeNs step_ns = std::max(kStep_ns, (to_ns - from_ns) / kStepsMax + 1);
  const double span_s = seconds(to_ns - from_ns), walk = InertialNoiseParams::kGapRateWalk_rad_s_sqrt_s;
  for (TimeNs at_ns = from_ns; at_ns < to_ns; at_ns += step_ns) {
    MotionSample& part = samples.emplace_back();
    part.from_ns = at_ns;
    part.time_ns = std::min(at_ns + step_ns, to_ns);
    const double gone = seconds(at_ns - from_ns + (part.time_ns - at_ns) / 2) / span_s, left = 1.0 - gone;
    part.w_WI_I_rad_s = left * before.rate_rad_s + gone * after.rate_rad_s;
    const Eigen::Array3d variance = (left * before.sigma_rad_s).array().square() +
                                    (gone * after.sigma_rad_s).array().square() + walk * walk * gone * left * span_s;
    part.rate_sigma_rad_s = variance.sqrt().min(InertialNoiseParams::kRateSigmaMax_rad_s);
    part.clipped_axes = kClipGyro;
    part.bridges_gap = true;
  }
}

RestDetector::Params mapping_stationary_params(const LidarInertialOdometry::Params& params) {
  // RestDetector limits the spread of the rate on each axis. The factor 1/sqrt(3) limits the norm of the three spreads
  // to kRate_rad_s.
  return {
      .rate_max_rad_s = StationaryBounds::kRate_rad_s,
      .rate_spread_rad_s = StationaryBounds::kRate_rad_s / std::numbers::sqrt3,
      .force_spread_m_s2 = StationaryBounds::kForce_m_s2,
      .rest_s = 0.0,
      .caller_settings = {.force_min_m_s2 = std::max(params.expert.gravity_m_s2 - StationaryBounds::kForce_m_s2, 0.0),
                          .force_max_m_s2 = params.expert.gravity_m_s2 + StationaryBounds::kForce_m_s2}};
}

InertialTrack::InertialTrack(const Params& params) : rest_detector_(mapping_stationary_params(params)) {}

std::optional<TimeNs> InertialTrack::last_ns() const {
  return samples_.empty() ? sweep_boundary_ns_ : samples_.back().time_ns;
}

Status InertialTrack::check(const ImuSample& sample) const {
  const std::optional<TimeNs> last = last_ns();
  if (last && sample.time_ns <= *last) {
    return {ErrorCode::time_order, "time_ns", double(sample.time_ns), double(*last)};
  }
  return {};
}

void InertialTrack::store_sample(const Params& params, const ImuSample& sample, const AngularRateState& rate) {
  const TimeNs from_ns = last_ns().value_or(sample.time_ns);
  // The first IMU sample has no previous time stamp, so its averaging window is assumed as long as the averaging window
  // of the second sample.
  if (!sweep_boundary_ns_ && samples_.size() == 1) samples_[0].from_ns = 2 * from_ns - sample.time_ns;
  MotionSample next;
  next.from_ns = from_ns;
  next.time_ns = sample.time_ns;
  update_rest(sample, rate, next);
  if (!next.at_rest) next.w_WI_I_rad_s = rate.w_WI_I_rad_s - initial_rest_.gyro_bias_rad_s;
  next.f_I_m_s2 = sample.specific_force_m_s2;
  next.rate_sigma_rad_s = assumed_rate_sigma(params, rate);
  next.clipped_axes = static_cast<std::uint8_t>(rate.clipped_axes & kClipGyro);
  next.accel_saturated_axes = accel_saturated_axes(params, sample);
  const bool after_gap = next.time_ns - next.from_ns > kGap_ns;
  // After a gap, the averaging window of the first sample is assumed as long as the last averaging window before the
  // gap.
  if (after_gap && newest_rate_ && !next.at_rest)
    next.from_ns = std::max(from_ns, next.time_ns - (newest_rate_->time_ns - newest_rate_->from_ns));
  next.bridges_gap = after_gap && next.from_ns == from_ns;
  if (next.bridges_gap) next.rate_sigma_rad_s.setConstant(params.expert.prior.kRateSigmaMax_rad_s);
  second_newest_rate_ = newest_rate_;
  newest_rate_ = rate_of(next);
  if (after_gap && !next.bridges_gap) fill_gap();
  samples_.push_back(next);
}

void InertialTrack::fill_gap() {
  const std::size_t first = samples_.size();
  bridge_gap(*second_newest_rate_, *newest_rate_, samples_);
  if (pending_rates_rad_s_.empty()) return;
  for (const MotionSample& part : std::span(samples_).subspan(first))
    pending_rates_rad_s_.insert(pending_rates_rad_s_.end() - 1, part.w_WI_I_rad_s);
}

void InertialTrack::update_rest(const ImuSample& sample, const AngularRateState& rate, MotionSample& next) {
  ImuSample received = sample;
  received.angular_velocity_rad_s = rate.w_WI_I_rad_s;
  const bool clipped = (rate.clipped_axes & kClipGyro) != 0;
  const Eigen::Vector3d bias =
      initial_rest_.still_stationary ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : initial_rest_.gyro_bias_rad_s;
  if (clipped) stationary_state_ = {};
  if (!clipped && rest_detector_.detect_stationary(received, stationary_state_, bias))
    next.rest_start_ns = stationary_state_.first_ns;
  if (initial_rest_.still_stationary) {
    if (!initial_rest_.first_ns) initial_rest_.first_ns = initial_rest_.initial_rest_start_ns = sample.time_ns;
    // At the start of a recording, noise may interrupt the detected rest. If a new rest starts within kBiasRest_s of
    // the first sample, the new rest counts as the initial rest.
    if (next.rest_start_ns && seconds(*next.rest_start_ns - *initial_rest_.first_ns) < OdometryStart::kBiasRest_s)
      initial_rest_.initial_rest_start_ns = next.rest_start_ns;
    initial_rest_.still_stationary = next.rest_start_ns == initial_rest_.initial_rest_start_ns;
    if (initial_rest_.still_stationary && seconds(stationary_state_.small_rate_since_ns) >= OdometryStart::kBiasRest_s)
      initial_rest_.gyro_bias_rad_s = stationary_state_.mean_rate_rad_s();
  }
  next.at_rest = initial_rest_.still_stationary;
  if (stationary_state_.pending_samples > 0) {
    pending_rates_rad_s_.push_back(rate.w_WI_I_rad_s);
    return;
  }
  const bool goes_on = next.rest_start_ns && *next.rest_start_ns < stationary_state_.pending_first_ns;
  if (!goes_on) revoke_rest(next.rest_start_ns);
  pending_rates_rad_s_.clear();
}

void InertialTrack::revoke_rest(std::optional<TimeNs> rest_start_ns) {
  const std::size_t count = std::min(pending_rates_rad_s_.size(), samples_.size());
  for (std::size_t back = 1; back <= count; ++back) {
    MotionSample& sample = samples_[samples_.size() - back];
    sample.rest_start_ns = rest_start_ns;
    if (!sample.at_rest || initial_rest_.still_stationary) continue;
    sample.at_rest = false;
    sample.w_WI_I_rad_s = pending_rates_rad_s_[pending_rates_rad_s_.size() - back] - initial_rest_.gyro_bias_rad_s;
  }
}

bool InertialTrack::starts_at_rest(double lasted_s) const {
  const auto rests = [&](const MotionSample& sample) {
    return sample.at_rest || seconds(sample.from_ns - samples_.front().from_ns) >= lasted_s;
  };
  // The gyro bias is nonzero only after a sufficiently long initial rest. The first samples of the initial rest may
  // already be deleted from samples_, so the gyro bias is tested first.
  return !initial_rest_.gyro_bias_rad_s.isZero(0.0) || std::all_of(samples_.begin(), samples_.end(), rests);
}

bool InertialTrack::is_stationary_until(TimeNs end_ns) const {
  const auto rests = [&](const MotionSample& sample) { return sample.from_ns >= end_ns || sample.rest_start_ns; };
  return std::all_of(samples_.begin(), samples_.end(), rests);
}

bool InertialTrack::is_stationary_between(TimeNs from_ns, TimeNs end_ns) const {
  const std::span<const MotionSample> samples = motion_samples_from(from_ns);
  const auto after = [&](const MotionSample& sample) { return sample.from_ns >= end_ns; };
  const auto end = std::find_if(samples.begin(), samples.end(), after);
  return std::all_of(samples.begin(), end, [](const MotionSample& sample) { return bool(sample.rest_start_ns); });
}

std::span<const MotionSample> InertialTrack::motion_samples_from(TimeNs from_ns) const {
  const auto ended = [&](const MotionSample& sample) { return sample.time_ns <= from_ns; };
  return {std::partition_point(samples_.begin(), samples_.end(), ended), samples_.end()};
}

std::optional<Eigen::Vector3d> InertialTrack::resting_force(TimeNs time_ns, double lasted_s) const {
  if (!stationary_state_.is_stationary || seconds(time_ns - stationary_state_.first_ns) < lasted_s) return std::nullopt;
  return stationary_state_.mean_force_m_s2();
}

void InertialTrack::prune_until(TimeNs end_ns) {
  const auto after = [&](const MotionSample& sample) { return sample.time_ns > end_ns; };
  samples_.erase(samples_.begin(), std::find_if(samples_.begin(), samples_.end(), after));
  sweep_boundary_ns_ = end_ns;
}

}  // namespace tumble::mapping
