// SPDX-License-Identifier: BSD-3-Clause
#include "second_pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../mapping/inertial_track.hpp"

namespace tumble {

namespace {

// duration of motion after which the second pass is abandoned
constexpr double kAbandonAfter_s = 10.0;

constexpr double kRest_s = 1.0;             // duration of the initial rest that is buffered
constexpr std::size_t kSweepsPerSweep = 3;  // buffered sweeps that the second pass processes per new sweep
// factor on the variances of the estimated calibration, because the second pass uses the readings a second time
constexpr double kInflation = 4.0;
constexpr double kBufferLead_s = 0.1;  // buffered time before the first sweep, because the clocks may differ
constexpr std::size_t kSweepsPerExtraRejection = 20;  // sweeps per additional rejection that the second pass may have
// The second pass does not use the estimated lidar calibration if more than one in kSweepsPerRejection sweeps was
// rejected.
constexpr std::size_t kSweepsPerRejection = 5;

void start_from_saturation_levels(const SaturationLevels& known, AngularRateStream::Params& params) {
  params.expert.gyro_planes.known_limits = known.gyro_planes;
  params.expert.accel_saturation_planes.known_limits = known.accel_saturation_planes;
  for (SaturationPlanes* const planes :
       {&params.expert.gyro_planes.known_limits, &params.expert.accel_saturation_planes.known_limits}) {
    for (std::optional<SaturationPlane>& plane : planes->sensing_axis) {
      if (plane) plane->covariance *= kInflation;
    }
  }
}

}  // namespace

FirstSecondsReprocessing::FirstSecondsReprocessing(const Params& params, const MotionRegimeStream::Params& rate,
                                                   const LidarInertialOdometry::Params& mapping)
    : params_(params),
      rate_(rate),
      mapping_(mapping),
      enabled_(params.after_motion_s > 0.0),
      rest_detector_(mapping::mapping_stationary_params(mapping)) {
  require_valid_fields(params);
  if (!enabled_) return;
  const double most_s = kRest_s + kBufferLead_s + kAbandonAfter_s;
  samples_.samples.reserve(static_cast<std::size_t>(std::ceil(most_s / rate.rate.period_s)) + 16);
}

void FirstSecondsReprocessing::abandon_second_pass() {
  enabled_ = false;
  replayed_pass_.reset();
  sweeps_.clear();
  samples_ = {};
  next_sample_ = next_sweep_ = 0;
}

void FirstSecondsReprocessing::store_input(const ImuSample& sample) {
  if (!enabled_) return;
  if (!motion_start_ns_ &&
      !rest_detector_.detect_stationary(sample, stationary_state_, rate_.rate.model.nominal.gyro_bias_rad_s))
    motion_start_ns_ = sample.time_ns;
  if (!motion_start_ns_) {
    const TimeNs from_ns = sample.time_ns - static_cast<TimeNs>(1e9 * kRest_s);
    while (!sweeps_.empty() && sweeps_.front().start_ns < from_ns) sweeps_.pop_front();
    samples_.drop_until(from_ns - static_cast<TimeNs>(1e9 * kBufferLead_s));
  } else if (seconds(sample.time_ns - buffer_start_ns()) > kAbandonAfter_s) {
    abandon_second_pass();
    return;
  }
  samples_.push(sample);
}

void FirstSecondsReprocessing::store_input(TimeNs start_ns, TimeNs end_ns, std::vector<LidarPoint> points,
                                           const std::optional<OdometerReading>& reading, SweepVerdict verdict) {
  if (!enabled_) return;
  sweeps_.push_back({start_ns, end_ns, std::move(points), reading, verdict});
  rejected_in_first_pass_ += verdict == SweepVerdict::rejected;
}

bool FirstSecondsReprocessing::tracking_failed_in_first_pass() const {
  if (early_second_pass_tried_ || !(params_.tracking_failure_s > 0.0)) return false;
  const auto rejected = [](const Sweep& sweep) { return sweep.verdict == SweepVerdict::rejected; };
  const auto last = std::find_if_not(sweeps_.rbegin(), sweeps_.rend(), rejected);
  return last != sweeps_.rbegin() && last != sweeps_.rend() &&
         seconds(sweeps_.back().end_ns - last->end_ns) >= params_.tracking_failure_s;
}

TimeNs FirstSecondsReprocessing::buffer_start_ns() const {
  return sweeps_.empty() ? *motion_start_ns_ : std::max(*motion_start_ns_, sweeps_.front().start_ns);
}

bool FirstSecondsReprocessing::is_due() const {
  if (!enabled_ || !motion_start_ns_ || sweeps_.empty()) return false;
  return seconds(sweeps_.back().end_ns - buffer_start_ns()) >= params_.after_motion_s ||
         tracking_failed_in_first_pass();
}

MotionRegimeStream::Params FirstSecondsReprocessing::rate_params_with_delay() const {
  MotionRegimeStream::Params out = rate_;
  out.rate.lag_s = std::min(std::max(params_.rate_lag_s, rate_.rate.lag_s), rate_.rate.lag_max_s());
  return out;
}

MotionRegimeStream::Params FirstSecondsReprocessing::calibrated_rate(const OdometryPass& first) const {
  MotionRegimeStream::Params out = rate_params_with_delay();
  const AngularRateStream::State& state = first.rate_stream_state().rate;
  out.rate.model.calibration = first.rates().rate().body_imu_calibration(state);
  out.rate.model.calibration->covariance *= kInflation;
  start_from_saturation_levels(state.clipping_state.known_limits, out.rate);
  return out;
}

LidarInertialOdometry::Params FirstSecondsReprocessing::calibrated_mapping_params(const OdometryPass& first) const {
  LidarInertialOdometry::Params out = mapping_;
  if (kSweepsPerRejection * rejected_in_first_pass_ > sweeps_.size()) return out;
  const LidarImuCalibration learnt = first.mapper().lidar_calibration();
  const auto sigma = first.mapper().next_lidar_calibration_prior_covariance().diagonal().cwiseSqrt().eval();
  out.T_IL = learnt.T_IL;
  out.imu_minus_lidar_clock_s = learnt.imu_minus_lidar_clock_s;
  out.mount_sigma_rad = sigma.head<3>().maxCoeff();
  out.mount_sigma_m = sigma.segment<3>(3).maxCoeff();
  out.time_offset_sigma_s = sigma[6];
  return out;
}

bool FirstSecondsReprocessing::start_second_pass(const OdometryPass& first) {
  const MotionRegimeStream::Params rate = calibrated_rate(first);
  const LidarInertialOdometry::Params mapping = calibrated_mapping_params(first);
  if (!check_body_imu_calibration(*rate.rate.model.calibration).ok() || !check_odometry_params(mapping).ok()) {
    abandon_second_pass();  // the estimated calibration is out of bounds
    return false;
  }
  replayed_pass_.emplace(rate, mapping);
  if (first.mapper().start_pose()) replayed_pass_->set_start_pose(*first.mapper().start_pose());
  next_sample_ = next_sweep_ = rejected_in_second_pass_ = 0;
  started_by_tracking_failure_ = seconds(sweeps_.back().end_ns - buffer_start_ns()) < params_.after_motion_s;
  return true;
}

void FirstSecondsReprocessing::replay_next_input(OdometryPass& first) {
  if (!replayed_pass_ && (!is_due() || !start_second_pass(first))) return;
  run_second_pass(first, kSweepsPerSweep);
}

void FirstSecondsReprocessing::complete_second_pass(OdometryPass& first) {
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  if (replayed_pass_ && started_by_tracking_failure_) run_second_pass(first, kAll);
  if (!replayed_pass_ && (!enabled_ || !motion_start_ns_ || sweeps_.empty() || !start_second_pass(first))) return;
  started_by_tracking_failure_ = false;
  run_second_pass(first, kAll);
  abandon_second_pass();
}

void FirstSecondsReprocessing::run_second_pass(OdometryPass& first, std::size_t sweeps) {
  // At the end of the buffered samples, the second pass reports the last rates immediately, without later samples.
  bool tail = false;
  for (std::size_t taken = 0; tail || taken < sweeps; ++taken) {
    if (next_sweep_ == sweeps_.size()) {
      replace_first_pass_results(first);
      return;
    }
    Sweep& sweep = sweeps_[next_sweep_++];
    const std::span<const ImuSample> samples = samples_.all();
    while (!replayed_pass_->has_rates_until(sweep.end_ns) && next_sample_ < samples.size()) {
      if (!replayed_pass_->add_imu(samples[next_sample_++]).ok()) return abandon_second_pass();
    }
    if (!replayed_pass_->has_rates_until(sweep.end_ns)) {
      tail = true;
      replayed_pass_->flush_until(
          std::max(first.newest_smoothed_rate()->time_ns, replayed_pass_->oldest_needed_ns(sweep.end_ns)));
    }
    if (!replayed_pass_->has_rates_until(
            sweep.end_ns)) {  // the clocks differ by more than assumed: wait for the next sweep
      --next_sweep_;
      return;
    }
    LidarInertialOdometry::SweepResult report;
    (void)replayed_pass_->add_sweep(sweep.start_ns, sweep.end_ns, sweep.points, sweep.reading, report);
    last_sweep_rejected_ = report.verdict == SweepVerdict::rejected;
    rejected_in_second_pass_ += last_sweep_rejected_;
    if (!started_by_tracking_failure_) std::vector<LidarPoint>().swap(sweep.points);
  }
}

void FirstSecondsReprocessing::replace_first_pass_results(OdometryPass& first) {
  replayed_pass_->flush_until(first.newest_smoothed_rate()->time_ns);
  SweepVerdict& newest = sweeps_.back().verdict;
  const bool first_lost = newest == SweepVerdict::rejected;
  if (rejected_in_second_pass_ <= rejected_in_first_pass_ + sweeps_.size() / kSweepsPerExtraRejection &&
      (!last_sweep_rejected_ || first_lost)) {
    first.adopt_map(std::move(*replayed_pass_));
    is_applied_ = true;
    // A later second pass must compare its number of rejected sweeps with the number of this second pass.
    rejected_in_first_pass_ = rejected_in_second_pass_;
    if (!last_sweep_rejected_) newest = SweepVerdict::registered;
  }
  if (!started_by_tracking_failure_) return abandon_second_pass();
  replayed_pass_.reset();
  next_sample_ = next_sweep_ = 0;
  started_by_tracking_failure_ = false;
  early_second_pass_tried_ = true;
}

}  // namespace tumble
