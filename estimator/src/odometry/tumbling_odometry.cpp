// SPDX-License-Identifier: BSD-3-Clause
#include "tumbling_odometry_impl.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "tumble/common/detail/sample_check.hpp"
#include "tumble/mapping/detail/deskew.hpp"

namespace tumble {

using odometry::mapper_params;
using odometry::outlier_params;
using odometry::rate_stream_params;

namespace {

std::vector<LidarPoint> points_after(TimeNs from_ns, TimeNs start_ns, std::span<const LidarPoint> points) {
  std::vector<LidarPoint> out;
  out.reserve(points.size());
  for (LidarPoint point : points) {
    const TimeNs offset_ns = start_ns + point.offset_ns - from_ns;
    if (offset_ns < 0) continue;
    point.offset_ns = static_cast<std::uint32_t>(offset_ns);
    out.push_back(point);
  }
  return out;
}

std::size_t drop_until(TimeNs time_ns, std::deque<WaitingSweep>& sweeps) {
  std::size_t dropped = 0;
  for (; !sweeps.empty() && sweeps.front().end_ns <= time_ns; sweeps.pop_front()) ++dropped;
  return dropped;
}

constexpr double kAhead_s = 1.0;        // maximum time by which a sweep may end after the newest sample
constexpr double kSweepsMax_hz = 20.0;  // maximum sweep rate of a lidar, for the number of sweeps that wait for rates

}  // namespace

TumblingOdometry::Impl::Impl(const Params& params)
    : params_(params),
      stated_calibration_(params.lidar_calibration_prior()),
      stamp_order_(params.expert->rate.rate.kGapMax_s),
      outlier_filter_(outlier_params(params)),
      sample_clock_(params.expert->stamps),
      plausibility_(plausibility_setup(params.expert->gravity_m_s2, params.imu.gyro_range_rad_s)),
      odometry_pass_(rate_stream_params(params), mapper_params(params)),
      first_seconds_reprocessing_(params.expert->first_seconds_reprocessing, rate_stream_params(params),
                                  mapper_params(params)),
      further_lidars_(params.further_lidars, params.T_IL) {}

Status TumblingOdometry::Impl::add_imu(const ImuSample& sample) {
  if (const Status status = check_sample(sample); !status.ok()) return status;
  if (uses_whole_recording()) return record_sample(sample);
  StampOrder::Verdict verdict{};
  if (const Status status = stamp_order_.order_of_stamp(sample.time_ns, stamp_order_state_, verdict); !status.ok())
    return status;
  if (verdict == StampOrder::Verdict::restarts_after_gap) restart_rate_estimation();
  if (verdict == StampOrder::Verdict::restarts_after_step_back) restart_at_newest();
  if (outlier_filter_.first_is_outlier(sample, outlier_filter_state_)) restart_without_first_sample();
  for (const ImuSample& confirmed : outlier_filter_.filter_sample(sample, outlier_filter_state_)) {
    if (const Status status = process_ordered_sample(confirmed); !status.ok()) return status;
  }
  if (outlier_filter_.must_delay_for_check(sample, outlier_filter_state_)) return {};
  if (const Status status = process_ordered_sample(sample); !status.ok()) return status;
  const std::optional<Eigen::Vector3d> offset = gyro_offset_.detect_initial_offset(sample, gyro_offset_state_);
  if (!offset) return {};
  restart_with_gyro_offset(*offset);
  return process_ordered_sample(sample);
}

Status TumblingOdometry::Impl::process_ordered_sample(const ImuSample& sample) {
  SampleClock::State stamps = sample_clock_state_;  // a copy, because a rejected sample must not change the clock
  ImuSample timed = sample;
  if (const Status status = sample_clock_.push(sample.time_ns, stamps, timed.time_ns); !status.ok()) return status;
  if (const Status status = odometry_pass_.add_imu(timed); !status.ok()) return status;
  sample_clock_state_ = stamps;
  OutlierFilter::mark_accepted(sample, outlier_filter_state_);
  StampOrder::accept(sample.time_ns, stamp_order_state_);
  first_seconds_reprocessing_.store_input(timed);
  plausibility_.step(timed, plausibility_state_);
  ImuPlausibility::limit_memory(plausibility_state_);
  newest_ns_ = timed.time_ns;
  if (!last_registered_ns_) {
    last_registered_ns_ = timed.time_ns;
    sweeps_before_first_imu_ += drop_until(timed.time_ns, waiting_sweeps_);
  }
  register_sweeps_with_rates();
  return {};
}

Status TumblingOdometry::Impl::add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points) {
  if (finished_) return {ErrorCode::out_of_range, "sweeps after finish()", 1.0, 0.0};
  if (end_ns < start_ns) return {ErrorCode::time_order, "end_ns", double(end_ns), double(start_ns)};
  if (const Status status = check_stamp(start_ns, "start_ns"); !status.ok()) return status;
  if (const Status status = check_stamp(end_ns, "end_ns"); !status.ok()) return status;
  const TimeNs from_ns = std::max(start_ns, sweep_end_ns_.value_or(start_ns));
  if (from_ns > start_ns && from_ns - start_ns > (end_ns - start_ns) / 2)
    return {ErrorCode::time_order, "start_ns", double(start_ns), double(from_ns)};
  const TimeNs latest_ns = newest_ns_.value_or(end_ns) + static_cast<TimeNs>(1e9 * kAhead_s);
  if (end_ns > latest_ns) return {ErrorCode::out_of_range, "end_ns", double(end_ns), double(latest_ns)};
  if (last_registered_ns_ && end_ns <= *last_registered_ns_) {
    ++sweeps_before_first_imu_;
    return {};
  }
  const std::size_t most = max_waiting_sweeps();
  if (waiting_sweeps_.size() >= most && !newest_ns_)
    sweeps_before_first_imu_ += drop_until(waiting_sweeps_.front().end_ns, waiting_sweeps_);
  if (waiting_sweeps_.size() >= most)
    return {ErrorCode::out_of_range, "sweeps waiting", double(waiting_sweeps_.size() + 1), double(most)};
  if (const Status status = mapping::check_time_offsets(end_ns - start_ns, points); !status.ok()) return status;
  sweep_end_ns_ = end_ns;
  waiting_sweeps_.push_back({from_ns, end_ns, points_after(from_ns, start_ns, points)});
  register_sweeps_with_rates();
  return {};
}

std::size_t TumblingOdometry::Impl::max_waiting_sweeps() const {
  return params_.expert->waiting_sweeps_max + static_cast<std::size_t>(kSweepsMax_hz * params_.lag_s);
}

Status TumblingOdometry::Impl::add_sweep(std::size_t lidar, TimeNs start_ns, TimeNs end_ns,
                                         std::span<const LidarPoint> points) {
  if (lidar == 0) return add_sweep(start_ns, end_ns, points);
  if (finished_) return {ErrorCode::out_of_range, "sweeps after finish()", 1.0, 0.0};
  const TimeNs latest_ns = newest_ns_.value_or(end_ns) + static_cast<TimeNs>(1e9 * kAhead_s);
  return further_lidars_.add(lidar, start_ns, end_ns, points, latest_ns,
                             params_.further_lidars.size() * max_waiting_sweeps());
}

Status TumblingOdometry::Impl::add_reading(const OdometerReading& reading) {
  if (!newest_ns_) return {ErrorCode::empty, "imu samples", 0.0, 1.0};
  const std::size_t most =
      uses_whole_recording() ? std::numeric_limits<std::size_t>::max() : WaitingReadings::kReadingsMax;
  const TimeNs latest_ns = *newest_ns_ + static_cast<TimeNs>(1e9 * kAhead_s);
  return readings_.add(reading, odometry_pass_.oldest_needed_ns(*last_registered_ns_), latest_ns, most);
}

Status TumblingOdometry::add_frame_alignment_position(const PositionReading& position) {
  if (!impl_->newest_ns_) return {ErrorCode::empty, "imu samples", 0.0, 1.0};
  const std::size_t most =
      impl_->uses_whole_recording() ? std::numeric_limits<std::size_t>::max() : PositionAlignment::kReadingsMax;
  const TimeNs latest_ns = *impl_->newest_ns_ + static_cast<TimeNs>(1e9 * kAhead_s);
  return impl_->positions_.add(position, impl_->odometry_pass_.oldest_needed_ns(*impl_->last_registered_ns_), latest_ns,
                               most);
}

std::optional<TumblingOdometry::Sweep> TumblingOdometry::take() {
  if (impl_->finished_results_.empty()) return std::nullopt;
  std::optional<Sweep> out(std::move(impl_->finished_results_.front()));
  impl_->finished_results_.pop_front();
  return out;
}

Status TumblingOdometry::Impl::newest(PoseState& pose, Eigen::Matrix3d* velocity_covariance_I_m2_s2) const {
  return odometry_pass_.newest(pose, velocity_covariance_I_m2_s2);
}

std::optional<double> TumblingOdometry::estimated_jitter_s() const {
  return impl_->sample_clock_.corrects_stamps(impl_->sample_clock_state_)
             ? SampleClock::jitter_s(impl_->sample_clock_state_)
             : std::nullopt;
}

SensorHealth TumblingOdometry::Impl::health() const {
  if (uses_whole_recording()) return whole_recording_result_ ? whole_recording_result_->health : SensorHealth{};
  using Kind = HealthFinding::Kind;
  SensorHealth out = odometry_pass_.rates().rate().health(odometry_pass_.rate_stream_state().rate);
  out.add(Kind::wrong_force_magnitude_at_rest, odometry_pass_.check_force_at_rest(), "imu");
  add_findings(plausibility_, plausibility_state_, "imu", out);
  out.add(Kind::lidar_scale, odometry_pass_.lidar_scale().verdict(), "lidar");
  out.add(Kind::vertical_unknown, mapper().check_gravity_direction(), "");
  out.add(Kind::not_localised, mapper().check_localised(), "");
  const Localisation& localisation = odometry_pass_.localisation();
  out.add(Kind::tracking_lost, localisation.current_verdict(), "", "", localisation.lost_since_ns());
  const double deviations = std::max(stated_calibration_.distance_in_sigmas(mapper().lidar_calibration()),
                                     calibration_contradiction(stated_calibration_, mapper()));
  out.add(Kind::lidar_calibration, check_lidar_calibration_distance(deviations), "lidar");
  return out;
}

Status TumblingOdometry::finish(const SweepProgress& on_sweep) {
  if (impl_->uses_whole_recording()) return impl_->finish_whole_recording(on_sweep);
  OutlierFilter::finish(impl_->outlier_filter_state_);
  if (!impl_->newest_rate()) return {};  // no rate since the last call
  impl_->flush_all();
  impl_->first_seconds_reprocessing_.complete_second_pass(impl_->odometry_pass_);
  impl_->start_rate_estimation();
  return {};
}

void TumblingOdometry::Impl::register_sweep(TimeNs start_ns, TimeNs end_ns, std::vector<LidarPoint> points) {
  if (finished_results_.size() >= params_.expert->waiting_sweeps_max) {
    finished_results_.pop_front();
    ++dropped_sweeps_;
  }
  Sweep& out = finished_results_.emplace_back();
  const std::optional<OdometerReading> reading = readings_.take_readings_in(
      odometry_pass_.oldest_needed_ns(*last_registered_ns_), odometry_pass_.oldest_needed_ns(end_ns));
  out.status = odometry_pass_.add_sweep(start_ns, end_ns, points, reading, out.result);
  last_registered_ns_ = end_ns;
  if (out.result.trajectory.empty()) return;
  positions_.add_sweep(out.result);
  out.position_frame = positions_.position_frame();
  first_seconds_reprocessing_.store_input(start_ns, end_ns, std::move(points), reading, out.result.verdict);
  // The second pass has no prior map. If the first pass is localised in a prior map, the second pass would have a
  // different map frame.
  if (mapper().prior_map() != nullptr && mapper().check_localised().ok())
    first_seconds_reprocessing_.abandon_second_pass();
  const bool applied_before = first_seconds_reprocessing_.is_applied();
  first_seconds_reprocessing_.replay_next_input(odometry_pass_);
  if (first_seconds_reprocessing_.is_applied() != applied_before) positions_.restart_fit();
}

/// Returns whether a sweep must be registered immediately, because its latency would exceed lag_s when the next IMU
/// sample arrives. If the sweep ends in a gap of the IMU data, the first IMU sample after the sweep may be much later
/// than the sweep. A sweep is therefore due only if the first IMU sample after the sweep is also older than lag_s - 1.5
/// sample periods.
bool TumblingOdometry::Impl::is_due(TimeNs end_ns) const {
  const std::optional<TimeNs> covering_ns = odometry_pass_.covering_ns(end_ns);
  if (!covering_ns) return false;
  const double period_s = 1.0 / params_.imu.rate_hz, lag_s = std::max(params_.lag_s, 2.0 * period_s);
  return seconds(*newest_ns_ - odometry_pass_.oldest_needed_ns(end_ns)) + period_s > lag_s &&
         seconds(*newest_ns_ - *covering_ns) > lag_s - 1.5 * period_s;
}

void TumblingOdometry::Impl::register_sweeps_with_rates() {
  while (!waiting_sweeps_.empty()) {
    const TimeNs end_ns = waiting_sweeps_.front().end_ns;
    // The first IMU sample after a sweep may be up to one sample period later than the sweep. flush_until() therefore
    // reports the rates for a due sweep before lag_s has passed.
    if (!odometry_pass_.has_rates_until(end_ns) && is_due(end_ns))
      odometry_pass_.flush_until(odometry_pass_.oldest_needed_ns(end_ns));
    if (!odometry_pass_.has_rates_until(end_ns)) break;
    WaitingSweep sweep = std::move(waiting_sweeps_.front());
    waiting_sweeps_.pop_front();
    further_lidars_.merge_into(sweep);
    register_sweep(sweep.start_ns, sweep.end_ns, std::move(sweep.points));
  }
  const std::optional<TimeNs> covered_ns = odometry_pass_.covered_ns();
  if (!waiting_sweeps_.empty() || !covered_ns) return;
  if (seconds(*covered_ns - *last_registered_ns_) > kLidarSilent_s) {
    register_sweep(*covered_ns, *covered_ns, {});
    if (finished_results_.back().result.trajectory.empty())
      finished_results_.pop_back();  // no sweep has started the map yet
    sweep_end_ns_ = *covered_ns;
  }
}

void TumblingOdometry::Impl::flush_all() {
  odometry_pass_.flush_until(*newest_ns_);
  register_sweeps_with_rates();
}

void TumblingOdometry::Impl::restart_rate_estimation() {
  ++restart_count_;
  OutlierFilter::finish(outlier_filter_state_);
  flush_all();
  first_seconds_reprocessing_.abandon_second_pass();
  start_rate_estimation();
}

void TumblingOdometry::Impl::restart_at_newest() {
  ++restart_count_;
  PoseState pose;
  const bool located = newest(pose).ok();
  OutlierFilter::finish(outlier_filter_state_);
  if (newest_rate()) flush_all();
  Eigen::Isometry3d T_WI = mapper().start_pose().value_or(Eigen::Isometry3d::Identity());
  if (located) {
    T_WI.linear() = pose.orientation_W.toRotationMatrix();
    T_WI.translation() = pose.position_W_m;
  }
  const Eigen::Vector3d offset_rad_s = gyro_offset_rad_s();
  if (mapper().check_localised().ok()) {
    reset(T_WI);
  } else {
    reset();  // the newest pose is not in the frame of the prior map
  }
  if (!offset_rad_s.isZero(0.0)) set_gyro_offset(offset_rad_s);
}

void TumblingOdometry::Impl::restart_without_first_sample() {
  const std::optional<Eigen::Isometry3d> start = mapper().start_pose();
  std::deque<WaitingSweep> waiting = std::move(waiting_sweeps_);
  FurtherLidars further = std::move(further_lidars_);
  OutlierFilter::State outliers = outlier_filter_state_;
  const std::optional<TimeNs> sweep_end_ns = sweep_end_ns_;
  reset();
  if (start) odometry_pass_.set_start_pose(*start);
  waiting_sweeps_ = std::move(waiting);
  further_lidars_ = std::move(further);
  sweep_end_ns_ = sweep_end_ns;
  outliers.rejected += std::exchange(outliers.count, 0);
  outlier_filter_state_ = outliers;
}

void TumblingOdometry::Impl::restart_with_gyro_offset(const Eigen::Vector3d& offset_rad_s) {
  const std::optional<Eigen::Isometry3d> start = mapper().start_pose();
  sweeps_before_first_imu_ += waiting_sweeps_.size();
  reset();
  if (start) odometry_pass_.set_start_pose(*start);
  set_gyro_offset(offset_rad_s);
}

void TumblingOdometry::Impl::set_gyro_offset(const Eigen::Vector3d& offset_rad_s) {
  gyro_offset_state_.offset_decided = true;
  MotionRegimeStream::Params rate = rate_stream_params(params_);
  rate.rate.model.nominal.gyro_bias_rad_s = offset_rad_s;
  if (rate.rate.model.calibration) rate.rate.model.calibration->constants.gyro_bias_rad_s = offset_rad_s;
  odometry_pass_.start_rate_estimation(rate);
  first_seconds_reprocessing_.set_gyro_offset(offset_rad_s);
}

void TumblingOdometry::Impl::reset() {
  const auto fresh = std::make_unique<Impl>(params_);
  fresh->stated_calibration_ = stated_calibration_;
  fresh->restart_count_ = restart_count_;
  fresh->dropped_sweeps_ = dropped_sweeps_;
  fresh->sweeps_before_first_imu_ = sweeps_before_first_imu_;
  fresh->outlier_filter_state_.rejected = outlier_filter_state_.rejected;
  fresh->finished_results_ = std::move(finished_results_);
  fresh->odometry_pass_.copy_prior_map(odometry_pass_);
  *this = std::move(*fresh);
}

void TumblingOdometry::Impl::reset(const Eigen::Isometry3d& T_WI) {
  reset();
  odometry_pass_.set_start_pose(T_WI);
  odometry_pass_.copy_prior_map(odometry_pass_);
}

void TumblingOdometry::Impl::start_rate_estimation() {
  MotionRegimeStream::Params params = rate_stream_params(params_);
  params.rate.model.nominal.gyro_bias_rad_s = gyro_offset_rad_s();
  if (const BodyImuCalibration learnt = body_imu_calibration(); check_body_imu_calibration(learnt).ok())
    params.rate.model.calibration = learnt;
  odometry_pass_.start_rate_estimation(params);
}

}  // namespace tumble
