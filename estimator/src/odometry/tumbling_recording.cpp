// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <utility>

#include "tumbling_odometry_impl.hpp"
#include "tumbling_odometry_params.hpp"

namespace tumble {

namespace {

ImuDescription imu_check_params(const TumblingOdometry::Params& params) {
  return {.gyro_range_rad_s = params.imu.gyro_range_rad_s,
          .accel_range_m_s2 = params.imu.accel_range_m_s2,
          .gravity_m_s2 = params.expert->gravity_m_s2,
          .lever_arm_I_m = params.lever_arm_I_m};
}

/// `stamps_ns` receives the uncorrected time stamps of all samples that OutlierFilter accepts.
Status select_samples(const OutlierFilter& filter, const SampleClock& clock, std::vector<ImuSample>& samples,
                      OutlierFilter::State& outliers, WholeRecordingEstimate& out) {
  const std::vector<bool> inlier = find_inliers(filter, samples);
  std::size_t next = 0;
  outliers.rejected += std::erase_if(samples, [&](const ImuSample&) { return !inlier[next++]; });
  for (const ImuSample& sample : samples) out.stamps_ns.push_back(sample.time_ns);
  std::vector<TimeNs> times_ns = out.stamps_ns;
  if (Status status = correct_stamps(clock, times_ns, out.corrected_jitter_s); !status.ok()) return status;
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k].time_ns = times_ns[k];
  return {};
}

Status estimate_rates(const TumblingOdometry::Params& params, std::span<const ImuSample> samples,
                      WholeRecordingEstimate& out) {
  const MotionRegimeSmoother smoother(odometry::recording_rate_params(params));
  if (Status status = smoother.estimate(samples, out.rates, out.report); !status.ok()) return status;
  const std::optional<double> hand_held =
      out.report.regimes_estimated ? std::optional(out.report.probabilities.hand_held) : std::nullopt;
  out.findings = check_recording(imu_check_params(params), samples, out.rates, hand_held);
  out.suspected_error_covariance_rad2_s2 = suspected_error_covariance(out.findings, samples, out.rates);
  for (std::size_t k = 0; k < out.suspected_error_covariance_rad2_s2.size(); ++k)
    out.rates[k].covariance_rad2_s2 += out.suspected_error_covariance_rad2_s2[k];
  return {};
}

}  // namespace

Status TumblingOdometry::Impl::record_sample(const ImuSample& sample) {
  if (finished_) return {ErrorCode::out_of_range, "samples after finish()", 1.0, 0.0};
  StampOrder::Verdict verdict{};
  if (const Status status = stamp_order_.order_of_stamp(sample.time_ns, stamp_order_state_, verdict); !status.ok())
    return status;
  const bool first_is_wrong = verdict != StampOrder::Verdict::continues_in_order && recorded_samples_.size() <= 1;
  if (verdict == StampOrder::Verdict::restarts_after_step_back && !first_is_wrong)
    return {ErrorCode::time_order, "time_ns", double(sample.time_ns), double(recorded_samples_.back().time_ns)};
  if (verdict == StampOrder::Verdict::restarts_after_gap && !first_is_wrong) ++restart_count_;
  if (first_is_wrong) {
    recorded_samples_.clear();
    stamp_order_state_ = {};
    last_registered_ns_.reset();
  }
  StampOrder::accept(sample.time_ns, stamp_order_state_);
  recorded_samples_.push_back(sample);
  newest_ns_ = sample.time_ns;
  if (!last_registered_ns_) last_registered_ns_ = sample.time_ns;
  return {};
}

Status TumblingOdometry::Impl::finish_whole_recording(const SweepProgress& on_sweep) {
  if (finished_) return {};
  finished_ = true;
  finished_results_.clear();
  const LidarInertialOdometry::Params mapping = odometry::mapper_params(params_);
  const auto whole = std::make_shared<WholeRecordingEstimate>(mapping);
  std::vector<ImuSample> samples = recorded_samples_;
  if (Status status = select_samples(outlier_filter_, sample_clock_, samples, outlier_filter_state_, *whole);
      !status.ok())
    return status;
  if (Status status = estimate_rates(params_, samples, *whole); !status.ok()) return status;
  whole->saturation_levels =
      flag_saturated_forces(odometry::recording_rate_params(params_).rate.saturation_detector, samples);
  for (WaitingSweep& sweep : waiting_sweeps_) further_lidars_.merge_into(sweep);
  if (!waiting_sweeps_.empty()) {
    const MappingInput input{samples,
                             whole->rates,
                             waiting_sweeps_.size(),
                             [&](std::size_t k) {
                               if (on_sweep) on_sweep(k, waiting_sweeps_.size());
                               return waiting_sweeps_[k];
                             },
                             [this](TimeNs from_ns, TimeNs to_ns) { return readings_.find(from_ns, to_ns); },
                             odometry_pass_.mapper().start_pose()};
    whole->mapped_recording = map_with_calibration(input, mapping);
    whole->scale = find_sweep_scale(samples, whole->mapped_recording, params_.expert->gravity_m_s2);
  }
  PositionAlignment positions = positions_;
  for (MappedSweep& sweep : whole->mapped_recording.sweeps) {
    positions.add_sweep(sweep.result);
    finished_results_.push_back({sweep.status, std::move(sweep.result), positions.position_frame()});
  }
  whole->mapped_recording.sweeps.clear();
  whole->health = whole->findings.health;
  if (!waiting_sweeps_.empty()) whole->mapped_recording.add_findings(whole->scale, whole->health);
  whole_recording_result_ = whole;
  return whole->mapped_recording.status;
}

const LidarInertialOdometry& TumblingOdometry::Impl::mapper() const {
  return whole_recording_result_ ? whole_recording_result_->mapped_recording.mapper : odometry_pass_.mapper();
}

const LidarScale& TumblingOdometry::Impl::lidar_scale() const {
  return whole_recording_result_ ? whole_recording_result_->scale : odometry_pass_.lidar_scale();
}

BodyImuCalibration TumblingOdometry::Impl::body_imu_calibration() const {
  return whole_recording_result_
             ? whole_recording_result_->report.rate.calibration
             : odometry_pass_.rates().rate().body_imu_calibration(odometry_pass_.rate_stream_state().rate);
}

const SaturationLevels& TumblingOdometry::Impl::saturation_levels() const {
  return whole_recording_result_ ? whole_recording_result_->saturation_levels
                                 : odometry_pass_.rate_stream_state().rate.clipping_state.known_limits;
}

}  // namespace tumble
