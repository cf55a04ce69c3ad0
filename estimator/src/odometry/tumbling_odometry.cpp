// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/tumbling_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tumble/mapping/sweep_check.hpp"
#include "tumble/odometry/tumbling_odometry_fields.hpp"

namespace tumble {

namespace {

// Of the horizontal part of gravity: what the levelling leaves, and a world that is not quite level.
constexpr double kGravitySigma_m_s2 = 0.03;

RegimeStream::Params rate_params(const TumblingOdometry::Params& params) {
  require_fields(params);
  RegimeStream::Params out = params.expert.rate;
  RateModelParams& model = out.rate.model;
  model.nominal.lever_arm_m = params.lever_arm_I_m;
  model.lever_arm_sigma_m = params.lever_arm_sigma_m;
  model.gyro_noise_density = params.imu.gyro_noise_rad_s_sqrt_hz;
  model.accel_noise_density = params.imu.accel_noise_m_s2_sqrt_hz;
  if (params.imu.gyro_range_rad_s > 0.0) out.rate.rails.stated_gyro_rad_s = params.imu.gyro_range_rad_s;
  if (params.imu.accel_range_m_s2 > 0.0) out.rate.rails.stated_accel_m_s2 = params.imu.accel_range_m_s2;
  out.rate.period_s = 1.0 / params.imu.rate_hz;
  out.rate.lag_s = std::max(params.lag_s, 2.0 * out.rate.period_s);
  out.evidence.gravity_m_s2 = out.carried.body.gravity_m_s2 = params.gravity_m_s2;
  out.carried.body.gap_max_s = out.rate.gap_max_s;
  return out;
}

LidarInertialOdometry::Params mapper_params(const TumblingOdometry::Params& params) {
  LidarInertialOdometry::Params out = params.expert.mapping;
  out.T_IL = params.T_IL;
  out.mount_sigma_rad = params.mount_sigma_rad;
  out.mount_sigma_m = params.mount_sigma_m;
  out.time_offset_sigma_s = params.time_offset_sigma_s;
  out.gravity_m_s2 = params.gravity_m_s2;
  out.range_min_m = params.range_min_m;
  out.range_max_m = params.range_max_m;
  out.own_body_L = params.own_body_L;
  if (params.imu.accel_range_m_s2 > 0.0) out.accel_rail_m_s2 = sure_range(params.imu.accel_range_m_s2);
  return out;
}

constexpr double kSilent_s = 1.0;       // a lidar that says nothing for so long is made up for
constexpr double kAhead_s = 1.0;        // a sweep that ends so much after the newest sample has a stamp that is wrong
constexpr double kSweepsMax_hz = 20.0;  // of the lidars that there are: so many a second wait for the lag

/// What the stream does not know of a clipped axis, its deviation being beyond what the mapper believes at most, goes
/// to the mapper as the reading it is, a bound: the registration estimates what is missing. A rig that is not learnt
/// yet may extrapolate a push by tens of rad/s, and says so.
RateState for_the_mapper(const RateState& rate, const ImuSample& sample, double sigma_max_rad_s) {
  RateState out = rate;
  for (int axis = 0; axis < 3; ++axis) {
    if ((rate.clipped_axes >> axis & 1) == 0) continue;
    if (rate.covariance_rad2_s2(axis, axis) <= sigma_max_rad_s * sigma_max_rad_s) continue;
    out.w_WI_I_rad_s[axis] = sample.angular_velocity_rad_s[axis];
    out.covariance_rad2_s2.row(axis).setZero();
    out.covariance_rad2_s2.col(axis).setZero();
    out.source = RateSource::bounded_only;
  }
  return out;
}

/// Samples as the stream came to see them, with the forces told that a rail hid; asked for in order of time.
class SeenByTheStream {
 public:
  SeenByTheStream(std::span<const ImuSample> samples, const RateStream::State& state)
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
  std::span<const RateStream::Knot> window_;
  std::size_t next_ = 0, knot_ = 0;
};

}  // namespace

void TumblingOdometry::Queue::push(const ImuSample& sample) {
  if (samples.size() == samples.capacity() && head > 0) {
    samples.erase(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(head));
    head = 0;
  }
  samples.push_back(sample);
}

void TumblingOdometry::Queue::drop_until(TimeNs time_ns) {
  while (head < samples.size() && samples[head].time_ns <= time_ns) ++head;
}

LidarInertialOdometry::Params TumblingOdometry::Params::Expert::mapping_defaults() {
  LidarInertialOdometry::Params out;
  out.gravity_sigma_m_s2 = kGravitySigma_m_s2;
  out.estimate_saturation_deficit = true;
  return out;
}

TumblingOdometry::TumblingOdometry(const Params& params)
    : params_(params), rates_(rate_params(params)), rate_state_(rates_.start()), mapper_(mapper_params(params)) {
  const double in_lag = std::max(params.lag_s, 1.0) * params.imu.rate_hz;
  unsettled_.samples.reserve(2 * static_cast<std::size_t>(std::ceil(in_lag)) + 16);
}

Status TumblingOdometry::add_imu(const ImuSample& sample) {
  if (newest_ns_ && sample.time_ns <= *newest_ns_)
    return {Trouble::time_order, "time_ns", double(sample.time_ns), double(*newest_ns_)};
  const Status status = take_in(sample);
  if (status.trouble != Trouble::gap) return status;
  const double gap_max_s = params_.expert.rate.rate.gap_max_s;
  if (!after_gap_ || !check_follows(sample.time_ns, after_gap_->time_ns, gap_max_s).ok()) {
    after_gap_ = sample;
    return status;
  }
  const ImuSample first = *after_gap_;
  begin_anew();
  ++gaps_;
  if (const Status begun = take_in(first); !begun.ok()) return begun;
  return take_in(sample);
}

Status TumblingOdometry::take_in(const ImuSample& sample) {
  std::optional<RateState> rate;
  if (const Status status = rates_.push(sample, rate_state_, rate); !status.ok()) return status;
  unsettled_.push(sample);
  newest_ns_ = sample.time_ns;
  after_gap_.reset();
  if (!registered_ns_) registered_ns_ = sample.time_ns;
  if (!rate) return {};
  settle(*rate);
  register_covered();
  return {};
}

Status TumblingOdometry::add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points) {
  if (end_ns < start_ns) return {Trouble::time_order, "end_ns", double(end_ns), double(start_ns)};
  if (sweep_end_ns_ && start_ns < *sweep_end_ns_)
    return {Trouble::time_order, "start_ns", double(start_ns), double(*sweep_end_ns_)};
  const TimeNs latest_ns = newest_ns_.value_or(end_ns) + static_cast<TimeNs>(1e9 * kAhead_s);
  if (end_ns > latest_ns) return {Trouble::out_of_range, "end_ns", double(end_ns), double(latest_ns)};
  const std::size_t most = params_.sweeps_max + static_cast<std::size_t>(kSweepsMax_hz * params_.lag_s);
  if (waiting_.size() >= most)
    return {Trouble::out_of_range, "sweeps waiting", double(waiting_.size() + 1), double(most)};
  if (const Status status = mapping::check_offsets(end_ns - start_ns, points); !status.ok()) return status;
  sweep_end_ns_ = end_ns;
  waiting_.push_back({start_ns, end_ns, {points.begin(), points.end()}});
  register_covered();
  return {};
}

std::optional<TumblingOdometry::Sweep> TumblingOdometry::take() {
  if (done_.empty()) return std::nullopt;
  Sweep out = std::move(done_.front());
  done_.pop_front();
  return out;
}

Status TumblingOdometry::newest(PoseState& pose) const {
  std::vector<RateState> rates;
  rates_.flush(rate_state_, rates);
  std::vector<ImuSample> samples;
  SeenByTheStream seen(unsettled_.all(), rate_state_.rate);
  for (RateState& rate : rates) {
    samples.push_back(seen.at(rate.time_ns));
    rate = for_the_mapper(rate, samples.back(), params_.expert.mapping.rate_sigma_max_rad_s);
  }
  return mapper_.predict(samples, rates, pose);
}

void TumblingOdometry::finish() {
  if (!rates_.rate().newest(rate_state_.rate)) return;  // nothing since the last time
  begin_anew();
}

void TumblingOdometry::settle(const RateState& rate) {
  const ImuSample sample = SeenByTheStream(unsettled_.all(), rate_state_.rate).at(rate.time_ns);
  unsettled_.drop_until(rate.time_ns);
  settled_ = rate;
  const RateState told = for_the_mapper(rate, sample, params_.expert.mapping.rate_sigma_max_rad_s);
  if (!mapper_.add_imu(sample, told).ok()) ++refused_samples_;
}

void TumblingOdometry::register_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points) {
  if (done_.size() >= params_.sweeps_max) {
    done_.pop_front();
    ++dropped_sweeps_;
  }
  Sweep& out = done_.emplace_back();
  out.status = mapper_.add_sweep(start_ns, end_ns, points, out.report);
  registered_ns_ = end_ns;
}

void TumblingOdometry::register_covered() {
  const auto offset_ns = static_cast<TimeNs>(std::llround(1e9 * params_.expert.mapping.time_offset_s));
  while (!waiting_.empty() && settled_ && settled_->time_ns >= waiting_.front().end_ns + offset_ns) {
    const Waiting& sweep = waiting_.front();
    register_sweep(sweep.start_ns, sweep.end_ns, sweep.points);
    waiting_.pop_front();
  }
  if (!waiting_.empty() || !settled_) return;
  const TimeNs covered_ns = settled_->time_ns - offset_ns;
  if (seconds(covered_ns - *registered_ns_) > kSilent_s) {
    register_sweep(covered_ns, covered_ns, {});
    sweep_end_ns_ = covered_ns;
  }
}

void TumblingOdometry::begin_anew() {
  std::vector<RateState> rates;
  rates_.flush(rate_state_, rates);
  for (const RateState& rate : rates) settle(rate);
  register_covered();
  RegimeStream::Params params = rate_params(params_);
  params.rate.model.calibration = rig();
  try {
    rates_ = RegimeStream(params);
  } catch (const InvalidParams&) {  // what was learnt is beyond what can be: from what was given
    rates_ = RegimeStream(rate_params(params_));
  }
  rate_state_ = rates_.start();
}

}  // namespace tumble
