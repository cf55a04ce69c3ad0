// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_pass.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {

namespace {

constexpr double kMinGravity_m_s2 = 1e-3;
constexpr double kPreallocated_s = 2.0;  // longer than any gap of a lidar

std::size_t sample_count_in_duration(double time_s, const MotionRegimeStream::Params& rate) {
  return static_cast<std::size_t>(std::ceil(time_s / rate.rate.period_s)) + 16;
}

/// If the recovered rate of a clipped gyro axis is too uncertain, the mapper receives the gyro's reading as a lower
/// bound instead. If the calibration is uncertain, a recovered rate may have an error of tens of rad/s at an impact.
AngularRateState limit_rate_covariance(const AngularRateState& rate, const ImuSample& sample) {
  constexpr double kSigmaMax_rad_s = InertialNoiseParams::kRateSigmaMax_rad_s;
  AngularRateState out = rate;
  for (int axis = 0; axis < 3; ++axis) {
    if ((rate.clipped_axes >> axis & 1) == 0) continue;
    if (rate.covariance_rad2_s2(axis, axis) <= kSigmaMax_rad_s * kSigmaMax_rad_s) continue;
    out.w_WI_I_rad_s[axis] = sample.angular_velocity_rad_s[axis];
    out.covariance_rad2_s2.row(axis).setZero();
    out.covariance_rad2_s2.col(axis).setZero();
    out.source = AngularRateSource::lower_bound_only;
  }
  return out;
}

/// Adds the detected accelerometer clipping to the flags of samples. Successive calls of at() must have increasing
/// times.
class ClippingClassifiedSamples {
 public:
  ClippingClassifiedSamples(std::span<const ImuSample> samples, const AngularRateStream::State& state)
      : samples_(samples), window_(state.window) {}

  ImuSample at(TimeNs time_ns) {
    while (next_ + 1 < samples_.size() && samples_[next_].time_ns < time_ns) ++next_;
    while (knot_ < window_.size() && window_[knot_].observation.sample.time_ns < time_ns) ++knot_;
    ImuSample out = samples_[next_];
    if (knot_ < window_.size()) {
      const unsigned railed = clip_flags({.accel = window_[knot_].observation.clipping.accel});
      out.device_clip_flags = static_cast<std::uint8_t>(out.device_clip_flags | railed);
    }
    return out;
  }

 private:
  std::span<const ImuSample> samples_;
  std::span<const AngularRateStream::Knot> window_;
  std::size_t next_ = 0, knot_ = 0;
};

}  // namespace

void OdometryPass::WaitingInputQueue::push(const ImuSample& sample) {
  if (samples.size() == samples.capacity() && head > 0) {
    samples.erase(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(head));
    head = 0;
  }
  samples.push_back(sample);
}

void OdometryPass::WaitingInputQueue::drop_until(TimeNs time_ns) {
  while (head < samples.size() && samples[head].time_ns <= time_ns) ++head;
}

OdometryPass::OdometryPass(const MotionRegimeStream::Params& rate, const LidarInertialOdometry::Params& mapping)
    : rates_(rate),
      rate_stream_state_(rates_.start()),
      mapper_(mapping),
      scale_(mapping.expert.gravity_m_s2, sample_count_in_duration(kPreallocated_s, rate)),
      localisation_(mapping.expert.matching.distance_m),
      time_offset_s_(mapping.imu_minus_lidar_clock_s),
      rest_gravity_({.gravity_m_s2 = std::max(mapping.expert.gravity_m_s2, kMinGravity_m_s2)}) {
  pending_.samples.reserve(sample_count_in_duration(std::max(rate.rate.lag_s, kPreallocated_s), rate));
}

Status OdometryPass::add_imu(const ImuSample& sample) {
  std::optional<AngularRateState> rate;
  if (const Status status = rates_.push(sample, rate_stream_state_, rate); !status.ok()) return status;
  pending_.push(sample);
  rest_gravity_.step(sample, rest_gravity_state_);
  RestGravity::limit_memory(rest_gravity_state_);
  if (rate && (!smoothed_ || rate->time_ns > smoothed_->time_ns)) process_angular_rate(*rate);
  return {};
}

TimeNs OdometryPass::oldest_needed_ns(TimeNs lidar_ns) const {
  return lidar_ns + static_cast<TimeNs>(std::llround(1e9 * time_offset_s_));
}

std::optional<TimeNs> OdometryPass::covered_ns() const {
  if (!smoothed_) return std::nullopt;
  return smoothed_->time_ns - oldest_needed_ns(0);
}

bool OdometryPass::has_rates_until(TimeNs end_ns) const {
  return smoothed_ && smoothed_->time_ns >= oldest_needed_ns(end_ns);
}

std::optional<TimeNs> OdometryPass::covering_ns(TimeNs end_ns) const {
  const std::span<const ImuSample> open = pending_.all();
  const TimeNs needed = oldest_needed_ns(end_ns);
  const auto covers = [&](const ImuSample& sample) { return sample.time_ns >= needed; };
  const auto first = std::find_if(open.begin(), open.end(), covers);
  if (first == open.end()) return std::nullopt;
  return first->time_ns;
}

Status OdometryPass::add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points,
                               const std::optional<OdometerReading>& reading,
                               LidarInertialOdometry::SweepResult& report) {
  // set_odometer_reading() cannot fail, because add() checked the reading
  if (reading) (void)mapper_.set_odometer_reading(*reading);
  const Status status = mapper_.add_sweep(start_ns, end_ns, points, report);
  if (report.trajectory.empty()) return status;
  scale_.add(report);
  localisation_.add(report);
  return status;
}

Status OdometryPass::newest(PoseState& pose, Eigen::Matrix3d* velocity_covariance_I_m2_s2) const {
  std::vector<AngularRateState> rates;
  rates_.flush(rate_stream_state_, rates);
  std::vector<ImuSample> samples;
  ClippingClassifiedSamples classified(pending_.all(), rate_stream_state_.rate);
  std::erase_if(rates,
                [&](const AngularRateState& rate) { return last_mapped_ns_ && rate.time_ns <= *last_mapped_ns_; });
  for (AngularRateState& rate : rates) {
    samples.push_back(classified.at(rate.time_ns));
    rate = limit_rate_covariance(rate, samples.back());
  }
  return mapper_.predict(samples, rates, pose, velocity_covariance_I_m2_s2);
}

void OdometryPass::process_angular_rate(const AngularRateState& rate) {
  const ImuSample sample = ClippingClassifiedSamples(pending_.all(), rate_stream_state_.rate).at(rate.time_ns);
  pending_.drop_until(rate.time_ns);
  smoothed_ = rate;
  if (last_mapped_ns_ && rate.time_ns <= *last_mapped_ns_) return;
  last_mapped_ns_ = rate.time_ns;
  scale_.add(sample);
  if (!mapper_.add_imu(sample, limit_rate_covariance(rate, sample)).ok()) ++samples_rejected_by_mapper_;
}

void OdometryPass::flush_until(TimeNs time_ns) {
  std::vector<AngularRateState> rates;
  rates_.flush(rate_stream_state_, rates);
  for (const AngularRateState& rate : rates) {
    if (smoothed_ && smoothed_->time_ns >= time_ns) return;
    if (!smoothed_ || rate.time_ns > smoothed_->time_ns) process_angular_rate(rate);
  }
}

void OdometryPass::start_rate_estimation(const MotionRegimeStream::Params& rate) {
  rates_ = MotionRegimeStream(rate);
  const FrozenAxes::State frozen = rate_stream_state_.rate.frozen_axes;  // an axis may stay frozen across the restart
  const FlightSignCheck::State sense = rate_stream_state_.rate.flight_sign_check;
  rate_stream_state_ = rates_.start();
  rate_stream_state_.rate.frozen_axes = frozen;
  rate_stream_state_.rate.flight_sign_check = sense;
}

void OdometryPass::adopt_map(OdometryPass&& other) {
  if (mapper_.prior_map() != nullptr) other.mapper_.copy_prior_map(mapper_);
  mapper_ = std::move(other.mapper_);
  scale_ = std::move(other.scale_);
  localisation_ = other.localisation_;
  time_offset_s_ = other.time_offset_s_;
  last_mapped_ns_ = other.last_mapped_ns_;
}

}  // namespace tumble
