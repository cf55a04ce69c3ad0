// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/tumbling_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tumble/mapping/sweep_check.hpp"
#include "tumble/odometry/tumbling_odometry_fields.hpp"

namespace tumble {

namespace {

// Below this share of the stated range a reading is one for sure: a calibration moves a rail by its error of scale.
constexpr double kSureShare = 0.98;
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
  if (params.imu.accel_range_m_s2 > 0.0) out.accel_rail_m_s2 = kSureShare * params.imu.accel_range_m_s2;
  return out;
}

/// The forces of the sample that a rate is of which the stream knows to be at a rail.
unsigned railed_forces(const RateStream::State& state, TimeNs time_ns) {
  const auto is_it = [&](const RateStream::Knot& knot) { return knot.observation.sample.time_ns == time_ns; };
  const auto knot = std::find_if(state.window.begin(), state.window.end(), is_it);
  return knot == state.window.end() ? 0u : clip_flags({.accel = knot->observation.clipping.accel});
}

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
  std::optional<RateState> rate;
  Status status = rates_.push(sample, rate_state_, rate);
  if (status.trouble == Trouble::gap) {
    begin_anew();
    status = rates_.push(sample, rate_state_, rate);
  }
  if (!status.ok()) return status;
  unsettled_.push(sample);
  if (rate) status = settle(*rate);
  register_covered();
  return status;
}

Status TumblingOdometry::add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points) {
  if (end_ns < start_ns) return {Trouble::time_order, "end_ns", double(end_ns), double(start_ns)};
  if (sweep_end_ns_ && start_ns < *sweep_end_ns_)
    return {Trouble::time_order, "start_ns", double(start_ns), double(*sweep_end_ns_)};
  if (waiting_.size() >= params_.expert.sweeps_max) {
    return {Trouble::out_of_range, "sweeps waiting", double(waiting_.size() + 1), double(params_.expert.sweeps_max)};
  }
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
  // of the window some may be settled already
  if (settled_) std::erase_if(rates, [&](const RateState& rate) { return rate.time_ns <= settled_->time_ns; });
  std::vector<ImuSample> samples;
  for (const RateState& rate : rates) samples.push_back(as_the_stream_sees_it(rate));
  return mapper_.predict(samples, rates, pose);
}

void TumblingOdometry::finish() {
  std::vector<RateState> rates;
  rates_.flush(rate_state_, rates);
  for (const RateState& rate : rates) {
    if (!settled_ || rate.time_ns > settled_->time_ns) settle(rate);
  }
  register_covered();
}

// With the forces told that a rail hid.
ImuSample TumblingOdometry::as_the_stream_sees_it(const RateState& rate) const {
  const std::span<const ImuSample> all = unsettled_.all();
  ImuSample out = *std::find_if(all.begin(), all.end(), [&](const ImuSample& s) { return s.time_ns == rate.time_ns; });
  const unsigned railed = railed_forces(rate_state_.rate, rate.time_ns);
  out.device_clip_flags = static_cast<std::uint8_t>(out.device_clip_flags | railed);
  return out;
}

Status TumblingOdometry::settle(const RateState& rate) {
  const ImuSample sample = as_the_stream_sees_it(rate);
  unsettled_.drop_until(rate.time_ns);
  settled_ = rate;
  return mapper_.add_imu(sample, rate);
}

void TumblingOdometry::register_covered() {
  const auto offset_ns = static_cast<TimeNs>(std::llround(1e9 * params_.expert.mapping.time_offset_s));
  while (!waiting_.empty() && settled_ && settled_->time_ns >= waiting_.front().end_ns + offset_ns) {
    const Waiting& sweep = waiting_.front();
    Sweep& out = done_.emplace_back();
    out.status = mapper_.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points, out.report);
    waiting_.pop_front();
  }
}

void TumblingOdometry::begin_anew() {
  finish();
  RegimeStream::Params params = rate_params(params_);
  params.rate.model.calibration = rig();
  rates_ = RegimeStream(params);
  rate_state_ = rates_.start();
  ++gaps_;
}

}  // namespace tumble
