// SPDX-License-Identifier: BSD-3-Clause
#include "rolling_odometry_impl.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace tumble {

using odometry::outlier_filters_of, odometry::merge_setup, odometry::rolling_params, odometry::clipping_finders_of,
    odometry::frozen_axis_detectors;

namespace {

ImuSample at_time(TimeNs time_ns, ImuSample sample) {
  sample.time_ns = time_ns;
  return sample;
}

void mark_readings_absent(ImuSample& sample) {
  sample.angular_velocity_rad_s.setConstant(std::numeric_limits<double>::quiet_NaN());
}

bool any_reading(std::span<const ImuSample> samples) {
  return std::any_of(samples.begin(), samples.end(), [](const ImuSample& sample) { return check_sample(sample).ok(); });
}

RollingOdometry::Pose as_pose(const RollingEstimate& estimate) {
  RollingOdometry::Pose out;
  out.pose = {estimate.time_ns, estimate.sphere_centre_W_m, estimate.q_WI, estimate.sphere_velocity_W_m_s,
              estimate.covariance};
  out.angular_velocity_B_rad_s = estimate.w_WI_I_rad_s;
  out.velocity_covariance_B_m2_s2 = estimate.velocity_covariance_I_m2_s2;
  out.contact_mode = estimate.mode;
  out.at_rest = estimate.at_rest;
  out.position_uncertain = estimate.position_uncertain;
  return out;
}

}  // namespace

RollingOdometry::Impl::Impl(const Params& params) : Impl(params, merge_setup(params)) {}

RollingOdometry::Impl::Impl(const Params& params, const ImuMerge::Setup& merged)
    : params_(params),
      stamp_order_(RollingGapParams::kGapMax_s),
      sample_clock_(params.expert->stamps),
      imu_merge_(merged),
      smoother_(rolling_params(params, merged, params.imus.size(), imu_merge_.mean_imu_position_m())),
      clipping_finders_(clipping_finders_of(params)),
      imu_time_alignment_(params.imus.size()),
      outlier_filters_(outlier_filters_of(params)),
      frozen_axis_detectors_(frozen_axis_detectors(params)),
      merged_imu_checks_{RestGravity({.gravity_m_s2 = params.gravity_m_s2}),
                         ImuPlausibility(plausibility_setup(params.gravity_m_s2, 0.0))},
      is_live_(params.lag_s <= 0.0) {
  start_clipping_states();
}

Status RollingOdometry::Impl::add_imus(std::span<const ImuSample> samples) {
  if (finished_) return {ErrorCode::out_of_range, "samples after finish()", 1.0, 0.0};
  if (samples.size() != params_.imus.size())
    return {ErrorCode::insufficient_data, "samples", double(samples.size()), double(params_.imus.size())};
  if (uses_whole_recording()) {
    if (!any_reading(samples)) return check_sample(samples.front());
    Status status;
    for (std::size_t k = 0; k < samples.size() && status.ok(); ++k)
      status = record_sample(k, at_time(samples.front().time_ns, samples[k]));
    return status;
  }
  if (!any_reading(samples)) return add_inliers(samples);  // returns the error
  StampOrder::Verdict verdict{};
  if (const Status status = stamp_order_.order_of_stamp(samples.front().time_ns, stamp_order_state_, verdict);
      !status.ok())
    return status;
  if (verdict == StampOrder::Verdict::restarts_after_step_back) restart_at_newest(StampOrder::kStepBack_s);
  if (verdict == StampOrder::Verdict::restarts_after_gap)
    restart_at_newest(seconds(samples.front().time_ns - *stamp_order_state_.newest_ns));
  if (const Status status = add_delayed_samples(samples); !status.ok()) return status;
  Samples judged;
  std::copy(samples.begin(), samples.end(), judged.begin());
  std::array<bool, ImuMerge::kImus> delayed_sample{};
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!check_sample(samples[k]).ok()) continue;
    OutlierFilter::State& state = outlier_filter_state_[k];
    const std::size_t before = state.delayed_count;
    if (!outlier_filters_[k].must_delay_for_check(at_time(samples.front().time_ns, samples[k]), state)) continue;
    delayed_sample[k] = state.delayed_count > before;
    if (!delayed_sample[k]) mark_readings_absent(judged[k]);
  }
  const std::span<const ImuSample> inliers = std::span(judged).first(samples.size());
  if (!any_reading(inliers)) return {};
  if (delayed_count_ > 0 || std::find(delayed_sample.begin(), delayed_sample.end(), true) != delayed_sample.end()) {
    delayed_samples_[delayed_count_++] = judged;
  } else if (const Status status = add_inliers(inliers); !status.ok()) {
    return status;
  }
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!delayed_sample[k] && check_sample(judged[k]).ok())
      OutlierFilter::mark_accepted(at_time(samples.front().time_ns, judged[k]), outlier_filter_state_[k]);
  }
  return {};
}

Status RollingOdometry::add_imu(std::size_t unit, const ImuSample& sample) {
  return impl_->add_imu(unit, sample);
}

Status RollingOdometry::Impl::add_imu(std::size_t unit, const ImuSample& sample) {
  if (finished_) return {ErrorCode::out_of_range, "samples after finish()", 1.0, 0.0};
  const std::size_t units = params_.imus.size();
  if (unit >= units) return {ErrorCode::out_of_range, "unit", double(unit), double(units - 1)};
  if (uses_whole_recording()) return record_sample(unit, sample);
  if (!check_sample(sample).ok()) return {};
  StampOrder::Verdict verdict{};
  if (const Status status = stamp_order_.order_of_stamp(sample.time_ns, unit_stamp_order_states_[unit], verdict);
      !status.ok())
    return status;
  if (verdict == StampOrder::Verdict::restarts_after_step_back) {
    restart_at_newest(StampOrder::kStepBack_s);
    forget_waiting_readings();
  }
  OutlierFilter::State& outliers = outlier_filter_state_[unit];
  for (const ImuSample& confirmed : outlier_filters_[unit].filter_sample(sample, outliers)) {
    if (const Status status = add_inlier(unit, confirmed); !status.ok()) return status;
  }
  if (outlier_filters_[unit].must_delay_for_check(sample, outliers)) return {};
  return add_inlier(unit, sample);
}

/// Resamples a reading of one IMU, which OutlierFilter accepted, with the readings of the other IMUs.
Status RollingOdometry::Impl::add_inlier(std::size_t unit, const ImuSample& sample) {
  if (const Status status = imu_time_alignment_.push(unit, sample, imu_time_alignment_state_); !status.ok())
    return status;
  OutlierFilter::mark_accepted(sample, outlier_filter_state_[unit]);
  StampOrder::accept(sample.time_ns, unit_stamp_order_states_[unit]);
  return add_time_aligned_readings(false);
}

void RollingOdometry::Impl::forget_waiting_readings() {
  imu_time_alignment_state_ = {};
  unit_stamp_order_states_ = {};
}

/// `ended` is true if no further IMU readings will follow. Returns the first error.
Status RollingOdometry::Impl::add_time_aligned_readings(bool ended) {
  Status first;
  ImuTimeAlignment::Readings readings;
  while (imu_time_alignment_.next(imu_time_alignment_state_, readings, ended)) {
    const std::optional<TimeNs>& newest_ns = stamp_order_state_.newest_ns;
    const double passed_s = newest_ns ? seconds(readings.front().time_ns - *newest_ns) : 0.0;
    if (passed_s > RollingGapParams::kGapMax_s) restart_at_newest(passed_s);
    const Status status = add_inliers(std::span(readings).first(params_.imus.size()));
    if (first.ok()) first = status;
  }
  return first;
}

/// The outlier filter of an IMU delays suspect samples until later samples show which samples are outliers. When no
/// outlier filter delays samples, the delayed samples of all IMUs are processed together.
Status RollingOdometry::Impl::add_delayed_samples(std::span<const ImuSample> next) {
  bool open = false;
  for (std::size_t k = 0; k < next.size(); ++k) open = is_delayed_after(next, k) || open;
  if (open) return {};
  const std::size_t count = std::exchange(delayed_count_, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const std::span<const ImuSample> inliers = std::span(delayed_samples_[k]).first(next.size());
    if (!any_reading(inliers)) continue;
    if (const Status status = add_inliers(inliers); !status.ok()) return status;
  }
  return {};
}

/// Returns whether the outlier filter still delays readings of the IMU with the index `unit`. Marks rejected readings
/// of this IMU as absent.
bool RollingOdometry::Impl::is_delayed_after(std::span<const ImuSample> next, std::size_t unit) {
  OutlierFilter::State& state = outlier_filter_state_[unit];
  if (state.delayed_count == 0) return false;
  const TimeNs first_ns = state.delayed_sample.front().time_ns;
  const bool follows = check_sample(next[unit]).ok(), full = delayed_count_ == delayed_samples_.size();
  std::span<const ImuSample> confirmed;
  if (follows) confirmed = outlier_filters_[unit].filter_sample(at_time(next.front().time_ns, next[unit]), state);
  if (!follows) OutlierFilter::finish(state);
  if (state.delayed_count > 0 && !full) return true;
  if (state.delayed_count > 0) confirmed = {state.delayed_sample.data(), std::exchange(state.delayed_count, 0)};
  for (const ImuSample& sample : confirmed) OutlierFilter::mark_accepted(sample, state);
  if (!confirmed.empty()) return false;
  for (Samples& samples : std::span(delayed_samples_).first(delayed_count_)) {
    if (samples.front().time_ns >= first_ns) mark_readings_absent(samples[unit]);
  }
  return false;
}

Status RollingOdometry::Impl::add_inliers(std::span<const ImuSample> samples) {
  std::optional<ImuSample> merged;
  SampleClock::State stamps = sample_clock_state_;
  TimeNs time_ns = 0;
  if (Status status = sample_clock_.push(samples.front().time_ns, stamps, time_ns); !status.ok()) return status;
  Samples flagged = flag_clipped(samples);
  flagged.front().time_ns = time_ns;
  *merge_state_buffer_ = *imu_merge_state_;  // a copy, so that a rejected sample changes no state
  Frozen frozen = frozen_imus_;
  for (std::size_t k = 0; k < samples.size(); ++k) frozen_axis_detectors_[k].step(samples[k], frozen[k]);
  const std::span<ImuSample> judged = std::span(flagged).first(samples.size());
  if (Status status = exclude_frozen(frozen, judged); !status.ok()) {
    frozen_imus_ = frozen;  // needed by health()
    return status;
  }
  if (Status status = imu_merge_.step(judged, *merge_state_buffer_, merged); !status.ok()) return status;
  if (Status status = ImuMerge::verdict(*merge_state_buffer_); !status.ok()) return status;
  if (merged) {
    if (Status status = process_ordered_sample(*merged); !status.ok()) return status;
  }
  std::swap(imu_merge_state_, merge_state_buffer_);
  sample_clock_state_ = stamps;
  frozen_imus_ = frozen;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    merged_imu_checks_.rest_gravity.step(samples[k], merged_imu_checks_.rest_gravity_state[k]);
    RestGravity::limit_memory(merged_imu_checks_.rest_gravity_state[k]);
  }
  observe_saturation(samples);
  StampOrder::accept(samples.front().time_ns, stamp_order_state_);
  return {};
}

/// Sets clip flags only for confirmed saturation limits (ConfirmedSaturation). A new saturation limit is detected after
/// two to ten saturated samples, which remain without clip flags.
RollingOdometry::Impl::Samples RollingOdometry::Impl::flag_clipped(std::span<const ImuSample> samples) const {
  Samples out;
  std::copy(samples.begin(), samples.end(), out.begin());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!check_sample(samples[k]).ok()) continue;
    const auto& [state, previous] = clipping_states_[k];
    const Clipping judged = clipping_finders_[k].classify_clipping(previous ? &*previous : nullptr, samples[k], state);
    out[k].device_clip_flags =
        confirmed_saturation(state.known_limits, params_.imus[k].data_sheet).flags(samples[k], judged);
  }
  return out;
}

/// Cost: O(1), except for rare searches for saturation planes (SaturationPlane). No memory is allocated.
void RollingOdometry::Impl::observe_saturation(std::span<const ImuSample> samples) {
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!check_sample(samples[k]).ok()) continue;
    auto& [state, previous] = clipping_states_[k];
    clipping_finders_[k].observe_reading(samples[k], state);
    clipping_finders_[k].axis_limit_detector().classify_clipping(samples[k], state.known_limits.axis_limit_state);
    previous = samples[k];
  }
}

void RollingOdometry::Impl::start_clipping_states() {
  for (std::size_t k = 0; k < clipping_finders_.size(); ++k) clipping_states_[k] = {clipping_finders_[k].start(), {}};
}

std::size_t RollingOdometry::rejected_readings() const {
  std::size_t out = 0;
  for (const OutlierFilter::State& unit : impl_->outlier_filter_state_) out += unit.rejected;
  return out;
}

/// Returns an error if every IMU has a frozen axis.
Status RollingOdometry::Impl::exclude_frozen(const Frozen& states, std::span<ImuSample> samples) const {
  bool any = false, received = false;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const bool finite = check_sample(samples[k]).ok();
    const bool frozen = finite && FrozenAxes::any_frozen(states[k]);
    if (frozen) mark_readings_absent(samples[k]);
    any = any || frozen;
    received = received || (finite && !frozen);
  }
  if (!any || received) return {};
  SensorHealth health;
  add_frozen_findings(states, health);
  return health.worst_status();
}

std::optional<double> RollingOdometry::estimated_jitter_s() const {
  return impl_->sample_clock_.corrects_stamps(impl_->sample_clock_state_)
             ? SampleClock::jitter_s(impl_->sample_clock_state_)
             : std::nullopt;
}

std::optional<RollingOdometry::Pose> RollingOdometry::Impl::newest() const {
  if (!state_->live_filter.started) return std::nullopt;
  return as_pose(transform_to_world(RollingFilter::estimate(state_->live_filter)));
}

std::optional<RollingOdometry::Pose> RollingOdometry::take() {
  if (impl_->returned_result_count_ == impl_->finished_results_.size()) return std::nullopt;
  const Pose out = as_pose(impl_->finished_results_[impl_->returned_result_count_++]);
  if (impl_->returned_result_count_ == impl_->finished_results_.size()) {
    impl_->finished_results_.clear();
    impl_->returned_result_count_ = 0;
  }
  return out;
}

RollingOdometry::SphereCalibration RollingOdometry::sphere_calibration() const {
  const bool newest = impl_->is_live_ || (!impl_->finished_ && !impl_->state_->committed_state.started);
  const RollingNominalState& constants = newest ? impl_->state_->live_filter.nominal : impl_->state_->constants;
  return {-constants.lever_arm_error_m, impl_->params_.radius_m + constants.radius_error_m,
          impl_->state_->radius_sigma_m};
}

Status RollingOdometry::finish() {
  if (impl_->finished_) return {};
  const Status status =
      impl_->uses_whole_recording() ? impl_->finish_whole_recording() : impl_->add_time_aligned_readings(true);
  impl_->end_continuous_run();
  impl_->finished_ = true;
  return status;
}

void RollingOdometry::Impl::end_continuous_run() {
  for (OutlierFilter::State& unit : outlier_filter_state_) OutlierFilter::finish(unit);
  delayed_count_ = 0;
  const std::size_t before = finished_results_.size();
  if (!is_live_ && !finished_) smoother_.finish(*state_, finished_results_);
  for (std::size_t k = before; k < finished_results_.size(); ++k)
    finished_results_[k] = transform_to_world(finished_results_[k]);
}

void RollingOdometry::Impl::reset() {
  start_continuous_run();
  forget_waiting_readings();
  recorded_samples_ = {};
}

/// Resets all states of a run, except the IMU readings that wait for resampling to common times.
void RollingOdometry::Impl::start_continuous_run() {
  sample_clock_state_ = {};
  imu_merge_state_ = {};
  state_ = {};
  start_clipping_states();
  frozen_imus_ = {};
  for (OutlierFilter::State& unit : outlier_filter_state_) {
    unit.delayed_count = 0;
    unit.count = 0;
  }
  delayed_count_ = 0;
  merged_imu_checks_.rest_gravity_state = {};
  merged_imu_checks_.plausibility_state = {};
  whole_recording_result_.reset();
  stamp_order_state_ = {};
  start_ = T_world_run_origin_ = std::nullopt;
  restart_.reset();
  finished_ = false;
}

void RollingOdometry::Impl::reset(const Eigen::Isometry3d& T_WG) {
  reset();
  start_ = T_WG;
}

Status RollingOdometry::Impl::process_ordered_sample(const ImuSample& merged) {
  const std::size_t before = finished_results_.size();
  Status status;
  if (is_live_) {
    status = smoother_.filter().step(merged, state_->live_filter);
    if (status.ok()) finished_results_.push_back(RollingFilter::estimate(state_->live_filter));
  } else {
    status = smoother_.step(merged, *state_, finished_results_);
  }
  initialise_pose();
  for (std::size_t k = before; k < finished_results_.size(); ++k)
    finished_results_[k] = transform_to_world(finished_results_[k]);
  if (!status.ok()) return status;
  merged_imu_checks_.plausibility.step(merged, merged_imu_checks_.plausibility_state);
  ImuPlausibility::limit_memory(merged_imu_checks_.plausibility_state);
  return {};
}

}  // namespace tumble
